"""Scenes of disks with more bricks beyond their sides."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from dembound.accuracy.moved_sides import Extended, movable, must_not_exceed, same_step, sentence_of
from dembound.boundaries import SIDES, normal_axis
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import Load
from dembound.casefile.run import Run
from dembound.disks.loads import forces_of
from dembound.disks.material.wave_front import front_of
from dembound.disks.scene import DiskScene, build
from dembound.disks.sources import sources_of
from dembound.disks.stability import choose_step
from dembound.errors import CaseError
from dembound.holes import Hole, Rectangle
from dembound.motion.paths import Front, Source, plane_needed
from dembound.motion.silence import monitored
from dembound.packings import Packing
from dembound.packings.tiling import count_disks
from dembound.table import Box, shifted_box, shifted_place

AROUND = 65
"""Places along each side of a scene without monitors."""


def extended_disks(case: DiskCase, most: int) -> Extended:
    """A scene of disks with more bricks; parameters and errors as of `extended`."""
    if case.ground.size is not None:
        reason = "its disks fill a box of the ground only, and are not continued beyond"
        instead = "take --reference finest, or let the disks fill the ground: packing.size = [{:g}, {:g}], no [ground]"
        raise CaseError(
            [f"ground.size: the scene cannot be extended, as {reason}; {instead.format(*case.ground.size)}"], case.name
        )
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
    larger, inside = enlarged(scene, bricks)
    return Extended(larger, sentence, inside)


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
        run=_run_of(scene),
        name=f"{case.name}_extended",
    )
    return larger, shifted_box(inside, by)


def _run_of(scene: DiskScene) -> Run:
    """The ``[run]`` table of an enlarged scene; beside a continuum its step has a limit of its own."""
    case = scene.case
    return case.run if case.outside_sides else same_step(case.run, choose_step(scene)[0])


def _with_more(case: DiskCase, bricks: Mapping[str, int]) -> Packing:
    """The packing with so many more bricks beyond its sides."""
    (across, up), more = case.packing.copies, {side: bricks.get(side, 0) for side in SIDES}
    return case.packing.with_copies(across + more["left"] + more["right"], up + more["bottom"] + more["top"])


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
