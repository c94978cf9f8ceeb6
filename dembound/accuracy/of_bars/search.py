"""The cheapest choice of nodes, steps and absorbing ends of a bar that keeps the error within a bound."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.accuracy.budget import Budget
from dembound.accuracy.choice import Choice
from dembound.accuracy.judge import no_seed
from dembound.accuracy.of_bars.causes import (
    EQUAL,
    FACTOR,
    HOW,
    QUIET,
    ExactMotion,
    difference,
    largest_motion,
    not_linear,
    split,
)
from dembound.accuracy.of_bars.options import GIVEN_ENDS, BarOption, bar_options, may_break, other_options
from dembound.accuracy.proposal import Advice, Proposal, Request, ended_earlier
from dembound.bar.layers import ENDS
from dembound.bar.scene import BarScene, build_bar
from dembound.casefile.bar.model import BarCase
from dembound.errors import CaseError
from dembound.formulas.bars.motions import AT_PLACE, BarMotions
from dembound.formulas.bars.rods import Window
from dembound.formulas.cause import Cause, Causes
from dembound.formulas.history import History, Motions
from dembound.methods.rod import Range
from dembound.results.histories import in_words

MARGIN = 2.0
"""Factor by which rules for finer nodes and other ends may be wrong: 1.31 of all pairs of choices for 40 bars with
nodes up to four times as far apart as given, 1.64 with up to 32 times (benchmarks/error_bound_bars.py --every)."""

DISPERSES = 0.95
"""Square of the Courant number, over that at which waves are not dispersed, above which the rules are not used."""

Kind = tuple[str, ...]


class Floors:
    """Lower bounds of the errors of choices."""

    def __init__(self) -> None:
        self._known: dict[Kind, list[tuple[float, float]]] = defaultdict(list)

    def add(self, choice: BarOption, error: float, without_echo: float) -> None:
        """Add a choice whose error is known; without_echo : its error before `first_echo`."""
        for kind, size in zip(_kinds(choice), (error, without_echo), strict=True):
            self._known[kind].append((choice.spacing, size))

    def of(self, choice: BarOption) -> float:
        """Lower bound of the error of a choice; 0 where no bound is known."""
        same, alike = (self._known[kind] for kind in _kinds(choice))
        finer = [error * (choice.spacing / at) ** 2 / MARGIN for at, error in same if choice.spacing <= at]
        coarser = [error for at, error in same if choice.spacing > at]
        others = [error * min(1.0, choice.spacing / at) ** 2 / MARGIN for at, error in alike]
        return max([*finer, *coarser, *others], default=0.0)


def _kinds(choice: BarOption) -> tuple[Kind, Kind]:
    """Keys of the choices that are comparable: with the same ends, and with any ends."""
    same = choice.method, f"{choice.courant:.2f}"
    return (choice.ends, *same), same


def is_regular(choice: BarOption, places: Mapping[str, float]) -> bool:
    """Whether the rules hold for finer and coarser nodes than those of a choice; places : m, by monitor."""
    scene, rod = choice.scene, choice.scene.rod
    away = max(abs(float(scene.positions[scene.monitors[name], 0]) - place) for name, place in places.items())
    return away <= AT_PLACE * rod.ranges[-1].end and all(
        (choice.step * part.speed / part.spacing) ** 2 < DISPERSES * without for part, without in _undispersed(scene)
    )


def _undispersed(scene: BarScene) -> Iterator[tuple[Range, float]]:
    """Ranges, each with the square of the Courant number ν at which waves do not disperse.

    Of shares φ_p of the stress that bonds of p spacings carry, long waves lag by (kΔx)²(Σφ_p p² − ν²)/24; Σφ_p p² is 1
    for finite differences and (m² + 1)/2 for L's bonds (L eq. 12).
    """
    bonds = scene.case.method.begin(scene.rod)
    for part in scene.rod.ranges:
        if part.cells > 2 * bonds.horizon:
            shares = np.array(bonds.shares(part))
            yield part, float(shares @ np.arange(1, len(shares) + 1) ** 2)


def first_echo(scene: BarScene) -> dict[str, float]:
    """By monitor the time (s) at which a wave may first come back from an absorbing end; infinite without one."""
    case, rod = scene.case, scene.rod
    ends = {"left": 0, "right": rod.count - 1}
    pushed = {ends[side] for side in case.driving}
    for load in case.load:
        pushed |= {0, load.nodes - 1} if load.side == "left" else {rod.count - load.nodes, rod.count - 1}
    returning = [ends[side] for side in ENDS if case.side(side).is_artificial]
    found = {}
    for name, node in scene.monitors.items():
        ways = [_time(scene, start, end) + _time(scene, end, node) for start in pushed for end in returning]
        found[name] = min(ways, default=np.inf)
    return found


def _time(scene: BarScene, first: int, last: int) -> float:
    """Travel time (s) of waves from one node to another."""
    low, high = sorted((first, last))
    return sum(
        max(0, min(high, part.last) - max(low, part.first)) * part.spacing / part.speed for part in scene.rod.ranges
    )


COSTLIEST = 64.0
"""Cost up to which choices are tried, over that of the given case: an eighth of the spacing."""

BETWEEN = 4
"""Times in a step at which it is looked whether the motion is seen between its steps."""

ALONG = "; its nodes and method remain, as it may break, and the error is that before bonds change"
"""What is said of a bar that may break."""


def advice_for_bar(case: BarCase, asked: Request) -> Advice:
    """The errors of a bar, and for every bound the cheapest choice that keeps it, or else the most accurate choice.

    asked : by default of steps as long as `COSTLIEST`; more than one seed is refused.

    Raises CaseError for a bar whose errors are not known, one that does not move at its monitors, and where no choice
    keeps the values of `kept`; the errors of building a scene.
    """
    if refused := not_linear(case):
        raise CaseError([f"advise: nothing is known of {line}" for line in refused], case.name)
    own = given_motion(case)
    if not own.moves:
        raise CaseError(["advise: nothing moves at the monitors"], case.name)
    given = Proposal(Choice("the case as it is", {}, case), own.choice.cost, own.budget)
    if asked.seeds > 1:
        raise no_seed(case)
    asked.watch.given(given)
    kept = asked.kept
    motions = affordable(own, bar_options(case, kept), asked.longest)
    if asked.bounds and not motions:
        raise CaseError(["advise: no choice keeps the values of --keep, --set and --longest"], case.name)
    best, tried = {}, 0
    for bound in asked.bounds:
        motion, count = cheapest(motions, bound)
        tried += count
        words = motion.choice.words
        if may_break(case):
            words += ALONG + (_otherwise(own, bound, kept, asked.longest) if not motion.holds(bound) else "")
        found = Proposal(Choice.of(case, motion.choice.case(case), words), motion.choice.cost, motion.budget)
        best[bound] = found if may_break(case) else ended_earlier(found, case, bound, motion.recorded, kept)
        asked.watch.best(bound, best[bound])
    return Advice(given, best, tried)


def given_motion(case: BarCase) -> Motion:
    """The motion of a case as it is; raises the errors of building its scene."""
    exact = ExactMotion(build_bar(case))
    return Motion(next(each for each in bar_options(case, ()) if not each.changes), exact)


def affordable(own: Motion, options: Iterable[BarOption], longest: float | None = None) -> list[Motion]:
    """Motions of choices that take at most `longest` s, or `COSTLIEST` times the CPU time of `own`; cheapest first."""
    choices = sorted(options, key=lambda each: each.cost)
    most = COSTLIEST * own.choice.cost if longest is None else longest
    return [Motion(each, own.exact) for each in choices if each.cost <= most]


def _otherwise(own: Motion, bound: float, kept: Sequence[str], longest: float | None) -> str:
    """The cheapest finite-difference choice that keeps a bound, in words, for a bar that may break; or ""."""
    motions = affordable(own, other_options(own.choice.scene.case, kept), longest)
    best = cheapest(motions, bound)[0] if motions else None
    if best is None or not best.holds(bound):
        return ""
    words = best.choice.words.removeprefix(f"{GIVEN_ENDS}, ")
    error = in_words(best.budget.worst().share.value)
    return f"; {words}, at Courant number {best.choice.courant:.3g}, have {error}, but break otherwise"


def cheapest(motions: Sequence[Motion], bound: float) -> tuple[Motion, int]:
    """The first motion whose error is below a bound, else the most accurate, and the number of computed errors.

    Choices whose lower bounds exceed the bound are skipped.
    """
    floors, found, left = Floors(), list[Motion](), list[Motion]()
    for motion in motions:
        if FACTOR * max(floors.of(motion.choice), motion.unseen) > bound:
            left.append(motion)
            continue
        motion.add_to(floors)
        found.append(motion)
        if motion.holds(bound):
            return motion, len(found)
    best = min(found, key=lambda each: each.error)
    for motion in reversed(left):  # finer nodes first
        if max(floors.of(motion.choice), motion.unseen) < best.error:
            motion.add_to(floors)
            found.append(motion)
            best = min(best, motion, key=lambda each: each.error)
    return best, len(found)


@dataclass(frozen=True)
class Motion:
    """The motion of a choice compared with the exact motion."""

    choice: BarOption
    exact: ExactMotion

    def add_to(self, floors: Floors) -> None:
        """Add the error to the lower bounds, where their rules hold."""
        if is_regular(self.choice, self.exact.places):
            counted, echo = self._surely_counted, first_echo(self.choice.scene)
            floors.add(self.choice, self._error_of(counted), self._error_of(counted, echo))

    @cached_property
    def unseen(self) -> float:
        """Error by motion between the steps of the choice, where they are longer than those of the case, RMS over RMS.

        The difference between the exact motion and the cubic spline through its values at the steps: a pulse of a few
        samples may be exact at each of them, and missed between.
        """
        if self.choice.step <= (1.0 + EQUAL) * self.exact.step:
            return 0.0
        own, between = self._exact, self.exact.at(self._motions.window.finer(BETWEEN))
        seen = {name: own[name].at(each.time).values for name, each in between.items()}
        errors = {n: {q: seen[n][q] - values for q, values in each.values.items()} for n, each in between.items()}
        return Budget(between, Causes([Cause("", HOW, errors)])).worst().share.value

    @cached_property
    def error(self) -> float:
        """The error at the worst monitor, including motion missed between steps."""
        return math.hypot(self._error_of(self.recorded), self.unseen)

    def _error_of(self, recorded: Motions, last: Mapping[str, float] | None = None) -> float:
        """The error of recorded motions; last : time (s) by monitor up to which they are compared."""
        own, exact = self._own, self._exact
        if last is not None:
            own = {
                name: replace(
                    each,
                    values={
                        q: np.where(each.time[:, None] <= last[name], values, exact[name].values[q])
                        for q, values in each.values.items()
                    },
                )
                for name, each in own.items()
            }
        return Budget(recorded, Causes([difference("all", own, exact, recorded)])).worst().share.value

    @property
    def _surely_counted(self) -> dict[str, History]:
        """The recorded monitors and quantities that count for all choices."""
        counted = self.exact.surely_counted(self._motions.window)
        return {
            name: replace(own, values={q: values for q, values in own.values.items() if q in counted[name]})
            for name, own in self.recorded.items()
        }

    def holds(self, bound: float) -> bool:
        """Whether the error is below a bound, with a reserve, directly and as the sum of causes (slower to find)."""
        return FACTOR * self.error <= bound and self.budget.worst().share.upper <= bound

    @cached_property
    def budget(self) -> Budget:
        """The error and its causes as an estimate gives them; grid and steps have opposite signs.

        It differs from `error` also by its exact motion, which is sampled in another window.
        """
        unseen = {name: dict.fromkeys(own.values, self.unseen) for name, own in self.recorded.items()}
        between = [Cause("between steps", "by the exact motion", unseen, "bound")] if self.unseen else []
        return Budget(self.recorded, Causes([*self.causes, *between]))

    @cached_property
    def causes(self) -> list[Cause]:
        """Errors by ends, nodes, steps, and monitors that are not at nodes."""
        return split(self._motions, self._own, self._motions.exact(), self.recorded)

    @property
    def moves(self) -> bool:
        """Whether anything moves at a monitor, but for rounding errors."""
        largest = largest_motion(self.choice.scene.case, self.choice.scene.case.run.duration)["velocity"]
        return any(np.abs(own.velocity).max() > QUIET * largest for own in self._exact.values())

    @cached_property
    def _motions(self) -> BarMotions:
        """The motions at all steps."""
        scene, step, steps = self.choice.scene, self.choice.step, self.choice.steps
        times = dict.fromkeys(self.exact.places, step * np.arange(steps + 1))
        return BarMotions(scene.case, scene, Window.up_to(steps * step, step), times)

    @cached_property
    def _own(self) -> Motions:
        return self._motions.own()

    @cached_property
    def _exact(self) -> Motions:
        return self.exact.at(self._motions.window)

    @cached_property
    def recorded(self) -> dict[str, History]:
        """The motion as a run records it, without the stress of end nodes, which is recorded half a spacing inside."""
        found = {}
        for name, own in self._own.items():
            at_end = self._motions.nodes[name] in (0, self.choice.scene.count - 1)
            values = {q: values for q, values in own.values.items() if q != "stress" or not at_end}
            found[name] = replace(own, place=np.array([self.exact.places[name], 0.0]), values=values)
        return found
