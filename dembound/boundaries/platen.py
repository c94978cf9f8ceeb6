"""Sides that hold particles, all or those within a range, as walls and jaws do, and zones in which no bond breaks.

In such a zone beside a side forces at rest always have ground to act on.
"""

from collections.abc import Iterator, Mapping
from typing import Any, Literal, Self

from pydantic import field_validator

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.edge import Edge, axis_of_motion, normal_axis
from dembound.places import is_in_range
from dembound.table import Box, quantity

INTACT = 2
"""Disks from a side, counted by bonds, whose bonds do not break by default."""

MOST_INTACT = 1000
"""Largest number of such disks: more than half of any body that can be computed."""


class Keeping(Boundary):
    """A side with a zone in which bonds do not break."""

    intact: int | None = quantity(
        None,
        means="count",
        help="disks from the side, counted by bonds, whose bonds do not break; absent: "
        f"{INTACT} where forces of the static stage act on a side that stands for ground beyond, else 0",
        ge=0,
        le=MOST_INTACT,
    )

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """A zone of a bar."""
        yield from super().problems(side, tables)
        if "bar" in tables and self.intact is not None:
            yield f"boundary.{side}.intact: is for sides of disks"


class Holding(Keeping):
    """A side that prescribes motion, of all its particles or, as a platen or jaw, of those `within` a range."""

    within: tuple[float, float] | None = quantity(None, unit="m", means="place")
    """range [x0, x1] or [y0, y1] of the side in which it holds particles; absent: all"""

    reactions: Literal["kept", "none"] = quantity("kept")
    """of a static side: "kept", constant forces in the run; "none", the support is taken away"""

    until: float | None = quantity(None, unit="s", ge=0.0)
    """of a static side: time of the run at which kept reactions end; absent: never"""

    @field_validator("within")
    @classmethod
    def _ascends(cls, within: tuple[float, float] | None) -> tuple[float, float] | None:
        if within is not None and not within[0] < within[1]:
            raise ValueError("must have its lower end first, below the other one")
        return within

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """A range of an end of a bar, or one beside the disks, and reactions, which are of the static stage."""
        yield from super().problems(side, tables)
        for key in ("reactions", "until"):
            if key in self.model_fields_set:
                yield f"boundary.{side}.{key}: is of the static stage; give it to static.boundary.{side}"
        yield from beside_disks(f"boundary.{side}", side, self, tables)

    def mistakes(self) -> Iterator[str]:
        """An end of reactions that there are not."""
        yield from super().mistakes()
        if self.until is not None and self.reactions == "none":
            yield 'until: is of reactions that are "kept"'

    def on_whole_side(self) -> Self:
        """The side with all its particles held."""
        return self if self.within is None else self.model_copy(update={"within": None})

    def part_of(self, edge: Edge) -> Edge:
        """The particles of an edge that are held."""
        if self.within is None:
            return edge
        along = edge.positions[:, 1 - edge.axis]
        low, high = self.within
        return edge.only(is_in_range((low, high), along, edge.length), high - low)


class Wall(Holding):
    """A side that holds its particles at rest, beyond which ground or rock goes on or not."""

    artificial: bool = quantity(True)
    """ground or rock goes on beyond the side"""

    @property
    def is_artificial(self) -> bool:
        """The value of the key ``artificial``."""
        return self.artificial


def beside_disks(place: str, side: str, table: Boundary | None, tables: Mapping[str, Any]) -> Iterator[str]:
    """Mistakes of the range `within` of the table at a place of the case."""
    if not isinstance(table, Holding) or table.within is None:
        return
    low, high = table.within
    if "bar" in tables:
        yield f"{place}.within: is for sides of disks; an end of a bar is one node"
    elif packing := tables.get("packing"):
        box: Box = packing.box
        first, last = box[1 - normal_axis(side)], box[3 - normal_axis(side)]
        if high <= first or low >= last:
            yield f"{place}.within: is beside the disks, which are from {first:g} to {last:g} m there"
        for other, beyond in tables["boundary"].items():
            if beyond and normal_axis(other) != normal_axis(side) and (beyond.needs_column or beyond.is_outside):
                yield (
                    f'{place}.within: is of a sample, but boundary.{other} is "{beyond.type}", where the ground '
                    "and this side go on; leave it out"
                )


def driven_components(boundary: Mapping[str, Boundary | None]) -> Iterator[tuple[str, int]]:
    """Sides whose motion a wave prescribes, and the axis of this motion."""
    for side, table in boundary.items():
        for motion in table.waves if table else ():
            if table and (axis := axis_of_motion(side, motion)) in table.prescribed(normal_axis(side)):
                yield side, axis
