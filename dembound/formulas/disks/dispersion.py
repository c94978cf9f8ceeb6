"""Errors of grid and time step: waves that disks and steps delay on their way from where they start to a monitor.

Kinks and jumps add errors at frequencies that companions with larger disks do not have.

The spectrum of a velocity with a kink falls as 1/ω²; the spectrum of the errors of a delay, which grow as ω³, rises as
ω up to the highest frequency of the disks. Companions of the diameter D' only have frequencies below 2c/D' of P waves,
and above 0.87 of that their waves run at less than half of c (cos qD'/2 = 1/2) and come late. The part of the source's
wave above that frequency is assumed to arrive like the rest: of plane waves with the spectrum of the wave, from a
place in a plane with that times √ω, as waves of a line source in the far field.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np

from dembound.boundaries import Motion, normal_axis, plane_of
from dembound.boundaries.edge import OPPOSITE
from dembound.casefile.disks import DiskCase
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.scene import DiskScene
from dembound.disks.sources import sources_of
from dembound.formulas.cause import GRID, MOTIONS, STEP, USUAL, Cause
from dembound.formulas.disks.waves import (
    AXES,
    DIAGONAL,
    Direction,
    Frequencies,
    delay_of,
    errors_in_layers,
    frequencies_of,
    layers_between,
)
from dembound.formulas.history import Delay, History, Motions, error_of_delay, error_of_steps, part_above
from dembound.motion.paths import Source
from dembound.places import spans_all
from dembound.table import Box


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


Layers = Sequence[tuple[PackedMaterial, float]]
"""Grounds, each with its share of a path."""


def _both_ways(along: np.ndarray, path: float, axis: int, layers: Layers, directions: Sequence[Direction]) -> list[Way]:
    """The paths of P and S waves along a unit vector, with speeds along an axis, and shares of the path by layer."""
    across = np.array([-along[1], along[0]])
    p, s = ([(ground, share * path, ground.wave_speeds(axis)[kind]) for ground, share in layers] for kind in (0, 1))
    return [Way("p", along, directions, p), Way("s", across, directions, s)]


@dataclass(frozen=True)
class Dispersion:
    """Delays on the ways of one scene, which runs at a time step (s)."""

    scene: DiskScene
    time_step: float

    def causes(self, motions: Motions) -> Iterator[Cause]:
        """Errors by dispersion of the packing, and of the time step."""
        if not any(self.ways(own) for own in motions.values()):
            yield Cause.unknown("grid and time step", "waves start everywhere")
            return
        words = "by the dispersion of plane waves on the way from where waves start, and by velocities of half steps"
        whole, grid = (
            {name: self._delayed(own, step) for name, own in motions.items()} for step in (self.time_step, 0.0)
        )
        yield Cause(GRID, words, grid, of_disks=True, factor=USUAL)
        steps = {n: {q: each - grid[n][q] for q, each in errors.items()} for n, errors in whole.items()}
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


SLOW = math.sqrt(3.0) / 2.0
"""Frequency over the highest one of a row, above which its waves run at less than half their speed."""

LEAST = 5e-4
"""Smallest error that is listed, half of what is printed as "< 0.1 %"; smooth waves have none."""

MOST_SAMPLES = 10_000
"""Steps of the run, at most, in which the wave is taken, from its begin on."""

AHEAD = 10.0
"""Periods of the lowest frequency before the begin of the wave from which on what is above it counts: it has no begin,
and falls as 1/t from a kink."""

KINK_FACTOR = 1.6
"""Factor of the causes: the true errors of the steps under triangles were 0.6 to 1.54 times as large, at eight monitors
in plane waves of a velocity, dashpots and a force, and round a force in rock."""

KINKS = "kinks"
"""Name of these causes, after the grid and the time step."""

Signal = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Times (k,) s, velocities (k,) of a wave at them, and the part (k,) that companions do not have."""


def causes_of_kinks(dispersion: Dispersion, motions: Motions, diameter: float) -> Iterator[Cause]:
    """Errors, as sizes, of grid and time step at frequencies above those of companions with disks of `diameter` (m).

    motions : of the companions, by monitor.
    """
    kinks = _Kinks(dispersion, diameter)
    found = {name: kinks.sizes(own) for name, own in motions.items()}
    words = "by the spectrum of the waves above that of companions"
    for number, (name, of_disks) in enumerate(((GRID, True), (STEP, False))):
        parts = {monitor: each[number] for monitor, each in found.items()}
        if max((size for each in parts.values() for size in each.values()), default=0.0) > LEAST:
            yield Cause(f"{name} at {KINKS}", words, parts, of_disks=of_disks, factor=KINK_FACTOR)


@dataclass
class _Kinks:
    """The errors of one scene whose motion is known from companions with disks of a diameter (m)."""

    dispersion: Dispersion
    diameter: float
    _signals: dict[tuple[str, float, float], Signal | None] = field(default_factory=dict)

    def sizes(self, own: History) -> tuple[dict[str, float], dict[str, float]]:
        """Errors of the grid and of the time step at one monitor, RMS over RMS, by quantity.

        P and S waves are weighted by their shares of the squared motion.
        """
        ways = [way for way in self.dispersion.ways(own) if math.isfinite(way.path * way.speed)]
        squares = [float(np.sum((own.values["velocity"] @ way.moves) ** 2)) for way in ways]
        grid, step = dict.fromkeys(MOTIONS, 0.0), dict.fromkeys(MOTIONS, 0.0)
        for way, square in zip(ways, squares, strict=True):
            share = square / max(sum(squares), np.finfo(float).tiny)
            for quantity, (of_grid, of_step) in self._of_way(way).items():
                grid[quantity] += share * of_grid**2
                step[quantity] += share * of_step**2
        grid, step = ({q: math.sqrt(total) for q, total in each.items()} for each in (grid, step))
        return grid, step

    def _of_way(self, way: Way) -> dict[str, tuple[float, float]]:
        """Errors of grid and time step, by quantity, of the wave on this path with the largest errors."""
        dispersion, most = self.dispersion, dict.fromkeys(MOTIONS, (0.0, 0.0))
        for name, power in sorted(_waves(dispersion.scene.case, way)):
            if (signal := self._signal(name, power, way.speed)) is None:
                continue
            time, whole, above = signal
            step = dispersion.time_step
            delays = (dispersion.delay(way, each) for each in (0.0, step))
            grid, stepped = (error_of_delay(time, above[:, None], delay) for delay in delays)
            sampled = error_of_steps(time, above[:, None], step)
            for k, (quantity, motion) in enumerate(zip(MOTIONS, (whole, step * np.cumsum(whole)), strict=True)):
                errors = grid[k], stepped[k] + sampled[k] - grid[k]
                of_grid, of_step = (float(np.linalg.norm(each) / np.linalg.norm(motion)) for each in errors)
                most[quantity] = max(most[quantity], (of_grid, of_step), key=max)
        return most

    def _signal(self, name: str, power: float, speed: float) -> Signal | None:
        """A wave of a speed (m/s) with its spectrum times ω^power; None if companions contain all of it."""
        key = name, power, speed
        if key not in self._signals:
            case, step = self.dispersion.scene.case, self.dispersion.time_step
            wave = case.wave[name]
            highest = SLOW * 2.0 * speed / self.diameter
            begin = wave.begin() - AHEAD * 2.0 * math.pi / highest
            time = begin + step * np.arange(int(min((case.run.duration - begin) / step, MOST_SAMPLES)))
            self._signals[key] = None
            if len(time) > 1:
                whole, above = part_above(time, wave.velocity(time), highest, power)
                if np.linalg.norm(above) > LEAST * np.linalg.norm(whole):
                    self._signals[key] = time, whole, above
        return self._signals[key]


def _waves(case: DiskCase, way: Way) -> set[tuple[str, float]]:
    """The names of the waves on a path, each with the power of ω that multiplies its spectrum."""
    loads = [load for load in case.load if load.wave is not None]
    if loads:
        return {(str(load.wave), 0.0 if _is_plane(case, load.region) else 0.5) for load in loads}
    if case.incident is not None:
        return {(case.incident.wave, 0.0)}
    return {(waves[way.motion], 0.0) for waves in case.driving.values() if way.motion in waves}


def _is_plane(case: DiskCase, region: Box | None) -> bool:
    """Whether a load acts on the whole width or height of a scene, so that its waves are plane."""
    return region is not None and any(spans_all(region, case.box, axis) for axis in (0, 1))
