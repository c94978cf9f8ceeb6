"""Mistakes about the motion that the histories of waves are of: incident, of an outcrop, or within the ground."""

from collections.abc import Iterator, Mapping
from typing import Any

from dembound.boundaries import Free
from dembound.boundaries.boundary import Boundary
from dembound.boundaries.sides import normal_axis
from dembound.casefile.cross_checks import driving_waves
from dembound.casefile.messages import numbered


def motion_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """Kinds of motion where they have no meaning, one line each; invalid tables are None."""
    waves: dict[str, Any] = {name: wave for name, wave in tables["wave"].items() if wave and wave.motion is not None}
    for name, wave in waves.items():
        if wave.motion == "outcrop" and not wave.halves:
            why = f'which type "{wave.type}" does not know; give half of it as incident'
            yield f'wave.{name}.motion: is "outcrop", {why}'
    for place, load in numbered("load", tables["load"]):
        if load.wave in waves:
            yield f"wave.{load.wave}.motion: is for waves of sides, but this one is the factor of {place}; leave it out"
    incident = tables["incident"]
    if incident and incident.wave in waves and waves[incident.wave].motion == "within":
        why = 'but [incident] takes the wave below; give "incident" or "outcrop"'
        yield f'wave.{incident.wave}.motion: is "within", {why}'
    driving = [name for _, name in driving_waves(tables["boundary"])]
    for side, table in tables["boundary"].items():
        for name in dict.fromkeys(table.waves.values() if table else ()):
            if name not in waves:
                continue
            motion, held = waves[name].motion, {0, 1} & {*table.prescribed(normal_axis(side))}
            if held and motion != "within":
                yield (
                    f'wave.{name}.motion: is "{motion}", but boundary.{side} prescribes the motion within the ground; '
                    'give "within", or type = "viscous_input" there'
                )
            elif motion == "within" and not held:
                reasons = [*not_level(side, table, tables)]
                reasons += ["every wave_p and wave_s to name a wave of its own"] if driving.count(name) > 1 else []
                yield from (f'wave.{name}.motion: is "within", which needs {reason}' for reason in reasons)


def not_level(side: str, table: Boundary, tables: Mapping[str, Any]) -> Iterator[str]:
    """What is missing for level ground between a side and a free surface, whose motion gives the incident wave."""
    sides = tables["boundary"]
    if side != "bottom":
        yield f"its side to be the bottom, not {side}"
    elif not (top := sides.get("top") or Free()).is_outside and (not top.is_free or top.is_artificial):
        yield "a free surface at the top"  # of the ground, where disks end below it
    if table.dashpots_alone() != table:
        yield f"boundary.{side} without springs"
    if tables["hole"]:
        yield "ground without holes"
    held = tables["motion"] and tables["motion"].held
    lateral = {name: sides.get(name) for name in ("left", "right")}
    taking = [name for name, each in lateral.items() if each and each.factors and not each.needs_column and not held]
    if taking:
        names = " and ".join(f"boundary.{name}" for name in taking)
        yield f"level ground: {names} take from the wave; give periodic, free_field or outside"
