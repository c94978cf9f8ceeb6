"""A periodic side, connected to the opposite one."""

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.edge import OPPOSITE, normal_axis


class Periodic(Boundary):
    """The side is connected to the opposite one, which must be periodic, too."""

    is_periodic: ClassVar[bool] = True

    type: Literal["periodic"]

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """An opposite side of another type, and a column without a bottom or top side."""
        sides, opposite = tables["boundary"], OPPOSITE[side]
        missing = opposite not in sides
        if missing or (sides[opposite] and not sides[opposite].is_periodic):
            yield f'boundary.{side}.type: is "{self.type}", so boundary.{opposite} must be periodic too'
        beside = [name for name, table in sides.items() if table and table.needs_column]
        if beside and normal_axis(side) == 1:
            other = f"boundary.{beside[0]}"
            yield f'boundary.{side}.type: is "{self.type}", but the column of {other} needs two ends'
