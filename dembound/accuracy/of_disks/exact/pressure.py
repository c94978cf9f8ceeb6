"""A pressure on the wall of a circular hole: in a full space, or below a free surface (Garvin's problem)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from dembound.accuracy.of_disks.exact.problem import (
    BEGINNING,
    ROUGH,
    Problem,
    echoes,
    has_pressure,
    hole_of,
    must_be_continuous,
    places_of,
    solid_of,
    surface_of,
)
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError
from dembound.exact.explosion import buried_explosion, cavity_moment, cavity_motion
from dembound.exact.solid import Solid
from dembound.formulas.history import History
from dembound.holes import Circle
from dembound.waves import Wave

SHALLOW = 0.25
"""Largest radius of a hole over the depth of its axis with which it is treated as a line source."""

SAMPLES = 8000
"""Number of times at which the moment of a line source is computed; between them it is interpolated."""


@dataclass(frozen=True)
class Blast:
    """A pressure on the wall of a circular hole, its solid, and the places (2,) m where the motion is requested.

    wave : the pressure over `pressure` (Pa); wave_name : its name in messages. surface : height of the free surface, m;
    None if there is none.
    """

    solid: Solid
    hole: Circle
    pressure: float
    wave: Wave
    wave_name: str
    surface: float | None
    places: Mapping[str, np.ndarray]

    @classmethod
    def of(cls, scene: DiskScene) -> Self:
        """The blast of a scene; raises CaseError, with the reasons, if it has none or also other sources."""
        case = scene.case
        hole, driven = hole_of(scene), [load for load in case.load if load.wave is not None]
        if len(driven) != 1 or driven[0].pressure is None or case.entering:
            raise CaseError(
                ["load: the solution is that of one pressure on the wall of a hole, following a wave, alone"]
            )
        load = driven[0]
        assert load.pressure is not None and load.wave is not None  # noqa: PT018
        wave, solid, duration = case.wave[load.wave], solid_of(scene), case.run.duration
        must_be_continuous(load.wave, wave.velocity, -BEGINNING * duration, duration)
        return cls(solid, hole, load.pressure, wave, load.wave, surface_of(scene), places_of(scene))

    def history(self, t: np.ndarray) -> np.ndarray:
        """Pressure (Pa) on the wall at times, s."""
        return self.pressure * self.wave.velocity(t)

    def rough(self) -> CaseError:
        """The error for a wave with which the solution does not converge."""
        return CaseError([f"wave.{self.wave_name}: {ROUGH}"])


@dataclass(frozen=True)
class PressureProblem(Problem):
    """A problem of a pressure in a hole."""

    blast: Blast

    @classmethod
    def concerns(cls, case: DiskCase) -> bool:
        """Whether there is a pressure in a hole."""
        return has_pressure(case)


@dataclass(frozen=True)
class CavityProblem(PressureProblem):
    """The wave of a pressure in a hole in a full space."""

    name: ClassVar[str] = "cavity"
    sentence: ClassVar[str] = "exact cavity in a full space"

    @property
    def until(self) -> dict[str, float]:
        """Time (s) at which the wave returns from the free surface to each monitor."""
        blast = self.blast
        return echoes(blast.places, blast.hole, blast.surface, blast.solid.p_wave_speed, blast.wave.start)

    @classmethod
    def of(cls, scene: DiskScene) -> Self:
        """The problem of a scene, see `Blast.of`."""
        return cls(Blast.of(scene))

    def motions(self, times: np.ndarray) -> dict[str, History]:
        """Motion of the monitors, away from the hole's axis."""
        blast, found = self.blast, {}
        for name, place in blast.places.items():
            away = place - blast.hole.centre
            distance = max(math.hypot(*away), blast.hole.radius)
            try:
                motion = cavity_motion(times, distance, blast.history, blast.hole.radius, blast.solid, tolerance=1e-5)
            except RuntimeError:
                raise blast.rough() from None
            direction = np.append(away / math.hypot(*away), 0.0)
            moved, moving = (np.outer(values, direction) for values in (motion.displacement, motion.velocity))
            found[name] = History.of(place, times, moved, moving)
        return found


@dataclass(frozen=True)
class GarvinProblem(PressureProblem):
    """A pressure in a hole that is small compared with its depth, as a line source below a free surface."""

    name: ClassVar[str] = "garvin"
    sentence: ClassVar[str] = (
        "line explosion below a free surface (Garvin), exact but for what the hole scatters of echoes"
    )

    @property
    def until(self) -> dict[str, float]:
        """Infinite for every monitor; scattering of returning waves by the hole is of the order of size/depth."""
        return dict.fromkeys(self.blast.places, math.inf)

    @classmethod
    def of(cls, scene: DiskScene) -> Self:
        """The problem of a scene, see `Blast.of`; the hole must be below a free surface and small relative to depth."""
        blast = Blast.of(scene)
        if blast.surface is None:
            raise CaseError(["boundary.top.type: Garvin's problem has a free surface above the hole"])
        depth = blast.surface - blast.hole.centre[1]
        if blast.hole.radius > SHALLOW * depth:
            name, radius = blast.hole.name, blast.hole.radius
            raise CaseError(
                [f"hole.{name}.radius: is {radius:g}, must be at most {SHALLOW:g} of its depth ({depth:g} m)"]
            )
        return cls(blast)

    def motions(self, times: np.ndarray) -> dict[str, History]:
        """Motion of the monitors."""
        from scipy.interpolate import CubicSpline

        blast = self.blast
        assert blast.surface is not None
        x, depth = blast.hole.centre[0], blast.surface - blast.hole.centre[1]
        advance = blast.hole.radius / blast.solid.p_wave_speed  # by which the moment begins before the pressure
        source = np.linspace(0.0, float(times[-1]) + advance, SAMPLES)
        found = {}
        try:
            moment = cavity_moment(source - advance, blast.history, blast.hole.radius, blast.solid)
            for name, place in blast.places.items():
                below = max(blast.surface - float(place[1]), 0.0)
                moved, moving = (
                    buried_explosion(
                        times + advance, place[0] - x, below, depth, CubicSpline(source, rate), blast.solid, 1e-5
                    )
                    for rate in moment[1:]
                )
                still = np.zeros(len(times))
                both = (np.column_stack([each[0], -each[1], still]) for each in (moved, moving))
                found[name] = History.of(place, times, *both)
        except RuntimeError:
            raise blast.rough() from None
        return found
