"""Mistakes of holes that depend on other tables."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from dembound.casefile.disks.load import Load
from dembound.casefile.messages import choices, corners, numbered, show
from dembound.holes import Hole
from dembound.table import Box


def hole_problems(tables: Mapping[str, Any], has_static: bool) -> Iterator[str]:
    """Check the holes; a table or an entry that is invalid on its own is None.

    has_static : whether there is a static stage.
    """
    for place, hole in numbered("hole", tables["hole"]):
        if tables["packing"]:
            yield from _outside(place, hole, tables["packing"].box)
        if hole.is_shape:
            yield from _shapes(place, hole, tables["boundary"])
        if hole.stage == "after" and not has_static:
            yield f'{place}.stage: is "after", but the case has no [static] stage to come after'
        for key in ("load", "monitor"):
            yield from _places_in_it(place, hole, key, tables)
    for place, load in numbered("load", tables["load"]):
        if load.hole is not None:
            yield from _no_wall(place, load, tables)


def _shapes(place: str, hole: Hole, boundary: Mapping[str, Any]) -> Iterator[str]:
    """The shape of a sample that is cut later, or beside which the ground goes on."""
    if hole.stage == "after":
        yield f'{place}.stage: is "after", but a sample is cut before anything else; leave it out'
    for side, table in boundary.items():
        if table and (table.is_periodic or table.is_outside or table.needs_column or table.half_cells):
            kind = "half_mass" if table.half_cells else f'"{table.type}"'
            yield f'{place}.keep: is "inside", so the body ends at this shape; boundary.{side} must not be {kind}'


def _outside(place: str, hole: Hole, box: Box) -> Iterator[str]:
    """A hole outside the disks' box (left, bottom, right, top; m)."""
    x0, y0, x1, y1 = hole.box
    left, bottom, right, top = box
    if x1 <= left or y1 <= bottom or x0 >= right or y0 >= top:
        yield f"{place}: lies outside the scene, {corners(*box)}"


def _places_in_it(place: str, hole: Hole, key: str, tables: Mapping[str, Any]) -> Iterator[str]:
    """Loads or monitors in the hole, where there are no particles."""
    span = tables["packing"].span if tables["packing"] else 0.0
    for where, table in numbered(key, tables[key]):
        if table.position is not None and hole.takes(np.array([table.position]), span)[0]:
            yield f"{where}.position: lies in {place}; must be where particles remain"


def _no_wall(place: str, load: Load, tables: Mapping[str, Any]) -> Iterator[str]:
    """A pressure on a hole that the case does not have, or whose wall is not its whole outline.

    A hole that is invalid on its own has no name here.
    """
    holes = {hole.name: hole for hole in tables["hole"] if hole}
    if load.hole not in holes:
        if None not in tables["hole"]:
            defined = f"defined: {choices(str(load.hole), holes)}" if holes else "none is defined"
            yield f"{place}.hole: {show(load.hole)} is not a hole of this case; {defined}"
        return
    hole = holes[load.hole]
    if hole.is_shape:
        yield f"{place}.hole: {show(hole.name)} is the shape of the sample; a pressure acts in a hole, or on sides"
    if load.on == "outline" and hole.outline is None:
        yield f'{place}.on: "outline" needs edges that do not cross; give hole {hole.name} such, or on = "bonds"'
    if tables["packing"]:
        yield from _at_periodic_sides(place, hole, tables)


def _at_periodic_sides(place: str, hole: Hole, tables: Mapping[str, Any]) -> Iterator[str]:
    """A message about a hole that reaches a periodic side, beyond which it is not repeated."""
    (x0, y0, x1, y1), (left, bottom, right, top) = hole.box, tables["packing"].box
    reached = {"left": x0 <= left, "right": x1 >= right, "bottom": y0 <= bottom, "top": y1 >= top}
    for side, table in tables["boundary"].items():
        if table and table.is_periodic and reached[side]:
            yield f"{place}.hole: {show(hole.name)} reaches the periodic side {side}, which closes its wall otherwise"
