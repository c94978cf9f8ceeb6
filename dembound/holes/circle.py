"""A circular hole."""

from typing import Literal

import numpy as np

from dembound.holes.hole import Centred
from dembound.holes.outline import EllipseOutline
from dembound.table import Box, quantity


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
