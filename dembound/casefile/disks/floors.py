"""Ground that stands lower beyond a side than the top of the disks, where holes leave a level floor at that side."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from dembound.boundaries import Free
from dembound.casefile.disks.ground import Ground
from dembound.casefile.messages import numbered
from dembound.holes import Hole
from dembound.holes.floor import Floor, floor_beside
from dembound.packings import Packing
from dembound.packings.base import TYPED

SIDEWAYS = ("left", "right")
"""The sides at which there may be a floor."""


def floors(holes: Sequence[Hole], packing: Packing, ground: Ground, boundary: Mapping[str, Any]) -> dict[str, Floor]:
    """The floors at the sides of the disks, if these reach the free surface of the ground; see `floor_beside`."""
    top = boundary.get("top", Free())
    height = packing.extent[1] if ground.size is None else ground.size[1]
    if not (top and top.is_free) or packing.box[3] < (1.0 - TYPED) * height:
        return {}
    found = {side: floor_beside(holes, packing.box, side, 2.0 * packing.radius) for side in SIDEWAYS}
    return {side: floor for side, floor in found.items() if floor is not None}


def lowered_problems(tables: Mapping[str, Any]) -> Iterator[str]:
    """What cannot be where the ground beyond a side is lower: all for which it would have to be a half-space.

    A table or an entry that is invalid on its own is None.
    """
    packing, ground, boundary = (tables[key] for key in ("packing", "ground", "boundary"))
    if not (packing and ground):
        return
    holes = [hole for hole in tables["hole"] if hole]
    lower = {
        side: floor.height
        for side, floor in floors(holes, packing, ground, boundary).items()
        if (table := boundary.get(side)) and table.is_outside
    }
    if not lower:
        return
    where = " and ".join(f"at y = {height:.4g} m beyond the {side} side" for side, height in lower.items())
    instead = "end the holes inside the disks, with the surface at its height at both sides"
    no_half_space = f"as the ground is no half-space, with its surface {where}; {instead}"
    if tables["incident"]:
        yield f"incident: what the surface sends back of the wave is not known, {no_half_space}"
    for side, table in boundary.items():
        for motion in table.waves if table and table.is_outside else ():
            yield f"boundary.{side}.wave_{motion}: the motion far from the disks is not known, {no_half_space}"
    for place, load in numbered("load", tables["load"]):
        if load.is_everywhere and (load.wave is not None or not tables["static"]):
            yield f"{place}: acts on all disks and needs [static], without a wave, {no_half_space}"
