"""The cheapest choice of disks and sides that keeps the error of all monitors within a bound.

Choices are tried in the order of their counted cost, and only those are built whose error is to be found. None of them
is run: what their sides send back is found with companions of larger disks, the rest by formulas.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import count

import numpy as np

from dembound.accuracy.best import Best
from dembound.accuracy.budget import Expected, expected
from dembound.accuracy.cause import SIDES, Cause
from dembound.accuracy.choice import Choice
from dembound.accuracy.end import ended_earlier
from dembound.accuracy.history import History, Motions
from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.of_disks.cost import planned_cost
from dembound.accuracy.of_disks.expected import of_ground, of_sides
from dembound.accuracy.of_disks.law import ElasticTwin, elastic_twin
from dembound.accuracy.of_disks.near import wall_error
from dembound.accuracy.of_disks.options import Built, DiskOption, Options
from dembound.accuracy.of_disks.pair import sides_of_pair
from dembound.accuracy.runner import BUDGET, SHORT, Runner
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError, DemboundError
from dembound.motion.kind import Plan
from dembound.motion.silence import monitored
from dembound.running import plan

SAFETY = 1.4
"""Expected errors are below the bound by this factor: above 0.2 % true ones are at most 1.18 times these, below it they
were up to 2.2 times (docs/error_bound.md)."""

LONGEST, PART = 8.0, 0.2
"""CPU seconds after which a search ends, or this part of the given run if that is more, as counted: not measured, so
that it finds the same on every machine."""

PER_CHOICE, PER_DISK, PER_STEP = 0.05, 3e-6, 2e-8
"""CPU seconds of finding the error of a choice, of building it by disk, and of its companions by particle-step."""

COSTLIEST = 64.0
"""Cost up to which choices are tried, over that of the given case: disks of a quarter of the diameter."""


def best_of_disks(case: DiskCase, bound: float, kept: Sequence[str], *, short: bool = False) -> Best:
    """The cheapest choice that keeps a bound, or the one with the smallest error; kept : keys that do not change.

    short : whether the given case is taken where it keeps the bound and takes less time than the search.

    Raises CaseError for cases without waves and where no choice keeps those values; the errors of building and running
    the companions.
    """
    _require_known(case)
    planned: Plan[DiskScene] = plan(case)
    most = max(SHORT, BUDGET * planned.scene.count * planned.steps)
    runner = Runner()
    twin = elastic_twin(case, planned, most, kept, runner)
    if twin is None:
        return _best(case, planned, bound, kept, most, runner, short=short)
    found = _best(twin.case, twin.planned, bound, kept, most, runner, twin, short=short)
    own_cost = found.own_cost * planned.steps / twin.planned.steps  # steps of the given law cost as much: nothing opens
    choice = Choice.of(case, found.case, f"{twin.words}; {found.words}")
    found = replace(found, given=case, choice=choice, own_cost=own_cost)
    if found.holds or twin.stress == 0.0:
        return found
    other = _best(case, planned, bound, kept, most, runner, short=short)
    other = replace(other, cost=other.cost * own_cost / other.own_cost, own_cost=own_cost)
    return min(found, other, key=lambda each: each.error)


def _best(
    case: DiskCase,
    planned: Plan[DiskScene],
    bound: float,
    kept: Sequence[str],
    most: float,
    runner: Runner,
    twin: ElasticTwin | None = None,
    *,
    short: bool,
) -> Best:
    """The best choice under the law of a case, planned; twin : the same, if it is not that of the given case."""
    companions = Companions(case, planned.scene, planned.time_step, most, runner)
    moved = (own.values["velocity"] for own in companions.recorded(companions.scene).values())
    if not _is_reached(planned) or not any(map(np.any, moved)):
        raise CaseError(["--error: nothing moves at the monitors"], case.name)
    search = _Search(companions, Options(planned, bound, kept), bound, planned_cost(planned).seconds, twin)
    best = (search.given() if short else None) or search.best()
    words, error, cost = best.option.words, best.error, best.built.cost
    breaks = companions.first_break
    if breaks < case.run.duration:
        words += f"; the error is that before bonds break, after about {breaks:.3g} s"
    choice = Choice.of(case, best.built.case, words)
    found = Best(case, choice, error.worst, error.by, bound, cost, search.own_cost, search.tried, SAFETY)
    if breaks < case.run.duration:
        return found
    return ended_earlier(found, best.recorded, best.motion, best.causes, kept)


def _require_known(case: DiskCase) -> None:
    """Raise CaseError where errors, or the body itself, depend on what is not known for other disks and sides."""
    problems = []
    if case.static is not None and case.static.from_ is not None:
        problems.append("static.from: is the body of the given disks and sides; must be left out with --error")
    if not case.driving and case.incident is None:
        reason = "starts waves everywhere, so that their delay by the disks is not known; --error needs a place"
        problems += [
            f"load.{load.name}: {reason}" for load in case.load if load.is_everywhere and load.wave is not None
        ]
    if problems:
        raise CaseError(problems, case.name)


def _is_reached(planned: Plan[DiskScene]) -> bool:
    """Whether the fastest waves come to any monitor within the run."""
    scene, duration = planned.scene, planned.scene.case.run.duration
    front, places = planned.kind.front(scene, planned.time_step), monitored(scene)
    return any(
        float(source.distance(places).min()) <= front.reach(duration - source.start)
        for source in planned.kind.sources(scene)
    )


@dataclass(frozen=True)
class _Found:
    """A choice with its error; recorded : the motion without it, by monitor; causes : of the error."""

    built: Built
    recorded: Motions
    causes: list[Cause]

    @property
    def option(self) -> DiskOption:
        """The choice before it was built."""
        return self.built.option

    @cached_property
    def error(self) -> Expected:
        """The error of all causes."""
        return expected(self.causes, self.recorded)

    @property
    def motion(self) -> dict[str, History]:
        """The motion with what the sides add to it."""
        sides = [cause.errors for cause in self.causes if cause.name == SIDES]
        return {
            name: replace(own, values={q: own.values[q] + sum(errors[name][q] for errors in sides) for q in own.values})
            for name, own in self.recorded.items()
        }


@dataclass
class _Search:
    """The search for a choice.

    own_cost : CPU time (s) of the steps of the given case. twin : its case, if its law is not that given. tried :
    number of choices whose error was found. spent : CPU time of building choices, as counted, s. waiting : by cost,
    what may come next: diameters, their choices, and those that are built and cost more than others may. of_sides : by
    arrangement and distance the largest error of its sides alone. of_disks : by factor of the diameter, with a
    continuum and without, the smallest error of disks alone: where waves enter the continuum, disks have other places.
    """

    companions: Companions
    options: Options
    bound: float
    own_cost: float
    twin: ElasticTwin | None
    tried: int = 0
    spent: float = 0.0
    waiting: list[tuple[float, int, DiskOption | Built | float]] = field(default_factory=list)
    of_sides: dict[tuple[str, float], float] = field(default_factory=dict)
    of_disks: dict[tuple[float, bool], float] = field(default_factory=dict)

    def given(self) -> _Found | None:
        """The given case, if it keeps the bound and takes less time than a search for a cheaper one; None if not."""
        if self.own_cost > LONGEST or (built := self._built(self.options.own)) is None:
            return None
        found = self._with_error(built, [])
        return found[0] if found and self._keeps(found[0].error.worst) else None

    def best(self) -> _Found:
        """The cheapest choice that keeps the bound, or the one with the smallest error."""
        found: list[_Found] = []
        left: list[DiskOption] = []
        for item in self._by_cost():
            option = item.option if isinstance(item, Built) else item
            if not self._affords(option):
                continue
            if not self._keeps(self._alone(option)):
                left.append(option)
                continue
            built = item if isinstance(item, Built) else self._built(item)
            if built is None:
                continue
            if built is not item and self.waiting and built.cost > self.waiting[0][0]:
                self._wait(built.cost, built)
                continue
            found += self._with_error(built, left)
            if found and self._keeps(found[-1].error.worst):
                return found[-1]
        return self._most_accurate(found, left)

    def _most_accurate(self, found: list[_Found], left: list[DiskOption]) -> _Found:
        """The choice with the smallest error of those found and those left out, as none keeps the bound.

        These are tried from the smallest error on that their sides or disks are known to have alone, as long as this is
        below the smallest one found.
        """
        while left:
            left.sort(key=self._alone)
            option = left.pop(0)
            if found and self._alone(option) >= min(each.error.worst for each in found):
                break
            if found and not self._affords(option):
                continue
            if (built := self._built(option)) is not None:
                found += self._with_error(built, None)
        if not found:
            raise CaseError(["--error: no choice keeps the values of --keep and --set"], self.companions.case.name)
        return min(found, key=lambda each: each.error.worst)

    def _affords(self, option: DiskOption) -> bool:
        """Whether the search may go on with a choice, as always with the first one."""
        packing = option.case.packing
        disks = packing.about(packing.extent)
        spent = self.spent + PER_STEP * self.companions.runner.work
        return self.spent == 0.0 or spent + PER_CHOICE + PER_DISK * disks <= max(LONGEST, PART * self.own_cost)

    def _alone(self, option: DiskOption) -> float:
        """The largest one of the errors that sides, disks and walls of a choice are known to have alone."""
        case = option.case
        walls = wall_error(case, 2.0 * case.packing.radius) if case.packing.is_lattice else 0.0
        return max(self.of_sides.get(_sides(option), 0.0), self.of_disks.get(_disks(option), 0.0), walls)

    def _keeps(self, error: float) -> bool:
        """Whether an error is within the bound, with its reserve."""
        return SAFETY * error <= self.bound

    def _by_cost(self) -> Iterator[DiskOption | Built]:
        """Choices by cost; those with the next smaller disks are only counted when their cost has been reached."""
        factors, least = self.options.factors, 0.0
        self._wait(least, factors.pop(0))
        while self.waiting:
            cost, _, item = heapq.heappop(self.waiting)
            if cost > COSTLIEST * self.own_cost:
                return
            if not isinstance(item, float):
                yield item
                continue
            made = self._of(item)
            for each in made:
                self._wait(each.cost, each)
            least = min((each.cost for each in made), default=least)
            if factors:
                self._wait(least, factors.pop(0))

    def _wait(self, cost: float, item: DiskOption | Built | float) -> None:
        """Put a choice, or the choices of a diameter, where its cost is reached."""
        heapq.heappush(self.waiting, (cost, next(self._numbers), item))

    @cached_property
    def _numbers(self) -> Iterator[int]:
        """Numbers by which choices of one cost keep their order."""
        return count()

    def _built(self, option: DiskOption) -> Built | None:
        """A choice, built; None if it cannot run."""
        built = self.options.build(option)
        self.spent += PER_CHOICE + (0.0 if built is None else PER_DISK * built.planned.scene.disk_count)
        return built

    def _of(self, factor: float) -> list[DiskOption]:
        """Choices with disks of one diameter."""
        own = self.companions.scene.ground.brick.mean_diameter
        may_be = self.twin is None or self.twin.holds(factor * own)
        return self.options.of(factor) if may_be else []

    def _with_error(self, built: Built, left: list[DiskOption] | None) -> list[_Found]:
        """A choice with its error; nothing if a companion of it cannot run.

        left : where it is left, without its companions, if the error of its disks alone is too large; None: nowhere.
        """
        option, scene, step = built.option, built.planned.scene, built.planned.time_step
        recorded = self.companions.recorded(scene)
        try:
            disks, others = of_ground(self.companions, scene, step)
            error = expected(disks, recorded).worst
            self.of_disks[_disks(option)] = min(error, self.of_disks.get(_disks(option), error))
            if left is not None and not self._keeps(error):
                left.append(option)
                return []
            self.tried += 1
            sides = [of_sides(self.companions, scene, step, option.wider)] if sides_of_pair(scene.case) else []
        except DemboundError:
            return []
        alone = expected(sides, recorded).worst
        self.of_sides[_sides(option)] = max(alone, self.of_sides.get(_sides(option), 0.0))
        law = [] if self.twin is None else self.twin.causes(scene, recorded)
        return [_Found(built, recorded, [*disks, *others, *sides, *law])]


def _sides(option: DiskOption) -> tuple[str, float]:
    """What the sides of a choice are, and how much farther away."""
    return option.arrangement, option.wider


def _disks(option: DiskOption) -> tuple[float, bool]:
    """The size of the disks of a choice over that given, and whether they are in a continuum."""
    return option.factor, bool(option.case.outside_sides)
