"""Sides beside which bonds may be kept from breaking, so that forces at rest always have ground to act on."""

from collections.abc import Iterator, Mapping
from typing import Any

from dembound.boundaries.boundary import Boundary
from dembound.table import quantity

INTACT = 2
"""Disks from a side, counted by bonds, whose bonds do not break by default."""

MOST_INTACT = 1000
"""Largest number of such disks: more than half of any body that can be computed."""


class Keeping(Boundary):
    """A side with a zone in which bonds do not break."""

    intact: int | None = quantity(
        None,
        unit="1",
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
