"""Cases of disks that are moved as a whole: every key that is a place, by the meaning of keys."""

from dataclasses import replace

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.kinds import checked
from dembound.table import Table

Way = tuple[float, float]


def moved_value(value, by: Way):
    """Places, pairs of numbers one after the other or within each other, moved by (x, y) m."""
    return np.add(np.reshape(value, (-1, 2)), by).reshape(np.shape(value)).tolist()


def moved(table: Table, by: Way) -> Table:
    """A table with all of its places, also default ones, moved by (x, y) m."""
    places = [key for key in type(table).model_fields if table.described(key).get("means") == "place"]
    given = {key: getattr(table, key) for key in places}
    return type(table).model_validate(
        table.given() | {key: moved_value(value, by) for key, value in given.items() if value is not None}
    )


def translated(case: DiskCase, by: Way) -> DiskCase:
    """A case moved by (x, y) m as a whole."""
    static = case.static
    if static is not None:
        sides = {side: moved(table, by) for side, table in static.boundary.items()}
        static = static.model_copy(update={"boundary": sides})
    whole = replace(
        case,
        packing=moved(case.packing, by),
        ground=case.ground if case.ground.size is None else moved(case.ground, by),
        hole=tuple(moved(hole, by) for hole in case.hole),
        load=tuple(moved(load, by) for load in case.load),
        monitor=tuple(moved(monitor, by) for monitor in case.monitor),
        boundary={side: moved(table, by) for side, table in case.boundary.items()},
        incident=None if case.incident is None else moved(case.incident, by),
        static=static,
    )
    return checked(whole)
