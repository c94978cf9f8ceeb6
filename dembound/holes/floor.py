"""The level floor that holes leave beside a side of the ground, as in a cut or in front of a slope."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dembound.holes.hole import Hole
from dembound.roots import root
from dembound.table import Box

FINE = 8
"""Places per diameter at which points are tested for being in a hole."""


class Floor(NamedTuple):
    """A floor beside the left or right side of a rectangle, with no ground above.

    height : y, m. width : m, length from the side inwards over which it is level within half a diameter.
    """

    height: float
    width: float


def floor_beside(holes: Sequence[Hole], box: Box, side: str, diameter: float) -> Floor | None:
    """The floor beside the left or right side of a box (left, bottom, right, top; m); None if no hole lowers it there.

    diameter : mean diameter of the disks, m. The height is that of the outline itself. Holes that leave less than half
    a diameter of ground at the top or at the side count as reaching it.
    """
    if not holes:
        return None
    left, bottom, right, top = box
    edge, inwards = (left, 1.0) if side == "left" else (right, -1.0)

    def is_open(x: np.ndarray | float, y: np.ndarray | float) -> np.ndarray:
        places = np.stack(np.broadcast_arrays(np.atleast_1d(x), np.atleast_1d(y)), axis=1)
        return np.any([hole.takes(places, span=0.0) for hole in holes], axis=0)

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
