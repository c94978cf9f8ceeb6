"""V1 and V2 files of the California Strong Motion Instrumentation Program (CSMIP, formerly DMG): several channels.

The header of a channel has 13 lines of text (V1) or 25 (V2), 7 lines of integers and 7 (V1) or 13 (V2) of numbers. V1
has uncorrected accelerations, even ones or, from film, pairs of time and acceleration; V2 has corrected accelerations,
velocities and displacements. A line "/&" ends the channel.
"""

import re
from collections.abc import Sequence

import numpy as np

from dembound.records.channel import Channel, Record
from dembound.records.formats.format import Format
from dembound.records.formats.source import COUNT, DECIMAL, END, Flaw, Source, rows_of

BLOCK = re.compile(
    rf"\s*{COUNT}\s+(?:points of\s+)?(accel|veloc|displ).*?\bat\s+({DECIMAL})\s*(pts/)?sec"
    r"\W*(?:in units of|units:?|in)\s+([^\s()]+)(.*)",
    re.IGNORECASE,
)
"""The line before even samples, as "31932 Accelerogram points at 100 pts/sec in units of g.  Format: (8f9.6)"."""

PAIRS = "(10f7.3)"
HEADER = {"V1": 27, "V2": 45}
LAYOUT = {"V1": "(8f9.6)", "V2": "(8f10.3)"}
"""Lines of the header of a channel, and the layout of samples where the line before them has none."""


class Csmip(Format):
    """All channels and quantities of a file."""

    name = "CSMIP V1/V2"

    def recognises(self, lines: Sequence[str]) -> bool:
        """Whether the first lines are those of a V1, V2 or V3 file."""
        return bool(_volume(lines, 0))

    def read(self, source: Source) -> Record:
        """The channels of the file, of V2 with all three quantities."""
        volume = _volume(source.lines, 0)
        if volume not in HEADER:
            raise Flaw("holds spectra (V3), must be V1 or V2")
        first = 0 if volume == "V1" else 1
        title = f"{source.line(first + 5)[:40].strip()}, {source.line(first + 1)[:40].strip()}"
        channels: list[Channel] = []
        begin = 0
        while begin < len(source.lines):
            if source.lines[begin].strip():
                if _volume(source.lines, begin) != volume:
                    raise Flaw(f"line {begin + 1} is not the first one of a channel of {volume}")
                more, begin = _channel(source, volume, begin)
                channels += more
            begin += 1
        return Record(f"CSMIP {volume}", title, tuple(channels))


def _volume(lines: Sequence[str], begin: int) -> str:
    """V1, V2 or V3 by the first lines of a channel; empty for other lines."""
    first, second = ("\n".join(lines[begin : begin + 2]).lower() + "\n").split("\n")[:2]
    if first.startswith("uncorrected accelerogram data"):
        return "V1"
    if first.startswith("corrected accelerogram") and "uncorrected accelerogram" in second:
        return "V2"
    return "V3" if first.startswith("response and fourier") else ""


def _channel(source: Source, volume: str, begin: int) -> tuple[list[Channel], int]:
    """The quantities of the channel that begins at a line, by its index, and the index of the line that ends it."""
    at = begin + HEADER[volume]
    component = source.found(r"^chan\s+\d+:\s*(.*?)\s*(?:deg)?\s*$", begin, at, "the component")[1]
    found = []
    if volume == "V1" and re.fullmatch(r"[-.\d\s]+", source.line(at)):
        channel, at = _from_film(source, component, begin, at)
        found.append(channel)
    while at < len(source.lines) and (block := BLOCK.match(source.lines[at])):
        count, layout = int(block[1]), block[6] if "(" in block[6] else LAYOUT[volume]
        values = source.fixed(at + 1, count, layout)
        rate = float(block[3])
        step = rate if not block[4] else 1.0 / rate if rate else 0.0
        peak = _peak(source, at) if volume == "V1" else _peak_of(block[2], source, begin)
        found.append(source.channel(component, source.measured(block[5]), values, step, peak=peak))
        at += 1 + rows_of(count, layout)
    if not found:
        raise Flaw(f"line {at + 1} does not state number, time step and unit of samples")
    if at < len(source.lines) and not END.match(source.lines[at]):
        raise Flaw(f"line {at + 1} does not end the channel, after {len(found[-1].values)} samples")
    return found, at


def _from_film(source: Source, component: str, begin: int, at: int) -> tuple[Channel, int]:
    """The channel whose pairs of time and acceleration begin at a line, and the index of the line behind them."""
    count = int(source.found(rf"no\. of points\s*=\s*{COUNT}\b", begin, at, "the number of points")[1])
    unit = source.found(r"units of uncor\w*\s.*?and (g)(/10)?", begin, at, "the unit")
    pairs = source.fixed(at, 2 * count, PAIRS)
    numbers = pairs[1::2] * (0.1 if unit[2] else 1.0)
    step, values = source.from_film(pairs[::2], numbers)
    found = float(np.abs(numbers).max())
    channel = source.channel(
        component, source.measured(unit[1]), values, step, float(pairs[0]), _peak(source, at), found
    )
    return channel, at + rows_of(2 * count, PAIRS)


def _peak(source: Source, at: int) -> str:
    """The peak (g) in the header of V1 whose samples or the line before them is at this index."""
    peak = source.lines[at - 7][60:70]
    return "" if peak.strip().startswith("-999.") else peak


def _peak_of(quantity: str, source: Source, begin: int) -> str:
    """The peak of a quantity, by its first letters, in the header of V2 that begins at this index."""
    return source.found(rf"^peak\s+{quantity}\w*\s*=\s*({DECIMAL})", begin, begin + 25, f"the peak of {quantity}")[1]
