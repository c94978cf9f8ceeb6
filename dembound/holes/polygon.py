"""A hole of any shape with straight edges."""

from typing import Literal, Self

import numpy as np
from pydantic import field_validator

from dembound.holes.hole import Hole
from dembound.holes.outline import PolygonOutline
from dembound.table import Box, quantity, shifted_place

Points = tuple[tuple[float, float], ...]


class Polygon(Hole):
    """A section drawn point by point, as the valley above a slope."""

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
