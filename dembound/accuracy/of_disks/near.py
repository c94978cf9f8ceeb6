"""Errors beside what is smaller than a wave, where a lattice of disks is coarse: near forces and beside holes.

Plane waves on a lattice of diameter D with the wave number k have errors of the order (kD)². Near a force motion varies
over its distance r, too, and P and S waves are not apart: along the ray S waves, which a lattice disperses more, carry
as much of it as P waves. Walls of holes consist of disks, so that their shape is known to a diameter.
"""

from __future__ import annotations

import numpy as np

from dembound.accuracy.history import History
from dembound.accuracy.of_disks.places import middle_of_forces
from dembound.casefile.disks import DiskCase
from dembound.disks.material.wave_front import slowest_speed
from dembound.disks.scene import DiskScene
from dembound.holes import Hole, Rectangle
from dembound.packings.square import Square
from dembound.table import Box

NEAR, CURVED = 0.08, 0.6
"""Error of the motion along the ray over (κD)², κ = k + CURVED/r, with the RMS wave number k of S waves: measured along
a force in rock within a factor of 1.6 at r of 4 to 14 disks, for k of 0.08 to 0.28 per disk (docs/error_bound.md)."""


WALL = 0.7
"""Error beside a round hole times its disks along the radius (docs/charts.md): 7 to 0.7 % with 10 to 80 of them."""

STRAIGHT = 0.45
"""Error beside a rectangle, whose walls have no steps, times the square of the disks along its smaller half: 4.7 and
0.47 % with 3 and 9 of them (benchmarks/error_bound.py)."""


def errors_near_loads(scene: DiskScene, own: History) -> dict[str, float]:
    """The error at one monitor by quantity, RMS over RMS of its larger component; 0 without forces in places.

    own : the motion, whose RMS frequency and part along the ray from the nearest force count.
    """
    rays = [_nearest(own.place - place, scene) for place in _places(scene)]
    if not rays:
        return dict.fromkeys(own.values, 0.0)
    diameter, ray = scene.ground.brick.mean_diameter, min(rays, key=lambda each: float(np.hypot(*each)))
    distance = max(float(np.hypot(*ray)), diameter)
    rates = {"velocity": np.gradient(own.values["velocity"], own.time, axis=0), "displacement": own.values["velocity"]}
    found = {}
    for quantity, values in own.values.items():
        number = _norm(rates[quantity]) / max(_norm(values), np.finfo(float).tiny) / slowest_speed(scene.ground)
        size = NEAR * (diameter * (number + CURVED / distance)) ** 2
        found[quantity] = size * _along(values, own.component(quantity), ray / distance)
    return found


def _places(scene: DiskScene) -> list[np.ndarray]:
    """The middle (2,) m of each force with a wave in a place."""
    loads = [load for load in scene.case.load if load.wave is not None and load.pressure is None]
    return [middle_of_forces(load, scene)[0] for load in loads if not load.is_everywhere]


def _nearest(ray: np.ndarray, scene: DiskScene) -> np.ndarray:
    """A ray (2,) m from a force, or from its nearest copy across periodic sides."""
    size, periodic = np.array(scene.case.size), np.array(scene.case.periodic)
    return np.asarray(ray - np.where(periodic, size * np.rint(ray / size), 0.0))


def _along(values: np.ndarray, column: int, ray: np.ndarray) -> float:
    """Part of a component (column) of a motion (k, 2) that is due to motion along a unit vector (2,), RMS over RMS."""
    size = _norm(values[:, column])
    return _norm(values @ ray) * abs(float(ray[column])) / size if size > 0.0 else 0.0


def _norm(values: np.ndarray) -> float:
    return float(np.linalg.norm(values))


def wall_error(case: DiskCase, diameter: float) -> float:
    """Error of the motion beside the holes of a case, RMS over RMS, with disks of a diameter (m); 0 without holes."""
    box = case.packing.box if isinstance(case.packing, Square) else None
    return max((of_hole(hole, diameter) + misfit(hole, diameter, box) for hole in case.hole), default=0.0)


def of_hole(hole: Hole, diameter: float) -> float:
    """Error of the motion beside one hole, RMS over RMS; walls of a rectangle are taken to be between disks."""
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
