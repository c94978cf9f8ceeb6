"""A free side: no forces act on it. A side without a table is free."""

from typing import ClassVar, Literal

from dembound.boundaries.boundary import Boundary
from dembound.table import quantity


class Free(Boundary):
    """No forces act on the side; a reflected wave doubles its motion."""

    for_bars: ClassVar[bool] = True
    for_static: ClassVar[bool] = True
    is_free: ClassVar[bool] = True

    type: Literal["free"] = "free"

    artificial: bool = quantity(False)
    """ground or rock goes on beyond the side"""

    @property
    def is_artificial(self) -> bool:
        """The value of the key ``artificial``."""
        return self.artificial
