"""Causes of the error of disks computed by formulas from the motion at the monitors, without further runs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np

from dembound.boundaries import Motion, axis_of_motion, normal_axis, plane_of
from dembound.boundaries.edge import OPPOSITE
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.scene import DiskScene
from dembound.disks.sources import sources_of
from dembound.formulas.cause import CONTINUUM, GRID, MOTIONS, NEAR, STEP, USUAL, WALLS, Cause
from dembound.formulas.delays import Delay, error_of_delay, error_of_steps
from dembound.formulas.disks.continuum import CONTINUUM_FACTOR, expected_errors
from dembound.formulas.disks.held_sides import HeldSides
from dembound.formulas.disks.matched_sides import Reflected, Reflections, errors_on_rock
from dembound.formulas.disks.near import NEAR_FACTOR, WALL_FACTOR, errors_near_loads, wall_errors
from dembound.formulas.disks.waves import (
    AXES,
    DIAGONAL,
    Direction,
    Frequencies,
    crossing_time,
    delay_of,
    errors_in_layers,
    frequencies_of,
    layers_between,
)
from dembound.formulas.history import History, Motions
from dembound.motion.paths import Source

SINGLE, SINGLE_FACTOR = 1.0, 3.0
"""How far single disks at the free surface of a random packing move otherwise than the ground, over the diameter and
the strain along the surface.

Measured 0.5 to 2.3, RMS over the disks of each of 9 packings (B, bricks of 10 and 20 diameters; SV and P waves at 20 to
40°, 40 to 160 diameters long), 0.4 to 1.4 at a depth of 1.5 diameters; in layers up to 3.1. Of 144 disks 5 % are
beyond three times the size.
"""

NEAR_SURFACE = 2.0
"""Depth in diameters down to which they do so."""


@dataclass(frozen=True)
class Formulas:
    """The formulas of one scene, which runs at a time step (s); reflections : of its sides."""

    scene: DiskScene
    time_step: float
    reflections: Reflections = field(default_factory=Reflections, repr=False)

    def causes(self, motions: Motions) -> list[Cause]:
        """All causes but absorbing sides without waves; motions : by monitor."""
        return [
            *self.of_waves_in(motions),
            *self._delays(motions),
            *self._walls(motions),
            *self._near(motions),
            *self._edges(motions),
            *self._surface(motions),
            *self.held_sides.causes(motions),
        ]

    def without_motion(self, names: Sequence[str]) -> list[Cause]:
        """The causes that do not depend on the motion, at monitors of these names."""
        places = {name: self.scene.monitored[name] for name in names}
        return [*self._continuum(places), *self._walls(names)]

    def of_waves_in(self, motions: Motions) -> Iterator[Cause]:
        """A continuum, and sides with dashpots that waves enter through."""
        yield from self._continuum({name: own.place for name, own in motions.items()})
        yield from self._rock(motions)
        for side, waves in self.scene.case.driving.items():
            table = self.scene.case.side(side)
            if table.is_interface:
                continue
            if table.is_artificial and not table.absorbs:
                reason = f'"{table.type}" has no dashpots, by which its reflection would be known'
                yield Cause.unknown(f"{side} side", reason)
            if table.factors and table.dashpots_alone() != table:
                reason = "its springs send back waves, which check computes and an estimate does not"
                yield Cause.unknown(f"{side} side", reason)
            if table.factors:
                shares = self.reflections.of(self.scene, side, self.time_step)
                parts = {name: self._returned(own, side, waves, shares) for name, own in motions.items()}
                words = "by the reflection of dashpots at normal incidence"
                yield Cause(f"{side} side", words, parts, factor=USUAL)

    def _rock(self, motions: Motions) -> Iterator[Cause]:
        """Sides on rock, beyond the reflection of the rock."""
        for side, table in self.scene.case.boundary.items():
            if not table.is_interface:
                continue
            if self.scene.case.hole or self.scene.case.load or table.dashpots_alone() != table:
                reason = "dashpots stand for rock at normal incidence alone; at other angles it is not predicted"
                yield Cause.unknown(f"{side} side", reason)
            back = {motion: self.held_sides.reflects(OPPOSITE[side], motion) for motion in table.factors}
            parts = {name: errors_on_rock(self.scene, side, own, back) for name, own in motions.items()}
            words = "by the place where its disks begin, beside the reflection of its rock at normal incidence"
            yield Cause(f"{side} side", words, parts, of_disks=True, factor=USUAL)

    def _continuum(self, places: Mapping[str, np.ndarray]) -> Iterator[Cause]:
        """Errors of the continuum beyond sides, at places (2,) m of monitors."""
        if self.scene.outside is None:
            return
        if (sizes := expected_errors(self.scene, places)) is None:
            reason = (
                "its layers stretch both axes, as its ground is strongly anisotropic, and return a part of motion"
                if self.scene.outside.body.is_stretched_along
                else "its elements are judged by the highest frequency of waves, and a wave that jumps has none"
            )
            yield Cause.unknown(CONTINUUM, reason)
            return
        parts = {name: dict(zip(MOTIONS, each, strict=True)) for name, each in sizes.items()}
        words = "by the formulas of its elements, layers and ties"
        yield Cause(CONTINUUM, words, parts, factor=CONTINUUM_FACTOR)
        if self._contacts_open:
            reason = "open contacts make disks softer than it, whose stiffness is that of closed ones"
            yield Cause.unknown(f"{CONTINUUM} beside contacts", reason)

    @property
    def _contacts_open(self) -> bool:
        """Whether contacts beside a continuum may be open, at rest or under a wave.

        Without stress disks just touch. A static stage leaves the contacts of a lattice closed; in a random packing it
        opens some: in pattern B 10 % under a locked-in stress that has relaxed upwards, where waves 40 m long in a box
        of 15 m have an error of 13 %, but 1 % with contacts closed for good, or with a tenth of their stiffness; 1.9 %
        under weight, and 67 % without stress.
        """
        case = self.scene.case
        at_rest = case.static is not None and case.packing.is_lattice
        return self.scene.has_history and self.scene.ground.moduli.emod > 0.0 and not at_rest

    def _walls(self, names: Iterable[str]) -> Iterator[Cause]:
        """Errors by walls of holes, which are made of disks."""
        case, ground = self.scene.case, self.scene.ground
        if not case.hole:
            return
        diameter, places = ground.brick.mean_diameter, self.scene.monitored
        parts = {name: wall_errors(case, ground, diameter, places[name]) for name in names}
        words = "by the disks along the radius, the way of the wave, and the place"
        yield Cause(WALLS, words, parts, of_disks=True, factor=WALL_FACTOR)

    def _near(self, motions: Motions) -> Iterator[Cause]:
        """Errors by coarse disks near forces."""
        sizes = {name: errors_near_loads(self.scene, own) for name, own in motions.items()}
        if any(size for each in sizes.values() for size in each.values()):
            yield Cause(NEAR, "by its measured size", sizes, of_disks=True, factor=NEAR_FACTOR)

    def _edges(self, motions: Motions) -> Iterator[Cause]:
        """Unknown errors of monitors at absorbing sides of random packings, or at uneven sides."""
        case = self.scene.case
        packing, box = case.packing, case.packing.box
        reach = 2.0 * self.scene.ground.brick.mean_diameter
        edges = {side: box[k] for k, side in enumerate(("left", "bottom", "right", "top"))}
        at = [
            name
            for name, own in motions.items()
            for side, table in case.boundary.items()
            if not (packing.is_lattice and side in packing.regular_sides)
            and table.factors
            and abs(own.place[normal_axis(side)] - edges[side]) < reach
        ]
        if at:
            names = " and ".join(dict.fromkeys(at))
            edge = "an uneven edge" if packing.is_lattice else "the edge of a random packing"
            yield Cause.unknown(
                "edge", f"how single disks at {edge} move otherwise than those around, at {names}", True
            )

    def _surface(self, motions: Motions) -> Iterator[Cause]:
        """Single disks near the free surface of a random packing, which a wave at an angle strains along it."""
        case, ground = self.scene.case, self.scene.ground
        if not (case.incident and case.incident.angle) or case.packing.is_lattice or not case.side("top").is_free:
            return
        angle, below = math.radians(abs(case.incident.angle)), ground.at(case.box[1])
        slowness = math.sin(angle) / below.wave_speeds(1)[0 if case.incident.type == "p" else 1]
        size = SINGLE * slowness * ground.brick.mean_diameter
        near = case.box[3] - NEAR_SURFACE * ground.brick.mean_diameter
        parts = {
            name: {
                "velocity": size * np.gradient(own.velocity, own.time, axis=0),
                "displacement": size * own.velocity,
            }
            for name, own in motions.items()
            if own.place[1] > near
        }
        if parts:
            words = "by the strain along it and the diameter, the size for single disks of several packings"
            yield Cause("surface", words, parts, of_disks=True, factor=SINGLE_FACTOR, is_sample=True)

    def _returned(
        self, own: History, side: str, waves: Mapping[Motion, str], shares: Mapping[Motion, Reflected]
    ) -> dict[str, np.ndarray | float]:
        """Error of a driven side that withholds part of its wave, and reflects waves that return to it.

        A side that reflects R lets 1 − R of its wave in. Its reflection is the recorded motion again, delayed by the
        way to the far side, with the sign of that side's reflection, if that side is a free surface or otherwise
        reflects everything; else nothing that counts comes back. The out-of-phase part of what is withheld is a shift
        of the entry time, which is no error (entry.py).
        """
        axis = normal_axis(side)
        errors = {quantity: np.zeros_like(own.values[quantity]) for quantity in MOTIONS}
        for motion in waves:
            column = axis_of_motion(side, motion)
            trip = 2.0 * crossing_time(self.scene, axis, motion)
            if motion not in shares or not math.isfinite(trip):
                continue
            later = own.time - trip
            share, sign = shares[motion], self.held_sides.reflects(OPPOSITE[side], motion)
            sent = reflected_motion(own, column, share)
            kept = reflected_motion(own, column, Reflected(abs(share.dashpots), share.dashpots))
            for quantity, values in sent.items():
                back = sign * np.interp(later, own.time, values, left=0.0)
                errors[quantity][:, column] = back - kept[quantity]
        return dict(errors)

    @cached_property
    def held_sides(self) -> HeldSides:
        """Sides of the problem itself that hold disks."""
        return HeldSides(self.scene)

    def _delays(self, motions: Motions) -> Iterator[Cause]:
        """Errors by dispersion of the packing, and of the time step."""
        if not any(self.ways(own) for own in motions.values()):
            yield Cause.unknown("grid and time step", "waves start everywhere")
            return
        words = "by the dispersion of plane waves on the way from where waves start, and by velocities of half steps"
        whole, grid = (
            {name: self._delayed(own, step) for name, own in motions.items()} for step in (self.time_step, 0.0)
        )
        yield Cause(GRID, words, grid, of_disks=True, factor=USUAL)
        steps = {
            name: {quantity: each - grid[name][quantity] for quantity, each in errors.items()}
            for name, errors in whole.items()
        }
        yield Cause(STEP, words, steps, factor=USUAL)

    def _delayed(self, own: History, step: float) -> dict[str, np.ndarray]:
        """Errors by dispersion, with time steps of this length (s)."""
        errors = {quantity: np.zeros_like(own.values[quantity]) for quantity in MOTIONS}
        for way in self.ways(own):
            if not math.isfinite(way.path * way.speed):
                continue
            moving = (own.values["velocity"] @ way.moves)[:, None]
            if self._in_layers:
                delay = partial(self._delay_of_a_second, way, step)
                parts = errors_in_layers(self.scene, way.motion, float(own.place[1]), delay, own.time)(moving)
            else:
                parts = error_of_delay(own.time, moving, self.delay(way, step))
            for quantity, part in zip(MOTIONS, parts, strict=True):
                errors[quantity] += part * way.moves
        for quantity, part in zip(MOTIONS, error_of_steps(own.time, own.values["velocity"], step), strict=True):
            errors[quantity] += part
        return errors

    def delay(self, way: Way, step: float) -> Delay:
        """Delay of waves over a path, the sum of those in its layers; step : of the run, s, or 0."""
        parts = [
            delay_of(ground, way.motion, way.directions, path, speed, step, self._frequencies_in(ground))
            for ground, path, speed in way.parts
        ]
        return lambda omega: np.asarray(sum(part(omega) for part in parts))

    @cached_property
    def _in_layers(self) -> bool:
        """Whether waves enter layers from below, and all come back from a free surface, or leave there."""
        case = self.scene.case
        top = case.side("top")
        alone = list(case.driving) == ["bottom"] and not any(load.wave for load in case.load)
        return self.scene.ground.is_layered and alone and bool(top.factors or top.is_free)

    def _delay_of_a_second(self, way: Way, step: float, ground: PackedMaterial) -> Delay:
        """Delay of waves in one layer over a way of one second."""
        speed = ground.wave_speeds(1)[0 if way.motion == "p" else 1]
        return delay_of(ground, way.motion, way.directions, speed, speed, step, self._frequencies_in(ground))

    def _frequencies_in(self, ground: PackedMaterial) -> Frequencies:
        """Frequencies of plane waves on the lattice of one layer, by direction, found once."""
        return self._found.setdefault(id(ground), frequencies_of(ground))

    @cached_property
    def _found(self) -> dict[int, Frequencies]:
        return {}

    @cached_property
    def _sources(self) -> list[Source]:
        """Places and sides where waves start."""
        return sources_of(self.scene.case, self.scene.ground)

    def ways(self, own: History) -> list[Way]:
        """Paths of P and S waves to a monitor: from a driven side, or from the nearest load or hole.

        An oblique wave comes through a continuum, which delays it less: its path is the longer side of the disks.
        Empty where waves start everywhere.
        """
        sources, ground, case = self._sources, self.scene.ground, self.scene.case
        driving = list(case.driving)
        if driving and not any(load.wave for load in case.load):
            axis = normal_axis(driving[0])
            path = max(float(each.distance(own.place[None])[0]) for each in sources if not each.is_local)
            ends = (float(own.place[1]), plane_of(driving[0], case.box) if axis == 1 else float(own.place[1]))
            if not case.side(OPPOSITE[driving[0]]).is_artificial:
                path = case.size[axis]  # the mean of the ways there, and back from the other side
                ends = (case.box[1], case.box[3]) if axis == 1 else ends
            return _both_ways(np.eye(2)[axis], path, axis, layers_between(ground, ends), [AXES[axis]])
        if case.incident is not None:
            layers = layers_between(ground, case.packing.box[1::2])
            return _both_ways(np.eye(2)[1], max(case.packing.extent), 1, layers, [AXES[0], DIAGONAL])
        local = [each for each in sources if np.isfinite(each.box).all()]
        places = [np.clip(own.place, each.box[:2], each.box[2:]) for each in local]
        rays = [own.place - place for place in places]
        if not rays:
            return []
        ray = min(rays, key=lambda each: float(np.hypot(*each)))
        path, axis = float(np.hypot(*ray)), int(np.argmax(np.abs(ray)))
        along = ray / path if path > 0.0 and not {0, 1} & set(ground.held) else np.eye(2)[axis]
        layers = layers_between(ground, (float(own.place[1]), float(own.place[1] - ray[1])))
        return _both_ways(along, path, axis, layers, [AXES[0], DIAGONAL])


@dataclass(frozen=True)
class Way:
    """The path of P or S waves.

    motion : kind of the waves. moves : (2,) unit vector of their particle motion. directions : in which they may run.
    parts : by layer the ground, the path in it, m, and the speed of long waves, m/s.
    """

    motion: Motion
    moves: np.ndarray
    directions: Sequence[Direction]
    parts: Sequence[tuple[PackedMaterial, float, float]]

    @property
    def path(self) -> float:
        """Its length, m."""
        return sum(path for _, path, _ in self.parts)

    @property
    def speed(self) -> float:
        """Speed of long waves in the slowest layer, m/s; nan where none run."""
        return float(np.min([speed for *_, speed in self.parts]))


def _both_ways(
    along: np.ndarray,
    path: float,
    axis: int,
    layers: Sequence[tuple[PackedMaterial, float]],
    directions: Sequence[Direction],
) -> list[Way]:
    """The paths of P and S waves along a unit vector, with speeds along an axis, and shares of the path by layer."""
    across = np.array([-along[1], along[0]])
    p, s = ([(ground, share * path, ground.wave_speeds(axis)[kind]) for ground, share in layers] for kind in (0, 1))
    return [Way("p", along, directions, p), Way("s", across, directions, s)]


def reflected_motion(own: History, column: int, share: Reflected) -> dict[str, np.ndarray]:
    """Velocity and displacement (k,) that a side reflects of a recorded motion along x or y (column 0 or 1).

    In phase R/(1 − R) of the motion, as 1 − R of it has come in; the out-of-phase part has the shape of a mass's force,
    the acceleration, and no lasting displacement.
    """
    velocity, displacement = (own.values[quantity][:, column] for quantity in MOTIONS)
    acceleration = np.gradient(velocity, own.time)
    size = float(np.linalg.norm(acceleration))
    lag = -share.out_of_phase * float(np.linalg.norm(velocity)) / size if size > 0.0 else 0.0
    in_phase = (
        share.dashpots / (1.0 - share.dashpots) if share.dashpots < 1.0 else 0.0
    )  # without dashpots none comes in
    return {
        "velocity": in_phase * velocity + lag * acceleration,
        "displacement": in_phase * displacement + lag * velocity,
    }
