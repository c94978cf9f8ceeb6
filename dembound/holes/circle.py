"""A circular hole."""

from typing import Literal

import numpy as np

from dembound.holes.hole import Box, Hole
from dembound.table import quantity


class Circle(Hole):
    """A tunnel or a borehole."""

    type: Literal["circle"]
    centre: tuple[float, float] = quantity(..., unit="m", help="where its centre is")
    radius: float = quantity(..., unit="m", help="its radius", gt=0.0)

    def contains(self, positions: np.ndarray) -> np.ndarray:
        """Which positions (k, 2) m lie in it, (k,) bool; those on its rim do not."""
        return np.hypot(*(positions - self.centre).T) < self.radius

    @property
    def box(self) -> Box:
        """The square around it: x0, y0, x1, y1 in m."""
        (x, y), r = self.centre, self.radius
        return x - r, y - r, x + r, y + r
