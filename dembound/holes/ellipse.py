"""An elliptic hole."""

from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field

from dembound.holes.hole import Hole
from dembound.holes.outline import EllipseOutline
from dembound.table import Box, quantity, shifted_place

Length = Annotated[float, Field(gt=0.0)]


class Ellipse(Hole):
    """A cavern, or a crack where one axis is short."""

    type: Literal["ellipse"]
    centre: tuple[float, float] = quantity(..., unit="m", means="place", help="centre [x, y]")
    semi_axes: tuple[Length, Length] = quantity(
        ..., unit="m", means="length", help="[a, b], half its length and half its width"
    )
    angle: float = quantity(
        0.0, unit="degrees", means="direction", help="from the x axis to the semi-axis a, counter-clockwise"
    )

    @property
    def _direction(self) -> tuple[float, float]:
        """Cosine and sine of the angle."""
        return float(np.cos(np.radians(self.angle))), float(np.sin(np.radians(self.angle)))

    def contains(self, positions: np.ndarray) -> np.ndarray:
        """Mask (k,) of positions (k, 2) m that lie in the ellipse; its rim does not count."""
        c, s = self._direction
        along_axes = (positions - self.centre) @ np.array([[c, -s], [s, c]])
        return np.hypot(*(along_axes / self.semi_axes).T) < 1.0

    def shifted(self, by: tuple[float, float]) -> Self:
        """The hole shifted by (x, y) m."""
        return self.model_copy(update={"centre": shifted_place(self.centre, by)})

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
