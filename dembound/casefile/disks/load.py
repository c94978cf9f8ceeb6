"""The ``[[load]]`` and ``[[monitor]]`` tables of disks."""

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import AfterValidator

from dembound.boundaries.edge import normal_axis
from dembound.casefile.disks.targets import with_history
from dembound.casefile.messages import numbered
from dembound.casefile.types import LAWS
from dembound.table import Box, FileName, Table, quantity

Vector = tuple[float, float]

ACTIONS = ("force", "acceleration", "pressure")
"""The keys of which each load has one."""


class Load(Table):
    """A load on particles: one of `force`, `acceleration` and `pressure`.

    A force acts on one particle or on those of a rectangle, in proportion to their area; on the free surface of a
    continuum it is a uniform traction. An acceleration acts on the same or, without a place, on all particles. A
    pressure acts in a hole, or on sides as by a membrane.

    A wave's values, as pure numbers, are the time factor; without one the load is steady, from the static stage on.
    """

    name: FileName = quantity()
    """name in messages and results"""
    force: Vector | None = quantity(None, unit="N/m")
    """force [fx, fy] on all of them; needs position or region"""
    acceleration: Vector | None = quantity(None, unit="m/s²")
    """force [ax, ay] per mass of each particle"""
    position: Vector | None = quantity(None, unit="m", means="place")
    """where; the nearest particle is loaded"""
    region: Box | None = quantity(None, unit="m", means="place")
    """rectangle [x0, y0, x1, y1] of loaded particles, or of the continuum's surface"""
    pressure: float | None = quantity(None, unit="Pa", means="pressure of a load")
    """pressure on the wall of a hole, away from it, or on sides, inwards; negative values pull"""
    hole: str | None = quantity(None)
    """name of the hole on whose wall a pressure acts"""
    sides: tuple[Literal["left", "right", "bottom", "top"], ...] | None = quantity(None, min_length=1)
    """sides on which a steady pressure acts, as round a sample"""
    on: Literal["outline", "bonds"] = quantity("outline")
    """where a pressure acts: on the true outline, or on the bonds that it cuts"""
    wave: str | None = quantity(None)
    """wave that is the time factor; absent: steady"""

    @property
    def key(self) -> str:
        """The key that is given: one of `ACTIONS`."""
        return next(key for key in ACTIONS if getattr(self, key) is not None)

    @property
    def vector(self) -> Vector:
        """The force (N/m) or acceleration (m/s²) along x and y, before the time factor; not of a pressure."""
        return getattr(self, self.key)

    @property
    def axes(self) -> tuple[int, ...]:
        """Axes along which the load acts: 0 for x, 1 for y."""
        if self.sides is not None:
            return tuple(sorted({normal_axis(side) for side in self.sides}))
        if self.pressure is not None:
            return (0, 1)
        return tuple(axis for axis, value in enumerate(self.vector) if value != 0.0)

    def moves_along(self, axis: int) -> bool:
        """Whether it moves a body as a whole along an axis; pressures in holes and on opposite sides are in balance."""
        along = [side for side in self.sides or () if normal_axis(side) == axis]
        return self.hole is None and axis in self.axes and len(along) != 2

    @property
    def is_everywhere(self) -> bool:
        """Whether the load acts on all particles."""
        return self.position is None and self.region is None and self.pressure is None

    def mistakes(self) -> Iterator[str]:
        """Not one action, or not in one place."""
        yield from (*self._problems_with_action(), *self._problems_with_place())

    def _problems_with_action(self) -> list[str]:
        """Mistakes in force, acceleration and pressure."""
        given = [key for key in ACTIONS if getattr(self, key) is not None]
        if not given:
            return [f"{ACTIONS[0]}: is missing; give one of {', '.join(ACTIONS)}"]
        if len(given) > 1:
            return [f"{key}: is not allowed together with {given[0]}" for key in given[1:]]
        if self.pressure is not None:
            return [] if self.pressure != 0.0 else ["pressure: is zero, must not be"]
        return [] if self.axes else [f"{self.key}: is zero along x and y, must not be"]

    def _problems_with_place(self) -> list[str]:
        """Mistakes in position, region and hole."""
        if self.pressure is not None:
            return self._problems_with_hole()
        if stray := [key for key in ("hole", "sides", "on") if key in self.model_fields_set]:
            return [f"{key}: is for a pressure" for key in stray]
        if self.position is not None and self.region is not None:
            return ["region: is not allowed together with position"]
        if self.region is not None:
            x0, y0, x1, y1 = self.region
            return [] if x0 < x1 and y0 < y1 else ["region: must have x0 < x1 and y0 < y1, in the order x0, y0, x1, y1"]
        if self.force is not None and self.position is None:
            return ["position: is missing; a force needs either position or region"]
        return []

    def _problems_with_hole(self) -> list[str]:
        """Mistakes in the place of a pressure."""
        stray = [key for key in ("position", "region") if getattr(self, key) is not None]
        found = [f"{key}: is not allowed together with pressure; give hole or sides" for key in stray]
        if self.hole is None and self.sides is None:
            return ["hole: is missing; a pressure needs the name of a hole, or sides", *found]
        if self.sides is not None:
            beside = [key for key in ("hole", "on") if key in self.model_fields_set]
            found += [f"{key}: is not allowed together with sides" for key in beside]
            if self.wave is not None:
                found.append("wave: is not allowed together with sides, on which a pressure is steady")
            if len(set(self.sides)) < len(self.sides):
                found.append("sides: names a side twice")
        return found


def pressed_side_problems(loads: Iterable[tuple[str, Load]], tables: Mapping[str, Any]) -> Iterator[str]:
    """Pressures on sides that are not the surface of a rectangular body; loads : with their places in the file."""
    for place, load in loads:
        for side in load.sides or ():
            table = tables["boundary"].get(side)
            if table and (table.is_periodic or table.is_outside or table.needs_column or table.is_mirror):
                yield f'{place}.sides: names {side}, "{table.type}", where the body goes on; must be a free side'
        if load.sides and any(hole and hole.is_shape for hole in tables["hole"]):
            yield f"{place}.sides: is for a rectangular body, and a hole keeps what is inside; must not be together"


def gravity(loads: Iterable[Load | None]) -> list[float]:
    """Accelerations (m/s²) along y of the steady ones among some loads that act on all particles."""
    everywhere = [load for load in loads if load and load.acceleration is not None and load.is_everywhere]
    return [load.vector[1] for load in everywhere if load.wave is None]


def rest_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """What a run until rest lacks: contacts that open, and a weight by which something falls."""
    run, material, loads = tables["run"], tables["material"], tables["load"]
    if not run or run.until != "rest" or None in loads:
        return
    if material and not LAWS[material.law].has_history:
        yield f'run.until: is "rest", but under law = "{material.law}" nothing falls; give law = {with_history()}'
    if pull(loads) == 0.0:
        yield 'run.until: is "rest", but no [[load]] without a wave has an acceleration by which disks fall; give one'
    for place, wall in numbered("wall", tables["wall"]):
        if wall.velocity is not None and wall.until is None:
            yield f'{place}.until: is missing; with run.until = "rest" walls must come to a stop'


def pull(loads: Iterable[Load]) -> float:
    """The largest acceleration (m/s²) of the steady loads; 0 without one."""
    steady = (load.acceleration for load in loads if load.acceleration is not None and load.wave is None)
    return max((math.hypot(*each) for each in steady), default=0.0)


FREE_FIELD = ".free_field"
"""Suffix of a monitor's name for the history of its twin in the free-field column."""


def is_no_twin(name: str) -> str:
    """The name of a monitor; raises ValueError for one that a twin has."""
    if name.endswith(FREE_FIELD):
        raise ValueError(f'is "{name}", must not end in "{FREE_FIELD}", which is kept for a monitor\'s twin')
    return name


class Monitor(Table):
    """A place at which the motion of the nearest particle, or of the continuum there, is recorded.

    In a file it may be one of a row, see `monitor_rows.MonitorTable`.
    """

    name: Annotated[FileName, AfterValidator(is_no_twin)] = quantity()
    """name of the history in the results"""
    position: tuple[float, float] = quantity(unit="m", means="place")
    """where; of equally near particles the lowest, of these the leftmost"""
    points: tuple[tuple[float, float], ...] | None = quantity(None, unit="m", means="place")
    """corners of a polygon, of whose particles the mean is recorded"""
