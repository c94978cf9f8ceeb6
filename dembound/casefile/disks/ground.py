"""The ``[ground]`` table, where in the ground monitors and loads may be, and mistakes of a box of disks in it."""

from collections.abc import Iterator, Mapping

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.sides import SIDES
from dembound.casefile.messages import corners
from dembound.packings import Packing
from dembound.packings.base import TYPED, Extent
from dembound.table import Box, Table, quantity


class Ground(Table):
    """The ground, of which the disks fill a box; what is outside the box is a continuum.

    Its free surface is at the top. Without a size the disks fill all of it.
    """

    size: Extent | None = quantity(
        None, unit="m", means="length", help="width and height of the ground; its surface is at this height"
    )


def ground_problems(ground: Ground, packing: Packing, boundaries: Mapping[str, Boundary | None]) -> Iterator[str]:
    """Check a box of disks against the ground that it is a part of; an invalid side is None."""
    if ground.size is None:
        if packing.origin != (0.0, 0.0):
            yield "packing.origin: places the disks in the ground, but [ground] has no size; give it"
        return
    width, height = ground.size
    left, bottom, right, top = packing.box
    near = TYPED * max(width, height)
    if left < -near or bottom < -near or right > width + near or top > height + near:
        ground_is = corners(0.0, 0.0, width, height)
        yield f"packing.origin: the box of disks is {corners(*packing.box)}, must lie in the ground, {ground_is}"
        return
    brick = packing.brick_size[1]
    for key, value in (("packing.origin", bottom), ("ground.size", height)):
        rows = value / brick
        if abs(rows - round(rows)) > TYPED * max(1.0, rows):
            yield (
                f"{key}: its height, {value:.10g} m, is not a whole number of bricks of {brick:.10g} m; "
                f"{int(rows) * brick:.10g} or {(int(rows) + 1) * brick:.10g} would be"
            )
    highest = boundaries.get("top")
    if highest is not None and highest.is_outside and abs(height - top) <= near:
        yield 'boundary.top.type: is "outside", but the disks reach the surface of the ground; it must be "free"'
    for side, gap in packing.gaps(ground.size).items():
        table = boundaries.get(side)
        if not (side in boundaries and (table is None or table.is_outside)):
            yield f'boundary.{side}.type: the ground goes on {gap:g} m beyond this side, so it must be "outside"'


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
