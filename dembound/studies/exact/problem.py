"""What exact problems of cases have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from typing import ClassVar, NamedTuple, Self

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError
from dembound.exact.solid import Solid
from dembound.holes import Circle

ISOTROPY = 1e-6
"""Relative difference of C11 − C12 and 2 C66 up to which a medium is treated as isotropic."""

ROUGH = "is so rough that the solution does not converge; the solution needs a continuous wave"


class Motion(NamedTuple):
    """Motion of a monitor at k times: x, y, and rotation, which exact problems leave zero."""

    displacement: np.ndarray
    """(k, 3) m, m, rad"""
    velocity: np.ndarray
    """(k, 3) m/s, m/s, rad/s"""


class Problem(ABC):
    """A problem with an exact solution, which a case may be."""

    name: ClassVar[str]
    """By which it is chosen."""
    sentence: ClassVar[str]
    """The solution in words."""

    @property
    def until(self) -> float:
        """Time (s) up to which the solution is that of the case."""
        return float("inf")

    @classmethod
    @abstractmethod
    def concerns(cls, case: DiskCase) -> bool:
        """Whether a case has the loads of this problem."""

    @classmethod
    @abstractmethod
    def of(cls, scene: DiskScene) -> Self:
        """The problem that a scene is; raises CaseError, with the reasons, if it is none."""

    @abstractmethod
    def motions(self, times: np.ndarray) -> dict[str, Motion]:
        """Motions of all monitors by name at times (k,) s; raises CaseError where no solution is found."""


def solid_of(scene: DiskScene) -> Solid:
    """The homogenised medium of a scene; raises CaseError if it is not isotropic."""
    tensor = scene.ground.material_tensor
    if abs(tensor[0, 0] - tensor[0, 1] - 2.0 * tensor[3, 3]) > ISOTROPY * tensor[0, 0]:
        raise CaseError(["material: makes an anisotropic medium, which has no such solution; see kratio and fric"])
    p_speed, s_speed = (float(np.sqrt(tensor[k, k] / scene.ground.density)) for k in (0, 3))
    return Solid(scene.ground.density, p_speed, s_speed)


def law_problems(case: DiskCase) -> Iterator[str]:
    """That a case has a law other than that of a linear solid."""
    if LAWS[case.material.law].has_history:
        name = case.material.law
        yield f'material.law: is "{name}", must have no history, as "elastic"; the solution is that of a linear solid'


def places_of(scene: DiskScene) -> dict[str, np.ndarray]:
    """Places (2,) m of the case's monitors, without those of a free-field column."""
    return {monitor.name: scene.monitored[monitor.name] for monitor in scene.case.monitor}


def surface_of(scene: DiskScene) -> float | None:
    """Height (m) of the free surface; None if the ground goes on above."""
    if scene.outside is not None:
        surface = scene.outside.free_surface
        return None if surface is None else surface[0]
    top = scene.case.side("top")
    return scene.case.size[1] if top.is_free and not top.is_artificial else None


def hole_of(scene: DiskScene) -> Circle:
    """The one hole of a scene; raises CaseError unless it is one circle, in linear rock that goes on around it."""
    case = scene.case
    problems = [*law_problems(case)]
    if len(case.hole) != 1 or not isinstance(case.hole[0], Circle):
        problems.append("hole: the solution is that of one circle")
    if case.motion.held:
        problems.append(f"motion.held: is {list(case.motion.held)}, must be empty")
    for side in ("left", "right", "bottom", "top"):
        table = case.side(side)
        surface = side == "top" and surface_of(scene) is not None
        if not (table.is_artificial or table.is_outside or surface):
            problems.append(f'boundary.{side}.type: is "{table.type}", must be a side beyond which the rock goes on')
    if problems:
        raise CaseError(problems)
    hole = case.hole[0]
    assert isinstance(hole, Circle)
    return hole


def echo(places: Mapping[str, np.ndarray], hole: Circle, surface: float | None, speed: float) -> float:
    """Time (s) waves need at least from a hole's wall to the free surface and back to the nearest of places (2,) m."""
    if surface is None or not places:
        return float("inf")
    centre = np.array(hole.centre)
    paths = [np.hypot(place[0] - centre[0], 2.0 * surface - place[1] - centre[1]) for place in places.values()]
    return float(min(paths) - hole.radius) / speed
