"""ASCII files of K-NET and KiK-net (NIED, Japan): 17 lines of header, then integers of one component.

The integers have an offset, which stays in the values; "Max. Acc." in the header is without it.
"""

from collections.abc import Sequence

import numpy as np

from dembound.records.channel import Record
from dembound.records.formats.format import Format
from dembound.records.formats.numbers import DECIMAL, Flaw
from dembound.records.formats.source import Source

HEADER = 17
KIK_NET = {
    str(number): f"{direction} ({place})"
    for number, (place, direction) in enumerate(
        ((place, direction) for place in ("borehole", "surface") for direction in ("N-S", "E-W", "U-D")), start=1
    )
}
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
