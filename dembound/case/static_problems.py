"""Mistakes of a static stage that show only beside the other tables."""

from collections.abc import Iterator, Mapping, Sequence

from dembound.boundaries import BoundaryTable, Fixed, Periodic, Roller, normal_axis
from dembound.case.load import Load
from dembound.case.material import Material
from dembound.case.motion import Motion
from dembound.case.sentences import numbered
from dembound.case.static import Static

Sides = Mapping[str, BoundaryTable | None]


def static_problems(
    static: Static, boundaries: Sides, loads: Sequence[Load | None], material: Material | None, motion: Motion | None
) -> Iterator[str]:
    """Check the static stage; a table or an entry that is invalid on its own is None."""
    for side in static.boundary:
        if isinstance(boundaries.get(side), Periodic):
            yield f"static.boundary.{side}: is not allowed, as boundary.{side} is periodic"
    if static.stress is not None and any(isinstance(table, Periodic) for table in boundaries.values()):
        yield "static.stress: cannot be applied to periodic sides"
    if material and None not in loads:
        yield from _nothing_to_settle(static, loads, material)
    if motion and None not in static.boundary.values():
        yield from _unheld_loads(static, loads, motion)


def _nothing_to_settle(static: Static, loads: Sequence[Load | None], material: Material) -> Iterator[str]:
    """A stage that would end where it begins."""
    relaxes = material.law == "linearpbond" and material.locked_in  # the cut faces lack their neighbours' push
    steady = any(load and load.wave is None for load in loads)
    if not (static.stress or steady or relaxes):
        yield (
            "static: has nothing to settle; give it a stress, give the case a steady load, "
            'or the material law = "linearpbond" with locked_in = true'
        )


def _unheld_loads(static: Static, loads: Sequence[Load | None], motion: Motion) -> Iterator[str]:
    """Steady loads that would push the body away."""
    for place, load in numbered("load", loads):
        for axis in load.axes:
            if load.wave is None and not _holds(static, motion, axis):
                yield (
                    f"static.boundary: nothing holds the body along {'xy'[axis]} against {place}; "
                    'give a side "fixed" or "roller"'
                )


def _holds(static: Static, motion: Motion, axis: int) -> bool:
    """Whether the body has no way to go along an axis; periodic sides leave it one, round and round."""
    return "xy"[axis] in motion.held or any(
        isinstance(table, Fixed) or (isinstance(table, Roller) and normal_axis(side) == axis)
        for side, table in static.boundary.items()
    )
