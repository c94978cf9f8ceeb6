"""The base of all holes: a name, a stage, the particles to remove, and the level floor that they leave at a side."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Literal, NamedTuple, Self

import numpy as np

from dembound.holes.outline import Outline
from dembound.places import includes
from dembound.roots import root
from dembound.table import Box, FileName, Table, quantity, shifted_place

Apart = Callable[[int, float], float]
"""Distance (m) of a wall across an axis, at a place (m), from the nearest plane between disks."""

WALL = 0.4
"""Error beside a round hole in a lattice under a pressure, times the number of disks along its radius: the median of
0.41, compared with exact solutions, with 3.5 to 20 disks and three places of the centre, at 1 to 2.5 radii
(benchmarks/walls.py). The lattice acts as a hole that is larger by 0.2 D.
"""


class Hole(Table, ABC):
    """An area without particles, and without those that it separates from the body.

    One that keeps what is "inside" is the shape of a sample, whose sides are those of the scene.
    """

    type: str
    name: FileName = quantity()
    """name in loads and messages"""
    stage: Literal["before", "after", "run"] = quantity("before")
    """"before": built with the body; "after": excavated after the static stage, which then goes on; "run": at a time of
    the run"""
    time: float | None = quantity(None, unit="s", ge=0.0)
    """time of the run at which its disks vanish, with stage = "run" """
    keep: Literal["outside", "inside"] = quantity("outside")
    """which particles remain"""

    def mistakes(self) -> Iterator[str]:
        """A time of another stage, or none."""
        if (self.stage == "run") != (self.time is not None):
            yield 'time: is missing, with stage = "run"' if self.time is None else 'time: needs stage = "run"'

    @property
    def is_shape(self) -> bool:
        """Whether it is the shape of a sample."""
        return self.keep == "inside"

    def takes(self, positions: np.ndarray, span: float) -> np.ndarray:
        """Mask (k,) of positions (k, 2) m where particles are removed, none of them on the outline.

        span : size of the scene, m, see `edges.includes`.
        """
        depth = self.depth(positions)
        taken: np.ndarray = ~includes(depth if self.is_shape else -depth, span)
        return taken

    @abstractmethod
    def depth(self, positions: np.ndarray) -> np.ndarray:
        """Distances (k,) m of positions (k, 2) m from the outline, negative outside; beside it to first order."""

    @abstractmethod
    def shifted(self, by: tuple[float, float]) -> Self:
        """The hole shifted by (x, y) m."""

    @property
    @abstractmethod
    def box(self) -> Box:
        """The smallest rectangle around it: x0, y0, x1, y1 in m."""

    def wall_error(self, diameter: float, apart: Apart) -> float:
        """Error of the motion by a pressure in it, beside it in a lattice of disks of a diameter (m), RMS over RMS.

        The default is for a round hole: `WALL` over the number of disks in its smaller half.
        """
        return WALL / (self.smaller_half / diameter)

    @property
    def smaller_half(self) -> float:
        """Half the smaller side of the rectangle around it, m."""
        left, bottom, right, top = self.box
        return 0.5 * min(right - left, top - bottom)

    @property
    def outline(self) -> Outline | None:
        """The rim of the hole, on which a pressure acts; None unless it is a simple closed curve."""
        return None


class Centred(Hole):
    """A hole with a centre."""

    centre: tuple[float, float] = quantity(unit="m", means="place")
    """centre [x, y]"""

    def shifted(self, by: tuple[float, float]) -> Self:
        """The hole shifted by (x, y) m."""
        return self.model_copy(update={"centre": shifted_place(self.centre, by)})


FINE = 8
"""Places per diameter at which points are tested for being in a hole."""


HALVINGS = 50
"""Bisections of half a diameter: to 1e-15 of it."""


class Floor(NamedTuple):
    """A floor beside the left or right side of a rectangle, with no ground above.

    height : y, m. width : m, length from the side inwards over which it is level within half a diameter.
    """

    height: float
    width: float


def _is_open(holes: Sequence[Hole], x: np.ndarray | float, y: np.ndarray | float) -> np.ndarray:
    """Whether places x, y (k,) m are in holes, (k,)."""
    places = np.stack(np.broadcast_arrays(np.atleast_1d(x), np.atleast_1d(y)), axis=1)
    return np.any([hole.takes(places, span=0.0) for hole in holes], axis=0)


def surface_below(holes: Sequence[Hole], box: Box, along: np.ndarray, diameter: float) -> np.ndarray:
    """Heights y (k,) m of the outline of the uppermost ground in a box at x (k,) m; nan where holes leave none.

    box : left, bottom, right, top, m. diameter : mean diameter of the disks, m. Strips of less than half a diameter may
    be missed. The heights are those of the solid side of the outline, to the last bits.
    """
    bottom, top = box[1], box[3]
    heights = np.full(len(along), np.nan)
    waiting = np.arange(len(along))
    for y in np.append(np.arange(top - 0.5 * diameter, bottom, -0.5 * diameter), bottom):
        solid = ~_is_open(holes, along[waiting], y) if holes else np.ones(len(waiting), dtype=bool)
        heights[waiting[solid]] = y
        waiting = waiting[~solid]
    level = heights == top - 0.5 * diameter
    level[level] = ~_is_open(holes, along[level], top) if holes else True
    heights[level] = top
    below = np.flatnonzero(~level & ~np.isnan(heights))
    low, high = heights[below], heights[below] + 0.5 * diameter
    for _ in range(HALVINGS if len(below) else 0):
        middle = 0.5 * (low + high)
        is_open = _is_open(holes, along[below], middle)
        low, high = np.where(is_open, low, middle), np.where(is_open, middle, high)
    heights[below] = low
    return heights


def level_beside(holes: Sequence[Hole], box: Box, side: str, diameter: float) -> float:
    """Length (m) from the left or right side of a box inwards over which no hole opens its upper side.

    diameter : mean diameter of the disks, m; see `floor_beside`, whose floors such sides have none of.
    """
    left, _, right, top = box
    away = np.arange(0.5 * diameter, right - left, diameter / FINE)
    there = _is_open(holes, left + away if side == "left" else right - away, top - 0.5 * diameter)
    return float(away[np.argmax(there)]) if holes and there.any() else right - left


def floor_beside(holes: Sequence[Hole], box: Box, side: str, diameter: float) -> Floor | None:
    """The floor beside the left or right side of a box (left, bottom, right, top; m); None if no hole lowers it there.

    diameter : mean diameter of the disks, m. The height is that of the outline itself. Holes that leave less than half
    a diameter of ground at the top or at the side count as reaching it.
    """
    if not holes:
        return None
    left, bottom, right, top = box
    edge, inwards = (left, 1.0) if side == "left" else (right, -1.0)

    is_open = partial(_is_open, holes)
    beside = edge + 0.5 * inwards * diameter
    down = np.arange(top - 0.5 * diameter, bottom, -diameter / FINE)
    solid = np.append(~is_open(beside, down), True)
    last = int(np.argmax(solid))
    if last == 0:
        return None
    height = bottom
    if last < len(down):
        height = root(lambda y: -1.0 if is_open(beside, y)[0] else 1.0, float(down[last]), float(down[last - 1]))
    away = np.arange(0.5 * diameter, right - left, diameter / FINE)
    x = edge + inwards * away
    level = is_open(x, height + 0.5 * diameter) & ~is_open(x, height - 0.5 * diameter)
    return Floor(height, right - left if level.all() else float(away[np.argmin(level)]))
