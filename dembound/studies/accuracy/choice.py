"""The cheapest choice of disks and sides that keeps the error of all monitors within a bound.

Choices are tried in the order of their predicted cost. None of them is run: what their sides send back is found with
companions of larger disks, the rest by formulas.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import count

from dembound.casefile import Case
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError, DemboundError
from dembound.running import plan
from dembound.studies.accuracy.candidates import (
    FACTORS,
    Candidate,
    candidates,
    cost_of,
    may_change_diameter,
    with_diameter,
)
from dembound.studies.accuracy.companions import Companions
from dembound.studies.accuracy.differences import differences, in_toml, value_at
from dembound.studies.accuracy.expected import Expected, expected, of_ground, of_sides

SAFETY = 1.4
"""Expected errors are below the bound by this factor: true ones were up to 1.33 times as large where sides reflect
(benchmarks/error_bound.py)."""

WORK = 5e7
"""Particle-steps of the companions that are first run: less than a second."""

SHARE = 0.1
"""Their share of the given case's work, if this is more."""

COSTLIEST = 64.0
"""Cost up to which choices are tried, over that of the given case: disks of a quarter of the diameter."""


@dataclass(frozen=True)
class Choice:
    """What was chosen.

    given : the case. case : with which it is to be run; itself if nothing is better. words : the choice in words.
    error : expected at the worst monitor, RMS over RMS, by : its causes. bound : that was asked for. cost, own_cost :
    predicted CPU time (s) of its steps, and of the given case's. tried : number of choices whose error was found.
    """

    given: DiskCase
    case: DiskCase
    words: str
    error: float
    by: dict[str, float]
    bound: float
    cost: float
    own_cost: float
    tried: int

    @property
    def holds(self) -> bool:
        """Whether it keeps the bound, with a reserve."""
        return SAFETY * self.error <= self.bound

    @property
    def changes(self) -> list[str]:
        """Keys that are changed, a line of TOML each."""
        return in_toml(differences(self.given, self.case))


def choose(case: Case, bound: float, kept: Sequence[str] = ()) -> Choice:
    """The cheapest choice whose errors of velocity and displacement are within a bound at all monitors.

    If there is none, that with the smallest error. A bound is RMS over RMS, such as 0.01. kept : dotted keys whose
    values remain as given, such as ``packing.radius`` or ``boundary``. Monitors that hardly move do not count.

    Raises CaseError for bars, cases without monitors or without waves, a bound that is none and unknown keys; the
    errors of building and running the companions.
    """
    disks = _usable(case, bound)
    for key in kept:
        value_at(disks, key)
    planned = plan(disks)
    companions = Companions(disks, planned.scene, planned.time_step, 0.0)  # type: ignore[arg-type]
    companions.most = max(WORK, SHARE * planned.scene.count * planned.steps)
    search = _Search(companions, bound, kept, cost_of(planned))
    best, error = search.best()
    return Choice(disks, best.case, best.words, error.worst, error.by, bound, best.cost, search.own_cost, search.tried)


def _usable(case: Case, bound: float) -> DiskCase:
    """The case, if its error can be bounded."""
    if not 0.0 < bound < 1.0:
        raise CaseError([f"--error: is {bound:g}, must be above 0 and below 1, such as 1% or 0.01"])
    if not isinstance(case, DiskCase):
        raise CaseError(["--error: is for cases of disks, this one is a bar's"], case.name)
    if not case.monitor:
        raise CaseError(["--error: needs a monitor, at which the error is bounded"], case.name)
    return case


@dataclass
class _Search:
    """The search for a choice.

    too_much : arrangements and distances whose sides alone reflect more than the bound. too_large : factors of
    diameters whose disks alone have larger errors than the bound, with these errors.
    """

    companions: Companions
    bound: float
    kept: Sequence[str]
    own_cost: float
    tried: int = 0
    too_much: set[tuple[str, float]] = field(default_factory=set)
    too_large: dict[float, float] = field(default_factory=dict)

    def best(self) -> tuple[Candidate, Expected]:
        """The cheapest choice that keeps the bound, or the one with the smallest error."""
        found: list[tuple[Candidate, Expected]] = []
        for candidate in self._by_cost():
            if (candidate.arrangement.name, candidate.wider) not in self.too_much:
                found += self._with_error(candidate)
                if found and SAFETY * found[-1][1].worst <= self.bound:
                    return found[-1]
        for factor in sorted(self.too_large, key=lambda factor: self.too_large[factor]):
            if not found:
                found = [each for candidate in self._of(factor) for each in self._with_error(candidate)]
        if not found:
            raise CaseError(["--error: no choice keeps the values of --keep and --set"], self.companions.case.name)
        return min(found, key=lambda each: each[1].worst)

    def _by_cost(self) -> Iterator[Candidate]:
        """Choices by cost; those with the next smaller disks are only made when their cost has been reached."""
        factors = list(FACTORS) if may_change_diameter(self.companions.case, self.kept) else [1.0]
        number, least = count(), 0.0
        waiting: list[tuple[float, int, Candidate | float]] = [(0.0, next(number), factors.pop(0))]
        while waiting:
            cost, _, item = heapq.heappop(waiting)
            if cost > COSTLIEST * self.own_cost:
                return
            if isinstance(item, Candidate):
                yield item
                continue
            made = self._of(item) if self._are_small_enough(item) else []
            for each in made:
                heapq.heappush(waiting, (each.cost, next(number), each))
            if made:
                least = min(each.cost for each in made)
            if factors:
                heapq.heappush(waiting, (least, next(number), factors.pop(0)))

    def _of(self, factor: float) -> list[Candidate]:
        """Choices with disks of one diameter."""
        plain = with_diameter(self.companions, factor)
        return [] if plain is None else list(candidates(self.companions, plain, factor, self.bound, self.kept))

    def _are_small_enough(self, factor: float) -> bool:
        """Whether the error of disks of one diameter leaves some of the bound to sides."""
        plain = with_diameter(self.companions, factor)
        if plain is None:
            return False
        assert isinstance(plain.scene, DiskScene)
        disks, _ = of_ground(self.companions, plain.scene, plain.time_step)
        error = expected(disks, self.companions, plain.scene).worst
        if SAFETY * error > self.bound:
            self.too_large[factor] = error
        return factor not in self.too_large

    def _with_error(self, candidate: Candidate) -> list[tuple[Candidate, Expected]]:
        """A choice with its error; nothing if a companion of it cannot run."""
        scene, step = candidate.scene, candidate.planned.time_step
        self.tried += 1
        try:
            disks, others = of_ground(self.companions, scene, step)
            sides = [of_sides(self.companions, scene, step, candidate.wider)] if _reflects(scene.case) else []
        except DemboundError:
            return []
        if SAFETY * expected(sides, self.companions, scene).worst > self.bound:
            self.too_much.add((candidate.arrangement.name, candidate.wider))
        return [(candidate, expected([*disks, *others, *sides], self.companions, scene))]


def _reflects(case: DiskCase) -> bool:
    """Whether sides reflect, so that companions are needed."""
    return any(
        table.is_artificial and not table.is_outside and side not in case.driving
        for side, table in case.boundary.items()
    )
