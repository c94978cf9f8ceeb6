"""V1A and V2A files of GeoNet (GNS Science, New Zealand): three components, each with a header of 26 lines.

16 lines of text, 4 of ten integers, 6 of ten numbers, then accelerations, in V2A also velocities and displacements, ten
to a line of 80 characters, in mm and s (Cousins, GNS accelerogram data files, standard format, 2008;
geonet.org.nz/data/supplementary/strong_motion_file_formats).
"""

import re
from collections.abc import Sequence

from dembound.records.channel import Channel, Record
from dembound.records.formats.numbers import COUNT, DECIMAL, Flaw, rows_of
from dembound.records.formats.source import SAME, Format, Source

HEADER, TEXTS, INTEGERS, REALS = 26, 16, 4, 6
LAYOUT = "(10f8.1)"
COUNTS, STEP = slice(33, 36), 25
"""Places of the numbers of accelerations, velocities and displacements, and of the time step of the samples."""

UNITS = {"Acceleration": "mm/s/s", "Velocity": "mm/s", "Displacement": "mm"}


class Geonet(Format):
    """Uncorrected (V1A) or corrected (V2A) accelerograms."""

    name = "GeoNet V1A/V2A"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the first line names an accelerogram and the text states component and number of points."""
        text = "\n".join(lines[:TEXTS])
        first = re.match(r"(un)?corrected accelerogram \S+", text, re.IGNORECASE)
        return bool(
            first and re.search(r"^Number of points\s+\d", text, re.M) and re.search(r"^Component\s", text, re.M)
        )

    def read(self, source: Source) -> Record:
        """The components of the file."""
        channels = source.channels(_component)
        volume = "V1A" if source.lines[0].lower().startswith("un") else "V2A"
        title = ", ".join(" ".join(source.line(at).split()) for at in (2, 6))
        return Record(f"GeoNet {volume}", title, channels)


def _component(source: Source, begin: int) -> tuple[list[Channel], int]:
    """The quantities of the component that begins at a line, by its index, and the index of their last line."""
    name = source.found(r"^component\s+(\S+)", begin, begin + TEXTS, "the component")[1]
    integers = source.fixed(begin + TEXTS, 10 * INTEGERS, "(10i8)")
    reals = source.fixed(begin + TEXTS + INTEGERS, 10 * REALS, "(10f8.0)")
    pattern = rf"^number of points\s+{COUNT}\s+duration\s+({DECIMAL})"
    points, length = source.found(pattern, begin, begin + TEXTS, "number of points and duration").groups()
    step = source.found(rf"\bat (?:intervals of )?({DECIMAL}) s", begin, begin + TEXTS, "the interval")[1]
    if int(points) != integers[COUNTS][0] or abs(float(step) - reals[STEP]) > SAME * reals[STEP]:
        raise Flaw(f"line {begin + 1} begins a text of {points} points every {step} s, the numbers below state others")
    at, found = begin + HEADER, []
    for (quantity, unit), count in zip(UNITS.items(), integers[COUNTS].astype(int), strict=True):
        if not 0 <= count < 1e9:
            raise Flaw(f"line {begin + TEXTS + INTEGERS} states {count} samples, must be 0 or more")
        if count:
            values = source.fixed(at, count, LAYOUT)
            pattern = rf"^{quantity}:?\s+(?:peak\s+({DECIMAL})\s+{unit})?"
            peak = source.found(pattern, begin, begin + TEXTS, quantity)[1] or ""
            measured = source.measured(unit, quantity)
            spelled = rf"^(?:{quantity}:?\s+peak|raw readings in units of)\s+{DECIMAL}\s+(\S+)"
            for other in re.findall(spelled, "\n".join(source.lines[begin : begin + TEXTS]), re.IGNORECASE | re.M):
                if other != unit and source.given.unit is None:
                    raise Flaw(f"line {begin + 1} begins a text with {other}, must be {unit}; give the unit by --unit")
            found.append(source.channel(name, measured, values, float(reals[STEP]), peak=peak, length=length))
            at += rows_of(count, LAYOUT)
    if not found:
        raise Flaw(f"states no samples of component {name}")
    return found, at - 1
