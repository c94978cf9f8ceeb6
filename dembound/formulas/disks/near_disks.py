"""Errors where single disks count: at the walls of holes, near forces, at edges, and near a free surface.

The walls of holes consist of disks, so that their shape is known to a diameter. Single disks move otherwise than the
ground at edges, and near a free surface under oblique waves. Near forces a lattice is coarse: motion varies over less
than a wave. Plane waves on a lattice of diameter D with the wave number k have errors of the order (kD)². Near a force
motion varies over its distance r, too, and P and S waves are not separate: along the ray S waves, which a lattice
disperses more, carry as much of it as P waves. Beside a region of half-width b over which forces are spread it varies
less: (r/(r + b))² as much.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np

from dembound.boundaries import normal_axis, plane_of
from dembound.casefile.disks import DiskCase
from dembound.continuum.sizing import mean_frequency
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.scene import DiskScene
from dembound.disks.surroundings.near_fields import signals_of
from dembound.formulas.cause import MOTIONS, NEAR, WALLS, Cause
from dembound.formulas.disks.places import middle_of_forces
from dembound.formulas.history import History, Motions
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

STEPS, STEPS_FACTOR = 0.25, 3.0
"""Error beside a slope between levels, over kD with the RMS wave number k of the slowest waves in the quantity, and
over kH where the slope's height H is less than 1/k; and the factor within which most true errors are.

A slope of disks is one in steps. In square lattices under SV waves of 40 and 80 diameters, slopes of 30 to 75°, 20 and
40 diameters high, compared with disks five times smaller, at the crest, behind it, on the face, at the toe, before it
and below: 91 of 96 errors are a third to three times it, the largest, on faces of 75°, seven times
(benchmarks/slopes.py)."""

WALL_FACTOR = 2.0
"""95 % of true errors beside holes are at most this factor times `wall_errors`: of means over 12 directions 1.4
times in lattices under a pressure (224, the largest 1.6), 1.5 times in random packings (240, at most 2.5), under
waves 2.0 times beside circles (137, at most 2.7) and 1.8 beside squares in lattices (89, at most 2.3), and 1.3
times in random packings (203, at most 2.0; benchmarks/walls.py). Single directions scatter more."""


def causes_of_walls(scene: DiskScene, names: Iterable[str]) -> Iterator[Cause]:
    """Errors by walls of holes at monitors of these names."""
    case, ground = scene.case, scene.ground
    if not case.holes:
        return
    diameter, places = ground.brick.mean_diameter, scene.monitored
    parts = {name: wall_errors(case, ground, diameter, places[name]) for name in names}
    words, factor = "by the disks along the radius, the way of the wave, and the place", WALL_FACTOR
    if any(map(case.is_above_surface, case.holes)):
        words, factor = f"{words}; a slope's by the diameter and the waves", STEPS_FACTOR
    yield Cause(WALLS, words, parts, of_disks=True, factor=factor)


def wall_errors(
    case: DiskCase, ground: PackedMaterial, diameter: float, place: np.ndarray | None = None
) -> dict[str, float]:
    """Errors of the motion beside the holes of a case by quantity, RMS over RMS, with disks of a diameter (m).

    ground : medium of the waves, with disks of any diameter. place : (2,) m; without one the mean of all directions at
    a wall. 0 without holes.
    """
    if not case.holes:
        return dict.fromkeys(MOTIONS, 0.0)
    signals, found = signals_of(case), {}
    omega = {
        quantity: 2.0 * np.pi * max((mean_frequency(signal, lowest) for signal in signals), default=0.0)
        for quantity, lowest in zip(MOTIONS, (np.inf, 1.0 / case.run.duration), strict=True)
    }
    for quantity in MOTIONS:
        errors = []
        for hole in case.holes:
            speed = slowest_speed(ground, hole.box[1], hole.box[3])
            numbers = omega[quantity] / speed, omega["velocity"] / speed
            if case.is_above_surface(hole):
                errors.append(_surface_error(case, hole, diameter, numbers[0]))
                continue
            share = 1.0 if hole.name in case.pressed else _scattered(case, ground, hole, numbers, place)
            errors.append(_wall_error(case, hole, diameter) * share)
        found[quantity] = max(errors)
    return found


def _surface_error(case: DiskCase, hole: Hole, diameter: float, number: float) -> float:
    """Error of the motion beside a slope under waves with a wave number (1/m) in the quantity, see `STEPS`."""
    high = case.packing.box[3] - max(hole.box[1], case.packing.box[1])
    number = min(number, 1.0 / diameter)
    return STEPS * number * diameter * min(number * high, 1.0)


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
    found = []
    for load in scene.case.load:
        if load.wave is not None and load.pressure is None and not load.is_everywhere:
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


SINGLE, SINGLE_FACTOR = 1.0, 3.0
"""How far single disks at the free surface of a random packing move otherwise than the ground, over the diameter and
the strain along the surface.

Measured 0.5 to 2.3, RMS over the disks of each of 9 packings (B, bricks of 10 and 20 diameters; SV and P waves at 20 to
40°, 40 to 160 diameters long), 0.4 to 1.4 at a depth of 1.5 diameters; in layers up to 3.1. Of 144 disks 5 % are
beyond three times the size.
"""

NEAR_SURFACE = 2.0
"""Depth in diameters down to which they do so."""


def causes_at_edges(scene: DiskScene, motions: Motions) -> Iterator[Cause]:
    """Unknown errors of monitors at absorbing sides of random packings, or at uneven sides."""
    case = scene.case
    packing, box = case.packing, case.packing.box
    reach = 2.0 * scene.ground.brick.mean_diameter
    uneven = [side for side in case.boundary if not (packing.is_lattice and side in packing.regular_sides)]
    planes = {side: plane_of(side, box) for side in uneven if case.boundary[side].factors}
    at = [
        name
        for name, own in motions.items()
        if any(abs(own.place[normal_axis(side)] - plane) < reach for side, plane in planes.items())
    ]
    if at:
        names = " and ".join(at)
        edge = "an uneven edge" if packing.is_lattice else "the edge of a random packing"
        yield Cause.unknown("edge", f"how single disks at {edge} move otherwise than those around, at {names}", True)


def causes_at_surface(scene: DiskScene, motions: Motions) -> Iterator[Cause]:
    """Single disks near the free surface of a random packing, which a wave at an angle strains along it."""
    case, ground = scene.case, scene.ground
    if not (case.incident and case.incident.angle) or case.packing.is_lattice or not case.side("top").is_free:
        return
    angle, below = math.radians(abs(case.incident.angle)), ground.at(case.box[1])
    slowness = math.sin(angle) / below.wave_speeds(1)[0 if case.incident.type == "p" else 1]
    size = SINGLE * slowness * ground.brick.mean_diameter
    near = case.box[3] - NEAR_SURFACE * ground.brick.mean_diameter
    parts = {
        name: {"velocity": size * np.gradient(own.velocity, own.time, axis=0), "displacement": size * own.velocity}
        for name, own in motions.items()
        if own.place[1] > near
    }
    if parts:
        words = "by the strain along it and the diameter, the size for single disks of several packings"
        yield Cause("surface", words, parts, of_disks=True, factor=SINGLE_FACTOR, is_sample=True)
