"""Lamb's problem: the motion of a half-space at or near its surface, beside a vertical line load."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from dembound.accuracy.of_disks.exact.problem import (
    BEGINNING,
    ROUGH,
    Problem,
    has_pressure,
    law_problems,
    motion_problems,
    must_be_continuous,
    places_of,
    solid_of,
)
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import Load
from dembound.disks.scene import DiskScene
from dembound.disks.supports import forces_of
from dembound.errors import CaseError
from dembound.exact.lamb import surface_displacement
from dembound.exact.lamb_below import buried_displacement
from dembound.exact.solid import Solid
from dembound.formulas.history import History
from dembound.motion.endings import monitored
from dembound.waves import Wave

CORNER = 0.25
"""Least distance between the load and a side that does not mirror it, over the distance from load to monitor."""

SHALLOW = 1e-6
"""Depth over distance up to which a monitor is on the surface, to rounding."""

ON_TOP = "must be on the top of the scene, where the solution is computed"


@dataclass(frozen=True)
class LineLoad:
    """Vertical force history on the surface: position along x (m), and downward N per metre per unit of the wave."""

    x: float
    force: float
    wave: str


@dataclass(frozen=True)
class LambProblem(Problem):
    """A line load on the surface, and the distances (m, positive to the right) of the monitors from it.

    With a symmetry side the load lies in that plane, and twice the case's force acts. Monitors are as deep below the
    `surface` (m) as the centres of their disks. wave : the load over its force.
    """

    name: ClassVar[str] = "lamb"
    sentence: ClassVar[str] = "exact half-space (Lamb)"
    solid: Solid
    load: LineLoad
    wave: Wave
    away: Mapping[str, float]
    surface: float
    places: Mapping[str, np.ndarray]

    @property
    def until(self) -> dict[str, float]:
        """Infinite for every monitor, as the solution always holds."""
        return dict.fromkeys(self.away, math.inf)

    @classmethod
    def concerns(cls, case: DiskCase) -> bool:
        """Whether a force acts, or no load of another problem."""
        return case.incident is None and not has_pressure(case)

    @classmethod
    def of(cls, scene: DiskScene) -> Self:
        """The problem of a scene.

        Raises CaseError if it is not Lamb's: one vertical load that follows a continuous wave, on a free top, away from
        sides that do not mirror it, an isotropic and linear medium, monitors on the top and not under the load.
        """
        case, load, solid = scene.case, _line_load(scene), solid_of(scene)
        half_space = [*motion_problems(case), *_disturbed(case), *_covered(case)]
        if problems := [*law_problems(case), *half_space, *_ends_of_the_surface(scene, load)]:
            raise CaseError(problems)
        wave = case.wave[load.wave]
        places = places_of(scene)
        away = {name: _away(scene, load, name, place) for name, place in places.items()}
        for distance in away.values():
            end = case.run.duration - abs(distance) / solid.p_wave_speed
            must_be_continuous(load.wave, wave.velocity, BEGINNING * end, end)
        return cls(solid, load, wave, away, case.box[3], places)

    def motions(self, times: np.ndarray) -> dict[str, History]:
        """Motion of the monitors; the velocity is the slope between the times."""
        return {name: self._motion(times, self.places[name], distance) for name, distance in self.away.items()}

    def _motion(self, times: np.ndarray, place: np.ndarray, distance: float) -> History:
        """Motion at a place (2,) m, at a horizontal distance (m) from the load."""
        solid, depth = self.solid, self.surface - float(place[1])
        try:
            if depth > SHALLOW * abs(distance):
                along, down = buried_displacement(times, abs(distance), depth, self._force, solid)
            else:
                speeds = solid.p_wave_speed, solid.s_wave_speed
                along, down = surface_displacement(times, abs(distance), self._force, solid.density, *speeds)
        except RuntimeError:
            raise CaseError([f"wave.{self.load.wave}: {ROUGH}"]) from None
        moved = np.column_stack([np.sign(distance) * along, -down, np.zeros(len(times))])
        return History.of(place, times, moved, np.gradient(moved, times, axis=0))

    def _force(self, times: np.ndarray) -> np.ndarray:
        """The load (N per metre, downwards) at times of any shape."""
        return self.load.force * self.wave.velocity(times)


def _away(scene: DiskScene, load: LineLoad, name: str, place: np.ndarray) -> float:
    """Distance (m) of a monitor to the right of the load; raises CaseError where there is no solution."""
    if name not in scene.between:
        _must_be_on_top(scene, scene.monitors[name], f"monitor.{name}.position")
    elif place[1] < scene.case.box[3] - scene.ground.brick.mean_diameter:
        raise CaseError([f"monitor.{name}.position: {ON_TOP}"])
    away = float(place[0]) - load.x
    if away == 0.0:
        raise CaseError([f"monitor.{name}.position: lies under the load, where the solution is infinite"])
    return away


def _line_load(scene: DiskScene) -> LineLoad:
    """The load of Lamb's problem."""
    case = scene.case
    driven: list[Load] = [load for load in case.load if load.wave is not None]
    if len(driven) != 1 or driven[0].force is None or driven[0].position is None or driven[0].force[0] != 0.0:
        raise CaseError(["load: Lamb's problem has one vertical force on one place, following a wave"])
    load = driven[0]
    assert load.position is not None and load.force is not None and load.wave is not None  # noqa: PT018
    node = int(forces_of(load, scene)[0][0])
    _must_be_on_top(scene, node, f"load.{load.name}.position")
    x, factor = float(scene.assembly.positions[node, 0]), 1.0
    for side in ("left", "right"):
        if case.side(side).is_mirror and node in scene.edges[side].nodes:
            x, factor = scene.plane(side), 2.0
    return LineLoad(x, -factor * load.force[1], load.wave)


def _covered(case: DiskCase) -> Iterator[str]:
    """A line if the top of a case is not the free surface of a half-space."""
    top = case.side("top")
    if not top.is_free:
        yield f'boundary.top.type: is "{top.type}", must be "free", the surface of the half-space'


def _disturbed(case: DiskCase) -> Iterator[str]:
    """Lines on features that Lamb's half-space does not have: holes, and other waves."""
    if case.holes:
        yield "hole: Lamb's half-space has none"
    for name in sorted(case.entering):
        yield f"wave.{name}: enters through a side; the solution is that of the load alone"


def _ends_of_the_surface(scene: DiskScene, load: LineLoad) -> Iterator[str]:
    """Lines on sides so near that the body is a quarter space; a mirror side is at distance zero."""
    reach = np.abs(monitored(scene)[:, 0] - load.x).max(initial=0.0)
    for side in ("left", "right"):
        away = abs(scene.plane(side) - load.x)
        if side in scene.edges and not scene.case.side(side).is_outside and 0.0 < away < CORNER * reach:
            yield (
                f"load: is {away:.3g} m from the {side} side and {reach:.3g} m from a monitor, which makes a quarter "
                f"space; the side must mirror the load (symmetry) or be at least {CORNER * reach:.3g} m away"
            )


def _must_be_on_top(scene: DiskScene, node: int, place: str) -> None:
    if "top" not in scene.edges or node not in scene.edges["top"].nodes:
        raise CaseError([f"{place}: {ON_TOP}"])
