"""The ``[static]`` table, the tables of its sides, and its mistakes that depend on other tables.

Where bonds may break, zones beside sides whose bonds do not, and springs of sides on relative motion, belong to them.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from dembound.boundaries import OPPOSITE, Boundary, normal_axis
from dembound.boundaries.edge import SIDES
from dembound.boundaries.platen import INTACT, Keeping
from dembound.boundaries.viscous import Bearing, BearingDashpots
from dembound.casefile.disks.incident import Motion
from dembound.casefile.disks.load import Load, gravity
from dembound.casefile.disks.material import STRENGTH_KEYS, Material
from dembound.casefile.messages import numbered
from dembound.casefile.types import LAWS, StaticSide
from dembound.table import Table, quantity

RATIO = 1e-5
"""Force ratio at rest under the elastic law, where what is left acts as constant forces and changes no motion."""

RATIO_SLIDING = 1e-7
"""Force ratio at rest under a history-dependent law.

What is left decides there which contacts at the limit of friction slide as a wave begins, see
`dembound.formulas.disks.rest`."""

MOST_STEPS = 100_000_000
"""Largest number of steps of the stage: a hundred disks take minutes for these, and thousands of steps are enough."""


class Static(Table):
    """The damped stage before the run, which brings the body to rest under steady loads and a given stress.

    It needs a `stress`, a steady load or `material.locked_in`, and a support along every axis on which a steady load
    acts. Under `k0`, and under a stress beside periodic, free-field
    and outside sides, contacts begin with the forces of that stress; otherwise forces on the sides make it.
    """

    stress: tuple[float, float, float] | None = quantity(None, unit="Pa", means="stress to reach")
    """stress [sxx, syy, sxy] to reach, tension positive; absent: that of the loads"""
    k0: float | None = quantity(None, means="ratio of stresses", ge=0.0, le=5.0)
    """stress along x over that along y due to weight; absent: what settling makes"""
    ratio: float | None = quantity(None, means="rest", gt=0.0, lt=1.0)
    """mean unbalanced over mean contact force at its end; absent: 1e-5, 1e-7 once contacts slide or open or bonds break
    """
    damp: float = quantity(0.7, means="share", gt=0.0, lt=1.0)
    """local damping coefficient of the stage"""
    max_steps: int = quantity(200_000, means="count", ge=1, le=MOST_STEPS)
    """steps after which the stage has failed"""
    from_: str | None = quantity(None, alias="from", min_length=1)
    """results of a case that has settled the same body, from the current folder"""
    boundary: Mapping[str, StaticSide] = quantity({})
    """a table for each side; an absent side is free"""

    def enough(self, *, slides: bool) -> float:
        """The force ratio at which the stage is over; slides : whether under a history-dependent law."""
        return self.ratio or (RATIO_SLIDING if slides else RATIO)


def begins_stressed(static: Static, boundaries: Mapping[str, Boundary | None], material: Material | None) -> bool:
    """Whether contacts begin with the forces of a stress at rest.

    They do with K0, beside sides that could not apply the stress, and under a law without stiffness but for it.
    """
    tables = [table for table in boundaries.values() if table]
    beside = any(table.is_periodic or table.needs_column or table.is_outside for table in tables)
    needed = material is not None and not LAWS[material.law].starts_elastic
    return static.k0 is not None or (static.stress is not None and (beside or needed))


Sides = Mapping[str, Boundary | None]


def static_problems(
    static: Static,
    boundaries: Sides,
    loads: Sequence[Load | None],
    material: Material | None,
    motion: Motion | None,
    *,
    has_column: bool,
    has_walls: bool = False,
) -> Iterator[str]:
    """Check the static stage; a table or an entry that is invalid on its own is None.

    has_column : whether a free-field column represents the ground beyond a continuum. has_walls : whether there are
    walls, on which the body may rest.
    """
    for side in static.boundary:
        if (table := boundaries.get(side)) and table.is_periodic:
            yield f"static.boundary.{side}: is not allowed, as boundary.{side} is periodic"
        if table and table.is_outside and side != "bottom" and has_column:
            yield f"static.boundary.{side}: is not allowed, as the ground goes on beyond; its bottom may be held"
    for side, own in static.boundary.items():
        for key in ("artificial", "intact"):
            if own and key in own.model_fields_set:
                yield f"static.boundary.{side}.{key}: is of no use in the static stage; give it to boundary.{side}"
    begins = begins_stressed(static, boundaries, material)
    if static.k0 is not None:
        yield from _without_weight(loads)
    if begins and material and material.locked_in:
        yield "material.locked_in: is not allowed beside a stress at rest; leave it out and give all in static.stress"
    if static.stress is not None and not begins:
        yield from _unreachable_stress(static, static.stress)
    if material and None not in loads:
        yield from _nothing_to_settle(static, loads, material)
    if motion and None not in static.boundary.values():
        yield from _unheld_loads(static, boundaries, loads, motion, has_column=has_column, has_walls=has_walls)


def changes(groups: Sequence[Any], holes: Sequence[Any], static: Static | None) -> Iterator[tuple[str, float]]:
    """Places of the keys by which the ground changes in the run, and these times (s); an invalid table is None."""
    for key, tables in (("group", groups), ("hole", holes)):
        for place, table in numbered(key, tables):
            if table.time is not None:
                yield f"{place}.time", table.time
    for side, held in (static.boundary if static else {}).items():
        if (until := getattr(held, "until", None)) is not None:
            yield f"static.boundary.{side}.until", until


def _without_weight(loads: Sequence[Load | None]) -> Iterator[str]:
    """Weight that static.k0 would be about, and is missing."""
    if None not in loads and not any(gravity(loads)):
        yield "static.k0: is of the stress due to weight; give a [[load]] with acceleration = [0.0, -9.81] and no wave"


def _unreachable_stress(static: Static, stress: tuple[float, float, float]) -> Iterator[str]:
    """Stresses along an axis on which both sides are held."""
    for axis, (low, high) in enumerate((("left", "right"), ("bottom", "top"))):
        if stress[axis] != 0.0 and all(_stands(static, side, axis) for side in (low, high)):
            name = "xy"[axis]
            yield f"static.stress: has a component along {name}, but {low} and {high} are held there; free one of them"


def _nothing_to_settle(static: Static, loads: Sequence[Load | None], material: Material) -> Iterator[str]:
    """A stage without loads or stresses."""
    steady = any(load and load.wave is None for load in loads)
    if not (static.stress or steady or material.locked_in):
        yield "static: has nothing to settle; give it a stress, give the case a steady load, or the material locked_in"


def _unheld_loads(
    static: Static,
    boundaries: Sides,
    loads: Sequence[Load | None],
    motion: Motion,
    *,
    has_column: bool,
    has_walls: bool,
) -> Iterator[str]:
    """Steady loads against which the body, or the free-field column, is not held.

    A body may rest on walls, but under k0, which gives the disks of free sides the forces of ground beyond.
    """
    below = ", under k0 also above walls" if has_walls and static.k0 is not None else ""
    beside = any(table.needs_column or (table.is_outside and has_column) for table in boundaries.values() if table)
    for place, load in numbered("load", loads):
        on_column = beside and load.is_everywhere
        if load.wave is not None or (has_walls and static.k0 is None and not on_column):
            continue
        what, where = ("free-field column", "bottom or top") if on_column else ("body", "a side")
        for axis in load.axes:
            kinds = '"fixed"' if on_column and axis == 0 else '"fixed" or "roller"'
            if load.moves_along(axis) and not _holds(static, ("bottom", "top") if on_column else SIDES, motion, axis):
                yield (
                    f"static.boundary: nothing holds the {what} along {'xy'[axis]} against {place}; "
                    f"give {where} {kinds}{below}"
                )


def _holds(static: Static, sides: Sequence[str], motion: Motion, axis: int) -> bool:
    """Whether these sides hold the body along an axis; periodic sides do not."""
    return "xy"[axis] in motion.held or any(_stands(static, side, axis) for side in sides)


def _stands(static: Static, side: str, axis: int) -> bool:
    """Whether the particles of a side cannot move along an axis during the stage."""
    table = static.boundary.get(side)
    return table is not None and axis in table.prescribed(normal_axis(side))


def intact_depths(
    materials: Sequence[Material], boundary: Mapping[str, Boundary], static: Static | None
) -> dict[str, int]:
    """Number of disks from each side, counted by bonds, whose bonds do not break; sides without any are left out.

    By default `INTACT` where forces of the static stage go on acting in a run in which bonds can break, and the side
    stands for ground beyond it or drives the ground. Not in samples, of which no side absorbs, is periodic, drives
    waves or says that it is artificial, nor on platens within a range.
    """
    if not can_break(materials):
        return {}
    depths = {}
    for side, table in boundary.items():
        if isinstance(table, Keeping) and (depth := _depth(side, table, boundary, static)) > 0:
            depths[side] = depth
    return depths


def bearing_of(side: str, table: Boundary, material: Material, intact: Mapping[str, int]) -> Bearing | None:
    """The springs of a side on relative motion; None without any. intact : see `intact_depths`."""
    if not isinstance(table, BearingDashpots) or not (side == "bottom" or table.needs_column):
        return None
    if table.bearing is None:
        return Bearing() if LAWS[material.law].has_history and side in intact else None
    if isinstance(table.bearing, Bearing):
        return table.bearing
    return Bearing() if table.bearing else None


def can_break(materials: Sequence[Material]) -> bool:
    """Whether bonds of some of the materials have a strength; only laws with a history, and load factors, use it."""
    return any(getattr(each, key) is not None for each in materials for key in STRENGTH_KEYS)


def keeps_forces(static: Static | None, side: str, table: Boundary) -> bool:
    """Whether forces of the static stage go on acting at a side with this table in the run."""
    if static is None or table.is_periodic:
        return False
    given = static.stress is not None or static.k0 is not None
    return given or side in static.boundary or table.needs_column or table.is_outside


def _depth(side: str, table: Keeping, boundary: Mapping[str, Boundary], static: Static | None) -> int:
    """The number of disks of one side, as given or by default."""
    if table.intact is not None:
        return table.intact
    beyond = table.is_artificial or table.is_interface or _drives(side, table, boundary)
    whole = table.on_whole_side() == table
    return INTACT if whole and beyond and keeps_forces(static, side, table) and _is_ground(boundary) else 0


def _is_ground(boundary: Mapping[str, Boundary]) -> bool:
    """Whether the body is a part of the ground, and no sample, by its sides."""
    return any(
        table.absorbs
        or table.is_periodic
        or _drives(side, table, boundary)
        or (table.is_artificial and "artificial" in table.model_fields_set)
        for side, table in boundary.items()
    )


def _drives(side: str, table: Boundary, boundary: Mapping[str, Boundary]) -> bool:
    """Whether waves enter through a side: not at a platen, if the opposite side holds the same motion."""
    if not table.waves:
        return False
    axis = normal_axis(side)
    across = boundary.get(OPPOSITE[side])
    held = set() if across is None else {*across.prescribed(axis)}
    return not set(table.prescribed(axis)) & held
