"""Mistakes of a wave at an angle that depend on other tables."""

from collections.abc import Iterator, Mapping
from typing import Any

from dembound.boundaries import SIDES, Free
from dembound.casefile.disks.incident import IncidentWave


def incident_problems(incident: IncidentWave, tables: Mapping[str, Any]) -> Iterator[str]:
    """Check the wave against the sides; an invalid side is None."""
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
