"""The ``[ground]`` table, where in the ground monitors and loads may be, and mistakes of a box of disks in it."""

from collections.abc import Iterator, Mapping

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.sides import SIDES, is_far, plane_of
from dembound.casefile.messages import corners
from dembound.packings import Packing
from dembound.packings.base import TYPED, Extent
from dembound.table import Box, Table, quantity


class Ground(Table):
    """The ground, of which the disks fill a box; outside it is a continuum up to its free surface at the top."""

    size: Extent | None = quantity(
        None,
        unit="m",
        means="length",
        help="width and height, whole bricks high; absent: the disks fill all of the ground",
    )
    origin: tuple[float, float] = quantity((0.0, 0.0), unit="m", means="place", help="lower left corner of the ground")

    def box(self, packing: Packing) -> Box:
        """Left, bottom, right and top (m) of the ground; without a size, of the disks, which then fill it."""
        if self.size is None:
            return packing.box
        (left, bottom), (width, height) = self.origin, self.size
        return left, bottom, left + width, bottom + height


def ground_problems(ground: Ground, packing: Packing, boundaries: Mapping[str, Boundary | None]) -> Iterator[str]:
    """Check the box of disks against the ground; an invalid side is None."""
    if ground.size is None:
        if ground.origin != (0.0, 0.0):
            yield "ground.origin: [ground] has no size, so that the disks fill it; give ground.size, or packing.origin"
        return
    box = ground.box(packing)
    near = TYPED * max(ground.size)
    (lowest, lower), (left, bottom), right, top = box[:2], packing.box[:2], packing.box[2], packing.box[3]
    if left < lowest - near or bottom < lower - near or right > box[2] + near or top > box[3] + near:
        yield (f"packing.origin: the box of disks is {corners(*packing.box)}, must lie in the ground, {corners(*box)}")
        return
    brick = packing.brick_size[1]
    for key, value, begins in (("packing.origin", bottom, lower), ("ground.size", ground.size[1], 0.0)):
        rows = (value - begins) / brick
        if abs(rows - round(rows)) > TYPED * max(1.0, rows):
            above = f" above ground.origin at {lower:.10g} m" if begins else ""
            yield (
                f"{key}: its height, {value - begins:.10g} m{above}, is not a whole number of bricks of {brick:.10g} m;"
                f" {begins + int(rows) * brick:.10g} or {begins + (int(rows) + 1) * brick:.10g} would be"
            )
    highest = boundaries.get("top")
    if highest is not None and highest.is_outside and abs(box[3] - top) <= near:
        yield 'boundary.top.type: is "outside", but the disks reach the surface of the ground; it must be "free"'
    for side, gap in packing.gaps(box).items():
        table = boundaries.get(side)
        if not (side in boundaries and (table is None or table.is_outside)):
            yield f'boundary.{side}.type: the ground goes on {gap:g} m beyond this side, so it must be "outside"'


def reach(ground: Ground, packing: Packing, boundary: Mapping[str, Boundary | None]) -> Box:
    """The box (m) of the ground, without a limit beyond sides with a continuum and beyond invalid sides.

    Above disks that lie deep in the ground the continuum ends at its surface.
    """
    box = ground.box(packing)
    ends, below_surface = {side: plane_of(side, box) for side in SIDES}, "top" in packing.gaps(box)
    for side in SIDES:
        table = boundary.get(side)
        if side in boundary and (table is None or table.is_outside) and not (side == "top" and below_surface):
            ends[side] = float("inf") if is_far(side) else float("-inf")
    return ends["left"], ends["bottom"], ends["right"], ends["top"]
