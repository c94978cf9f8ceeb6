"""An elliptic hole."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from dembound.holes.hole import Centred
from dembound.holes.outline import EllipseOutline
from dembound.table import Box, quantity

Length = Annotated[float, Field(gt=0.0)]


class Ellipse(Centred):
    """A cavern, or a crack where one axis is short."""

    type: Literal["ellipse"]
    semi_axes: tuple[Length, Length] = quantity(unit="m", means="length")
    """[a, b], half its length and width"""
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
