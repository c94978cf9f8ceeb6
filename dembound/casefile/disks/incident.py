"""The ``[incident]`` table, and its mistakes that depend on other tables."""

from collections.abc import Iterator, Mapping
from typing import Any, Literal

from dembound.boundaries import SIDES, Free
from dembound.casefile.disks.damping import is_damped, qualities
from dembound.table import Table, quantity


class IncidentWave(Table):
    """A plane wave that enters the disks at an angle, with its reflections at the free surface and at joints of layers.

    For sides of type "outside". At a point the incident wave, without reflections, has the velocity of its wave: along
    its direction (P), or to the right of its direction (SV), which is +x where it runs straight up.
    """

    type: Literal["sv", "p"] = quantity(..., unit="1", help="kind of wave: SV or P")
    angle: float = quantity(
        ...,
        unit="degrees",
        means="direction",
        help="from the vertical, of the direction in which it runs, in the lowest layer; positive to the right",
        gt=-90.0,
        lt=90.0,
    )
    wave: str = quantity(..., unit="1", help="name of the wave whose velocity it has")
    point: tuple[float, float] | None = quantity(
        None,
        unit="m",
        means="place",
        help="where the incident wave has this velocity; absent: the lower corner of the ground it reaches first",
    )


def incident_problems(incident: IncidentWave, tables: Mapping[str, Any]) -> Iterator[str]:
    """Check the wave against the sides; an invalid side is None."""
    if incident.angle != 0.0 and is_damped(tables):
        yield (
            f"incident.angle: is {incident.angle:g}, must be 0 in damped ground (quality_factor), where waves at an "
            "angle are not known"
        )
    if len(qualities(tables)) > 1:
        yield (
            "incident: needs one quality_factor in all layers, as forces that enter beside a joint would not balance; "
            "let the wave enter at boundary.bottom"
        )
    for side in SIDES:
        table = tables["boundary"].get(side, Free())
        if table is None or table.is_outside or (side == "top" and table.is_free):
            continue
        allowed = '"outside"' if side != "top" else '"outside" or "free"'
        yield (
            f'boundary.{side}.type: is "{table.type}", but the wave of [incident] comes through the ground beyond all '
            f"sides; must be {allowed}"
        )
    for side, table in tables["boundary"].items():
        for motion in table.waves if table else ():
            yield f"boundary.{side}.wave_{motion}: is not allowed together with [incident]; give one of them"
