"""The interface of problems with an exact solution, and checks that they share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from typing import ClassVar, Self

import numpy as np

from dembound.boundaries.edge import SIDES
from dembound.casefile.disks import DiskCase
from dembound.casefile.messages import numbered
from dembound.casefile.types import LAWS
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError
from dembound.exact.solid import Solid
from dembound.formulas.history import History
from dembound.holes import Circle
from dembound.table import Box

ISOTROPY = 1e-6
"""Relative difference of C11 − C12 and 2 C66 up to which a medium is treated as isotropic."""

SAMPLES = 2000
"""Number of times between which jumps of a wave are looked for."""

JUMP = 0.01
"""Jump over the largest value above which a wave is refused at once.

Solutions do not converge with such a jump, which takes a minute to detect; with a tenth of it, as at the end of a
measured record, Lamb's solution converges."""

BEGINNING = 1e-9
"""Share of a run after which it has begun: a wave that jumps at t = 0 is continuous from there on."""

CONTINUOUS = "the solution needs a continuous wave"
ROUGH = f"is so rough that the solution does not converge; {CONTINUOUS}"


class Problem(ABC):
    """A problem with an exact solution that a case may match."""

    name: ClassVar[str]
    """Name by which the problem is chosen."""
    sentence: ClassVar[str]
    """The solution in words."""

    @property
    @abstractmethod
    def until(self) -> dict[str, float]:
        """By monitor, time (s) up to which the solution holds for the case; infinite if always."""

    @classmethod
    @abstractmethod
    def concerns(cls, case: DiskCase) -> bool:
        """Whether a case has the loads of this problem."""

    @classmethod
    @abstractmethod
    def of(cls, scene: DiskScene) -> Self:
        """The problem of a scene; raises CaseError, with the reasons, if the scene does not match."""

    @abstractmethod
    def motions(self, times: np.ndarray) -> dict[str, History]:
        """Motion of all monitors by name at times (k,) s; raises CaseError where no solution is found."""


def solid_of(scene: DiskScene) -> Solid:
    """The homogenised medium of a scene; raises CaseError if it is not isotropic, or layered."""
    if scene.ground.is_layered:
        raise CaseError(["layer: the solution is that of uniform ground; leave the layers out"])
    tensor = scene.ground.material_tensor
    if abs(tensor[0, 0] - tensor[0, 1] - 2.0 * tensor[3, 3]) > ISOTROPY * tensor[0, 0]:
        raise CaseError(["material: makes an anisotropic medium, which has no such solution; see kratio and fric"])
    p_speed, s_speed = (float(np.sqrt(tensor[k, k] / scene.ground.density)) for k in (0, 3))
    return Solid(scene.ground.density, p_speed, s_speed)


def law_problems(case: DiskCase) -> Iterator[str]:
    """A line if the law of a case is not that of a linear solid."""
    if not LAWS[case.material.law].is_linear:
        name = case.material.law
        must = "have no history" if LAWS[name].has_history else "be linear"
        yield f'material.law: is "{name}", must {must}, as "elastic"; the solution is that of a linear solid'
    for key in ("joint", "group"):
        if getattr(case, key):
            yield f"{key}: must be left out; the solution is that of a solid without {key}s"
    if case.is_damped:
        yield "material.quality_factor: must be left out; the solution is that of an undamped solid"


def has_pressure(case: DiskCase) -> bool:
    """Whether a pressure that follows a wave acts in a hole of the case."""
    return any(load.pressure is not None and load.wave is not None for load in case.load)


def motion_problems(case: DiskCase) -> Iterator[str]:
    """Lines on held motions, and on steady loads without a static stage, which move the body as well."""
    if case.motion.held:
        yield f"motion.held: is {list(case.motion.held)}, must be empty"
    for place, load in numbered("load", case.load):
        if load.wave is None and case.static is None:
            yield f"{place}: is steady, and begins with the run; the solution is that of waves alone, add [static]"


def places_of(scene: DiskScene) -> dict[str, np.ndarray]:
    """Places (2,) m of the case's monitors, without those of a free-field column."""
    return {monitor.name: scene.monitored[monitor.name] for monitor in scene.case.monitor}


def surface_of(scene: DiskScene) -> float | None:
    """Height (m) of the free surface; None if the ground goes on above."""
    if scene.outside is not None:
        surface = scene.outside.free_surface
        return None if surface is None else surface[0]
    top = scene.case.side("top")
    return scene.case.box[3] if top.is_free and not top.is_artificial else None


def hole_of(scene: DiskScene) -> Circle:
    """The only hole of a scene; raises CaseError unless it is one circle, in linear rock that goes on around it."""
    case = scene.case
    problems = [*law_problems(case), *motion_problems(case)]
    if len(case.holes) != 1 or not isinstance(case.holes[0], Circle):
        problems.append("hole: the solution is that of one circle")
    for side in SIDES:
        table = case.side(side)
        surface = side == "top" and surface_of(scene) is not None
        if not (table.is_artificial or surface):
            problems.append(f'boundary.{side}.type: is "{table.type}", must be a side beyond which the rock goes on')
    for place, each in case.named_holes:
        reached = [
            side for side, is_beyond in zip(SIDES, _beyond(each.box, case.packing.box), strict=True) if is_beyond
        ]
        problems += [f"{place}: reaches boundary.{side}; the solution is that of a closed circle" for side in reached]
    if problems:
        raise CaseError(problems)
    hole = case.holes[0]
    assert isinstance(hole, Circle)
    return hole


def _beyond(inner: Box, outer: Box) -> tuple[bool, bool, bool, bool]:
    """Whether a rectangle reaches the left, right, bottom and top of another one."""
    return inner[0] <= outer[0], inner[2] >= outer[2], inner[1] <= outer[1], inner[3] >= outer[3]


def echoes(
    places: Mapping[str, np.ndarray], hole: Circle, surface: float | None, speed: float, begin: float
) -> dict[str, float]:
    """Times (s) when waves from a hole's wall, starting at `begin`, return from the free surface to places (2,) m."""
    if surface is None:
        return dict.fromkeys(places, float("inf"))
    (x, y), found = hole.centre, {}
    for name, place in places.items():
        path = float(np.hypot(place[0] - x, 2.0 * surface - place[1] - y)) - hole.radius
        found[name] = begin + path / speed
    return found


def must_be_continuous(name: str, velocity: Callable[[np.ndarray], np.ndarray], begin: float, end: float) -> None:
    """Raise CaseError if the wave of a name jumps between two times, s."""
    when, step = _largest_jump(velocity, begin, end)
    if step > JUMP:
        raise CaseError([f"wave.{name}: has a jump at {when:.3g} s; {CONTINUOUS}"])


def _largest_jump(velocity: Callable[[np.ndarray], np.ndarray], begin: float, end: float) -> tuple[float, float]:
    """Time (s) of the largest jump of a wave between two times (s), and its size over the largest velocity.

    Every interval between samples is halved repeatedly, and the half with the larger change is kept. The change of a
    continuous wave decreases with the width, a jump does not. Two opposite jumps between two samples are not
    detected.
    """
    times = np.linspace(begin, max(begin, end), SAMPLES)
    low, high = times[:-1], times[1:]
    largest = np.abs(velocity(times)).max()
    for _ in range(30):  # to 1e-9 of an interval
        middle = 0.5 * (low + high)
        before, after = (np.abs(velocity(middle) - velocity(edge)) for edge in (low, high))
        low, high = np.where(before > after, low, middle), np.where(before > after, middle, high)
    steps = np.abs(velocity(high) - velocity(low))
    k = int(steps.argmax())
    return float(high[k]), float(steps[k] / largest) if largest > 0.0 else 0.0
