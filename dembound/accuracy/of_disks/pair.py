"""A pair of runs with larger particles, with the sides of the case and with sides so far away that nothing returns."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from dembound.accuracy.history import History, Motions
from dembound.accuracy.moved_sides import movable
from dembound.accuracy.of_disks.coarser import Coarser, coarser, largest_diameter
from dembound.accuracy.of_disks.extended import bricks_needed, enlarged
from dembound.accuracy.runner import Runner, at_step
from dembound.boundaries import normal_axis
from dembound.casefile.disks import DiskCase
from dembound.disks.beyond.settings import signals_of
from dembound.disks.material.wave_front import slowest_speed
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.errors import CaseError
from dembound.outside import choice

RATIOS = (3.0, 4.0, 5.0, 6.0)
"""Diameters of the pair over those of the case that are tried, the smallest that can be afforded is taken."""

SHARE, PER_WAVE = 0.1, 7.0
"""Disks of the pair in the wave above whose frequency is a share of the energy: five in an S pulse of half a sine."""

SMALLER = (4.0, 2.0)
"""Width and height of the larger scene, over those of the case, where one without echoes cannot be afforded."""

LEEWAY = 1.5
"""Work of the cheapest pair over what may be spent, from which on none is run."""


@dataclass(frozen=True)
class Pair:
    """Two runs that differ in their sides.

    own, far : their histories; ratio : their diameter over that of the case. size : width and height (m) of the larger
    scene. echo_free : whether nothing returns from its sides. work : particle-steps of all runs. whole, weight : if it
    matters, histories of a third run, as own with whole cells at its sides, and its weight, see `Coarser`.
    """

    own: Motions
    far: Motions
    ratio: float
    size: tuple[float, float]
    echo_free: bool
    work: int
    whole: Motions | None = None
    weight: float = 0.0

    def difference(self, recorded: History, monitor: str, quantity: str) -> np.ndarray:
        """What the sides add to a recorded quantity (k, 2): own less far, at the times of the record."""
        own, far = self.own[monitor], self.far[monitor]
        values = own.values[quantity][:, :2] - far.values[quantity][:, :2]
        if self.whole is not None:
            values += self.weight * (self.whole[monitor].values[quantity] - own.values[quantity])[:, :2]
        return History(own.place, own.time, {quantity: values}).at(recorded.time).values[quantity]


def run_pair(case: DiskCase, scene: DiskScene, time_step: float, most: float, runner: Runner) -> Pair:
    """The pair of a case that costs at most so many particle-steps, if this is possible; else the cheapest one.

    scene, time_step (s) : of the case. Raises CaseError if no side can move, or even the cheapest pair costs too much,
    and the errors of runs.
    """
    pair = scenes_of_pair(case, scene, time_step, most)
    if (times := sum(map(_work, pair.scenes)) / most) > LEEWAY:
        raise CaseError([f"a pair of runs would take {times:.2g} times the work that may be spent (--budget)"])
    step = pair.step
    own, far, *whole = (runner.run(at_step(each.case, step)) for each in pair.scenes)
    return Pair(
        own.motions,
        far.motions,
        pair.ratio,
        pair.larger.case.packing.extent,
        pair.echo_free,
        own.work + far.work + sum(each.work for each in whole),
        whole[0].motions if whole else None,
        pair.weight,
    )


@dataclass(frozen=True)
class PairScenes:
    """The scenes of a pair before their runs, see `Pair`.

    smaller, larger : with the sides of the case, and far ones. bricks : that the larger one has more beyond its sides.
    whole : with whole cells at the sides, if it is run.
    """

    smaller: DiskScene
    larger: DiskScene
    bricks: Mapping[str, int]
    whole: DiskScene | None
    weight: float
    ratio: float
    echo_free: bool

    @property
    def scenes(self) -> list[DiskScene]:
        """The scenes that are run."""
        return [self.smaller, self.larger, *([] if self.whole is None else [self.whole])]

    @property
    def step(self) -> float:
        """The smallest of their time steps, s."""
        return min(choose_step(each)[0] for each in self.scenes)


def scenes_of_pair(case: DiskCase, scene: DiskScene, time_step: float, most: float) -> PairScenes:
    """The scenes of `run_pair`."""
    best = None
    for ratio in ratios(case, scene):
        given = coarser(case, scene, time_step, ratio * scene.ground.brick.mean_diameter)
        best = ratio, given, *_scenes(case, given, most)
        if _work(best[2]) + _work(best[3]) <= most:
            break
    assert best is not None
    ratio, given, smaller, larger, bricks, echo_free = best
    whole = build(given.with_whole_cells) if given.weight > 0.0 else None
    return PairScenes(smaller, larger, bricks, whole, given.weight, ratio, echo_free)


def sides_of_pair(case: DiskCase) -> list[str]:
    """The sides whose error a pair gives: those that may be farther away and send waves back."""
    return [side for side, table in case.boundary.items() if table.may_move and not table.absorber]


def ratios(case: DiskCase, scene: DiskScene) -> Sequence[float]:
    """Ratios of diameters, the smallest first, with which the pair still resolves waves and holes."""
    finest = scene.ground.brick.mean_diameter
    frequencies = [choice.cutoff(signal, SHARE) for signal in signals_of(case)]
    highest = max((each for each in frequencies if math.isfinite(each)), default=0.0)
    shortest = slowest_speed(scene.ground) / highest / PER_WAVE if highest > 0.0 else math.inf
    largest = max(1.0, largest_diameter(case, shortest) / finest)
    return [ratio for ratio in RATIOS if ratio <= largest] or [min(largest, RATIOS[0])]


def _scenes(case: DiskCase, given: Coarser, most: float) -> tuple[DiskScene, DiskScene, Mapping[str, int], bool]:
    """Both scenes, the bricks beyond the sides of the larger one, and whether it is free of echoes.

    It is smaller where they would cost too much.
    """
    smaller = build(given.case)
    bricks = bricks_needed(smaller, movable(smaller.case))
    steps = case.run.duration / choose_step(smaller)[0]
    allowed = most / steps - smaller.disk_count
    for times in (math.inf, *SMALLER):
        limited = {side: int(min(count, _limit(smaller.case, side, times))) for side, count in bricks.items()}
        if _count(smaller.case, limited) <= allowed:
            break
    larger, _ = enlarged(smaller, limited)
    return smaller, build(larger), limited, limited == bricks


def _limit(case: DiskCase, side: str, times: float) -> float:
    """Most bricks beyond a side of a scene that becomes that many times as long as it is."""
    axis = normal_axis(side)
    return math.inf if math.isinf(times) else math.ceil((times - 1.0) * case.packing.copies[axis])


def _count(case: DiskCase, bricks: Mapping[str, float]) -> float:
    """Number of disks of a lattice with more of them beyond its sides."""
    across, up = case.packing.copies
    across += int(bricks.get("left", 0) + bricks.get("right", 0))
    return across * (up + bricks.get("bottom", 0) + bricks.get("top", 0))


def _work(scene: DiskScene) -> float:
    """Particle-steps of a run."""
    return scene.disk_count * scene.case.run.duration / choose_step(scene)[0]
