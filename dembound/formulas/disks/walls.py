"""Errors beside holes, whose walls consist of disks, so that their shape is known to a diameter."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np

from dembound.boundaries import normal_axis
from dembound.casefile.disks import DiskCase
from dembound.continuum.sizing import mean_frequency
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.scene import DiskScene
from dembound.disks.surroundings.near_fields import signals_of
from dembound.formulas.cause import MOTIONS, WALLS, Cause
from dembound.holes import Hole, Rectangle
from dembound.holes.hole import WALL

RANDOM = 0.75
"""Error of the motion by a pressure in a hole of any shape in a random packing, times the disks along its smaller
half: compared with exact solutions 0.41 to 2.1, the median 0.74, for five seeds each of patterns B and C with 4,
6 and 10 disks along a radius, at 1 to 2.5 radii (benchmarks/walls.py). Walls there are never between disks."""

OF_WAVES = 1.7
"""Error beside a hole under waves that pass it, over kL times the error under a pressure in it; kL is the RMS wave
number of the slowest waves in velocity or displacement times the smaller half of the hole, as scattered motion,
and its error, are that part of the motion. Circles of 5 and 8 disks along the radius in lattices under SV waves,
at 1.5 radii: 1.3 to 2.4 of velocities with kL of 0.09 to 1.25, 1.6 to 2.6 of displacements with kL of 0.04 to
0.26; 1.2 times that at the wall (1.4 times with kL of 1.25), 0.7 at 2.5 radii (benchmarks/walls.py)."""

BETWEEN = 0.65
"""Factor for rectangles in lattices, whose walls are between disks, relative to other holes, and the largest kL:
compared with disks three times smaller, at 1.5 radii, velocities have 0.9 to 1.3 of kL where that is below 0.4,
at most 0.7 up to 1.9, displacements 1.2 to 1.7 of kL from 0.04 to 0.33."""

LONGEST, SHORT = 1.5, 7.5
"""Largest kL that counts, as of waves that jump; beside round holes in lattices that of waves half a radius long, which
were measured, too."""

LIT, DARK, CREEP, FALL = 0.46, 0.38, 0.27, 1.44
"""Error beside a round hole of radius a in a lattice under waves, times the disks along a.

It is k_q a [LIT + u (DARK + CREEP k_v a)] (a/r)^FALL at a distance r from the axis; k_v, k_q are the RMS wave numbers
in velocity and in the quantity, of the kind of wave that comes. u = (1 + cos θ)/2, with the angle θ to the way of the
wave: 0 where it meets the wall, 1 where waves arrive that have run along half of it. Walls made of disks delay these by
a part kD of their time, so that errors grow with (ka)². The mean over directions is WALL · OF_WAVES for long waves.

Fitted to exact motions at 12 directions and 1 and 1.5 radii under P and SV waves of 0.5 to 10 radii, 10 to 80 disks
along the radius: 99 % of 1248 errors are a third to three times it, where without directions 78 % of 1008 were; 95 %
are at most 2.1 times as large. Held out, with 160 disks, are 93 % of 96, others smaller than it. Where the free surface
cuts a hole waves come from both ways, and u = 1/2: of semicircular canyons, compared with disks three times smaller,
96 % of 432 (benchmarks/walls_in_waves.py)."""

WALL_FACTOR = 2.0
"""95 % of true errors beside holes are at most this factor times `wall_errors`: of means over 12 directions 1.4
times in lattices under a pressure (224, the largest 1.6), 1.5 times in random packings (240, at most 2.5), under
waves 2.0 times beside circles (137, at most 2.7) and 1.8 beside squares in lattices (89, at most 2.3), and 1.3
times in random packings (203, at most 2.0; benchmarks/walls.py). Single directions scatter more."""


def causes_of_walls(scene: DiskScene, names: Iterable[str]) -> Iterator[Cause]:
    """Errors by walls of holes at monitors of these names."""
    case, ground = scene.case, scene.ground
    if not case.hole:
        return
    diameter, places = ground.brick.mean_diameter, scene.monitored
    parts = {name: wall_errors(case, ground, diameter, places[name]) for name in names}
    words = "by the disks along the radius, the way of the wave, and the place"
    yield Cause(WALLS, words, parts, of_disks=True, factor=WALL_FACTOR)


def wall_errors(
    case: DiskCase, ground: PackedMaterial, diameter: float, place: np.ndarray | None = None
) -> dict[str, float]:
    """Errors of the motion beside the holes of a case by quantity, RMS over RMS, with disks of a diameter (m).

    ground : medium of the waves, with disks of any diameter. place : (2,) m; without one the mean of all directions at
    a wall. 0 without holes.
    """
    if not case.hole:
        return dict.fromkeys(MOTIONS, 0.0)
    signals, found = signals_of(case), {}
    omega = {
        quantity: 2.0 * np.pi * max((mean_frequency(signal, lowest) for signal in signals), default=0.0)
        for quantity, lowest in zip(MOTIONS, (np.inf, 1.0 / case.run.duration), strict=True)
    }
    for quantity in MOTIONS:
        errors = []
        for hole in case.hole:
            speed = slowest_speed(ground, hole.box[1], hole.box[3])
            numbers = omega[quantity] / speed, omega["velocity"] / speed
            share = 1.0 if hole.name in case.pressed else _scattered(case, ground, hole, numbers, place)
            errors.append(_wall_error(case, hole, diameter) * share)
        found[quantity] = max(errors)
    return found


def _scattered(
    case: DiskCase, ground: PackedMaterial, hole: Hole, numbers: tuple[float, float], place: np.ndarray | None
) -> float:
    """Error under waves that pass a hole, over the error under a pressure in it.

    numbers : wave numbers (1/m) of slow waves in the quantity and in velocity, infinite for waves that jump.
    """
    largest = LONGEST if np.isinf(numbers[1]) else SHORT
    own, moving = (min(number * hole.smaller_half, largest) for number in numbers)
    part = OF_WAVES * min(own, LONGEST)
    if not case.packing.is_lattice:
        return part
    if isinstance(hole, Rectangle):
        return BETWEEN * min(part, 1.0)
    if case.incident is not None and case.incident.type == "p":
        p_speed, s_speed = ground.wave_speeds(1)
        own, moving = own * s_speed / p_speed, moving * s_speed / p_speed
    behind, farther = _seen_from(case, hole, place)
    return own * (LIT + behind * (DARK + CREEP * moving)) / farther**FALL / WALL


def _seen_from(case: DiskCase, hole: Hole, place: np.ndarray | None) -> tuple[float, float]:
    """The place as seen from a hole: u, see `LIT`, and the distance from its middle in smaller halves, at least 1."""
    if place is None:
        return 0.5, 1.0
    box = np.reshape(hole.box, (2, 2))
    ray = place - box.mean(axis=0)
    distance = max(float(np.hypot(*ray)), hole.smaller_half)
    low, high = np.reshape(case.box, (2, 2))
    is_cut, way = bool((box[0] < low).any() or (box[1] > high).any()), np.zeros(2)
    if case.incident is not None:
        way = np.array([math.sin(math.radians(case.incident.angle)), math.cos(math.radians(case.incident.angle))])
    elif len(case.driving) == 1 and not any(load.wave for load in case.load):
        (side,) = case.driving
        way[normal_axis(side)] = 1.0 if side in ("left", "bottom") else -1.0
    behind = 0.5 if is_cut else 0.5 + 0.5 * float(ray @ way) / distance
    return behind, distance / hole.smaller_half


def _wall_error(case: DiskCase, hole: Hole, diameter: float) -> float:
    """Error of the motion by a pressure in one hole, beside its wall."""
    if case.packing.is_lattice:
        return hole.wall_error(diameter, case.packing.apart)
    return RANDOM / (hole.smaller_half / diameter)
