"""Scenes of disks with more bricks beyond their sides, and pairs of scenes, one of them enlarged."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np

from dembound.accuracy.judge import Extended, movable, must_not_exceed, same_step, sentence_of
from dembound.accuracy.of_disks.coarser import Coarser, coarser, largest_diameter
from dembound.boundaries.edge import SIDES, is_far, normal_axis, plane_of
from dembound.casefile.disks.load import Load, Monitor
from dembound.casefile.disks.model import DiskCase
from dembound.continuum import sizing
from dembound.disks.material.packing_waves import front_of, slowest_speed
from dembound.disks.scene import DiskScene, build
from dembound.disks.sources import sources_of
from dembound.disks.stability import choose_step
from dembound.disks.supports import forces_of
from dembound.disks.surroundings.near_fields import signals_of
from dembound.errors import CaseError
from dembound.formulas.disks.reflections import Reflections
from dembound.holes.hole import Hole
from dembound.holes.rectangle import Rectangle
from dembound.motion.endings import monitored
from dembound.motion.paths import Front, Source, plane_needed
from dembound.packings.base import Packing
from dembound.packings.tiling import count_disks, disks_around
from dembound.places import EQUAL, nearest
from dembound.table import Box

T = TypeVar("T", Load, Monitor)

AROUND = 65
"""Places along each side of a scene without monitors."""


def extended_disks(case: DiskCase, most: int) -> Extended:
    """A scene of disks with more bricks; parameters and errors as of `accuracy.extended.extended`."""
    if case.ground.size is not None:
        reason = "its disks fill a box of the ground only, and are not continued beyond"
        filled = "packing.size = [{:g}, {:g}], packing.origin = [{:g}, {:g}], no [ground]".format(*case.size, *case.box)
        instead = f"take --reference finest, or let the disks fill the ground: {filled}"
        raise CaseError([f"ground.size: the scene cannot be extended, as {reason}; {instead}"], case.name)
    if case.incident is not None:
        reason = "its wave comes through the ground beyond all sides; take --reference finest"
        raise CaseError([f"incident: the scene cannot be extended, as {reason}"], case.name)
    moving = movable(case)
    scene = build(case)
    bricks = bricks_needed(scene, moving)
    packing = _with_more(case, bricks)
    count = _particles(scene, packing.copies)
    size = "{:g} m × {:g} m".format(*packing.extent)
    must_not_exceed(count, most, size, case)
    sentence = sentence_of(case, f"the same scene {size}, {count:,} particles", moving)
    return Extended(enlarged(scene, bricks), sentence, case.packing.box)


def bricks_needed(scene: DiskScene, moving: Sequence[str]) -> dict[str, int]:
    """By side that moves, the number of bricks beyond it with which nothing returns to any monitor within the run."""
    case = scene.case
    front = front_of(scene.ground, case.run.safety)
    sources = sources_of(case, scene.ground)
    return {side: _bricks_beyond(scene, side, sources, front) for side in moving}


def enlarged(scene: DiskScene, bricks: Mapping[str, int]) -> DiskCase:
    """The case of a scene with so many more bricks beyond its sides; all places keep their coordinates.

    Monitors and loads to which a new disk would be nearer are moved to the centre of their own disk.

    Raises CaseError where a hole reaches beyond a side that moves.
    """
    case = scene.case
    if not any(bricks.values()):
        return case
    packing = _with_more(case, bricks)
    _holes_must_end(case, bricks)
    return replace(
        case,
        packing=packing,
        layer=case.layers_meeting(case.layer_planes),
        load=tuple(_at_own_disk(load, scene, packing) for load in case.load),
        monitor=tuple(_at_own_disk(monitor, scene, packing) for monitor in case.monitor),
        hole=(*case.holes, *_floors_beyond(case, packing.box)),
        ground=case.ground.level(),
        run=case.run if case.outside_sides else same_step(case.run, choose_step(scene)[0]),  # else with its own limit
        name=f"{case.name}_extended",
    )


def _with_more(case: DiskCase, bricks: Mapping[str, int]) -> Packing:
    """The packing with `bricks` more bricks beyond its sides, and its origin farther left and below."""
    (across, up), more = case.packing.copies, {side: bricks.get(side, 0) for side in SIDES}
    (left, bottom), (wide, high) = case.packing.origin, case.packing.brick_size
    larger = case.packing.with_copies(across + more["left"] + more["right"], up + more["bottom"] + more["top"])
    return larger.model_copy(update={"origin": (left - more["left"] * wide, bottom - more["bottom"] * high)})


def _at_own_disk(table: T, scene: DiskScene, larger: Packing) -> T:
    """A load or monitor at its place, or, where a new disk is nearer, at the centre of its own disk."""
    if table.position is None:
        return table
    brick, low = scene.ground.brick, np.array(larger.origin)
    own = scene.positions[forces_of(table, scene)[0]][0] if isinstance(table, Load) else scene.monitored[table.name]
    tiles, places = disks_around(brick, low, table.position)
    places = places[((tiles >= 0) & (tiles < larger.copies)).all(axis=1)].reshape(-1, 2)
    gone = [hole.takes(places, larger.span) for hole in scene.case.holes]
    there = np.vstack([own, places[~np.any(gone, axis=0)] if gone else places])
    taken = there[nearest(there, np.array([table.position]))[0]]
    if np.abs(taken - own).max() < EQUAL * brick.mean_diameter:
        return table
    return table.model_copy(update={"position": (float(own[0]), float(own[1]))})


def _bricks_beyond(scene: DiskScene, side: str, sources: list[Source], front: Front) -> int:
    """Number of bricks by which a side has to move outwards; monitors and loads in a continuum are then at disks."""
    case, axis, places = scene.case, normal_axis(side), _targets(scene)
    if side in case.column_sides:  # it moves like the ground under everything that is not local
        sources = [source for source in sources if source.is_local]
    outwards, plane = 1.0 if is_far(side) else -1.0, scene.plane(side)
    needed = plane_needed(side, sources, places, front, case.run.duration)
    ends = np.array([source.box[axis::2] for source in sources if source.is_local]).ravel()
    outermost = float(np.max(outwards * np.concatenate([places[:, axis], ends[np.isfinite(ends)]])))
    beyond = max(outwards * needed, outermost) - outwards * plane
    return max(0, int(np.ceil(beyond / case.packing.brick_size[axis] - 1e-9)))


def _targets(scene: DiskScene) -> np.ndarray:
    """Places (k, 2) m to which nothing may return: the monitors, or without monitors the border of the scene."""
    if scene.case.monitor:
        return monitored(scene)
    along, zero = np.linspace(0.0, 1.0, AROUND), np.zeros(AROUND)
    square = np.concatenate([np.column_stack([a, b]) for a, b in ((along, zero), (zero, along))])
    return scene.low + np.concatenate([square, 1.0 - square]) * scene.size


def _particles(scene: DiskScene, copies: tuple[int, int]) -> int:
    """Number of particles with other numbers of bricks, with the same holes and a column of the new height."""
    case, brick = scene.case, scene.ground.brick
    periodic = (case.side("left").is_periodic, case.side("bottom").is_periodic)
    count = scene.disk_count + count_disks(brick, copies, periodic) - count_disks(brick, case.packing.copies, periodic)
    if not scene.seams:
        return count
    new, old = (count_disks(brick, (1, up), (True, False)) for up in (copies[1], case.packing.copies[1]))
    return count + new - old


def _floors_beyond(case: DiskCase, larger: Box) -> list[Hole]:
    """The holes that go on as level floors from the sides of a case up to those of a larger box, m."""
    own = case.packing.box
    ends = {"left": (larger[0], own[0]), "right": (own[2], larger[2])}
    first = case.floors_of([hole for hole in case.holes if hole.stage == "before"])
    each = [("before", side, floor) for side, floor in first.items()]
    each += [("after", side, floor) for side, floor in case.floors.items() if first.get(side) != floor]
    found: list[Hole] = []
    for stage, side, floor in each:
        begin, end = ends[side]
        if _goes_on_level(case, side) and begin < end:
            table = {"type": "rectangle", "name": f"{stage}_{side}", "stage": stage}
            found.append(Rectangle.model_validate(table | {"corners": (begin, floor.height, end, larger[3])}))
    return found


def _goes_on_level(case: DiskCase, side: str) -> bool:
    """Whether the ground beyond a side with a floor has the height of this floor."""
    table = case.side(side)
    return table.is_outside or table.needs_column


def _holes_must_end(case: DiskCase, bricks: Mapping[str, int]) -> None:
    """Raise CaseError for holes that reach beyond a side that moves, but for level ground that goes on there."""
    said = "beyond which the case does not say how it goes on, so that the scene cannot be extended there"
    problems = [
        f"hole.{hole.name}: reaches the {side} side, {said}"
        for hole in case.holes
        for side in SIDES
        if bricks.get(side, 0)
        and reaches(hole.box, side, case.packing.box)
        and not (_goes_on_level(case, side) and (side in case.floors or case.is_above_surface(hole)))
    ]
    if problems:
        raise CaseError(problems, case.name)


def reaches(inner: Box, side: str, outer: Box) -> bool:
    """Whether a rectangle reaches a side of another one, or beyond."""
    beyond = plane_of(side, inner) - plane_of(side, outer)
    return beyond >= 0.0 if is_far(side) else beyond <= 0.0


RATIOS = (3.0, 4.0, 5.0, 6.0)
"""Diameters of the pair over those of the case that are tried, the smallest that can be afforded is taken."""

SHARE, PER_WAVE = 0.1, 7.0
"""Disks of the pair in the wave above whose frequency is a share of the energy: five in an S pulse of half a sine."""

SMALLER = (4.0, 2.0)
"""Width and height of the larger scene, over those of the case, where one without echoes cannot be afforded."""


@dataclass(frozen=True)
class Pair:
    """Two scenes with larger particles that differ in their sides.

    given : the case with larger particles; ratio : their diameter over that of the case. smaller, larger : with the
    sides of the case, and with far ones. bricks : by side, additional bricks of the larger scene; echo_free : whether
    nothing returns from there.
    """

    given: Coarser
    ratio: float
    smaller: DiskScene
    larger: DiskScene
    bricks: Mapping[str, int]
    echo_free: bool

    @cached_property
    def scenes(self) -> list[DiskScene]:
        """The scenes to run; where needed also the smaller one with whole cells at its sides, see `Coarser`."""
        whole = [build(self.given.with_whole_cells)] if self.given.weight > 0.0 else []
        return [self.smaller, self.larger, *whole]

    @property
    def step(self) -> float:
        """The smallest of their time steps, s."""
        return min(choose_step(each)[0] for each in self.scenes)

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the larger scene, m."""
        return self.larger.case.packing.extent

    @property
    def work(self) -> float:
        """Particle-steps of both runs, and of a third one where it is needed."""
        return sum(map(_work, self.scenes))


def pair_of(
    case: DiskCase, scene: DiskScene, time_step: float, most: float, reflections: Reflections | None = None
) -> Pair:
    """The pair of a case that costs at most so many particle-steps, if this is possible, else the cheapest one.

    scene, time_step (s) : of the case. reflections : of sides, measured before. Raises CaseError if no side can move.
    """
    for ratio in ratios(case, scene):
        given = coarser(case, scene, time_step, ratio * scene.ground.brick.mean_diameter, reflections)
        pair = _with_far_sides(given, ratio, most)
        if _work(pair.smaller) + _work(pair.larger) <= most:
            break
    return pair


def sides_of_pair(case: DiskCase) -> list[str]:
    """The sides whose error a pair gives: those that may be farther away and reflect."""
    return [side for side, table in case.boundary.items() if table.may_move and not table.absorber]


def ratios(case: DiskCase, scene: DiskScene) -> Sequence[float]:
    """Ratios of diameters, the smallest first, with which the pair still resolves waves and holes."""
    finest = scene.ground.brick.mean_diameter
    frequencies = [sizing.cutoff(signal, SHARE) for signal in signals_of(case)]
    highest = max((each for each in frequencies if math.isfinite(each)), default=0.0)
    shortest = slowest_speed(scene.ground) / highest / PER_WAVE if highest > 0.0 else math.inf
    largest = max(1.0, largest_diameter(case, shortest) / finest)
    return [ratio for ratio in RATIOS if ratio <= largest] or [min(largest, RATIOS[0])]


def _with_far_sides(given: Coarser, ratio: float, most: float) -> Pair:
    """The pair of a case with larger particles; its larger scene is smaller where it would cost too much."""
    smaller = build(given.case)
    bricks = bricks_needed(smaller, movable(smaller.case))
    allowed = most / (smaller.case.run.duration / choose_step(smaller)[0]) - smaller.disk_count
    copies = smaller.case.packing.copies
    for times in (math.inf, *SMALLER):
        longer = {side: (times - 1.0) * copies[normal_axis(side)] for side in bricks}
        limited = {side: count if count <= longer[side] else math.ceil(longer[side]) for side, count in bricks.items()}
        if math.prod(_with_more(smaller.case, limited).copies) <= allowed:  # a lattice of one disk in a brick
            break
    return Pair(given, ratio, smaller, build(enlarged(smaller, limited)), limited, limited == bricks)


def _work(scene: DiskScene) -> float:
    """Particle-steps of a run."""
    return scene.disk_count * scene.case.run.duration / choose_step(scene)[0]
