"""Texts of five networks, of which each file is one of columns, a component each, or of the values of one component.

The header states the layout. CWB (Taiwan): lines "#Key: value" and times in the first column. NSMN (Turkey, AFAD):
lines "KEY : value" and a line of names. UNAM (Mexico): lines in format 2.0 of the Mexican database of strong motions,
values of channels between slashes. ESM and ITACA (Europe, Italy): 64 lines "KEY: value" in format DYNA (Luzi et al.,
Seismological Research Letters 87, 987, 2016; each file names its version in HEADER_FORMAT), then one value in a line.
K-NET and KiK-net (NIED, Japan): 17 lines of header, then integers of one component; these have an offset, which stays
in the values, and "Max. Acc." in the header is without it.
"""

import re
from collections.abc import Sequence
from itertools import product

import numpy as np

from dembound.records.channel import Channel, Record
from dembound.records.formats.numbers import COUNT, DECIMAL, Flaw, number_of
from dembound.records.formats.source import SAME, Format, Source
from dembound.waves.unit_names import unit_named

GAL = 0.01
"""m/s²."""

LONGEST = 120
"""Lines of the longest header."""


class Cwb(Format):
    """Central Weather Bureau of Taiwan: "#DataSequence: Time U(+); N(+); E(+)" states the columns."""

    name = "CWB"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the header states the order of the columns."""
        text = "\n".join(lines[:LONGEST])
        return re.search(r"^#DataSequence: *Time ", text, re.MULTILINE) is not None

    def read(self, source: Source) -> Record:
        """The three components of the file."""
        begin = 0
        while source.line(begin).startswith("#") or not source.line(begin).strip():
            begin += 1
        sequence = value(source, "#DataSequence")
        names = re.findall(r"([A-Z])\([+-]\)", sequence)
        if "(-)" in sequence:
            raise Flaw(f"has columns of the opposite sense ({sequence}); --skip {begin} reads them as columns of text")
        unit = source.measured(value(source, "#AmplitudeUnit").partition(".")[0])
        rate = float(source.found(rf"^#SampleRate\(Hz\):\s*({DECIMAL})", 0, begin, "the sampling rate")[1])
        rows = columns_below(source, begin, 1 + len(names))
        time, step = rows[0], float(f"{(rows[0][-1] - rows[0][0]) / max(len(rows[0]) - 1, 1):.12g}")
        if abs(step * rate - 1.0) > 1e-3:
            raise Flaw(f"states {rate:g} samples in a second, times are {step:g} s apart")
        channels = []
        for name, values in zip(names, rows[1:], strict=True):
            peaks = value(source, rf"#AmplitudeMAX\. {name}")
            peak = max(re.findall(DECIMAL, peaks), key=lambda text: abs(float(text)), default="")
            even, numbers = source.evenly(time, values)
            length = value(source, "#RecordLength")
            channels.append(source.channel(name, unit, numbers, step, float(even[0]), peak, length=length))
        return Record("CWB", _title(source, "#StationCode", "#Origin Time"), tuple(channels))


class Nsmn(Format):
    """National Strong Motion Network of Turkey (AFAD): three components in gal."""

    name = "NSMN"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the first line names the network's records."""
        return lines[0].startswith("STRONG GROUND MOTION RECORDS OF TUR")

    def read(self, source: Source) -> Record:
        """The components of the file."""
        named = (at for at, line in enumerate(source.lines[:LONGEST]) if re.fullmatch(r"(\s+[NEU]-[SWD])+\s*", line))
        if (begin := next(named, -1) + 1) == 0:
            raise Flaw('has no line of names such as "N-S E-W U-D"; --skip 17 and --columns read it as columns of text')
        count = int(source.found(rf"^NUMBER OF DATA\s*:\s*{COUNT}", 0, begin, "the number of data")[1])
        peaks, step = value(source, "RAW PGA VALUES"), value(source, r"SAMPLING INTERVAL \(sec\)")
        spelled = re.search(r"^RAW PGA VALUES \(([^)]*)\)", "\n".join(source.lines[:begin]), re.MULTILINE)
        names, unit = source.line(begin - 1).split(), source.measured(spelled[1] if spelled else "")
        rows = columns_below(source, begin, len(names), count)
        peak = {name: value for name, value in re.findall(rf"\(([^)]*)\)\s*({DECIMAL})", peaks)}
        channels = [
            source.channel(name, unit, values, number_of(step), peak=peak.get(name, ""))
            for name, values in zip(names, rows, strict=True)
        ]
        return Record("NSMN", _title(source, "PLACE", "EARTHQUAKE DATE"), tuple(channels))


class Unam(Format):
    """Standard accelerograms of the Institute of Engineering of UNAM, Mexico: up to twelve channels in gal."""

    name = "UNAM"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the header is that of a standard file of accelerations."""
        return any(line.startswith("ARCHIVO ESTANDAR DE ACELERACION") for line in lines[:20])

    def read(self, source: Source) -> Record:
        """The channels of the file."""
        begin = next((at for at, line in enumerate(source.lines[:LONGEST]) if "CANAL-1" in line), 0) + 3
        names, counts = _slashed(source, "ORIENTACION"), _slashed(source, r"NUM\. TOTAL DE MUESTRAS")
        if len(names) != len(counts) or len(set(counts)) != 1 or not counts[0].isdecimal():
            raise Flaw("states unlike numbers of channels or samples")
        unit = source.measured(value(source, "UNIDADES DE LOS DATOS").partition(" ")[0])
        rows = columns_below(source, begin, len(names), int(counts[0]))
        rates, steps, lengths, peaks = (
            [number_of(text) for text in _slashed(source, key)] or [None] * len(names)
            for key in ("VEL. DE MUESTREO", "INTERVALO DE MUESTREO", "DURACION DEL REGISTRO", r"ACEL\. MAX\.\s*\(Gal\)")
        )
        if {len(each) for each in (rates, steps, lengths, peaks)} != {len(names)}:
            raise Flaw("states unlike numbers of channels")
        channels: list[Channel] = []
        for name, rate, step, length, peak, values in zip(names, rates, steps, lengths, peaks, rows, strict=True):
            if step is not None and rate and abs(step * rate - 1.0) > SAME:
                raise Flaw(f"{name}: states {rate:g} samples/s, and one every {step:g} s")
            between = 1.0 / rate if step is None and rate else step
            stated = f"{GAL * peak / unit.size:.5g}" if peak is not None else ""
            channels.append(source.channel(name, unit, values, between, peak=stated, length=f"{length}"))
        return Record("UNAM", _title(source, "NOMBRE DE LA ESTACION", "FECHA DEL SISMO"), tuple(channels))


def columns_below(source: Source, begin: int, width: int, count: int | None = None) -> np.ndarray:
    """The numbers (width, n) of the lines from an index on.

    Raises Flaw for lines of other numbers, and for another count of lines; repetitions of the last one, which fill a
    file, are remarked on.
    """
    rows = []
    for number, text in enumerate(source.lines[begin:], start=begin + 1):
        numbers = [found for field in text.split() if (found := number_of(field)) is not None]
        if text.strip() and (len(numbers) != width or len(text.split()) != width):
            raise Flaw(f"line {number} has {len(numbers)} numbers, must have {width}")
        rows += [numbers] if numbers else []
    if count is not None and len(rows) != count:
        if not 0 < count < len(rows) or any(row != rows[count - 1] for row in rows[count:]):
            raise Flaw(f"has {len(rows)} lines of numbers, the header states {count}")
        source.remarks.append(f"{len(rows) - count} repetitions of the last line are left out")
    return np.array(rows[:count]).reshape(-1, width).T


def value(source: Source, key: str) -> str:
    """The text behind a key of the header, further words and a colon; empty without one. Raises Flaw for two texts."""
    matches = (re.match(rf"{key}[^:]*:(.*)", line) for line in source.lines[:LONGEST])
    found = list(dict.fromkeys(each[1].strip() for each in matches if each))
    if len(found) > 1:
        twice = f'has the line "{key}" twice, with {found[0]} and {found[1]}; remove the wrong one'
        raise Flaw(twice.replace("\\", ""))
    return found[0] if found else ""


def _title(source: Source, *keys: str) -> str:
    """The values of these keys in one line."""
    return ", ".join(filter(None, (value(source, key) for key in keys)))


def _slashed(source: Source, key: str) -> list[str]:
    """The values of all channels behind keys of UNAM's header, "/V/N00E/N90E" of the first six and of others."""
    found = (re.match(rf"{key}[^:]*C\d+-C\d+[^:]*:(.*)", line) for line in source.lines[:LONGEST])
    return [text.strip() for each in found if each for text in each[1].strip().split("/")[1:] if text.strip()]


KEY = re.compile(r"[A-Z][A-Z0-9_/^ ]*:")


class Esm(Format):
    """Accelerations, velocities or displacements, by DATA_TYPE."""

    name = "ESM/ITACA ASC"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the header has keys of the format."""
        keys = {line.partition(":")[0] for line in lines[: _begin(lines)]}
        return {"SAMPLING_INTERVAL_S", "NDATA", "UNITS"} <= keys

    def read(self, source: Source) -> Record:
        """The component of the file."""
        begin = _begin(source.lines)

        def stated(key: str, pattern: str = r"(.*?)") -> str:
            return str(source.found(rf"^{key}:[ \t]*{pattern}[ \t]*$", 0, begin, key)[1])

        texts = {key: value.strip() for key, _, value in (line.partition(":") for line in source.lines[:begin])}
        unit = source.measured(stated("UNITS"), texts.get("DATA_TYPE", ""))
        key = next((key for key in texts if re.match(r"PG[AVD]_", key)), "")
        of_peak, peak = unit_named(key[4:]), texts.get(key, "")
        if of_peak is not None and of_peak.size != unit.size and (stated_peak := number_of(peak)) is not None:
            peak = f"{stated_peak * of_peak.size / unit.size:.6g}"
        values, step = source.free(begin, int(stated("NDATA", COUNT))), stated("SAMPLING_INTERVAL_S", rf"({DECIMAL})")
        length = texts.get("DURATION_S", "")
        channel = source.channel(texts.get("STREAM", ""), unit, values, float(step), peak=peak, length=length)
        names = (texts.get(key, "") for key in ("STATION_CODE", "STATION_NAME", "EVENT_NAME", "EVENT_DATE_YYYYMMDD"))
        return Record("ESM/ITACA ASC", ", ".join(filter(None, names)), (channel,))


def _begin(lines: Sequence[str]) -> int:
    """Index of the first line that is no key."""
    return next((at for at, line in enumerate(lines) if not KEY.match(line)), len(lines))


HEADER = 17
PLACES = product(("borehole", "surface"), ("N-S", "E-W", "U-D"))
KIK_NET = {str(number): f"{direction} ({place})" for number, (place, direction) in enumerate(PLACES, start=1)}
"""Components by their numbers in files of KiK-net."""


class Knet(Format):
    """Values are integers times the "Scale Factor", as 3920(gal)/6182761."""

    name = "K-NET/KiK-net"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the header begins with the origin time and has a sampling frequency."""
        return lines[0].startswith("Origin Time") and any(line.startswith("Sampling Freq") for line in lines[:HEADER])

    def read(self, source: Source) -> Record:
        """The component of the file."""

        def stated(key: str, pattern: str = rf"({DECIMAL})") -> tuple[str, ...]:
            found = source.found(rf"^{key}\s+{pattern}", 0, HEADER, key.replace("\\", ""))
            return tuple(map(str, found.groups()))

        (rate,), (duration,) = stated(r"Sampling Freq\(Hz\)"), stated(r"Duration Time\(s\)")
        full, unit, steps = stated("Scale Factor", rf"({DECIMAL})\((\w+)\)/({DECIMAL})")
        (station,), (direction,) = stated("Station Code", r"(\S+)"), stated(r"Dir\.", r"(\S+)")
        (peak,), (origin,) = stated(r"Max\. Acc\. \(gal\)"), stated("Origin Time", r"(\S.*\S)")
        if not (0.0 < float(rate) <= 1e6 and 0.0 < float(duration) <= 1e6 and float(steps) > 0.0):
            raise Flaw("sampling frequency, duration and scale factor must be positive")
        values = source.free(HEADER, round(float(duration) * float(rate))) * (float(full) / float(steps))
        found = float(np.abs(values - values.mean()).max())
        component, step = KIK_NET.get(direction, direction), 1.0 / float(rate)
        channel = source.channel(component, source.measured(unit), values, step, peak=peak, found=found)
        return Record("KiK-net" if direction in KIK_NET else "K-NET", f"{station}, earthquake of {origin}", (channel,))
