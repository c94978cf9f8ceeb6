"""Files of volumes 1 and 2, uncorrected and corrected, of several channels.

V1 and V2 of the California Strong Motion Instrumentation Program (CSMIP, formerly DMG), which RENADIC of Chile writes,
too, those of the University of Southern California (USC), and V1 of Iran's BHRC. They descend from volumes I and II of
the California Institute of Technology (Trifunac and Lee, Routine computer processing of strong-motion accelerograms,
EERL 73-03, 1973). The header of a channel has 13 lines of text (V1) or 25 (V2), 7 lines of integers and 7 (V1) or 13
(V2) of numbers. V1 has uncorrected accelerations, even ones or, from film, pairs of time and acceleration; V2 has
corrected accelerations, velocities and displacements. A line "/&" ends a channel of CSMIP.
"""

import re
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from dembound.records.channel import Channel, Record
from dembound.records.formats.numbers import COUNT, DECIMAL, Flaw, number_of, rows_of, with_rounding
from dembound.records.formats.source import END, Format, Source
from dembound.waves.unit_names import Named, unit_named

BLOCK = re.compile(
    rf"\s*{COUNT}\s+(?:points of\s+)?(acc|vel|dis).*?\bat\s+({DECIMAL})\s*(pts/)?sec"
    r"\W*(?:in units of|in units|units:?|in)\s+([^\s()]+)(.*)",
    re.IGNORECASE,
)
"""The line before even samples, as "31932 Accelerogram points at 100 pts/sec in units of g.  Format: (8f9.6)"."""

PAIRS, EVEN = "(10f7.3)", "(10e13.6)"
RATE_LINE = 21
"""Layouts of pairs of time and acceleration, which USC shifts by a blank, and of BHRC's accelerations; the line in the
header whose first number is BHRC's sampling rate."""

FIRST = {
    "uncorrected accelerogram data": "CSMIP V1",
    "corrected accelerogram": "CSMIP V2",
    "response and fourier": "CSMIP V3",
    "file of uncorrected accelerogram data of volume i:": "USC V1",
    "* vol1ds file:": "BHRC V1",
}
"""How the first line of a channel begins, without a number behind "file" -> program and volume."""

TITLE = {"CSMIP V1": (5, 1), "CSMIP V2": (6, 2), "USC V1": (5, 1), "USC V2": (6, 2), "BHRC V1": (7, 2)}
"""Index of the lines of a header that name the station, and the event or its time."""

TENTHS = re.compile(r"units (?:of uncor\w*\s.*?|are sec\w* )and (g)(/10)?", re.IGNORECASE)
"""The unit of uncorrected accelerations in the text of a header, g or a tenth of it."""

HEADER = {"V1": 27, "V2": 45}
LAYOUT = {"V1": "(8f9.6)", "V2": "(8f10.3)"}
"""Lines of the header of a channel, and the layout of samples where the line before them has none."""


class Volumes(Format):
    """All channels and quantities of a file."""

    name = "CSMIP, USC or BHRC V1/V2"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the first lines are those of a file of one of the volumes."""
        return bool(_volume(lines, 0))

    def read(self, source: Source) -> Record:
        """The channels of the file, of V2 with all three quantities."""
        volume = _volume(source.lines, 0)
        if volume[-2:] not in HEADER:
            raise Flaw("holds spectra (V3), must be V1 or V2")
        place, event = TITLE[volume]
        title = f"{source.line(place)[:40].strip()}, {source.line(event)[:40].strip()}"
        return Record(volume, title, source.channels(partial(_channel, volume)))


def _volume(lines: Sequence[str], begin: int) -> str:
    """Program and volume by the first lines of a channel; empty for other lines."""
    first, second = ("\n".join(lines[begin : begin + 2]).lower() + "\n").split("\n")[:2]
    plain = re.sub(r"^file\s+\d+", "file", first)
    found = next((volume for words, volume in FIRST.items() if plain.startswith(words)), "")
    if found == "CSMIP V2" and "uncorrected accelerogram" not in second:
        return ""
    return "USC V2" if found == "CSMIP V2" and "volume i:" in second else found


def _channel(volume: str, source: Source, begin: int) -> tuple[list[Channel], int]:
    """The quantities of the channel that begins at a line, by its index, and the index of the line that ends it."""
    if _volume(source.lines, begin) != volume:
        raise Flaw(f"line {begin + 1} is not the first one of a channel of {volume}")
    at = begin + HEADER[volume[-2:]]
    named = r"^(?:chan\s+\d+:|comp\b(?=[^:]*$))\s*(\S+(?: \S+)*?)\s*(?:deg)?\s*(?:\(.*\)\s*|\s\d+\s*)?$"
    component = source.found(named, begin, at, "the component")[1]
    found = []
    if volume[-1] == "1" and re.fullmatch(r"[-.DE\d\s+]+", source.line(at)):
        read = _evenly if volume.startswith("BHRC") else _from_film
        channel, at = read(source, component, begin, at)
        found.append(channel)
    while at < len(source.lines) and (block := BLOCK.match(source.lines[at])):
        count, layout = int(block[1]), block[6] if "(" in block[6] else LAYOUT[volume[-2:]]
        values = source.fixed(at + 1, count, layout)
        rate = float(block[3])
        step = rate if not block[4] else 1.0 / rate if rate else 0.0
        unit = source.measured(block[5], block[2])
        in_text = TENTHS.search("\n".join(source.lines[begin:at])) if volume == "CSMIP V1" else None
        if in_text is not None and source.measured(in_text[1] + (in_text[2] or ""))[1:] != unit[1:]:
            raise Flaw(f"line {at + 1} states {unit.spelled.strip()}, the header another unit; give it by --unit")
        peak = _peak(source, at) if volume == "CSMIP V1" else _peak_of(block[2], source, begin, unit)
        if volume == "CSMIP V1":
            _require_text(source, begin, at, count, peak, step)
        length = _length(source, begin, at)
        found.append(source.channel(component, unit, values, step, peak=peak, length=length))
        at += 1 + rows_of(count, layout)
    if not found:
        raise Flaw(f"line {at + 1} does not state number, time step and unit of samples")
    if at < len(source.lines) and source.lines[at].strip() and not END.match(source.lines[at]):
        raise Flaw(f"line {at + 1} does not end the channel, after {len(found[-1].values)} samples")
    return found, at


def _in_tenths(source: Source, begin: int, at: int) -> tuple[int, Named, float]:
    """The number of points of uncorrected data, their unit, and its part in which they are: g, or a tenth of it.

    Raises Flaw for a unit that is given in place of tenths, and if the numbers of the header have another part, but not
    those of CSMIP, which are not reliable.
    """
    count = int(source.found(rf"no\. of points\s*=\s*{COUNT}\b", begin, at, "the number of points")[1])
    unit = TENTHS.search("\n".join(source.lines[begin:at]))
    is_tenth = unit is not None and unit[2] is not None
    if is_tenth and source.given.unit is not None:
        raise Flaw(f"--unit: is {source.given.unit}, the header states tenths of g; leave it out")
    volume = _volume(source.lines, begin)
    width = 13 if volume == "BHRC V1" else 10
    scale = number_of(source.line(at - 7)[4 * width : 5 * width]) if volume != "CSMIP V1" else None
    if scale == 0.1 and not is_tenth and source.given.unit is None:
        raise Flaw("states g in the text, a tenth of it in the numbers; give --unit for the numbers as they are")
    return count, source.measured(unit[1] if unit else ""), 0.1 if is_tenth else 1.0


def _evenly(source: Source, component: str, begin: int, at: int) -> tuple[Channel, int]:
    """BHRC's channel of even accelerations that begins at a line, and the index of the line behind them."""
    count, unit, part = _in_tenths(source, begin, at)
    rate = number_of(source.line(begin + RATE_LINE)[:13])
    values, step = part * source.fixed(at, count, EVEN), 1.0 / rate if rate else None
    return source.channel(component, unit, values, step, length=_length(source, begin, at)), at + rows_of(count, EVEN)


def _from_film(source: Source, component: str, begin: int, at: int) -> tuple[Channel, int]:
    """The channel whose pairs of time and acceleration begin at a line, and the index of the line behind them."""
    count, unit, part = _in_tenths(source, begin, at)
    rows = rows_of(2 * count, PAIRS)
    if len(source.line(at).rstrip()) % 7:  # USC's lines begin with a blank
        source = replace(source, lines=[line[1:] for line in source.lines])
    pairs = source.fixed(at, 2 * count, PAIRS)
    step, values = source.from_film(pairs[::2], part * pairs[1::2])
    found = float(np.abs(part * pairs[1::2]).max())
    peak = _peak(source, at) if _volume(source.lines, begin) == "CSMIP V1" else ""
    _require_text(source, begin, at, count, peak)
    length = _length(source, begin, at)
    return source.channel(component, unit, values, step, float(pairs[0]), peak, found, length), at + rows


def _length(source: Source, begin: int, at: int) -> str:
    """The length of the record (s) in the header of a channel; empty without one."""
    text = "\n".join(source.lines[begin:at])
    found = re.search(rf"(?:record length|duration)\s*=\s*({DECIMAL})", text, re.IGNORECASE)
    return found[1] if found else ""


def _require_text(source: Source, begin: int, at: int, count: int, peak: str, step: float | None = None) -> None:
    """Raise Flaw if the text of a V1 header states another number, rate or peak than below, unless a unit is given."""
    text = "\n".join(source.lines[begin:at])
    for what, pattern, below in (
        ("number of points", rf"no\. of points\s*=\s*{COUNT}", count),
        ("sampling rate", rf"\bat\s+({DECIMAL})\s+samples/sec", 1.0 / step if step else None),
        ("peak", rf"\bmax\s*=\s*({DECIMAL})\s*g\b", number_of(peak)),
    ):
        said, rounding = with_rounding(match[1] if (match := re.search(pattern, text, re.IGNORECASE)) else "")
        if said is None or below is None or source.given.unit:
            continue
        if abs(said - abs(below)) > 1.01 * rounding:
            begins = f"line {begin + 1} begins a text with a {what} of {said:g}"
            raise Flaw(f"{begins}, below is {abs(below):g}; --unit takes that")


def _peak(source: Source, at: int) -> str:
    """The peak (g) in the header of V1 whose samples or the line before them is at this index."""
    peak = source.lines[at - 7][60:70]
    return "" if peak.strip().startswith("-999.") else peak


def _peak_of(quantity: str, source: Source, begin: int, unit: Named) -> str:
    """The peak of a quantity, by its first letters, in the header of V2 that begins at this index, in a unit."""
    pattern = rf"^peak\s+{quantity}\w*\s*=\s*({DECIMAL})\s+(\S+)"
    found = source.found(pattern, begin, begin + HEADER["V2"] - 20, f"the peak of {quantity}")
    spelled = unit_named(re.sub("cms", "cm", found[2], flags=re.IGNORECASE))
    same = spelled is None or spelled.size == unit.size
    return found[1] if same or spelled is None else f"{float(found[1]) * spelled.size / unit.size:.6g}"
