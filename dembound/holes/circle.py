"""A circular hole."""

from typing import Literal, Self

import numpy as np

from dembound.holes.hole import Hole
from dembound.holes.outline import EllipseOutline
from dembound.table import Box, quantity, shifted_place


class Circle(Hole):
    """A tunnel or a borehole."""

    type: Literal["circle"]
    centre: tuple[float, float] = quantity(..., unit="m", means="place", help="centre [x, y]")
    radius: float = quantity(..., unit="m", means="length", help="radius", gt=0.0)

    def depth(self, positions: np.ndarray) -> np.ndarray:
        """Distances (k,) m of positions (k, 2) m from the circle, negative outside."""
        return self.radius - np.hypot(*(positions - self.centre).T)

    def shifted(self, by: tuple[float, float]) -> Self:
        """The hole shifted by (x, y) m."""
        return self.model_copy(update={"centre": shifted_place(self.centre, by)})

    @property
    def box(self) -> Box:
        """The square around it: x0, y0, x1, y1 in m."""
        (x, y), r = self.centre, self.radius
        return x - r, y - r, x + r, y + r

    @property
    def outline(self) -> EllipseOutline:
        """The circle."""
        return EllipseOutline(self.centre, (self.radius, self.radius))
