"""A side beyond which the ground goes on as a continuum, tied to the bonds that it cuts (disks/surroundings.py)."""

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.sides import OPPOSITE


class Outside(Boundary):
    """A continuum of the packing's moduli, whose far part absorbs; its keys are those of the table ``[outside]``."""

    is_outside: ClassVar[bool] = True

    type: Literal["outside"]

    @property
    def is_artificial(self) -> bool:
        """Always, as the ground goes on beyond it."""
        return True

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """What a continuum cannot be beside.

        Its own edges next to those of the body are free or go on, so the sides of the body there must do the same.
        """
        yield from super().problems(side, tables)
        boundary = tables["boundary"]
        for other, table in boundary.items():
            beside = other not in (side, OPPOSITE[side]) and table and not (table.is_free or table.is_outside)
            if beside or (table and table.needs_column):
                must = f'beside boundary.{side} it must be "free" or "{self.type}"'
                yield f'boundary.{other}.type: is "{table.type}"; {must}'
        for place, load in enumerate(tables["load"], 1):
            if load and load.acceleration is not None:
                yield f"load[{place}].acceleration: acts on the particles alone, not beyond boundary.{side}"
        if tables.get("static"):
            yield f'boundary.{side}.type: "{self.type}" does not carry a settled stress; leave [static] out'
        motion = tables.get("motion")
        for held in motion.held if motion else ():
            yield f'boundary.{side}.type: "{self.type}" moves freely, but motion.held holds {held}'
