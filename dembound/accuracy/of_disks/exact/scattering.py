"""A circular hole under a plane wave that comes at an angle."""

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
    hole_of,
    must_be_continuous,
    places_of,
    solid_of,
    surface_of,
)
from dembound.casefile.disks import DiskCase
from dembound.continuum.medium import ElasticPlaneWave
from dembound.disks.scene import DiskScene
from dembound.disks.surroundings.ground_waves import ground_waves
from dembound.errors import CaseError
from dembound.exact.scattering import PlaneWave, scattered_motion
from dembound.exact.solid import Solid
from dembound.formulas.history import History
from dembound.holes import Circle
from dembound.waves import Wave


@dataclass(frozen=True)
class ScatteringProblem(Problem):
    """Plane waves of a half-space, each scattered by the hole as in a full space.

    waves : the incident wave and its reflections at the free surface. wave : the velocity of the incident one, with
    the name wave_name in messages. surface : height of the free surface, m; None if there is none. places : (2,) m.
    """

    name: ClassVar[str] = "scattering"
    sentence: ClassVar[str] = "exact scattering by a cavity in a full space"
    solid: Solid
    hole: Circle
    waves: tuple[ElasticPlaneWave, ...]
    wave: Wave
    wave_name: str
    surface: float | None
    places: Mapping[str, np.ndarray]

    @property
    def until(self) -> dict[str, float]:
        """Time (s) at which waves scattered by the hole return from the free surface to each monitor."""
        centre = np.array([self.hole.centre])
        meets = min(
            float(wave.delays(centre)[0]) - self.hole.radius * math.hypot(*wave.slowness) for wave in self.waves
        )
        return echoes(self.places, self.hole, self.surface, self.solid.p_wave_speed, self.wave.start + meets)

    @classmethod
    def concerns(cls, case: DiskCase) -> bool:
        """Whether a wave comes at an angle."""
        return case.incident is not None

    @classmethod
    def of(cls, scene: DiskScene) -> Self:
        """The problem of a scene; raises CaseError unless there are one circle and no other waves."""
        case = scene.case
        hole, solid = hole_of(scene), solid_of(scene)
        assert case.incident is not None
        if case.entering != {case.incident.wave} or any(load.wave is not None for load in case.load):
            raise CaseError(["incident: the solution is that of one incident wave alone, without other waves or loads"])
        assert scene.outside is not None
        found = ground_waves(case, scene.ground, scene.outside)
        assert found is not None
        name, duration = case.incident.wave, case.run.duration
        must_be_continuous(name, case.wave[name].velocity, -BEGINNING * duration, duration)
        return cls(solid, hole, found.waves, case.wave[name], name, surface_of(scene), places_of(scene))

    def motions(self, times: np.ndarray) -> dict[str, History]:
        """Motion of the monitors: the sum over all plane waves."""
        centre = np.array([self.hole.centre])
        places = np.array([*self.places.values()]).reshape(-1, 2) - centre
        moved, moving = np.zeros((2, len(places), 3, len(times)))
        for wave in self.waves:
            delay = float(wave.delays(centre)[0])
            try:
                found = scattered_motion(
                    times - delay, places, self._about_the_hole(wave), self.hole.radius, self.solid
                )
            except RuntimeError:
                raise CaseError([f"wave.{self.wave_name}: {ROUGH}"]) from None
            moved[:, :2] += found.displacement
            moving[:, :2] += found.velocity
        return {
            name: History.of(place, times, moved[k].T, moving[k].T)
            for k, (name, place) in enumerate(self.places.items())
        }

    def _about_the_hole(self, wave: ElasticPlaneWave) -> PlaneWave:
        """A plane wave of the ground as one about the hole's axis."""
        slowness, motion = np.array(wave.slowness), np.array(wave.motion)
        x, y = slowness / np.hypot(*slowness)
        along, across = float(motion @ (x, y)), float(motion @ (y, -x))
        kind, factor = ("p", along) if abs(along) > abs(across) else ("sv", across)
        return PlaneWave(kind, math.atan2(y, x), lambda t: factor * self.wave.velocity(t))  # type: ignore[arg-type]
