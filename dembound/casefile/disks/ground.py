"""The ``[ground]`` table."""

from dembound.packings.base import Extent
from dembound.table import Table, quantity


class Ground(Table):
    """The ground, of which the disks fill a box; what is outside the box is a continuum.

    Its free surface is at the top. Without a size the disks fill all of it.
    """

    size: Extent | None = quantity(
        None, unit="m", means="length", help="width and height of the ground; its surface is at this height"
    )
