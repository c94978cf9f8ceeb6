"""The zones beside the sides of a body in which bonds do not break, and the springs of its bottom."""

from collections.abc import Mapping, Sequence

from dembound.boundaries import OPPOSITE, Boundary, normal_axis
from dembound.boundaries.platen import INTACT, Keeping
from dembound.boundaries.viscous import Bearing, BearingDashpots
from dembound.casefile.disks.material import STRENGTH_KEYS, Material
from dembound.casefile.disks.static import Static
from dembound.casefile.types import LAWS


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


def bearing_of(table: Boundary, material: Material, intact: Mapping[str, int]) -> Bearing | None:
    """The springs of the bottom on relative motion; None without any. intact : see `intact_depths`."""
    if not isinstance(table, BearingDashpots):
        return None
    if table.bearing is None:
        return Bearing() if LAWS[material.law].has_history and "bottom" in intact else None
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
