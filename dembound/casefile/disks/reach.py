"""Where monitors and loads of a case of disks may be."""

from collections.abc import Mapping

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.sides import SIDES
from dembound.casefile.disks.ground import Ground
from dembound.packings import Packing
from dembound.packings.base import TYPED
from dembound.table import Box


def reach(ground: Ground, packing: Packing, boundary: Mapping[str, Boundary | None]) -> Box:
    """The ground, and all that lies beyond the disks' sides with a continuum; an invalid side has no limit.

    Above disks that lie deep in the ground the continuum ends at its surface.
    """
    width, height = ground.size or packing.extent
    ends = {"left": 0.0, "bottom": 0.0, "right": width, "top": height}
    for side in SIDES:
        table = boundary.get(side)
        below_surface = side == "top" and packing.box[3] < (1.0 - TYPED) * height
        if side in boundary and (table is None or table.is_outside) and not below_surface:
            ends[side] = float("-inf") if side in ("left", "bottom") else float("inf")
    return ends["left"], ends["bottom"], ends["right"], ends["top"]


def is_in(box: Box, place: tuple[float, float]) -> bool:
    """Whether a place (m) is in a box or on its rim."""
    left, bottom, right, top = box
    return left <= place[0] <= right and bottom <= place[1] <= top
