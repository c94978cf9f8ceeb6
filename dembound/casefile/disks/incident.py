"""The ``[incident]`` table."""

from typing import Literal

from dembound.table import Table, quantity


class IncidentWave(Table):
    """A plane wave that comes through the ground at an angle, where this goes on as a continuum on all sides below.

    It has the velocity of its wave at a point, there without what the free surface sends back: along the direction in
    which it runs (P), or to the right of it as one looks along (SV), which is +x where it runs straight up.
    """

    type: Literal["sv", "p"] = quantity(..., unit="1", help="kind of wave")
    angle: float = quantity(
        ...,
        unit="degrees",
        means="direction",
        help="from the vertical, of the direction in which it runs; positive to the right",
        gt=-90.0,
        lt=90.0,
    )
    wave: str = quantity(..., unit="1", help="name of the wave whose velocity it has")
    point: tuple[float, float] | None = quantity(
        None,
        unit="m",
        means="place",
        help="where it has this velocity; absent: the lower corner of the ground on the side it comes from",
    )
