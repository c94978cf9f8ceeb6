"""Two scenes with larger particles: with the sides of the case, and with sides so far away that nothing returns."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from dembound.accuracy.moved_sides import movable
from dembound.accuracy.of_disks.coarser import Coarser, coarser, largest_diameter
from dembound.accuracy.of_disks.extended import bricks_needed, enlarged
from dembound.boundaries import normal_axis
from dembound.casefile.disks import DiskCase
from dembound.disks.beyond.settings import signals_of
from dembound.disks.material.wave_front import slowest_speed
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.outside import sizing

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


def pair_of(case: DiskCase, scene: DiskScene, time_step: float, most: float) -> Pair:
    """The pair of a case that costs at most so many particle-steps, if this is possible, else the cheapest one.

    scene, time_step (s) : of the case. Raises CaseError if no side can move.
    """
    for ratio in ratios(case, scene):
        given = coarser(case, scene, time_step, ratio * scene.ground.brick.mean_diameter)
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
    for times in (math.inf, *SMALLER):
        limited = {side: int(min(count, _limit(smaller.case, side, times))) for side, count in bricks.items()}
        if _count(smaller.case, limited) <= allowed:
            break
    return Pair(given, ratio, smaller, build(enlarged(smaller, limited)), limited, limited == bricks)


def _limit(case: DiskCase, side: str, times: float) -> float:
    """Most bricks beyond a side with which the scene becomes `times` times as long."""
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
