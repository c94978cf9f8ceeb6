"""The cheapest choice of disks and sides that keeps the error of all monitors within a bound.

Choices are tried in the order of their predicted cost. None of them is run: what their sides send back is found with
companions of larger disks, the rest by formulas.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import count

import numpy as np

from dembound.accuracy.budget import Budget
from dembound.accuracy.cause import SIDES, STEP, Causes, Truth
from dembound.accuracy.choice import Choice, digest
from dembound.accuracy.end import ended_earlier
from dembound.accuracy.history import History
from dembound.accuracy.of_disks.causes import causes_of_choice, entry_notes, of_ground
from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.of_disks.law import ElasticTwin, elastic_twin
from dembound.accuracy.of_disks.options import (
    FACTORS,
    DiskOption,
    cost_of,
    disk_options,
    may_change_diameter,
    with_diameter,
)
from dembound.accuracy.proposal import Advice, Proposal
from dembound.accuracy.runner import BUDGET, SHORT, Runner
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError, DemboundError
from dembound.motion.kind import Plan
from dembound.motion.silence import monitored
from dembound.running import plan

COSTLIEST = 64.0
"""Cost up to which choices are tried, over that of the given case: disks of a quarter of the diameter."""


def advice_for_disks(case: DiskCase, bounds: Sequence[float], of: Truth, kept: Sequence[str]) -> Advice:
    """The errors of a case, and for every bound the cheapest choice that keeps it, or that with the smallest error.

    of : the truth that errors are those of; kept : keys that do not change. Raises CaseError for cases without waves
    and where no choice keeps those values; the errors of building and running the companions.
    """
    _require_known(case)
    planned: Plan[DiskScene] = plan(case)
    most = max(SHORT, BUDGET * planned.scene.count * planned.steps)
    companions = Companions(case, planned.scene, planned.time_step, most, Runner())
    moved = (own.values["velocity"] for own in companions.recorded(companions.scene).values())
    if not _is_reached(planned) or not any(map(np.any, moved)):
        raise CaseError(["advise: nothing moves at the monitors"], case.name)
    searches = [_Search(companions, of, kept, cost_of(planned))]
    if bounds and (twin := elastic_twin(case, planned, most, kept, companions.runner)) is not None:
        own = Companions(twin.case, twin.planned.scene, twin.planned.time_step, most, companions.runner)
        searches.insert(0, _Search(own, of, kept, cost_of(twin.planned), twin))
    best = {bound: _best(case, searches, bound) for bound in sorted(bounds, reverse=True)}
    return Advice(searches[-1].given(), best, sum(search.tried for search in searches))


def _best(given: DiskCase, searches: Sequence[_Search], bound: float) -> Proposal:
    """The best choice of several searches, the second one only where the first finds none."""
    found = []
    for search in searches:
        found.append(search.proposal(given, bound))
        if found[-1].holds(bound) or (search.twin is not None and search.twin.stress == 0.0):
            break
    return min(found, key=lambda each: (not each.holds(bound), each.budget.worst().share.upper))


def _require_known(case: DiskCase) -> None:
    """Raise CaseError where errors, or the body itself, depend on what is not known for other disks and sides."""
    problems = []
    if case.static is not None and case.static.from_ is not None:
        problems.append("static.from: is the body of the given disks and sides; must be left out for advice")
    if not case.driving and case.incident is None:
        reason = "starts waves everywhere, so that their delay by the disks is not known; advice needs a place"
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
    """A choice with its error; budget : beside the motion without it."""

    option: DiskOption
    budget: Budget

    @cached_property
    def upper(self) -> float:
        """The largest error that it may have; infinite where a cause is not known."""
        share = self.budget.worst().share
        return math.inf if share.at_least else share.upper

    @property
    def motion(self) -> dict[str, History]:
        """The motion with what the sides add to it."""
        sides = [cause.parts for cause in self.budget.causes.found if cause.name == SIDES]
        return {
            name: replace(own, values={q: own.values[q] + sum(parts[name][q] for parts in sides) for q in own.values})
            for name, own in self.budget.motions.items()
        }


@dataclass
class _Search:
    """The search for a choice.

    twin : the case, if its law is not that given. of_sides : by arrangement and distance the largest error of its
    sides alone. of_disks : by factor of the diameter the error of its disks alone.
    """

    companions: Companions
    of: Truth
    kept: Sequence[str]
    own_cost: float
    twin: ElasticTwin | None = None
    bound: float = 0.0
    tried: int = 0
    of_sides: dict[tuple[str, float], float] = field(default_factory=dict)
    of_disks: dict[float, float] = field(default_factory=dict)
    found: dict[str, list[_Found]] = field(default_factory=dict)

    def given(self) -> Proposal:
        """The case as it is."""
        scene, step = self.companions.scene, self.companions.time_step
        causes = causes_of_choice(self.companions, scene, step, 0.0) + Causes([], [], entry_notes(scene))
        budget = Budget(self.companions.recorded(scene), causes, self.of)
        return Proposal(Choice("the case as it is", {}, self.companions.case), self.own_cost, budget)

    def proposal(self, given: DiskCase, bound: float) -> Proposal:
        """The best choice for a bound; given : the case that it is a choice for."""
        self.bound = bound
        best = self.best()
        words = best.option.words if self.twin is None else f"{self.twin.words}; {best.option.words}"
        breaks = self.companions.first_break
        if breaks < given.run.duration:
            words += f"; the error is that before bonds break, after about {breaks:.3g} s"
        found = Proposal(Choice.of(given, best.option.case, words), best.option.cost, best.budget)
        return found if breaks < given.run.duration else ended_earlier(found, given, bound, best.motion, self.kept)

    def best(self) -> _Found:
        """The cheapest choice that keeps the bound, or the one with the smallest error."""
        found: list[_Found] = []
        left: list[DiskOption] = []
        for option in self._by_cost():
            if not self._keeps(self.of_sides.get(_sides(option), 0.0)):
                left.append(option)
                continue
            found += self._with_error(option)
            if found and self._keeps(found[-1].upper):
                return found[-1]
        return self._most_accurate(found, left)

    def _most_accurate(self, found: list[_Found], left: list[DiskOption]) -> _Found:
        """The choice with the smallest error of those found and those left out, as none keeps the bound.

        These are tried from the smallest error on that their sides or disks are known to have alone, as long as this is
        below the smallest one found.
        """
        for factor, error in self.of_disks.items():
            if not self._keeps(error):
                left += [each for each in self._of(factor) if each.cost <= COSTLIEST * self.own_cost]
        while left:
            left.sort(key=self._alone)
            if found and self._alone(left[0]) >= min(each.upper for each in found):
                break
            found += self._with_error(left.pop(0))
        if not found:
            raise CaseError(["advise: no choice keeps the values of --keep and --set"], self.companions.case.name)
        return min(found, key=lambda each: each.upper)

    def _alone(self, option: DiskOption) -> float:
        """The larger one of the errors that sides and disks of a choice are known to have alone."""
        return max(self.of_sides.get(_sides(option), 0.0), self.of_disks.get(option.factor, 0.0))

    def _keeps(self, error: float) -> bool:
        """Whether an error is within the bound."""
        return error <= self.bound

    def _by_cost(self) -> Iterator[DiskOption]:
        """Choices by cost; those with the next smaller disks are only made when their cost has been reached."""
        factors = list(FACTORS) if may_change_diameter(self.companions.case, self.kept) else [1.0]
        number, least = count(), 0.0
        waiting: list[tuple[float, int, DiskOption | float]] = [(0.0, next(number), factors.pop(0))]
        while waiting:
            cost, _, item = heapq.heappop(waiting)
            if cost > COSTLIEST * self.own_cost:
                return
            if isinstance(item, DiskOption):
                yield item
                continue
            made = self._of(item) if self._are_small_enough(item) else []
            for each in made:
                heapq.heappush(waiting, (each.cost, next(number), each))
            if made:
                least = min(each.cost for each in made)
            if factors:
                heapq.heappush(waiting, (least, next(number), factors.pop(0)))

    def _of(self, factor: float) -> list[DiskOption]:
        """Choices with disks of one diameter."""
        plain = self._with_diameter(factor)
        return [] if plain is None else list(disk_options(self.companions, plain, factor, self.bound, self.kept))

    def _with_diameter(self, factor: float) -> Plan[DiskScene] | None:
        """The case with disks of another diameter, planned; None if it may not have them."""
        own = self.companions.scene.ground.brick.mean_diameter
        may_be = self.twin is None or self.twin.holds(factor * own)
        return with_diameter(self.companions, factor) if may_be else None

    def _are_small_enough(self, factor: float) -> bool:
        """Whether the error of disks of one diameter leaves some of the bound to sides."""
        plain = self._with_diameter(factor)
        if plain is None:
            return False
        found = of_ground(self.companions, plain.scene, plain.time_step)
        disks = Causes([cause for cause in found if cause.of_disks or cause.name == STEP])
        self.of_disks[factor] = Budget(self.companions.recorded(plain.scene), disks, self.of).worst().share.upper
        return self._keeps(self.of_disks[factor])

    def _with_error(self, option: DiskOption) -> list[_Found]:
        """A choice with its error; nothing if a companion of it cannot run."""
        if (known := self.found.get(key := digest(option.case))) is not None:
            return known
        self.tried += 1
        found = self.found[key] = self._found(option)
        return found

    def _found(self, option: DiskOption) -> list[_Found]:
        """A choice with its error, if its companions can run."""
        scene = option.scene
        motions = self.companions.recorded(scene)
        try:
            causes = causes_of_choice(self.companions, scene, option.planned.time_step, option.wider)
        except DemboundError:
            return []
        sides = Causes([cause for cause in causes.found if cause.name == SIDES])
        alone = Budget(motions, sides, self.of).worst().share.upper
        self.of_sides[_sides(option)] = max(alone, self.of_sides.get(_sides(option), 0.0))
        law = [] if self.twin is None else self.twin.causes(scene, motions)
        return [_Found(option, Budget(motions, causes + Causes(law), self.of))]


def _sides(option: DiskOption) -> tuple[str, float]:
    """What the sides of a choice are, and how much farther away."""
    return option.arrangement.name, option.wider
