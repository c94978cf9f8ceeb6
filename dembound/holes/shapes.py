"""The shapes of holes: circle, ellipse, rectangle and polygon."""

import math
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, field_validator

from dembound.holes.hole import Apart, Centred, Hole
from dembound.holes.outline import EllipseOutline, PolygonOutline
from dembound.table import Box, quantity, shifted_box, shifted_place


class Circle(Centred):
    """A tunnel or a borehole."""

    type: Literal["circle"]
    radius: float = quantity(unit="m", means="length", gt=0.0)
    """radius"""

    def depth(self, positions: np.ndarray) -> np.ndarray:
        """Distances (k,) m of positions (k, 2) m from the circle, negative outside."""
        return self.radius - np.hypot(*(positions - self.centre).T)

    @property
    def box(self) -> Box:
        """The square around it: x0, y0, x1, y1 in m."""
        (x, y), r = self.centre, self.radius
        return x - r, y - r, x + r, y + r

    @property
    def outline(self) -> EllipseOutline:
        """The circle."""
        return EllipseOutline(self.centre, (self.radius, self.radius))


Length = Annotated[float, Field(gt=0.0)]


class Ellipse(Centred):
    """A cavern, or a crack where one axis is short."""

    type: Literal["ellipse"]
    semi_axes: tuple[Length, Length] = quantity(unit="m", means="length")
    """[a, b], half its length and half its width"""
    angle: float = quantity(0.0, unit="degrees", means="direction")
    """from the x axis to the semi-axis a, counter-clockwise"""

    @property
    def _direction(self) -> tuple[float, float]:
        """Cosine and sine of the angle."""
        return float(np.cos(np.radians(self.angle))), float(np.sin(np.radians(self.angle)))

    def depth(self, positions: np.ndarray) -> np.ndarray:
        """Distances (k,) m of positions (k, 2) m from the ellipse, negative outside, to first order.

        f = 1 − (x/a)² − (y/b)² over the size of its gradient, (2x/a², 2y/b²).
        """
        (c, s), axes = self._direction, np.array(self.semi_axes)
        scaled = (positions - self.centre) @ np.array([[c, -s], [s, c]]) / axes
        steepness = np.hypot(*(2.0 * scaled / axes).T)
        return (1.0 - (scaled**2).sum(axis=1)) / np.maximum(steepness, 1.0 / axes.max())

    @property
    def box(self) -> Box:
        """The upright rectangle around it: x0, y0, x1, y1 in m."""
        (x, y), (a, b), (c, s) = self.centre, self.semi_axes, self._direction
        wide, high = float(np.hypot(a * c, b * s)), float(np.hypot(a * s, b * c))
        return x - wide, y - high, x + wide, y + high

    @property
    def outline(self) -> EllipseOutline:
        """The ellipse."""
        return EllipseOutline(self.centre, self.semi_axes, float(np.radians(self.angle)))


STRAIGHT = 0.2
"""Error beside a rectangle with walls between disks of a lattice under a pressure, times the number of disks along its
smaller half: 0.22 and 0.20 with 3 and 12 disks, compared with disks 3 and 5 times smaller (benchmarks/walls.py).
"""


class Rectangle(Hole):
    """A drift, a shaft or a trench, upright."""

    type: Literal["rectangle"]
    corners: Box = quantity(unit="m", means="place")
    """[x0, y0, x1, y1], lower left and upper right corner"""

    @field_validator("corners")
    @classmethod
    def _in_order(cls, corners: Box) -> Box:
        x0, y0, x1, y1 = corners
        if not (x0 < x1 and y0 < y1):
            raise ValueError("must have x0 < x1 and y0 < y1, in the order x0, y0, x1, y1")
        return corners

    def depth(self, positions: np.ndarray) -> np.ndarray:
        """Distances (k,) m of positions (k, 2) m from the nearest of the edges' lines, negative outside."""
        return np.minimum(positions - self.corners[:2], self.corners[2:] - positions).min(axis=1)

    def shifted(self, by: tuple[float, float]) -> Self:
        """The hole shifted by (x, y) m."""
        return self.model_copy(update={"corners": shifted_box(self.corners, by)})

    @property
    def box(self) -> Box:
        """The rectangle itself: x0, y0, x1, y1 in m."""
        return self.corners

    def wall_error(self, diameter: float, apart: Apart) -> float:
        """Error with walls between disks, plus that of other walls: half the change of width over the smaller half.

        The effect of a hole grows in proportion to its size; both errors may add or cancel.
        """
        along = self.smaller_half / diameter
        misfit = max(apart(k % 2, wall) for k, wall in enumerate(self.box)) / self.smaller_half
        return math.hypot(STRAIGHT / along, 0.5 * misfit)

    @property
    def outline(self) -> PolygonOutline:
        """The four edges of the rectangle."""
        x0, y0, x1, y1 = self.corners
        return PolygonOutline(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]))


Points = tuple[tuple[float, float], ...]


class Polygon(Hole):
    """A section drawn point by point, such as a horseshoe tunnel or the valley above a slope."""

    type: Literal["polygon"]
    points: Points = quantity(unit="m", means="place")
    """corners [[x, y], …] in order, the last joined to the first"""

    @field_validator("points")
    @classmethod
    def _three_or_more(cls, points: Points) -> Points:
        if len(points) < 3:
            raise ValueError(f"has {len(points)}, must have at least three")
        return points

    def depth(self, positions: np.ndarray) -> np.ndarray:
        """Distances (k,) m of positions (k, 2) m from the polygon, negative outside.

        Inside is where a ray along +x meets an odd number of edges. A cut that is drawn there and back, as from the
        outer to the inner corners of a ring, is no edge.
        """
        x, y = positions.T
        inside, away = np.zeros(len(positions), dtype=bool), np.full(len(positions), np.inf)
        edges = list(zip(self.points, self.points[1:] + self.points[:1], strict=True))
        for (x0, y0), (x1, y1) in edges:
            along, up = x1 - x0, y1 - y0
            if ((x1, y1), (x0, y0)) in edges:  # also of two corners in one place
                continue
            part = np.clip(((x - x0) * along + (y - y0) * up) / (along * along + up * up), 0.0, 1.0)
            away = np.minimum(away, np.hypot(x - x0 - part * along, y - y0 - part * up))
            if up != 0.0:
                inside ^= ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) / up * along)
        return np.where(inside, away, -away)

    def shifted(self, by: tuple[float, float]) -> Self:
        """The hole shifted by (x, y) m."""
        return self.model_copy(update={"points": tuple(shifted_place(point, by) for point in self.points)})

    @property
    def box(self) -> Box:
        """The upright rectangle around it: x0, y0, x1, y1 in m."""
        x, y = zip(*self.points, strict=True)
        return min(x), min(y), max(x), max(y)

    @property
    def outline(self) -> PolygonOutline | None:
        """Edges of the polygon; None if they cross or touch, as the ground is then not always on the same side."""
        outline = PolygonOutline(np.array(self.points))
        return None if outline.crosses_itself else outline
