"""The free surface of the ground as a line of points, in a case or a file, and what is above it."""

import re
from collections.abc import Collection, Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

from dembound.boundaries.boundary import Boundary
from dembound.holes.polygon import Points, Polygon
from dembound.packings.base import TYPED, Packing
from dembound.table import Box
from dembound.waves.file_wave import columns_in, header_of, read_text

LEVEL = 4.0
"""Least length, in diameters, over which the surface is level at a side of the disks."""

OTHER_UNIT = re.compile(r"\b(mm|cm|km|ft|feet|in(?!\s+\w)|inch|yd)\b", re.IGNORECASE)
"""Units of length in a header other than m."""

ABOVE = "surface"
"""Name of what is above the surface of the ground, among the holes."""


def surface_problems(points: Points, packing: Packing, boundaries: Mapping[str, Boundary | None]) -> Iterator[str]:
    """Check the points of a surface against the box of disks and its sides; an invalid side is None."""
    left, bottom, right, top = packing.box
    near = TYPED * packing.span
    if points[0][0] > left + near or points[-1][0] < right - near:
        yield (
            f"ground.surface: goes from x = {points[0][0]:.10g} to {points[-1][0]:.10g} m, must reach over the disks, "
            f"{left:.10g} to {right:.10g} m"
        )
    goes_on = [side for side, table in boundaries.items() if table and (table.is_outside or table.needs_column)]
    yield from _uneven_ends(points, packing, goes_on)
    inside = [y for x, y in points if left - near <= x <= right + near]
    if max(inside, default=bottom) > top + near:
        yield (
            f"ground.surface: is {max(inside):.10g} m high, but packing.size ends at y = {top:.10g} m; "
            "must end at or above it"
        )
    if min(inside, default=top) <= bottom + near:
        low = f"is as low as {min(inside):.10g} m"
        yield f"ground.surface: {low}, must be above the lower side of the disks, y = {bottom:.10g} m"


def _uneven_ends(points: Points, packing: Packing, sides: Collection[str]) -> Iterator[str]:
    """Some sides of the disks beside which a surface is not level within half a diameter over `LEVEL` diameters."""
    left, _, right, _ = packing.box
    diameter = 2.0 * packing.radius
    for side, x, end in (("left", left, left + LEVEL * diameter), ("right", right, right - LEVEL * diameter)):
        low, high = sorted((x, end))
        inside = [y for at, y in points if low < at < high] + [_height(points, low), _height(points, high)]
        if side in sides and max(inside) - min(inside) > 0.5 * diameter:
            yield (
                f"ground.surface: goes from y = {min(inside):.6g} to {max(inside):.6g} m beside boundary.{side}, "
                f"beyond which it is level; must be level within half a diameter over {LEVEL * diameter:.4g} m there"
            )


def _height(points: Points, x: float) -> float:
    """Height y (m) of a surface at x, m."""
    for (before, low), (after, high) in pairwise(points):
        if before <= x < after:
            return low + (x - before) / (after - before) * (high - low)
    return points[0][1] if x < points[0][0] else points[-1][1]


def points_in_file(name: str, context: Mapping[str, Any], key: str = "surface") -> tuple[Points, str]:
    """The points (m) in a text file, and its text.

    context : as for `FileWave`. key : whose value is the name of the file. Raises ValueError for a file without two
    columns of numbers, or with other units.
    """
    path, given = context.get("folder", Path()) / name, context.get("files", {}).get(name)
    try:
        text = read_text(path) if given is None else given
        rows = columns_in(text, path)
    except ValueError as error:
        raise ValueError(str(error).replace("path:", f"{key}:", 1)) from None
    if rows.shape[1] != 2:
        raise ValueError(f'{key}: "{path}" has {rows.shape[1]} columns, must have two, x and y in m')
    if other := OTHER_UNIT.search(header_of(text)):
        raise ValueError(f'{key}: the header of "{path}" names "{other[0]}", must be in m')
    return tuple((float(x), float(y)) for x, y in rows.tolist()), text


def air_above(points: Points, box: Box) -> Polygon:
    """What is above a surface, as a hole in a box of disks (left, bottom, right, top; m)."""
    (first, left), (last, right), wide = points[0], points[-1], box[2] - box[0]
    top = max(box[3], *(y for _, y in points)) + wide
    begin, end = min(first, box[0]) - wide, max(last, box[2]) + wide
    outline = (begin, left), *points, (end, right), (end, top), (begin, top)
    return Polygon(type="polygon", name=ABOVE, points=outline)
