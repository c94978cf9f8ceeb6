"""Arrangements of sides that stand in for the ground beyond a scene: the case's own, dashpots, springs, a continuum."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from dembound.accuracy.choice import Choice, changed
from dembound.accuracy.of_disks.boxes import box_tables, continuum_beyond, may_be_boxed, rectangles
from dembound.boundaries.boundary import Boundary
from dembound.casefile.disks import DiskCase
from dembound.disks.beyond.settings import extents
from dembound.disks.material.packed_material import PackedMaterial
from dembound.errors import CaseError
from dembound.table import Box

CONTINUUM_SHARE = 0.3
"""Part of the error asked for that the elements of a continuum may have; smaller ones cost more than they gain."""

ROUNDING = 1e-9
"""Part of a brick by which places may be beyond it."""


def may_widen(arrangement: Choice[DiskCase]) -> bool:
    """Whether the sides of a choice reflect and may be farther away; not where disks fill only a box of the ground."""
    reflecting = [side for side, table in _silent(arrangement.case).items() if not table.absorber]
    return bool(reflecting) and arrangement.case.ground.size is None


def _silent(case: DiskCase) -> dict[str, Boundary]:
    """The sides that may be farther away."""
    return {side: table for side, table in case.boundary.items() if table.may_move}


def arrangements(case: DiskCase, ground: PackedMaterial, bound: float) -> Iterator[Choice[DiskCase]]:
    """Choices of sides for a case, its own first: with valid tables, none of them built yet.

    ground : of the case. bound : error bound.
    """
    silent = _silent(case)
    yield Choice("sides as given", {}, case)
    if case.ground.size is None and case.incident is None and silent:
        yield from _dashpots(case, silent)
    if case.incident is None:
        yield from _continuum(case, ground, silent, bound)


def _dashpots(case: DiskCase, silent: Mapping[str, Boundary]) -> Iterator[Choice[DiskCase]]:
    """Matched dashpots, without springs and with springs towards the sources."""
    if any(table.needs_column for table in silent.values()):
        return  # the motion of the ground is not zero beyond them
    kinds: dict[str, dict[str, Any]] = {"viscous": {}}
    places = [0.5 * (low + high) for low, high in extents(case)]
    if places:
        kinds["viscoelastic"] = {"source": np.mean(places, axis=0).tolist()}
    for kind, extra in kinds.items():
        tables = {
            side: {"type": kind, **extra} | ({"half_mass": True} if side in case.packing.regular_sides else {})
            for side in silent
        }
        changes = {f"boundary.{side}": table for side, table in tables.items()}
        yield from _if_valid(f"{kind} sides", case, changes)


def _continuum(
    case: DiskCase, ground: PackedMaterial, silent: Mapping[str, Boundary], bound: float
) -> Iterator[Choice[DiskCase]]:
    """Choices with a continuum beyond all artificial sides, or beyond those without waves, and round boxes of disks."""
    coarse = CONTINUUM_SHARE * bound
    accuracies: dict[str, dict[str, Any]] = {"": {}} | (
        {"coarse ": {"outside.accuracy": coarse}} if coarse > case.outside.accuracy else {}
    )
    artificial = {side: table for side, table in case.boundary.items() if table.is_artificial}
    for name, accuracy in accuracies.items():
        for sides in (artificial, silent):
            beyond = {
                f"boundary.{side}": continuum_beyond(table) for side, table in sides.items() if not table.is_outside
            }
            changes = {**beyond, **accuracy}
            words = f"a {name}continuum beyond {' and '.join(sides)}"
            if changes and sides and (found := [*_if_valid(words, case, changes)]):
                yield from found
                break
        yield from _boxes(case, ground, accuracy, name)


def _boxes(
    case: DiskCase, ground: PackedMaterial, accuracy: Mapping[str, Any], name: str
) -> Iterator[Choice[DiskCase]]:
    """Boxes of disks of several sizes in a continuum."""
    if not may_be_boxed(case):
        return
    requested = changed(case, accuracy)
    small = [*rectangles(requested, ground)]
    for box in dict.fromkeys([*small, *(_with_monitors(case, each) for each in small)]):
        tables = box_tables(case, box)
        kept = {key: value for key, value in case.packing.given().items() if key != "bricks"}
        whole = {f"ground.{key}": value for key, value in tables.pop("ground").items()}
        changes = {**whole, "packing": kept | tables.pop("packing"), **tables}
        changes |= accuracy
        yield from _if_valid(f"a box of {_size(box)} in a {name}continuum", case, changes)


def _if_valid(words: str, case: DiskCase, changes: Mapping[str, Any]) -> Iterator[Choice[DiskCase]]:
    """The choice of some changes, if their tables have no mistake."""
    try:
        yield Choice(words, changes, changed(case, changes))
    except CaseError:
        return


def _with_monitors(case: DiskCase, box: Box) -> Box:
    """The smallest box of whole bricks that contains another box, all monitors and regions of loads."""
    places = [monitor.position for monitor in case.monitor]
    places += [corner for load in case.load if load.region for corner in (load.region[:2], load.region[2:])]
    low, high = np.array(box[:2]), np.array(box[2:])
    brick, margin = np.array(case.packing.brick_size), case.packing.radius
    lower, upper = np.min([low, *np.subtract(places, margin)], axis=0), np.max([high, *np.add(places, margin)], axis=0)
    low = np.maximum(low - brick * np.ceil((low - lower) / brick - ROUNDING), case.box[:2])
    high = np.minimum(high + brick * np.ceil((upper - high) / brick - ROUNDING), case.box[2:])
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _size(box: Box) -> str:
    """Width and height in words."""
    return f"{box[2] - box[0]:g} m × {box[3] - box[1]:g} m"
