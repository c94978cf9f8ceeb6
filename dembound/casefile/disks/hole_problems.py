"""Mistakes of holes that depend on other tables."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from dembound.casefile.messages import corners, numbered
from dembound.holes import Hole
from dembound.table import Box


def hole_problems(tables: Mapping[str, Any], has_static: bool) -> Iterator[str]:
    """Check the holes; a table or an entry that is invalid on its own is None. has_static: whether there is a stage."""
    for place, hole in numbered("hole", tables["hole"]):
        if tables["packing"]:
            yield from _outside(place, hole, tables["packing"].box)
        if hole.stage == "after" and not has_static:
            yield f'{place}.stage: is "after", but the case has no [static] stage to come after'
        for key in ("load", "monitor"):
            yield from _places_in_it(place, hole, key, tables[key])


def _outside(place: str, hole: Hole, box: Box) -> Iterator[str]:
    """A hole outside the disks' box (left, bottom, right, top; m)."""
    x0, y0, x1, y1 = hole.box
    left, bottom, right, top = box
    if x1 <= left or y1 <= bottom or x0 >= right or y0 >= top:
        yield f"{place}: lies outside the scene, {corners(*box)}"


def _places_in_it(place: str, hole: Hole, key: str, tables: Any) -> Iterator[str]:
    """Loads or monitors in the hole, whose particles are removed."""
    for where, table in numbered(key, tables):
        if table.position is not None and hole.contains(np.array([table.position]))[0]:
            yield f"{where}.position: lies in {place}; must be where particles remain"
