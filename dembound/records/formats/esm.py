"""ASC files of the Engineering Strong Motion database (ESM) and of Italy's ITACA: one component.

64 lines "KEY: value" in format DYNA (ESM: Luzi et al., Seismological Research Letters 87, 987, 2016; each file names
its version in HEADER_FORMAT), then one value in a line.
"""

import re
from collections.abc import Sequence

from dembound.records.channel import Record
from dembound.records.formats.format import Format
from dembound.records.formats.numbers import COUNT, DECIMAL, number_of
from dembound.records.formats.source import Source
from dembound.waves.unit_names import unit_named

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
