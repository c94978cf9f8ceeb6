"""The cheapest choice of disks and sides that keeps the error of all monitors within a bound.

Choices are tried in the order of their counted cost, first those whose errors formulas give, then cheaper ones with
companions; a choice is built only when its error is to be found. None of them is run: reflections of their sides are
found with companions of larger disks, the rest by formulas.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from dembound.accuracy.budget import Budget
from dembound.accuracy.choice import Choice, digest
from dembound.accuracy.of_disks.candidates import CUT, Candidates, option_of
from dembound.accuracy.of_disks.causes import PLACES, causes_of_choice, ground_causes, rest_causes, sides_cause
from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.of_disks.enlarged import sides_of_pair
from dembound.accuracy.of_disks.law import ElasticTwin
from dembound.accuracy.of_disks.options import Built, DiskOption
from dembound.accuracy.proposal import Proposal, Watch, ended_earlier
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError, DemboundError
from dembound.formulas.cause import SIDES, STEP, Cause, Causes, Truth
from dembound.formulas.disks.near_disks import WALL_FACTOR, wall_errors
from dembound.formulas.history import History

MORE = 1.1
"""Cost of a choice that was built, over that of the next one, from which on it waits until that has been tried: counted
costs, by which they are in order, are not nearer to it."""


@dataclass(frozen=True)
class _Found:
    """A choice with its error; budget : relative to the motion without the error."""

    built: Built
    budget: Budget

    @property
    def option(self) -> DiskOption:
        """The choice before it was built."""
        return self.built.option

    @cached_property
    def upper(self) -> float:
        """Its largest possible error; infinite where a cause is unknown."""
        share = self.budget.worst().share
        return math.inf if share.at_least else share.upper

    @property
    def motion(self) -> dict[str, History]:
        """The motion including the errors of the sides."""
        sides = [cause.parts for cause in self.budget.causes.found if cause.name == SIDES]
        return {
            name: replace(own, values={q: own.values[q] + sum(parts[name][q] for parts in sides) for q in own.values})
            for name, own in self.budget.motions.items()
        }


@dataclass
class _Tried:
    """Choices whose errors were found, those left out for part of their error, and those that take too long."""

    found: list[_Found] = field(default_factory=list)
    left: list[DiskOption | Built] = field(default_factory=list)
    too_long: list[DiskOption | Built] = field(default_factory=list)


@dataclass
class Search:
    """The search for a choice.

    candidates : choices by cost. watch : told of what is done. tried : number of choices whose error was found.
    was_cut : whether choices were left out for lack of time. of_sides : by arrangement and distance the largest error
    of its sides. of_disks : by factors of diameter and step, with a continuum and without, the smallest error of disks.
    known : choices whose error was found for another bound, by the digest of their case.
    """

    companions: Companions
    candidates: Candidates
    of: Truth
    kept: Sequence[str]
    watch: Watch
    bound: float = 0.0
    tried: int = 0
    was_cut: bool = False
    of_sides: dict[tuple[str, float], float] = field(default_factory=dict)
    of_disks: dict[tuple[float, float, bool], float] = field(default_factory=dict)
    known: dict[str, list[_Found]] = field(default_factory=dict)
    _walls: dict[tuple[str, float], float] = field(default_factory=dict, init=False, repr=False)

    @property
    def twin(self) -> ElasticTwin | None:
        """The case under the elastic law, if that replaces its own."""
        return self.candidates.twin

    def proposal(self, given: DiskCase, bound: float) -> Proposal:
        """The best choice for a bound; given : the case that it is a choice for."""
        self.bound, self.was_cut = bound, False
        self.candidates.begin(bound)
        best = self.best()
        words = best.option.words if self.twin is None else f"{self.twin.words}; {best.option.words}"
        words += (until := before_breaks(self.companions))
        if self.was_cut and best.upper > bound:
            words += CUT
        found = Proposal(Choice.of(given, best.built.case, words), best.built.cost, best.budget)
        return found if until else ended_earlier(found, given, bound, best.motion, self.kept)

    def know(self, given: Budget) -> None:
        """Take over the errors of the given case: of its sides, nearly equal for all disk sizes, and of its disks.

        Errors of disks, without those by places of monitors, which vary, grow at least with the diameter.
        """
        sides = Causes([cause for cause in given.causes.found if cause.name == SIDES])
        if sides.found:
            upper = Budget(given.motions, sides, self.of).worst().share.upper
            self.of_sides[_sides(self.candidates.options.own)] = upper
        disks = Causes([cause for cause in given.causes.found if cause.of_disks and cause.name != PLACES])
        if disks.found and not disks.unknown:
            self.candidates.of_given_disks = Budget(given.motions, disks, self.of).worst().share.upper

    def best(self) -> _Found:
        """The cheapest choice that keeps the bound, or else the one with the smallest error.

        Choices whose errors are known by formulas are tried first, then cheaper ones with companions of their own.
        """
        tried, most = _Tried(), math.inf
        for with_companions in (False, True):
            most = self._cheapest(with_companions, most, tried)
        if math.isfinite(most):
            return min((each for each in tried.found if self._keeps(each.upper)), key=lambda each: each.built.cost)
        return self._most_accurate(tried.found, tried.left, tried.too_long)

    def _cheapest(self, with_companions: bool, most: float, tried: _Tried) -> float:
        """Cost of the first choice, with or without companions, that keeps the bound; `most` if all cost more.

        All choices that were tried are added to `tried`.
        """
        self.candidates.waiting = []
        for item in self.candidates.by_cost():
            option = option_of(item)
            if item.cost >= most:
                break
            if bool(sides_of_pair(option.case)) is not with_companions:
                continue
            if not self.candidates.affords(item):
                tried.too_long.append(item)
                continue
            if with_companions and self._keeps(self._alone(item)):
                self._know_sides(option)
            if not self._keeps(self._alone(item)):
                tried.left.append(item)
                continue
            if (built := self.candidates.built(item)) is None:
                continue
            if built is not item and self.candidates.waiting and built.cost > MORE * self.candidates.waiting[0][0]:
                self.candidates.wait(built.cost, built)
                continue
            tried.found += self._with_error(built, tried.left)
            if tried.found and self._keeps(tried.found[-1].upper):
                return built.cost
        return most

    def _most_accurate(
        self, found: list[_Found], left: list[DiskOption | Built], too_long: list[DiskOption | Built]
    ) -> _Found:
        """The choice with the smallest error of those found and those left out, where none keeps the bound.

        Choices left out are tried in the order of the error that is known for their sides or disks, as long as that is
        below the smallest error found. Choices that take too long come last, the cheapest first, where there is no
        other.
        """
        while left:
            left.sort(key=self._alone)
            item = left.pop(0)
            if found and self._alone(item) >= min(each.upper for each in found):
                break
            if not self.candidates.affords(item):
                too_long.append(item)
            elif (built := self.candidates.built(item)) is not None:
                found += self._with_error(built, None)
        self.was_cut = bool(too_long) or self.candidates.was_cut
        for item in sorted(too_long, key=lambda each: each.cost):
            if not found and (built := self.candidates.built(item)) is not None:
                found += self._with_error(built, None)
        if not found:
            said = "advise: no choice keeps the values of --keep, --set and --longest"
            raise CaseError([said], self.companions.case.name)
        return min(found, key=lambda each: each.upper)

    def _alone(self, item: DiskOption | Built) -> float:
        """The largest known single error of a choice: of its sides, its disks, or walls."""
        option = option_of(item)
        walls = self._walls_of(option) if self.of == "rock" else 0.0
        return max(self.of_sides.get(_sides(option), 0.0), self.of_disks.get(_disks(option), 0.0), walls)

    def _walls_of(self, option: DiskOption) -> float:
        """The largest error by walls of holes, found once: choices are sorted by it again and again."""
        case, key = option.case, (option.arrangement, option.factor)
        if key not in self._walls:
            ground, diameter = self.companions.scene.ground, 2.0 * case.packing.radius
            errors = [wall_errors(case, ground, diameter, np.array(monitor.position)) for monitor in case.monitor]
            self._walls[key] = WALL_FACTOR * max((size for each in errors for size in each.values()), default=0.0)
        return self._walls[key]

    def _keeps(self, error: float) -> bool:
        """Whether an error is within the bound."""
        return error <= self.bound

    def _know_sides(self, option: DiskOption) -> None:
        """Find the error of a choice's sides with smaller disks from the given disks, which are quicker to build."""
        if _sides(option) in self.of_sides or option.factor >= 1.0:
            return
        given = (each for each in self.candidates.of(1.0) if _sides(each) == _sides(option) and each.shorter == 1.0)
        same = next(given, None)
        if same is None or not self.candidates.affords(same) or (built := self.candidates.built(same)) is None:
            return
        scene = built.planned.scene
        self.candidates.spent += self.candidates.per_error
        with suppress(DemboundError):
            cause = sides_cause(self.companions, scene, built.planned.time_step, option.wider)
            self._note_sides(option, [cause], scene)

    def _note_sides(self, option: DiskOption, causes: Sequence[Cause], scene: DiskScene) -> None:
        """Store the error of the sides of a choice from its causes."""
        sides = Causes([cause for cause in causes if cause.name == SIDES])
        alone = Budget(self.companions.recorded(scene), sides, self.of).worst().share.upper
        self.of_sides[_sides(option)] = max(alone, self.of_sides.get(_sides(option), 0.0))

    def _with_error(self, built: Built, left: list[DiskOption | Built] | None) -> list[_Found]:
        """A choice with its error; empty if a companion of it cannot run.

        left : list to which the choice is added, without running companions, if the error of its disks is too large;
        None: companions are always run.
        """
        if (known := self.known.get(key := digest(built.case))) is not None:
            return known
        self.watch.begins(f"choice {self.tried + 1}, {built.option.words}")
        option, scene, step = built.option, built.planned.scene, built.planned.time_step
        motions = self.companions.recorded(scene)
        try:
            ground = ground_causes(self.companions, scene, step)
            of_disks = Causes([cause for cause in ground if cause.of_disks or cause.name == STEP])
            error = Budget(motions, of_disks, self.of).worst().share.upper
            self.of_disks[_disks(option)] = min(error, self.of_disks.get(_disks(option), error))
            if left is not None and not self._keeps(error):
                left.append(built)
                return []
            self.tried += 1
            self.candidates.spent += self.candidates.per_error
            causes = causes_of_choice(self.companions, scene, step, option.wider, ground)
            causes += rest_causes(self.companions, scene)
        except DemboundError:
            return []
        self._note_sides(option, causes.found, scene)
        law = [] if self.twin is None else self.twin.causes(scene, motions)
        self.known[key] = [_Found(built, Budget(motions, causes + Causes(law), self.of))]
        return self.known[key]


def _sides(option: DiskOption) -> tuple[str, float]:
    """Key of the sides of a choice: arrangement, and how much farther away they are."""
    return option.arrangement, option.wider


def _disks(option: DiskOption) -> tuple[float, float, bool]:
    """Key of the disks of a choice: diameter and time step over those given, and whether they are in a continuum."""
    return option.factor, option.shorter, bool(option.case.outside_sides)


def before_breaks(companions: Companions) -> str:
    """Words that errors hold before bonds break; empty if none breaks."""
    breaks = companions.first_break
    if breaks >= companions.case.run.duration:
        return ""
    return f"; the error is that before bonds break, after about {breaks:.3g} s"
