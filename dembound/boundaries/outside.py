"""A side beyond which the ground goes on as a continuum, tied to the bonds that it cuts (disks/surroundings.py)."""

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

from dembound.boundaries.driven import Drivable
from dembound.boundaries.free import Free
from dembound.boundaries.sides import OPPOSITE


class Outside(Drivable):
    """A continuum of the packing's moduli, whose far part absorbs; its settings are those of the table ``[outside]``.

    Through the bottom of a body that is periodic sideways plane waves may enter from below (disks/incident.py).
    """

    is_outside: ClassVar[bool] = True

    type: Literal["outside"]

    @property
    def is_artificial(self) -> bool:
        """Always, as the ground goes on beyond it."""
        return True

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """What a continuum cannot be beside, and waves that cannot enter through it.

        Its own edges next to those of the body are free, periodic, mirror planes, or go on, so the sides of the body
        there must do the same.
        """
        yield from super().problems(side, tables)
        boundary = tables["boundary"]
        for other, table in boundary.items():
            allowed = table is None or table.is_free or table.is_periodic or table.is_mirror or table.is_outside
            if (other not in (side, OPPOSITE[side]) and not allowed) or (table and table.needs_column):
                must = f'beside boundary.{side} it must be "free", "periodic", "symmetry" or "{self.type}"'
                yield f'boundary.{other}.type: is "{table.type}"; {must}'
            if table and table.is_mirror and _has_column(tables):
                yield f'boundary.{other}.type: is "{table.type}", which takes [static] and loads on all disks out'
        across = {each: boundary.get(each, Free()) for each in ("left", "right")}
        sideways = all(table and (table.is_periodic or table.is_outside) for table in across.values())
        if self.waves and side != "bottom":
            yield f'boundary.{side}.type: is "{self.type}", through which waves enter at the bottom only'
        elif self.waves and not sideways:
            must = f'boundary.left and right are both "{self.type}" or periodic'
            yield f"boundary.{side}.type: waves enter through it only where {must}"
        for other, table in across.items():
            if table and table.is_free and side in ("bottom", "top") and _has_column(tables):
                yield (
                    f'boundary.{other}.type: is "{table.type}", but [static] and loads on all disks also act on the '
                    f'ground beyond boundary.{side}, which has no end there; must be "{self.type}" or periodic'
                )
        motion = tables.get("motion")
        for held in motion.held if motion else ():
            yield f'boundary.{side}.type: "{self.type}" moves freely, but motion.held holds {held}'


def _has_column(tables: Mapping[str, Any]) -> bool:
    """Whether the ground beyond a continuum rests under forces of its own: by a static stage or a load on all of it."""
    loads = [load for load in tables["load"] if load]
    return bool(tables.get("static")) or any(load.is_everywhere for load in loads)
