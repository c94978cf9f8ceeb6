"""The error of walls of holes, which consist of disks."""

from __future__ import annotations

from dembound.casefile.disks import DiskCase
from dembound.holes import Hole, Rectangle

WALL = 0.7
"""Error beside a round hole times its disks along the radius (docs/charts.md): 7 to 0.7 % with 10 to 80 of them."""

STRAIGHT = 0.45
"""Error beside a rectangle, whose walls have no steps, times the square of the disks along its smaller half: 4.7 and
0.47 % with 3 and 9 of them (benchmarks/error_bound.py)."""


def wall_error(case: DiskCase, diameter: float) -> float:
    """Error of the motion beside the holes of a case, RMS over RMS, with disks of a diameter (m); 0 without holes."""
    return max((of_hole(hole, diameter) for hole in case.hole), default=0.0)


def of_hole(hole: Hole, diameter: float) -> float:
    """The same beside one hole."""
    along = 0.5 * min(hole.box[2] - hole.box[0], hole.box[3] - hole.box[1]) / diameter
    return STRAIGHT / along**2 if isinstance(hole, Rectangle) else WALL / along
