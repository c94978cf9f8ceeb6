"""Errors near forces, where a lattice of disks is coarse: motion varies over less than a wave.

Plane waves on a lattice of diameter D with the wave number k have errors of the order (kD)². Near a force motion varies
over its distance r, too, and P and S waves are not separate: along the ray S waves, which a lattice disperses more,
carry as much of it as P waves. Beside a region of half-width b over which forces are spread it varies less: (r/(r +
b))² as much.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.scene import DiskScene
from dembound.formulas.cause import NEAR, Cause
from dembound.formulas.disks.places import middle_of_forces
from dembound.formulas.history import History, Motions

ALONG_RAY, CURVED = 0.1, 0.6
"""Error of motion along the ray over (κD)² (r/(r + b))², κ = k + CURVED/r, with the RMS wave number k of S waves."""

NEAR_FACTOR = 2.0
"""95 % of true errors along a force in a lattice are within this factor of `errors_near_loads`: they are 0.32 to 1.84
times as large (median 0.85) at r of 4 to 14 disks, k of 0.1 to 0.3 per disk, regions of 2 × 2, 2 × 8 and 6 × 6 disks,
with friction and without (benchmarks/near_loads.py). In random packings single disks move otherwise than those around,
by 4 to 40 % of the motion there, whatever the force: that is the cause `packing`."""


def causes_near_loads(scene: DiskScene, motions: Motions) -> Iterator[Cause]:
    """Errors by coarse disks near forces; motions : by monitor."""
    sizes = {name: errors_near_loads(scene, own) for name, own in motions.items()}
    if any(size for each in sizes.values() for size in each.values()):
        yield Cause(NEAR, "by its measured size", sizes, of_disks=True, factor=NEAR_FACTOR)


def errors_near_loads(scene: DiskScene, own: History) -> dict[str, float]:
    """The error at one monitor by quantity, RMS over RMS of its larger component; 0 without localised forces.

    own : the motion; its RMS frequency and its part along the ray from the nearest force determine the error.
    """
    rays = [(_nearest(own.place - place, scene), wide) for place, wide in _places(scene)]
    if not rays:
        return dict.fromkeys(own.values, 0.0)
    diameter, (ray, wide) = scene.ground.brick.mean_diameter, min(rays, key=lambda each: float(np.hypot(*each[0])))
    distance = max(float(np.hypot(*ray)), diameter)
    speed = slowest_speed(scene.ground, own.place[1], own.place[1] - ray[1])
    spread = (distance / (distance + wide)) ** 2
    rates = {"velocity": np.gradient(own.values["velocity"], own.time, axis=0), "displacement": own.values["velocity"]}
    found = {}
    for quantity, values in own.values.items():
        number = _norm(rates[quantity]) / max(_norm(values), np.finfo(float).tiny) / speed
        size = ALONG_RAY * spread * (diameter * (number + CURVED / distance)) ** 2
        found[quantity] = size * _along(values, own.component(quantity), ray / distance)
    return found


def _places(scene: DiskScene) -> list[tuple[np.ndarray, float]]:
    """The middle (2,) m of each localised force with a wave, and half the longer side of its region, m."""
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
    """Share of a component (column) of a motion (k, 2) due to motion along a unit vector (2,), RMS over RMS."""
    size = _norm(values[:, column])
    return _norm(values @ ray) * abs(float(ray[column])) / size if size > 0.0 else 0.0


def _norm(values: np.ndarray) -> float:
    return float(np.linalg.norm(values))
