"""Ground whose surface beyond a side is lower than the top of the disks: holes leave a level floor at that side."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from dembound.boundaries import Free
from dembound.casefile.disks.ground import Ground
from dembound.casefile.messages import numbered
from dembound.holes import Hole
from dembound.holes.floor import Floor, floor_beside
from dembound.packings import Packing

SIDEWAYS = ("left", "right")
"""The sides at which there may be a floor."""


def floors(holes: Sequence[Hole], packing: Packing, ground: Ground, boundary: Mapping[str, Any]) -> dict[str, Floor]:
    """The floors at the sides of the disks, if these reach the free surface of the ground; see `floor_beside`."""
    top = boundary.get("top", Free())
    if not (top and top.is_free) or "top" in packing.gaps(ground.box(packing)):
        return {}
    found = {side: floor_beside(holes, packing.box, side, 2.0 * packing.radius) for side in SIDEWAYS}
    return {side: floor for side, floor in found.items() if floor is not None}


def lowered(found: Mapping[str, Floor], boundary: Mapping[str, Any]) -> dict[str, Floor]:
    """Floors at sides beyond which a continuum has the same height; an invalid side is None."""
    return {side: floor for side, floor in found.items() if (table := boundary.get(side)) and table.is_outside}


def lowered_in(tables: Mapping[str, Any]) -> dict[str, Floor]:
    """Lowered floors from the tables of a case; tables and entries that are invalid on their own are None."""
    packing, ground, boundary = (tables[key] for key in ("packing", "ground", "boundary"))
    holes = [hole for hole in tables["hole"] if hole]
    return lowered(floors(holes, packing, ground, boundary), boundary) if packing and ground else {}


def lowered_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """Tables that need a half-space as the ground, where the ground beyond a side is lower."""
    lower = lowered_in(tables)
    if not lower:
        return
    where = " and ".join(f"at y = {floor.height:.4g} m beyond the {side} side" for side, floor in lower.items())
    no_half_space = (
        f"as the ground is no half-space, with its surface {where}; end the holes inside the disks, with the surface "
        "at its height at both sides"
    )
    if tables["incident"]:
        yield f"incident: what the surface sends back of the wave is not known, {no_half_space}"
    for side, table in tables["boundary"].items():
        for motion in table.waves if table and table.is_outside else ():
            yield f"boundary.{side}.wave_{motion}: the motion far from the disks is not known, {no_half_space}"
    for place, load in numbered("load", tables["load"]):
        if load.is_everywhere and (load.wave is not None or not tables["static"]):
            yield f"{place}: acts on all disks, which needs a [static] stage and no wave, {no_half_space}"
    if static := tables["static"]:
        for side in SIDEWAYS:
            table, own = tables["boundary"].get(side), static.boundary.get(side)
            if table and table.is_outside and not (own and 0 in own.prescribed(0)):
                yield f'static.boundary.{side}: must be "roller" or "fixed", as the ground beyond is no half-space'
