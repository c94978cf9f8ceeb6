"""Warnings about loads of which less than the given force acts, as a side carries part of it."""

from collections.abc import Iterator, Sequence

import numpy as np

from dembound.boundaries.support import Edge
from dembound.casefile.disks.load import Load
from dembound.disks.scene import DiskScene
from dembound.disks.supports import forces_of
from dembound.words import percent

HELD = 0.1
"""Share of a load that disks of held sides may have without a warning: a region often reaches such a side."""

ONE_WAY = 0.5
"""Share of the sizes of all steady forces that their resultant must exceed to pull the whole body one way."""


def load_warnings(scene: DiskScene) -> Iterator[str]:
    """Warnings about loads, one line each."""
    yield from _twice(scene.case.load)
    yield from _hung(scene)
    yield from _not_borne(scene)
    for load in scene.case.load:
        if load.force is None:
            continue
        nodes, forces = forces_of(load, scene)
        for edge in scene.edges.values():
            on_side = np.isin(nodes, edge.nodes)
            if on_side.any():
                yield from (f"load.{load.name}: {words}" for words in _at_side(scene, load, edge, forces, on_side))


def _hung(scene: DiskScene) -> Iterator[str]:
    """Warnings about bodies that steady loads pull towards a free side, held at the opposite one, all in tension."""
    static = scene.case.static
    if static is None or static.stress is not None:
        return
    before = scene if scene.before is None else scene.before
    for axis, (low, high) in enumerate((("left", "right"), ("bottom", "top"))):
        forces = before.steady_load[axis]
        if axis in scene.ground.held or abs(forces.sum()) <= ONE_WAY * np.abs(forces).sum():
            continue
        towards, held = (high, low) if forces.sum() > 0.0 else (low, high)
        if any(scene.case.side(side).is_periodic or scene.case.side(side).is_outside for side in (low, high)):
            continue
        table = static.boundary.get(held)
        if towards not in static.boundary and table is not None and axis in table.prescribed(axis):
            yield (
                f"static: the steady loads pull the body along {'xy'[axis]} towards its {towards}, which is free in "
                f"the static stage, and static.boundary.{held} holds it: it hangs, all in tension; give "
                f"static.boundary.{towards} where it is to rest on it"
            )


def _not_borne(scene: DiskScene) -> Iterator[str]:
    """A warning about a stress at rest that contacts cannot bear by friction."""
    if scene.at_rest is not None and not scene.at_rest.is_borne:
        key = "static.stress" if scene.case.static is not None and scene.case.static.k0 is None else "static.k0"
        yield (
            f"{key}: contacts and bonds of the packing cannot bear the stress at rest without sliding further and "
            "further; the static stage loses a part of it, or does not end: give more friction (fric), bonds, or a "
            "smaller difference of the principal stresses"
        )


def _at_side(scene: DiskScene, load: Load, edge: Edge, forces: np.ndarray, on_side: np.ndarray) -> Iterator[str]:
    """Effect of a side on a load with forces (k, 3), of which some (k,) are on the side's disks, in words."""
    table, side = scene.case.side(edge.side), edge.side
    prescribed = [axis for axis in load.axes if axis in table.prescribed(edge.axis)]
    if table.factors and on_side.all():
        yield (
            f"acts on disks of boundary.{side} alone, whose dashpots take a part of it: of a plane wave about half "
            "enters; put it on disks away from that side"
        )
    elif prescribed and (share := abs(forces[on_side, prescribed[0]].sum() / forces[:, prescribed[0]].sum())) > HELD:
        yield (
            f"has {percent(share, 3)} of its force along {'xy'[prescribed[0]]} on disks of boundary.{side}, which "
            "prescribes their motion, so that this part moves nothing"
        )


def _twice(loads: Sequence[Load]) -> Iterator[str]:
    """Warnings about loads that equal an earlier one except for their name."""
    seen: dict[str, str] = {}
    for load in loads:
        same = repr(load.model_copy(update={"name": ""}))
        if same in seen:
            yield f"load.{load.name}: is the same as load.{seen[same]}, so that it acts twice"
        seen.setdefault(same, load.name)
