"""The elements round a box with a continuum on some sides: their columns and rows."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from dembound.boundaries.edge import SIDES
from dembound.continuum.axis import Around
from dembound.continuum.medium import Ground, Layered, Unlike, layered
from dembound.continuum.mesh import Mesh
from dembound.disks.surroundings.settings import MOST_ALONG, ROUNDING, SLIVER, TALLEST, Settings
from dembound.errors import CaseError
from dembound.table import Box


def mesh_of(
    settings: Settings,
    box: Box,
    sides: Sequence[str],
    element: tuple[float, float] | None = None,
    *,
    surface: float | None = None,
    tops: tuple[float, float] | None = None,
    periodic: tuple[bool, bool] = (False, False),
    mirrors: Sequence[str] = (),
    ground: Ground | None = None,
) -> Mesh:
    """The elements with these settings on some sides of a box (left, bottom, right, top; m).

    element : largest width and height, m; None: by the settings. surface : height of a free surface above the box, m.
    tops : heights of the free surface left and right of a box that reaches it, m; None: they are as high as the box.
    periodic : along x and y. mirrors : sides that are planes of symmetry. ground : of layers, edges of elements lie on
    their joints, and the layers that absorb at the bottom and top below and above all of them; None: it has none.

    Raises CaseError for more elements along a side than anything needs.
    """
    width, height = box[2] - box[0], box[3] - box[1]
    element = element or settings.sides(width, height)
    most = max(width / element[0], height / element[1], ((surface or box[3]) - box[3]) / element[1])
    if most > MOST_ALONG:
        raise CaseError([f"outside.element: makes {most:.3g} elements along a side, must make at most {MOST_ALONG:,}"])
    rows = _Rows(settings._replace(element=element[1]), None if ground is None else layered(ground), element[0])
    beside = {} if tops is None and not rows.joints else _rows_to(box, tops, rows)
    if rows.joints:
        beside |= rows.beyond(box, surface)
    there = [side in sides and not (side == "top" and surface is not None) for side in SIDES]
    return Mesh.around(
        box,
        element,
        settings.order,
        margin=Around(*(settings.margin * each for each in there)),
        layer=Around(*(count * each for count, each in zip(settings.absorbing_at, there, strict=True))),
        wider=settings.beside,
        periodic=periodic,
        surface=surface,
        mirror=Around(*(int(side in mirrors) for side in SIDES)),
        **beside,
    )


class _Rows(NamedTuple):
    """Heights of rows of elements.

    settings : with their largest height as `element`. ground : its layers, if any. width : of the elements, m.
    """

    settings: Settings
    ground: Layered | Unlike | None
    width: float

    @property
    def joints(self) -> tuple[float, ...]:
        """Heights y (m) of the joints of the layers."""
        return () if self.ground is None else self.ground.joints

    @property
    def edges(self) -> tuple[float, ...]:
        """Heights y (m) of the joints on which edges lie; those of one side near one of the other share its edge."""
        if not isinstance(self.ground, Unlike):
            return self.joints
        return shared_edges(self.ground, SLIVER * self.settings.element)

    def largest(self, height: float) -> float:
        """Largest height (m) of elements that begin at a height y, m."""
        if not self.settings.taller or self.ground is None:
            return self.settings.element
        times = self.settings.taller[int(np.searchsorted(self.joints, height, side="right"))]
        return max(self.settings.element, min(self.settings.element * times, TALLEST * self.width))

    def between(self, low: float, high: float) -> list[float]:
        """Heights (m) of rows from a height y (m) to another, with edges on the joints between them.

        A joint nearer to an end than `SLIVER` of an element has no row of its own.
        """
        near = SLIVER * self.settings.element
        rows: list[float] = []
        for first, last in pairwise([low, *(joint for joint in self.edges if low + near < joint < high - near), high]):
            side = self.settings._replace(element=self.largest(first + near)).side(last - first)
            rows += [side] * round((last - first) / side)
        return rows

    def beyond(self, box: Box, surface: float | None) -> dict[str, Any]:
        """Heights (m) of the rows between a box and the lowest joint, and between the box and a surface above it.

        Below the former those of the lowest layer.
        """
        lowest = min(self.joints[0], box[1])
        below = self.between(lowest, box[1]) if box[1] - lowest > SLIVER * self.settings.element else []
        above = [] if surface is None else self.between(box[3], surface)
        return {"below": below, "above": above, "base": self.largest(-math.inf)}


def shared_edges(ground: Unlike, near: float) -> tuple[float, ...]:
    """The joints of either side, ascending, without those of the right side as near (m) to one of the left one."""
    left, edges = [*ground.left.joints], [*ground.left.joints]
    for joint in ground.right.joints:
        closest = min(left, key=lambda each: abs(each - joint), default=math.inf)
        if abs(closest - joint) < near:
            left.remove(closest)  # it takes the place of one joint only
        else:
            edges.append(joint)
    return tuple(sorted(edges))


def _rows_to(box: Box, tops: tuple[float, float] | None, rows: _Rows) -> dict[str, Any]:
    """Heights (m) of the rows beside a box, which end at both tops, and numbers of rows below either top, if any."""
    near = ROUNDING * (box[3] - box[1])
    ends = [end for end in sorted({*(tops or ()), box[3]}) if end < box[3] - near]
    ends = [end for end, last in zip(ends, [box[1], *ends], strict=False) if end > last + near]
    heights: list[float] = []
    reached = {}
    for low, high in pairwise([box[1], *ends, box[3]]):
        heights += rows.between(low, high)
        reached[high] = len(heights)
    if tops is None:
        return {"rows": heights}
    return {"rows": heights, "levels": tuple(reached[min(reached, key=lambda end: abs(end - top))] for top in tops)}
