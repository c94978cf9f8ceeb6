"""The error of walls of holes, which consist of disks."""

from __future__ import annotations

from dembound.casefile.disks import DiskCase
from dembound.holes import Hole, Rectangle
from dembound.packings.square import Square
from dembound.table import Box

WALL = 0.7
"""Error beside a round hole times its disks along the radius (docs/charts.md): 7 to 0.7 % with 10 to 80 of them."""

STRAIGHT = 0.45
"""Error beside a rectangle, whose walls have no steps, times the square of the disks along its smaller half: 4.7 and
0.47 % with 3 and 9 of them (benchmarks/error_bound.py)."""


def wall_error(case: DiskCase, diameter: float) -> float:
    """Error of the motion beside the holes of a case, RMS over RMS, with disks of a diameter (m); 0 without holes."""
    box = case.packing.box if isinstance(case.packing, Square) else None
    return max((of_hole(hole, diameter) + misfit(hole, diameter, box) for hole in case.hole), default=0.0)


def of_hole(hole: Hole, diameter: float) -> float:
    """The same beside one hole whose walls, if it is a rectangle, are between disks."""
    along = _smaller_half(hole) / diameter
    return STRAIGHT / along**2 if isinstance(hole, Rectangle) else WALL / along


def misfit(hole: Hole, diameter: float, box: Box | None) -> float:
    """How far the walls of a rectangle are from the nearest planes between disks of a lattice, over its smaller half.

    box : left, bottom, right and top (m) of the lattice, beyond which there are no walls; None without a lattice. What
    a hole does to waves grows with its size, by as large a part.
    """
    if box is None or not isinstance(hole, Rectangle):
        return 0.0
    apart = [
        abs(cells - round(cells)) * diameter
        for k, wall in enumerate(hole.box)
        if box[k % 2] < wall < box[2 + k % 2]
        for cells in [(wall - box[k % 2]) / diameter]
    ]
    return max(apart, default=0.0) / _smaller_half(hole)


def _smaller_half(hole: Hole) -> float:
    """Half the smaller side of the rectangle round a hole, m."""
    left, bottom, right, top = hole.box
    return 0.5 * min(right - left, top - bottom)
