"""The ``[[monitor]]`` tables of a file: single places, and rows along the surface, which become single monitors."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator

from dembound.boundaries.free import Free
from dembound.casefile.disks.ground import Ground, reach
from dembound.casefile.disks.load import Monitor, is_no_twin
from dembound.casefile.messages import numbered
from dembound.casefile.model import MOST_MONITORS
from dembound.holes.hole import Hole, surface_below
from dembound.holes.polygon import Points
from dembound.packings.base import TYPED, Packing
from dembound.table import FileName, Table, quantity

NUMBERED = re.compile(r"(.+)_\d+")
"""A monitor of a row."""

LONGEST_ROW = 6
"""Number of monitors of a row up to which all are named."""

DIGITS = 9
"""Digits after the point of the places of a row, m: less than disks and edges are apart (`places.ROUNDING`)."""


class MonitorTable(Table):
    """A place at which the motion of the nearest particle, or of the continuum, is recorded; or a row of places.

    A row `NAME` becomes the monitors `NAME_1`, `NAME_2` and so on from the left, on the outline of the uppermost
    ground.
    """

    name: Annotated[FileName, AfterValidator(is_no_twin)] = quantity()
    """name of the history; of a row without the numbers"""
    position: tuple[float, float] | None = quantity(None, unit="m", means="place")
    """where; of equally near particles the lowest, of these the leftmost"""
    points: Points | None = quantity(None, unit="m", means="place")
    """corners [[x, y], …] of a polygon, of whose particles at the start the mean by mass is recorded"""
    along: Literal["surface"] | None = quantity(None)
    """"surface": a row along the free surface"""
    spacing: float | None = quantity(None, unit="m", means="length", gt=0.0)
    """step along x from one monitor of a row to the next"""
    from_: float | None = quantity(None, unit="m", means="place", alias="from")
    """x of the first; absent: half a step from the left side of the ground"""
    to: float | None = quantity(None, unit="m", means="place")
    """largest x of a row; absent: half a step from its right side"""

    def mistakes(self) -> Iterator[str]:
        """Not one of a place, a polygon and a row, or keys of another of these."""
        of_rows = [key for key in ("spacing", "from_", "to") if getattr(self, key) is not None]
        if self.points is not None:
            stray = [key for key in ("position", "along", *of_rows) if getattr(self, key) is not None]
            yield from (f"{self.key_of(key)}: is not allowed together with points" for key in stray)
            if len(self.points) < 3:
                yield "points: must be three or more"
        elif self.along is None:
            if self.position is None:
                yield "position: is missing; give it, along or points"
            yield from (f"{self.key_of(key)}: is for a row; give along, too" for key in of_rows)
        else:
            if self.position is not None:
                yield "position: is not allowed together with along"
            if self.spacing is None:
                yield "spacing: is missing; a row needs it"

    def steps(self, left: float, right: float) -> tuple[float, int]:
        """First x (m) of a row in ground from one x (m) to another one, and the number of monitors, 0 or less for none.

        Without `from` and `to` the row is as far from the left side as from the right one.
        """
        assert self.spacing is not None
        first = left + 0.5 * self.spacing if self.from_ is None else self.from_
        last = right - 0.5 * self.spacing if self.to is None else self.to
        whole = (last - first) / self.spacing
        count = math.floor(whole + TYPED) + 1
        if self.from_ is None and count > 0:
            first += (0.5 if self.to is None else 1.0) * (whole - (count - 1)) * self.spacing
        return first, count


def without_rows(tables: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """The tables of a case with single monitors in place of rows, and the mistakes of rows, one line each.

    Tables and entries that are invalid on their own are None, and so are rows whose surface is therefore not known.
    """
    monitors, problems = list[Monitor | None](), list[str]()
    places = {id(table): place for place, table in numbered("monitor", tables["monitor"])}
    for table in tables["monitor"]:
        if table is None or table.along is None:
            monitors.append(table and _single(table))
            continue
        found = list(_row(table, tables))
        problems += [f"{places[id(table)]}.{line}" for line in found if isinstance(line, str)]
        monitors += [each for each in found if not isinstance(each, str)] or [None]
    return {**tables, "monitor": tuple(monitors)}, problems


def _single(table: MonitorTable) -> Monitor:
    """A monitor at a place, or of the mean of a polygon, whose place is that of the mean of its corners."""
    if table.points is None:
        assert table.position is not None
        return Monitor(name=table.name, position=table.position)
    x, y = np.mean(table.points, axis=0).tolist()
    return Monitor(name=table.name, position=(x, y), points=table.points)


def _row(row: MonitorTable, tables: Mapping[str, Any]) -> Iterator[Monitor | str]:
    """The monitors of a row, or its mistakes without the place; nothing where other tables are invalid."""
    packing, ground, boundary = (tables[key] for key in ("packing", "ground", "boundary"))
    top = boundary.get("top", Free())
    if not (packing and ground and top) or None in tables["hole"]:
        return
    box, limits = ground.box(packing), reach(ground, packing, boundary)
    if not (top.is_free or "top" in packing.gaps(box)):
        yield f'along: needs a free surface, but boundary.top.type is "{top.type}"'
        return
    near = TYPED * packing.span
    for key, x in (("from", row.from_), ("to", row.to)):
        if x is not None and not limits[0] - near <= x <= limits[2] + near:
            yield f"{key}: is {x:g}, must be an x of the ground, from {limits[0]:g} to {limits[2]:g} (m)"
            return
    first, count = row.steps(box[0], box[2])
    if not 0 < count <= MOST_MONITORS:
        none = "leaves no place for a monitor; give another one, or other from and to"
        yield f"spacing: {f'makes {count:,} monitors, must make {MOST_MONITORS:,} or less' if count > 0 else none}"
        return
    assert row.spacing is not None
    along = np.round(first + row.spacing * np.arange(count), DIGITS)
    air = ground.above(packing.box)
    made = [hole for hole in tables["hole"] if hole.stage != "run"]
    holes = [*made, *([] if air is None else [air])]
    heights = np.round(_surface(along, holes, packing, ground), DIGITS)
    if np.isnan(heights).any():
        yield f"along: there is no ground at x = {along[np.isnan(heights)][0]:g} m; give other from and to"
        return
    for number, (x, y) in enumerate(zip(along.tolist(), heights.tolist(), strict=True), start=1):
        yield Monitor(name=f"{row.name}_{number}", position=(x, y))


def _surface(along: np.ndarray, holes: Sequence[Hole], packing: Packing, ground: Ground) -> np.ndarray:
    """Heights y (k,) m of the ground's surface at x (k,) m; nan where holes leave no ground.

    Beyond the sides of the disks it goes on at the height that it has there, and above disks that lie deeper it is
    level.
    """
    box = packing.box
    if "top" in packing.gaps(ground.box(packing)):
        return np.full(len(along), ground.box(packing)[3])
    inside = np.clip(along, box[0] + packing.radius, box[2] - packing.radius)
    return surface_below(holes, box, inside, 2.0 * packing.radius)


def shown_names(names: Sequence[str]) -> list[str]:
    """The monitors that are named: of a row ``NAME_1``, ``NAME_2`` … of more than `LONGEST_ROW` its ends alone."""
    return [name for row in _by_row(names) for name in (row if len(row) <= LONGEST_ROW else (row[0], row[-1]))]


def spread_names(names: Sequence[str], most: int) -> list[str]:
    """Of more than `most` monitors about as many: of rows of more than `LONGEST_ROW` ends and evenly spaced others."""
    rows = _by_row(names)
    long = [row for row in rows if len(row) > LONGEST_ROW]
    if len(names) <= most or not long:
        return list(names)
    room = most - sum(len(row) for row in rows if len(row) <= LONGEST_ROW)
    kept = {name for row in rows for name in row}
    for row in long:
        count = min(max(room // len(long), 2), len(row))
        at = {round(k * (len(row) - 1) / (count - 1)) for k in range(count)}
        kept -= {name for k, name in enumerate(row) if k not in at}
    return [name for name in names if name in kept]


def _by_row(names: Sequence[str]) -> list[list[str]]:
    """The monitors of each row, and single ones alone."""
    rows: dict[str, list[str]] = {}
    for name in names:
        numbered = NUMBERED.fullmatch(name)
        rows.setdefault(numbered[1] if numbered else name, []).append(name)
    return list(rows.values())
