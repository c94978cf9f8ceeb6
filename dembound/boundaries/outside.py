"""A side beyond which the ground is a continuum, tied to the bonds that it cuts (disks/surroundings/continuum.py)."""

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

from dembound.boundaries.boundary import Boundary, Drivable
from dembound.boundaries.edge import OPPOSITE, SIDES
from dembound.boundaries.free import Free
from dembound.boundaries.platen import Keeping


class Outside(Keeping, Drivable):
    """Continues as an elastic continuum that absorbs, see `[outside]`; waves may enter through a bottom of this type.

    Notes
    -----
    Through the bottom of a body that is periodic sideways plane waves may enter from below
    (disks/surroundings/incident.py).
    """

    is_outside: ClassVar[bool] = True

    type: Literal["outside"]

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """Mistakes: neighbouring sides that do not go with a continuum, and waves that cannot enter through it.

        The continuum's own edges next to those of the body are free, periodic, mirror planes, or go on, so the sides of
        the body there must be of the same type.
        """
        yield from super().problems(side, tables)
        boundary = tables["boundary"]
        for other, table in boundary.items():
            if _first_beside(other, boundary) == side and not _goes_on(other, tables):
                yield _not_beside(other, table, self.type, side)
            if table and table.is_mirror and _has_column(tables):
                yield f'boundary.{other}.type: is "{table.type}", which takes [static] and loads on all disks out'
        across = {each: boundary.get(each, Free()) for each in ("left", "right")}
        wrong = any(_first_beside(other, boundary) for other in across)
        sideways = all(table and (table.is_periodic or table.is_outside) for table in across.values())
        if self.waves and side != "bottom":
            yield f'boundary.{side}.type: is "{self.type}", through which waves enter at the bottom only'
        elif self.waves and not (sideways or wrong):
            must = f'boundary.left and right are both "{self.type}" or periodic'
            yield f"boundary.{side}.type: waves enter through it only where {must}"
        top = boundary.get("top")
        if self.waves and top and top.is_outside and not _goes_on("top", tables):
            yield (
                f'boundary.top.type: is "{top.type}" at the surface of the ground, from which waves of boundary.{side} '
                "would come back as from a free one; leave it out, or let them enter by [incident], which then has no "
                "surface"
            )
        for other, table in across.items():
            if table and table.is_free and side in ("bottom", "top") and _has_column(tables):
                yield (
                    f'boundary.{other}.type: is "{table.type}", but [static] and loads on all disks also act on the '
                    f'ground beyond boundary.{side}, which has no end there; must be "{self.type}" or periodic'
                )
        motion = tables.get("motion")
        for held in motion.held if motion else ():
            yield f'boundary.{side}.type: "{self.type}" moves freely, but motion.held holds {held}'


def _first_beside(side: str, boundary: Mapping[str, Any]) -> str | None:
    """The first side with a continuum that this side cannot be beside; None if there is none.

    A free field is the ground beyond all sides and has no continuum beside it.
    """
    table = boundary.get(side)
    if table is None or table.is_free or table.is_periodic or table.is_mirror or table.is_outside:
        return None
    beside = SIDES if table.needs_column else [each for each in SIDES if each not in (side, OPPOSITE[side])]
    return next((each for each in beside if (other := boundary.get(each)) and other.is_outside), None)


def _not_beside(side: str, table: Boundary, outside: str, other: str) -> str:
    """Message about a side that cannot be beside another side of the type `outside`."""
    if table.needs_column:
        return (
            f'boundary.{side}.type: is "{table.type}", which cannot be in a case with boundary.{other} = "{outside}"; '
            f'make it "{outside}", too, which has a column of its own where waves enter'
        )
    must = f'beside boundary.{other} it must be "free", "periodic", "symmetry" or "{outside}"'
    return f'boundary.{side}.type: is "{table.type}"; {must}'


def _goes_on(side: str, tables: Mapping[str, Any]) -> bool:
    """Whether the ground goes on beyond a side of its box of disks; the box has its own error message for this."""
    ground, packing = tables.get("ground"), tables.get("packing")
    if not (ground and ground.size and packing):
        return False
    return side in packing.gaps(ground.box(packing))


def _has_column(tables: Mapping[str, Any]) -> bool:
    """Whether the ground beyond a continuum is loaded at rest: by a static stage or a load on all of it."""
    loads = [load for load in tables["load"] if load]
    return bool(tables.get("static")) or any(load.is_everywhere for load in loads)
