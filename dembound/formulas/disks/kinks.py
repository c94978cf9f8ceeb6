"""Errors of grid and time step at frequencies that companions with larger disks do not have: from kinks and jumps.

The spectrum of a velocity with a kink falls as 1/ω²; the spectrum of the errors of a delay, which grow as ω³, rises as
ω up to the highest frequency of the disks. Companions of the diameter D' only have frequencies below 2c/D' of P waves,
and above 0.87 of that their waves run at less than half of c (cos qD'/2 = 1/2) and come late. The part of the source's
wave above that frequency is assumed to arrive like the rest: of plane waves with the spectrum of the wave, from a
place in a plane with that times √ω, as waves of a line source in the far field.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.formulas.cause import GRID, MOTIONS, STEP, Cause
from dembound.formulas.delays import error_of_delay, error_of_steps, part_above
from dembound.formulas.disks.dispersion import Dispersion, Way
from dembound.formulas.history import History, Motions
from dembound.places import spans_all
from dembound.table import Box

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
