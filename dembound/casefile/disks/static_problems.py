"""Mistakes of a static stage that depend on other tables."""

from collections.abc import Iterator, Mapping, Sequence

from dembound.boundaries import SIDES, Boundary, normal_axis
from dembound.casefile.disks.load import Load, gravity
from dembound.casefile.disks.material import Material
from dembound.casefile.disks.motion import Motion
from dembound.casefile.disks.static import Static, begins_stressed
from dembound.casefile.messages import numbered

Sides = Mapping[str, Boundary | None]


def static_problems(
    static: Static,
    boundaries: Sides,
    loads: Sequence[Load | None],
    material: Material | None,
    motion: Motion | None,
    *,
    has_column: bool,
) -> Iterator[str]:
    """Check the static stage; a table or an entry that is invalid on its own is None.

    has_column : whether a free-field column represents the ground beyond a continuum.
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
    begins = begins_stressed(static, boundaries)
    if static.k0 is not None:
        yield from _without_weight(loads)
    if begins and material and material.locked_in:
        yield "material.locked_in: is not allowed beside a stress at rest; leave it out and give all in static.stress"
    if static.stress is not None and not begins:
        yield from _unreachable_stress(static, static.stress)
    if material and None not in loads:
        yield from _nothing_to_settle(static, loads, material)
    if motion and None not in static.boundary.values():
        yield from _unheld_loads(static, boundaries, loads, motion, has_column=has_column)


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
    static: Static, boundaries: Sides, loads: Sequence[Load | None], motion: Motion, *, has_column: bool
) -> Iterator[str]:
    """Steady loads against which the body, or the free-field column, is not held."""
    beside = any(table.needs_column or (table.is_outside and has_column) for table in boundaries.values() if table)
    for place, load in numbered("load", loads):
        if load.wave is not None:
            continue
        on_column = beside and load.is_everywhere
        what, where = ("free-field column", "bottom or top") if on_column else ("body", "a side")
        for axis in load.axes:
            if load.moves_along(axis) and not _holds(static, ("bottom", "top") if on_column else SIDES, motion, axis):
                yield (
                    f"static.boundary: nothing holds the {what} along {'xy'[axis]} against {place}; "
                    f'give {where} "fixed" or "roller"'
                )


def _holds(static: Static, sides: Sequence[str], motion: Motion, axis: int) -> bool:
    """Whether these sides hold the body along an axis; periodic sides do not."""
    return "xy"[axis] in motion.held or any(_stands(static, side, axis) for side in sides)


def _stands(static: Static, side: str, axis: int) -> bool:
    """Whether the particles of a side cannot move along an axis during the stage."""
    table = static.boundary.get(side)
    return table is not None and axis in table.prescribed(normal_axis(side))
