"""The ``[ground]`` table, ground of two heights, and mistakes of holes that depend on other tables."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from pydantic import PrivateAttr

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.edge import SIDES, is_far, plane_of
from dembound.boundaries.free import Free
from dembound.casefile.disks.load import Load
from dembound.casefile.disks.surface import air_above, points_in_file
from dembound.casefile.messages import choices, corners, counted, numbered, show
from dembound.casefile.types import LAWS
from dembound.holes.hole import Floor, Hole, floor_beside
from dembound.holes.polygon import Points, Polygon
from dembound.packings.base import TYPED, Extent, Packing
from dembound.table import Box, Table, quantity


class Ground(Table):
    """The ground, of which the disks fill a box; outside is a continuum up to its free surface.

    With a `surface` the disks fill the box up to that; beyond the box it goes on at its heights there.

    Notes
    -----
    Validation passes the case file's folder, and texts in place of files, as for waves of type "file".
    """

    size: Extent | None = quantity(None, unit="m", means="length")
    """width and height, whole bricks high; absent: that of the disks"""
    origin: tuple[float, float] = quantity((0.0, 0.0), unit="m", means="place")
    """lower left corner of the ground"""
    surface: Points | str | None = quantity(None, unit="m", means="place")
    """free surface from left to right: points [[x, y], …], or a text file of x and y; level over four diameters at the
    sides of the disks; absent: their top"""
    meet: float | None = quantity(None, unit="m", means="place")
    """x of the vertical plane between layers of side "left" and "right" """

    _points: Points = PrivateAttr(default=())
    _text: str = PrivateAttr(default="")

    def model_post_init(self, context: Mapping[str, Any] | None) -> None:
        """Reads its surface, if that is in a file."""
        if isinstance(self.surface, str):
            self._points, self._text = points_in_file(self.surface, context or {})
        else:
            self._points = self.surface or ()

    def mistakes(self) -> Iterator[str]:
        """Points that are no surface from left to right."""
        if self.surface is not None and len(self.points) < 2:
            yield f"surface: has {counted(len(self.points), 'point')}, must have at least two"
        if any(after < before for (before, _), (after, _) in pairwise(self.points)):
            yield "surface: must go from left to right, so that no x is less than the one before"

    @property
    def files(self) -> dict[str, str]:
        """Text of the file of the surface, by its path, if it has one."""
        return {self.surface: self._text} if isinstance(self.surface, str) else {}

    def level(self) -> "Ground":
        """The ground without its surface."""
        return Ground(**self.model_dump(exclude={"surface"}, exclude_unset=True))

    def alike(self) -> "Ground":
        """The ground without the plane between its sides."""
        return self if self.meet is None else self.model_copy(update={"meet": None})

    @property
    def points(self) -> Points:
        """The points of the surface; none without one."""
        return self._points

    def above(self, box: Box) -> Polygon | None:
        """What is above the surface, as a hole in a box of disks (left, bottom, right, top; m); None without one."""
        return air_above(self._points, box) if self._points else None

    def box(self, packing: Packing) -> Box:
        """Left, bottom, right and top (m) of the ground; without a size, of the disks, which then fill it."""
        if self.size is None:
            return packing.box
        (left, bottom), (width, height) = self.origin, self.size
        return left, bottom, left + width, bottom + height


def ground_problems(ground: Ground, packing: Packing, boundaries: Mapping[str, Boundary | None]) -> Iterator[str]:
    """Check the box of disks against the ground; an invalid side is None."""
    if ground.size is None:
        if ground.origin != (0.0, 0.0):
            yield "ground.origin: [ground] has no size, so that the disks fill it; give ground.size, or packing.origin"
        return
    box = ground.box(packing)
    near = TYPED * max(ground.size)
    (lowest, lower), (left, bottom), right, top = box[:2], packing.box[:2], packing.box[2], packing.box[3]
    if left < lowest - near or bottom < lower - near or right > box[2] + near or top > box[3] + near:
        yield (f"packing.origin: the box of disks is {corners(*packing.box)}, must lie in the ground, {corners(*box)}")
        return
    brick = packing.brick_size[1]
    for key, value, begins in (("packing.origin", bottom, lower), ("ground.size", ground.size[1], 0.0)):
        rows = (value - begins) / brick
        if abs(rows - round(rows)) > TYPED * max(1.0, rows):
            above = f" above ground.origin at {lower:.10g} m" if begins else ""
            yield (
                f"{key}: its height, {value - begins:.10g} m{above}, is not a whole number of bricks of {brick:.10g} m;"
                f" {begins + int(rows) * brick:.10g} or {begins + (int(rows) + 1) * brick:.10g} would be"
            )
    highest = boundaries.get("top")
    if highest is not None and highest.is_outside and abs(box[3] - top) <= near:
        yield 'boundary.top.type: is "outside", but the disks reach the surface of the ground; it must be "free"'
    for side, gap in packing.gaps(box).items():
        table = boundaries.get(side)
        if not (side in boundaries and (table is None or table.is_outside)):
            yield f'boundary.{side}.type: the ground goes on {gap:g} m beyond this side, so it must be "outside"'


def reach(ground: Ground, packing: Packing, boundary: Mapping[str, Boundary | None]) -> Box:
    """The box (m) of the ground, without a limit beyond sides with a continuum and beyond invalid sides.

    Above disks that lie deep in the ground the continuum ends at its surface.
    """
    box = ground.box(packing)
    ends, below_surface = {side: plane_of(side, box) for side in SIDES}, "top" in packing.gaps(box)
    for side in SIDES:
        table = boundary.get(side)
        if side in boundary and (table is None or table.is_outside) and not (side == "top" and below_surface):
            ends[side] = float("inf") if is_far(side) else float("-inf")
    return ends["left"], ends["bottom"], ends["right"], ends["top"]


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
    if not (packing and ground):
        return {}
    above = ground.above(packing.box)
    holes = [hole for hole in (*tables["hole"], above) if hole and hole.stage != "run"]
    return lowered(floors(holes, packing, ground, boundary), boundary)


UPWARDS = "boundary.bottom the wave, which then rises straight up"


def _oblique_beside(tables: Mapping[str, Any], where: str) -> Iterator[str]:
    """What a wave at an angle cannot go with where the ground beyond a side is lower than the box; where : in words."""
    others = {
        "layers": bool(tables["layer"]),
        "quality_factor": any(
            table and table.quality_factor is not None for table in (tables["material"], *tables["layer"])
        ),
    }
    for what in (name for name, there in others.items() if there):
        yield (
            f"incident: is not known together with {what} where the ground beyond a side is lower than the disks, with "
            f"its surface {where}; leave one out, or give {UPWARDS}"
        )


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
    packing, ground = tables["packing"], tables["ground"]
    driven = [side for side, table in tables["boundary"].items() if table and table.is_outside and table.waves]
    if driven and "bottom" in packing.gaps(ground.box(packing)):
        yield (
            f"packing.origin: the ground goes on below the disks; under waves from boundary.{driven[0]}, with its "
            f"surface {where}, they must reach its lower side; make packing.size higher"
        )
    if tables["incident"]:
        yield from _oblique_beside(tables, where)
    for place, load in numbered("load", tables["load"]):
        if load.is_everywhere and (load.wave is not None or not tables["static"]):
            yield f"{place}: acts on all disks, which needs a [static] stage and no wave, {no_half_space}"
    if static := tables["static"]:
        for side in SIDEWAYS:
            table, own = tables["boundary"].get(side), static.boundary.get(side)
            if table and table.is_outside and not (own and 0 in own.prescribed(0)):
                yield f'static.boundary.{side}: must be "roller" or "fixed", as the ground beyond is no half-space'


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
        if hole.stage == "run":
            yield from _in_run(place, hole, tables)
        for key in ("load", "monitor"):
            yield from _places_in_it(place, hole, key, tables)
    if tables["packing"] and tables["ground"] and (above := tables["ground"].above(tables["packing"].box)):
        for key in ("load", "monitor"):
            yield from _places_in_it("the air above ground.surface", above, key, tables)
    for place, load in numbered("load", tables["load"]):
        if load.hole is not None:
            yield from _no_wall(place, load, tables)


def _shapes(place: str, hole: Hole, boundary: Mapping[str, Any]) -> Iterator[str]:
    """The shape of a sample that is cut later, or beside which the ground goes on."""
    if hole.stage != "before":
        yield f'{place}.stage: is "{hole.stage}", but a sample is cut before anything else; leave it out'
    for side, table in boundary.items():
        if table and (table.is_periodic or table.is_outside or table.needs_column or table.half_cells):
            kind = "half_mass" if table.half_cells else f'"{table.type}"'
            yield f'{place}.keep: is "inside", so the body ends at this shape; boundary.{side} must not be {kind}'


def _in_run(place: str, hole: Hole, tables: Mapping[str, Any]) -> Iterator[str]:
    """What an excavation during the run does not go with; a table that is invalid on its own is None."""
    if (material := tables["material"]) and not (LAWS[material.law].has_history and LAWS[material.law].starts_elastic):
        yield f'{place}.stage: is "run", which needs contacts that open; give material.law = "linearpbond"'
    if any(table and table.quality_factor is not None for table in (material, *tables["layer"])):
        yield f'{place}.stage: is "run", which is for undamped ground; leave quality_factor out'
    for where, load in numbered("load", tables["load"]):
        if load.hole == hole.name:
            yield f"{where}.hole: {show(hole.name)} is made during the run; a pressure acts in a hole made before"
        elif load.wave is not None and load.is_everywhere:
            yield f'{where}.wave: acts on all disks, some of which vanish; not known with {place}.stage = "run"'


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
