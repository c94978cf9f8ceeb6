"""Errors beside what is smaller than a wave, where a lattice of disks is coarse: near forces and beside holes.

Plane waves on a lattice of diameter D with the wave number k have errors of the order (kD)². Near a force motion varies
over its distance r, too, and P and S waves are not apart: along the ray S waves, which a lattice disperses more, carry
as much of it as P waves. Beside a region of half a side b that forces are spread over it varies less: (r/(r + b))² as
much. Walls of holes consist of disks, so that their shape is known to a diameter.
"""

from __future__ import annotations

import numpy as np

from dembound.accuracy.history import History
from dembound.accuracy.of_disks.places import middle_of_forces
from dembound.casefile.disks import DiskCase
from dembound.disks.material.wave_front import slowest_speed
from dembound.disks.scene import DiskScene
from dembound.holes import Hole

NEAR, CURVED = 0.1, 0.6
"""Error of motion along the ray over (κD)² (r/(r + b))², κ = k + CURVED/r, with the RMS wave number k of S waves."""

NEAR_FACTOR = 2.0
"""95 % of true errors along a force in a lattice are within this factor of `errors_near_loads`: they are 0.32 to 1.84
times as large (median 0.85) at r of 4 to 14 disks, k of 0.1 to 0.3 per disk, regions of 2 × 2, 2 × 8 and 6 × 6 disks,
with friction and without (benchmarks/near_loads.py). In random packings single disks move otherwise than those around,
by 4 to 40 % of the motion there, whatever the force: that is the cause `packing`."""

RANDOM = 0.75
"""Error of the motion that a pressure makes beside a hole of any shape in a random packing, times the disks along its
smaller half: beside exact solutions 0.41 to 2.1, the median 0.74, of five seeds each of patterns B and C with 4, 6 and
10 disks along a radius, at 1 to 2.5 radii (benchmarks/walls.py). Walls there are never between disks."""

OF_WAVES = 0.45
"""The same of waves that pass a hole over that of a pressure in it: of velocities 0.7 in the median, of displacements
0.33, less farther away, as what a hole scatters is a part of the motion (benchmarks/walls.py)."""

WALL_FACTOR = 2.0
"""95 % of true errors beside holes are at most so many times as large as `wall_error`: of means over 12 directions 1.4
times in lattices under a pressure (224, the largest 1.6), 1.5 times in random packings (240, at most 2.5), 1.6 times in
lattices under waves (80, at most 2.1), and 1.1 times in random packings under waves (80, at most 1.7;
benchmarks/walls.py). Single directions scatter more."""


def errors_near_loads(scene: DiskScene, own: History) -> dict[str, float]:
    """The error at one monitor by quantity, RMS over RMS of its larger component; 0 without forces in places.

    own : the motion, whose RMS frequency and part along the ray from the nearest force count.
    """
    rays = [(_nearest(own.place - place, scene), wide) for place, wide in _places(scene)]
    if not rays:
        return dict.fromkeys(own.values, 0.0)
    diameter, (ray, wide) = scene.ground.brick.mean_diameter, min(rays, key=lambda each: float(np.hypot(*each[0])))
    distance = max(float(np.hypot(*ray)), diameter)
    spread = (distance / (distance + wide)) ** 2
    rates = {"velocity": np.gradient(own.values["velocity"], own.time, axis=0), "displacement": own.values["velocity"]}
    found = {}
    for quantity, values in own.values.items():
        number = _norm(rates[quantity]) / max(_norm(values), np.finfo(float).tiny) / slowest_speed(scene.ground)
        size = NEAR * spread * (diameter * (number + CURVED / distance)) ** 2
        found[quantity] = size * _along(values, own.component(quantity), ray / distance)
    return found


def _places(scene: DiskScene) -> list[tuple[np.ndarray, float]]:
    """The middle (2,) m of each force with a wave in a place, and half the longer side of its region, m."""
    loads = [load for load in scene.case.load if load.wave is not None and load.pressure is None]
    found = []
    for load in loads:
        if not load.is_everywhere:
            x0, y0, x1, y1 = load.region or (0.0, 0.0, 0.0, 0.0)
            found.append((middle_of_forces(load, scene)[0], 0.5 * max(x1 - x0, y1 - y0)))
    return found


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
    return max((_wall_error(case, hole, diameter) for hole in case.hole), default=0.0)


def _wall_error(case: DiskCase, hole: Hole, diameter: float) -> float:
    """Error of the motion beside the wall of one hole."""
    is_pressed = any(load.pressure is not None and case.hole_of(load) is hole for load in case.load)
    part = 1.0 if is_pressed else OF_WAVES
    if case.packing.is_lattice:
        return part * hole.wall_error(diameter, case.packing.apart)
    return part * RANDOM / (hole.smaller_half / diameter)
