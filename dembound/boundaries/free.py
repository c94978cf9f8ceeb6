"""A free side: nothing pushes. It is also what a side without a table is."""

from typing import ClassVar, Literal

from dembound.boundaries.boundary import Boundary


class Free(Boundary):
    """No support; an arriving wave is reflected with the motion doubled."""

    for_bars: ClassVar[bool] = True
    for_static: ClassVar[bool] = True
    is_free: ClassVar[bool] = True

    type: Literal["free"] = "free"
