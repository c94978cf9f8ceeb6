"""Arrangements of sides that stand in for the ground beyond a scene, and boxes of disks with a continuum round them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from dembound.accuracy.choice import Choice, changed
from dembound.accuracy.of_disks.enlarged import reaches
from dembound.boundaries.boundary import Boundary
from dembound.boundaries.edge import SIDES
from dembound.casefile.disks.model import DiskCase
from dembound.continuum import sizing
from dembound.continuum.interpolation import NearField
from dembound.continuum.sizing import GridSizes
from dembound.disks import step_cost
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.scene import DiskScene
from dembound.disks.surroundings.edges import BAND as FLOOR
from dembound.disks.surroundings.elements import mesh_of
from dembound.disks.surroundings.media import medium_of
from dembound.disks.surroundings.near_fields import extents, signals_of
from dembound.disks.surroundings.settings import expected_tops, least_element, settings_of
from dembound.errors import CaseError
from dembound.table import Box

WORTH = 0.8
"""Part of a scene's cost above which a box is no gain."""

NEARER = (1.0, 0.7, 0.5, 0.35, 0.25)
"""Parts of the distance that elements as large as waves allow need from loads; nearer ones are smaller."""

BAND = 4.0
"""Least distance of holes and loads from the sides of a box, in diameters: cracks near ties are not followed."""


class BoxOfDisks(NamedTuple):
    """A box: rectangle (m), numbers of its disks, of column disks and of nodes, and nanoseconds of a step."""

    box: Box
    disks: int
    nodes: int
    cost: float


def changes_to_box(case: DiskCase, box: Box) -> dict[str, Any]:
    """Changed keys of a case with disks in a box (m) only."""
    left, bottom, right, top = box
    size, origin = ([round(length, 10) for length in each] for each in ((right - left, top - bottom), (left, bottom)))
    outside = {f"boundary.{side}": continuum_beyond(case.side(side)) for side in _sides_beyond(case, box)}
    kept = {key: value for key, value in case.packing.given().items() if key != "bricks"}
    whole = {"ground.size": list(case.size)} | ({"ground.origin": list(case.box[:2])} if any(case.box[:2]) else {})
    return {**whole, "packing": kept | {"size": size, "origin": origin}, **outside}


def _sides_beyond(case: DiskCase, box: Box) -> Sequence[str]:
    """The sides of a box (m) beyond which a continuum goes on, with the top if the box is below the surface."""
    return SIDES if box[3] < case.box[3] else SIDES[:3]


def continuum_beyond(table: Boundary) -> dict[str, Any]:
    """The table of a side with a continuum beyond it, through which the waves of the given side enter."""
    return {"type": "outside"} | {f"wave_{motion}": name for motion, name in table.waves.items()}


def cheapest_box(scene: DiskScene) -> BoxOfDisks | None:
    """The cheapest box of disks in place of a scene that `may_be_boxed`; None if it would gain little."""
    best = min(boxes(scene), key=lambda each: each.cost, default=None)
    return None if best is None or best.cost > WORTH * _cost(scene) else best


def _cost(scene: DiskScene) -> float:
    """Nanoseconds of a step of a scene, without forces of an oblique wave, which boxes need as well."""
    return sum(cost for part, cost in step_cost.times_of_scene(scene).items() if part != "incident wave")


def may_be_boxed(case: DiskCase) -> bool:
    """Whether all sources but waves from below are in one place, and the ground could go on beyond it."""
    plain = not any(case.periodic) and not case.motion.held
    beyond = all(case.side(side).is_artificial for side in ("left", "right", "bottom"))
    at_top = case.side("top").is_free or case.side("top").is_outside
    from_below = not any(case.side(side).waves for side in ("left", "right", "top"))
    has_sources = bool(signals_of(case)) and any(True for _ in extents(case))
    return plain and _ends_level(case) and beyond and at_top and from_below and has_sources


def _ends_level(case: DiskCase) -> bool:
    """Whether holes end within the sides, or as level floors at them, with no body-wide loads."""
    box = case.packing.box
    reached = {side for hole in case.holes for side in ("left", "right") if reaches(hole.box, side, box)}
    if not reached:
        return True
    wide = FLOOR * 2.0 * case.packing.radius
    is_level = all(side in case.floors and case.floors[side].width >= wide for side in reached)
    return is_level and not case.entering and not any(load.is_everywhere for load in case.load) and case.static is None


def boxes(scene: DiskScene) -> Iterator[BoxOfDisks]:
    """Boxes of disks with elements of different sizes round them, for a scene that `may_be_boxed`."""
    for box in rectangles(scene.case, scene.ground):
        try:
            yield _with_continuum(scene, box)
        except CaseError:  # no mesh
            continue


def rectangles(case: DiskCase, ground: PackedMaterial) -> Iterator[Box]:
    """Boxes (m) of disks of a ground for a case that `may_be_boxed`, for different sizes of elements."""
    diameter, order, accuracy = ground.brick.mean_diameter, case.outside.order, case.outside.accuracy
    side = sizing.element_size(signals_of(case), medium_of(ground), order, accuracy)
    beside_a_force = NearField((0.0, 0.0, 0.0, 0.0), 1.0, "force").largest_side(order, accuracy)
    widest = max(side, least_element(case, diameter)) / beside_a_force
    for part in NEARER:
        box = _round(case, max(part * widest, BAND * diameter), diameter)
        if box[0] < box[2] and box[1] < box[3]:  # else all that makes waves is on the continuum
            yield box


def _round(case: DiskCase, clearance: float, diameter: float) -> Box:
    """The box of whole bricks (m) with a clearance (m) from holes and loads, up to the surface if it is near."""
    brick = np.array(case.packing.brick_size)
    lows, highs = (np.array(corners) for corners in zip(*extents(case), strict=True))
    ground, origin = np.array(case.box), np.array([case.packing.origin[0], case.box[1]])
    least = least_element(case, diameter)
    lowest = lows.min(axis=0) - clearance
    lowest[1] = min([lowest[1], *(floor.height - least for floor in case.floors.values())])
    low = origin + brick * np.floor((lowest - origin) / brick)
    high = origin + brick * np.ceil((highs.max(axis=0) + clearance - origin) / brick)
    low, high = np.maximum(low, ground[:2]), np.minimum(high, ground[2:])
    if ground[3] - high[1] < max(least, clearance):
        high[1] = ground[3]
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _with_continuum(scene: DiskScene, box: Box) -> BoxOfDisks:
    """A box with its counts and cost, including continuum and column."""
    case, ground = scene.case, scene.ground
    sides = _sides_beyond(case, box)
    settings = settings_of(case, medium_of(ground), ground.brick.mean_diameter, box, sides)
    surface, tops = (case.box[3], None) if "top" in sides else (None, expected_tops(case, box))
    grid = GridSizes.of(mesh_of(settings, box, sides, surface=surface, tops=tops))
    first = scene.column_count
    places = scene.assembly.positions[first:]
    inside = int(np.count_nonzero(((places >= box[:2]) & (places <= box[2:])).all(axis=1)))
    moved = any(table.waves for table in case.boundary.values()) or case.static is not None
    column = moved * len(ground.brick.radii) * math.ceil(case.size[1] / case.packing.brick_size[1])
    ties = int(2.0 * (box[2] - box[0] + box[3] - box[1]) / ground.brick.mean_diameter)
    beyond = step_cost.times_of_continuum(grid.nodes, grid.nodes * grid.absorbing / grid.elements, ties)
    cost = step_cost.time_per_disk(scene) * (inside + column) + sum(beyond.values())
    return BoxOfDisks(box, inside + column, grid.nodes, cost)


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
    accuracies: dict[str, dict[str, Any]] = {"": {}}
    if (coarse := CONTINUUM_SHARE * bound) > case.outside.accuracy:
        accuracies["coarse "] = {"outside.accuracy": coarse}
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
        changes = {**changes_to_box(case, box), **accuracy}
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
