"""AT2, VT2 and DT2 files of the PEER databases, and files like them: a header, then the values of one component.

The header has four lines, in some collections up to eleven: the last one has number and time step, one above it the
unit. Lines may end in CR CR LF, and values in "*** End".
"""

import re
from collections.abc import Sequence

from dembound.records.channel import Record
from dembound.records.formats.numbers import COUNT, DECIMAL, SECONDS, Flaw, number_of, quantity_named, seconds_of
from dembound.records.formats.source import Format, Source

UNITS = re.compile(r"\bunits\s+(?:of|are|is|:|=)?\s*[(\[]?\s*([^\s.,;)\]]+)", re.IGNORECASE)
SAMPLES = re.compile(
    rf"\s*NPTS?\s*=\s*{COUNT}\b.*?\bDT\s*=\s*({DECIMAL})\s*{SECONDS}?\b"
    rf"|\s*{COUNT}\s+({DECIMAL})\s+NPTS,\s*DT\b",
    re.IGNORECASE,
)
"""As "NPTS=  5000, DT=   .0050 SEC", and before 2006 "5000  .0050  NPTS, DT"."""

STEPS = re.compile(rf"\bDT\s*=\s*({DECIMAL})(?:[\s,]+({DECIMAL})(?=\s*s))?", re.IGNORECASE)
"""All time steps that a header states."""

LONGEST = 11
"""Lines of the longest header."""


class Peer(Format):
    """The second line of four has event, station and component, the third one quantity and unit."""

    name = "PEER AT2/VT2/DT2"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether a line of the header has number and time step, and another one a unit or the name of the database."""
        at = _at(lines)
        return at is not None and any(UNITS.search(line) or "PEER" in line for line in lines[:at])

    def read(self, source: Source) -> Record:
        """The component of the file."""
        at = _at(source.lines)
        assert at is not None
        found = SAMPLES.match(source.lines[at])
        assert found is not None
        count, step, unit = (found[1], found[2], found[3]) if found[1] else (found[4], found[5], "")
        above = [line.strip() for line in source.lines[:at] if line.strip()]
        stated = next((line for line in reversed(above) if UNITS.search(line)), "")
        title = next((line for line in [*above[1:2], *above[:1]] if line != stated), "")
        spelled = match[1] if (match := UNITS.search(stated)) else ""
        source.require_no_factor(enumerate(source.lines[:at], start=1))
        steps = {text for pair in STEPS.findall("\n".join(source.lines[: at + 1])) for text in pair if text}
        if len(set(map(number_of, steps))) > 1:
            said = f"states time steps of {' and '.join(sorted(steps))}"
            raise Flaw(f"{said}; --skip {at + 1} and --dt read what is below")
        named = source.measured(spelled, stated if quantity_named(stated) else " ".join(above))
        component = title.rpartition(",")[2].strip() if "," in title else ""
        values = source.free(at + 1, int(count))
        channel = source.channel(component, named, values, seconds_of(step, unit or "", at + 1))
        return Record(f"PEER {channel.quantity[0].upper()}T2", title, (channel,))


def _at(lines: Sequence[str]) -> int | None:
    """Index of the line with number and time step; None without one."""
    return next((at for at, line in enumerate(lines[: LONGEST + 1]) if SAMPLES.match(line)), None)
