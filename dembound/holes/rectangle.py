"""A rectangular hole."""

import math
from typing import Literal, Self

import numpy as np
from pydantic import field_validator

from dembound.holes.hole import Apart, Hole
from dembound.holes.outline import PolygonOutline
from dembound.table import Box, quantity, shifted_box

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
