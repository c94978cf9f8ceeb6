"""A free side: no forces act on it. A side without a table is free."""

from typing import ClassVar, Literal

from dembound.boundaries.boundary import Boundary


class Free(Boundary):
    """No support; a wave is reflected, and doubles the motion of the side."""

    for_bars: ClassVar[bool] = True
    for_static: ClassVar[bool] = True
    is_free: ClassVar[bool] = True

    type: Literal["free"] = "free"
