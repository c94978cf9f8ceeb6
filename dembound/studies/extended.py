"""A scene enlarged until nothing returns from its artificial sides: the reference for what they reflect.

Sides that stand in for the ground or rock beyond them (`Boundary.is_artificial`) move outwards by whole bricks, until
no wave can have been there and back at any monitor within the run. The disks of the case keep their places in bricks,
as all bricks are alike, and move like those of an endless scene. Driven sides, mirror planes and periodic sides stay
where they are, and free, fixed and roller sides that are not `artificial`.

Where waves enter through an artificial side it stays, too: farther away it would send another wave, as packings
disperse, or the same too late. What it reflects is then in the reference as in the case, and the sentence gives it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from dembound.bar.scene import build_bar
from dembound.bar.sources import sources_of_bar
from dembound.bar.stability import choose_step as choose_bar_step
from dembound.bar.wave_front import front_of_bar
from dembound.boundaries import SIDES, normal_axis
from dembound.casefile import Case
from dembound.casefile.bar import BarCase
from dembound.casefile.bar.bar import MOST_CELLS, Bar
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import Load
from dembound.casefile.run import Run
from dembound.disks.loads import forces_of
from dembound.disks.scene import DiskScene, build
from dembound.disks.sources import sources_of
from dembound.disks.stability import choose_step
from dembound.disks.wave_front import front_of
from dembound.errors import CaseError
from dembound.holes import Hole, Rectangle
from dembound.motion.paths import Front, Source, plane_needed
from dembound.motion.silence import monitored
from dembound.packings import Packing
from dembound.packings.tiling import count_disks
from dembound.table import Box, shifted_box, shifted_place

MOST = 8_000_000
"""Particles of the largest scene that is made unless another limit is given; its run takes some 2 GB."""

LESS = 0.95
"""Largest `run.safety` with which the step of the case is also stable in the larger scene.

There the disks of a moved side have more neighbours, and the limit of the step may be some per cent smaller. With a
larger safety the step remains "auto".
"""

AROUND = 65
"""Places along each side of a scene without monitors."""

R = TypeVar("R", bound=Run)


@dataclass(frozen=True)
class Extended:
    """An enlarged case.

    case : the enlarged case, called as the case with "_extended"; the case itself if no side has to move.
    sentence : its size, the number of its particles, and what does not return from where.
    inside : the scene of the case in it, m.
    """

    case: Case
    sentence: str
    inside: Box


def extended(case: Case, most: int = MOST) -> Extended:
    """The scene of a case enlarged so that nothing returns from artificial sides to its monitors within run.duration.

    Without monitors nothing returns to any place of the scene. Its time step is that of the case. Bars are extended
    beyond ends that are neither loaded nor driven.

    most : largest number of particles or nodes.

    Raises CaseError where no artificial side can move, where a hole reaches beyond a side that has to, and where more
    than `most` particles are needed; also the errors of building the scene.
    """
    if isinstance(case, BarCase):
        return _extended_bar(case, most)
    assert isinstance(case, DiskCase)
    return _extended_disks(case, most)


def _extended_disks(case: DiskCase, most: int) -> Extended:
    """A scene of disks with more bricks."""
    if case.ground.size is not None:
        reason = "its disks fill a box of the ground only, and are not continued beyond"
        instead = "take --reference finest, or let the disks fill the ground: packing.size = [{:g}, {:g}], no [ground]"
        raise CaseError(
            [f"ground.size: the scene cannot be extended, as {reason}; {instead.format(*case.ground.size)}"], case.name
        )
    if case.incident is not None:
        reason = "its wave comes through the ground beyond all sides; take --reference finest"
        raise CaseError([f"incident: the scene cannot be extended, as {reason}"], case.name)
    moving = _moving(case, set(case.driving))
    scene = build(case)
    bricks = bricks_needed(scene, moving)
    packing = _with_more(case, bricks)
    count = _particles(scene, packing.copies)
    size = "{:g} m × {:g} m".format(*packing.extent)
    _must_not_exceed(count, most, size, case)
    sentence = _sentence(case, f"the same scene {size}, {count:,} particles", moving)
    larger, inside = enlarged(scene, bricks)
    return Extended(larger, sentence, inside)


def movable_sides(case: DiskCase) -> list[str]:
    """The artificial sides that can move; raises CaseError if there are some, and none can."""
    return _moving(case, set(case.driving))


def bricks_needed(scene: DiskScene, moving: Sequence[str]) -> dict[str, int]:
    """By side that moves, the number of bricks beyond it with which nothing returns to any monitor within the run."""
    case = scene.case
    front = front_of(scene.ground, case.run.safety)
    sources = sources_of(case, scene.ground)
    return {side: _bricks_beyond(scene, side, sources, front) for side in moving}


def enlarged(scene: DiskScene, bricks: Mapping[str, int]) -> tuple[DiskCase, Box]:
    """The case of a scene with so many more bricks beyond its sides, and where (m) the scene lies in it.

    Raises CaseError where a hole reaches beyond a side that moves.
    """
    case = scene.case
    inside = (0.0, 0.0, *case.packing.extent)
    if not any(bricks.values()):
        return case, inside
    packing = _with_more(case, bricks)
    wide, high = case.packing.brick_size
    by = bricks.get("left", 0) * wide, bricks.get("bottom", 0) * high
    _holes_must_end(case, bricks)
    at_places = _at_places(case, scene, by, packing.extent)
    larger = replace(
        at_places,
        packing=packing,
        hole=(*at_places.hole, *_floors_beyond(case, by, packing.extent)),
        boundary={side: table.shifted(by) for side, table in case.boundary.items()},
        run=case.run
        if case.outside_sides
        else _same_step(case.run, choose_step(scene)[0]),  # ties have limits of theirs
        name=f"{case.name}_extended",
    )
    return larger, shifted_box(inside, by)


def _with_more(case: DiskCase, bricks: Mapping[str, int]) -> Packing:
    """The packing with so many more bricks beyond its sides."""
    (across, up), more = case.packing.copies, {side: bricks.get(side, 0) for side in SIDES}
    return case.packing.with_copies(across + more["left"] + more["right"], up + more["bottom"] + more["top"])


def _moving(case: Case, staying: set[str]) -> list[str]:
    """The artificial sides that can move; staying : sides where motion enters."""
    artificial = [side for side in SIDES if case.side(side).is_artificial]
    moving = [side for side in artificial if side not in staying]
    if artificial and not moving:
        raise CaseError(
            [
                f"boundary.{side}: lets motion in, so it cannot move away without changing that; no other side is "
                "artificial, and the scene cannot be extended"
                for side in artificial[:1]
            ],
            case.name,
        )
    return moving


def _bricks_beyond(scene: DiskScene, side: str, sources: list[Source], front: Front) -> int:
    """Number of bricks by which a side has to move outwards; monitors and loads in a continuum are then at disks."""
    case, axis, places = scene.case, normal_axis(side), _targets(scene)
    if side in case.column_sides:  # it moves like the ground under everything that is not local
        sources = [source for source in sources if source.is_local]
    outwards, plane = (1.0, float(scene.size[axis])) if side in ("right", "top") else (-1.0, 0.0)
    needed = plane_needed(side, sources, places, front, case.run.duration)
    ends = np.array([source.box[axis::2] for source in sources if source.is_local]).ravel()
    outermost = float(np.max(outwards * np.concatenate([places[:, axis], ends[np.isfinite(ends)]])))
    beyond = max(outwards * needed, outermost) - outwards * plane
    return max(0, int(np.ceil(beyond / case.packing.brick_size[axis] - 1e-9)))


def _targets(scene: DiskScene) -> np.ndarray:
    """Places (k, 2) m to which nothing may return: those of monitors, or without monitors all around the scene."""
    if scene.case.monitor:
        return monitored(scene)
    wide, high = scene.size
    along, zero = np.linspace(0.0, 1.0, AROUND), np.zeros(AROUND)
    square = np.concatenate([np.column_stack([a, b]) for a, b in ((along, zero), (zero, along))])
    return np.concatenate([square, 1.0 - square]) * [wide, high]


def _particles(scene: DiskScene, copies: tuple[int, int]) -> int:
    """Number of particles with other numbers of bricks, with the same holes and a column of the new height."""
    case, brick = scene.case, scene.ground.brick
    periodic = (case.side("left").is_periodic, case.side("bottom").is_periodic)
    count = scene.disk_count + count_disks(brick, copies, periodic) - count_disks(brick, case.packing.copies, periodic)
    if scene.seam is None:
        return count
    new, old = (count_disks(brick, (1, up), (True, False)) for up in (copies[1], case.packing.copies[1]))
    return count + new - old


def _must_not_exceed(count: int, most: int, size: str, case: Case) -> None:
    """Raise CaseError for a scene that is too large."""
    if count > most:
        raise CaseError(
            [
                f"run.duration: is {case.run.duration:g} s, for which nothing returns only in a scene of {size} with "
                f"{count:,} particles, more than {most:,}; take a shorter run, or coarser particles"
            ],
            case.name,
        )


def _sentence(case: Case, what: str, moving: list[str]) -> str:
    """The size of the scene, and what does not return."""
    artificial = [side for side in SIDES if case.side(side).is_artificial]
    if not artificial:
        return f"reference: {what}, none of whose sides is artificial"
    staying = [side for side in artificial if side not in moving]
    until = f"nothing returns before {case.run.duration:g} s"
    if not staying:
        return f"reference: {what}, from which {until}"
    stay, reflect = ("stay", "reflect") if len(staying) > 1 else ("stays", "reflects")
    stays = f"{what}, from whose {' and '.join(moving)} {until}; {' and '.join(staying)} {stay}, as waves enter there"
    if all(case.side(side).is_outside for side in staying):
        return f"reference: {stays}, before a continuum, which returns next to nothing"
    if all(case.side(side).layer for side in staying):
        return f"reference: {stays}, before a matched layer, which returns next to nothing"
    return f"reference: {stays}, and {reflect} as in the case"


def _floors_beyond(case: DiskCase, by: tuple[float, float], size: tuple[float, float]) -> list[Hole]:
    """The holes of a case shifted by (x, y) m that go on as level floors up to the sides of an enlarged one, m."""
    ends = {"left": (0.0, by[0]), "right": (by[0] + case.packing.extent[0], size[0])}
    first = case.floors_of([hole for hole in case.hole if hole.stage == "before"])
    each = [("before", side, floor) for side, floor in first.items()]
    each += [("after", side, floor) for side, floor in case.floors.items() if first.get(side) != floor]
    return [
        Rectangle.model_validate(
            {
                "type": "rectangle",
                "name": f"{stage}_{side}",
                "stage": stage,
                "corners": (ends[side][0], floor.height + by[1], ends[side][1], size[1]),
            }
        )
        for stage, side, floor in each
        if case.side(side).is_outside and ends[side][0] < ends[side][1]
    ]


def _holes_must_end(case: DiskCase, bricks: Mapping[str, int]) -> None:
    """Raise CaseError for holes that reach beyond a side that moves, but for level floors beside a continuum."""
    planes = dict(zip(SIDES, (0.0, case.packing.extent[0], 0.0, case.packing.extent[1]), strict=True))
    problems = [
        f"hole.{hole.name}: reaches the {side} side, beyond which the case does not say how it goes on, so that the "
        "scene cannot be extended there"
        for hole in case.hole
        for side, plane in planes.items()
        if bricks.get(side, 0)
        and _reaches(hole.box, side, plane)
        and not (side in case.floors and case.side(side).is_outside)
    ]
    if problems:
        raise CaseError(problems, case.name)


def _reaches(box: Box, side: str, plane: float) -> bool:
    """Whether a rectangle reaches a plane (m along its normal), or beyond."""
    axis = normal_axis(side)
    return box[2 + axis] >= plane if side in ("right", "top") else box[axis] <= plane


def _at_places(case: DiskCase, scene: DiskScene, by: tuple[float, float], size: tuple[float, float]) -> DiskCase:
    """The case with holes, loads and monitors shifted by (x, y) m, each exactly to its particle's place.

    size : m, of the enlarged scene, beyond which rounding must not bring them.
    """
    places = scene.monitored

    def shifted(place: np.ndarray) -> tuple[float, float]:
        x, y = shifted_place((float(place[0]), float(place[1])), by)
        return min(x, size[0]), min(y, size[1])

    def shifted_load(load: Load) -> Load:
        if load.position is not None:
            (node,), _ = forces_of(load, scene)
            return load.model_copy(update={"position": shifted(scene.positions[node])})
        if load.region is None:
            return load
        x0, y0, x1, y1 = shifted_box(load.region, by)
        return load.model_copy(update={"region": (x0, y0, min(x1, size[0]), min(y1, size[1]))})

    return replace(
        case,
        hole=tuple(hole.shifted(by) for hole in case.hole),
        load=tuple(shifted_load(load) for load in case.load),
        monitor=tuple(
            monitor.model_copy(update={"position": shifted(places[monitor.name])}) for monitor in case.monitor
        ),
    )


def _same_step(run: R, step: float) -> R:
    """The ``[run]`` table with the time step (s) of the case."""
    if run.time_step != "auto" or run.safety > LESS or getattr(run, "courant", None) is not None:
        return run
    return run.model_copy(update={"time_step": step})


def _extended_bar(case: BarCase, most: int) -> Extended:
    """A bar with more spacings."""
    scene = build_bar(case)
    bar, step = case.bar, choose_bar_step(scene)[0]
    moving = _moving(case, {*case.driving, *(load.side for load in case.load)})
    front = front_of_bar(scene, step)
    spacing = {side: bar.end(side).length / bar.end(side).cells for side in ("left", "right")}
    targets = monitored(scene) if case.monitor else scene.positions[[0, -1]]
    cells = {"left": 0, "right": 0}
    for side in moving:
        plane = bar.length if side == "right" else 0.0
        needed = plane_needed(side, sources_of_bar(case), targets, front, case.run.duration)
        beyond = needed - plane if side == "right" else plane - needed
        cells[side] = max(0, int(np.ceil(beyond / spacing[side] - 1e-9))) if np.isfinite(beyond) else 0
    count = bar.nodes - 1 + sum(cells.values())
    longer = {side: cells[side] * spacing[side] for side in cells}
    length = bar.length + sum(longer.values()) if bar.range else count * spacing["left"]
    _must_not_exceed(count + 1, min(most, MOST_CELLS), f"{length:g} m", case)
    sentence = _sentence(case, f"the same bar {length:g} m long, {count + 1:,} nodes", moving)
    if not any(cells.values()):
        return Extended(case, sentence, (0.0, 0.0, bar.length, 0.0))
    shift = longer["left"]
    monitors = tuple(
        monitor.model_copy(update={"position": min(monitor.position + shift, length)}) for monitor in case.monitor
    )
    larger = replace(
        case,
        bar=_lengthened(bar, longer, length),
        monitor=monitors,
        run=_same_step(case.run, step),
        name=f"{case.name}_extended",
    )
    return Extended(larger, sentence, (shift, 0.0, shift + bar.length, 0.0))


def _lengthened(bar: Bar, longer: Mapping[str, float], length: float) -> Bar:
    """A bar of another length (m), its end ranges longer by `longer` (m) if it has ranges."""
    ranges = list(bar.range)
    for side, index in (("left", 0), ("right", -1)):
        if ranges:
            ranges[index] = ranges[index].model_copy(update={"length": ranges[index].length + longer[side]})
    return bar.model_copy(update={"length": length, "range": tuple(ranges)} if ranges else {"length": length})
