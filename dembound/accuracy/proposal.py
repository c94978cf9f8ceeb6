"""Choices for a case with their errors and costs, who is told of them while they are found, and an earlier end.

A run may end before its duration, once its monitors are silent and no later motion counts.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.accuracy.budget import Budget, Share
from dembound.accuracy.choice import Choice
from dembound.casefile import Case
from dembound.errors import DemboundError
from dembound.formulas.cause import Cause, Causes, Truth
from dembound.formulas.history import Motions
from dembound.interrupts import look
from dembound.kinds import with_changes
from dembound.motion.endings import last_loud, silent_rule
from dembound.running import Progress, plan


@dataclass(frozen=True, repr=False)
class Proposal:
    """A choice for a case; without changes it is the case itself.

    cost : predicted CPU time of its steps, s. budget : its errors, relative to the requested truth.
    """

    choice: Choice
    cost: float
    budget: Budget

    def __repr__(self) -> str:
        return f"<{self.choice.name}, {self.cost:.2g} s of CPU time: {self.budget.worst()}>"

    @property
    def case(self) -> Case:
        """The case of the choice."""
        return self.choice.case

    def holds(self, bound: float) -> bool:
        """Whether its upper error is within a bound at all monitors."""
        return self._share.upper <= bound and not self._share.at_least

    @cached_property
    def _share(self) -> Share:
        """Its largest error, found once: of long records that takes a tenth of a second."""
        return self.budget.worst().share

    def with_causes(self, causes: Causes) -> Proposal:
        """A proposal for this choice, to whose budget causes of errors are added."""
        return replace(self, budget=replace(self.budget, causes=self.budget.causes + causes))


@dataclass(frozen=True, repr=False)
class Advice:
    """Choices advised for a case.

    given : the case as it is. best : by error bound the cheapest choice that keeps it, or else the choice with the
    smallest error. Each is a proposal with ``case``, ``cost`` (CPU seconds of its steps) and ``budget``. tried : number
    of choices whose error was computed. cpu_seconds : CPU time of the search, s.
    """

    given: Proposal
    best: Mapping[float, Proposal]
    tried: int
    cpu_seconds: float = 0.0

    def __repr__(self) -> str:
        best = (f"\n  {bound:g}: {proposal}" for bound, proposal in self.best.items())
        return f"<Advice, given: {self.given}{''.join(best)}>"


class Watch:
    """Is told what is computed; the default only obeys requests to end.

    Attributes
    ----------
    part : of the whole, such as the bound for which choices are tried; it precedes all that is done for it.
    """

    part = ""

    def begins(self, what: str) -> None:
        """Something that may take seconds begins; overriding methods call this one, which looks for requests to end."""
        look()

    def run(self, what: str) -> AbstractContextManager[Progress]:
        """The progress of a companion that begins."""
        return nullcontext(Progress())

    def says(self, words: str) -> None:
        """What is going to be computed, with its size, before it is."""

    def knows(self, causes: Sequence[Cause], motions: Motions, missing: str) -> None:
        """Causes are known, of these motions by monitor, while others are still missing, given in words."""

    def given(self, proposal: Proposal) -> None:
        """The errors of the case itself are known."""

    def best(self, bound: float, proposal: Proposal) -> None:
        """The best choice for an error bound is known; bounds come from the largest to the smallest."""


@dataclass(frozen=True)
class Request:
    """What advice is asked for.

    bounds : of errors. of : truth to which these are relative. kept : keys that do not change. longest : CPU seconds
    that the steps of a choice may take; None: the default. seeds : random packings that are run to find the scatter of
    the case's motion; 1: none. watch : told of what is done, and of what is known before all is.
    """

    bounds: Sequence[float]
    of: Truth
    kept: Sequence[str]
    longest: float | None
    seeds: int
    watch: Watch


END = "end"
"""Cause of errors: motion after the end."""

LEVEL_SHARE = 0.1
"""Level below which monitors are silent, over the error asked for, if that is above the default level."""

LEAST_SAVED = 0.1
"""Part of the duration that an earlier end must save."""

KEYS = ("run", "run.duration", "run.until", "run.silent_level", "run.silent_for")
"""Keys that, where one is kept, leave the end as it is."""


@dataclass(frozen=True)
class EarlierEnd:
    """An end before the duration.

    case : with this end. share : of the duration. lost : the error by the motion that is not recorded.
    """

    case: Case
    share: float
    lost: Cause


def ended_earlier(best: Proposal, given: Case, bound: float, motion: Motions, kept: Sequence[str]) -> Proposal:
    """A proposal with the earliest end with which it still keeps its bound; unchanged if no earlier end does.

    given : the case that the proposal is a choice for. motion : expected records of its monitors. kept : keys that do
    not change.
    """
    for end in earlier_ends(best.case, motion, bound, kept) if best.holds(bound) else []:
        words = f"{best.choice.name}, until the monitors are silent after about {end.share * given.run.duration:.3g} s"
        budget = replace(best.budget, causes=best.budget.causes + Causes([end.lost]))
        found = Proposal(Choice.of(given, end.case, words), end.share * best.cost, budget)
        if found.holds(bound):
            return found
    return best


def earlier_ends(case: Case, motion: Motions, bound: float, kept: Sequence[str]) -> list[EarlierEnd]:
    """Ends of a run with `until = "silent"`, the earliest first, without ends that save little.

    motion : expected records of its monitors, at the same times. bound : error bound. kept : keys that do not change.
    """
    if case.run.until != "duration" or any(key in KEYS for key in kept):
        return []
    default = float(type(case.run).model_fields["silent_level"].default)
    levels: dict[float, dict[str, object]] = {default: {}}
    if (level := float(f"{LEVEL_SHARE * bound:.3g}")) > default:
        levels[level] = {"run.silent_level": level}
    found = [_ended(case, motion, {"run.until": "silent", **change}) for change in levels.values()]
    return sorted(filter(None, found), key=lambda each: each.share)


def _ended(case: Case, motion: Motions, changes: Mapping[str, object]) -> EarlierEnd | None:
    """The end by one level of silence; None if it saves little, or the case cannot run."""
    try:
        changed = with_changes(case, changes)
        planned = plan(changed)
    except DemboundError:
        return None
    rule = silent_rule(planned.scene, planned.kind.sources(planned.scene))
    time = next(iter(motion.values())).time
    speeds = np.column_stack([np.abs(each.values["velocity"]).max(axis=1) for each in motion.values()])
    loud = last_loud(speeds, rule.level, np.zeros(speeds.shape[1]))
    end = max(time[loud] if loud >= 0 else 0.0, rule.earliest) + rule.hold
    if end > (1.0 - LEAST_SAVED) * case.run.duration:
        return None
    return EarlierEnd(changed, float(end / case.run.duration), _lost(motion, float(end)))


def _lost(motion: Motions, end: float) -> Cause:
    """The error by unrecorded motion after the end: minus that motion, displacement relative to the last sample."""
    errors: dict[str, dict[str, np.ndarray | float]] = {}
    for name, own in motion.items():
        late = own.time > end
        last = np.argmax(late) - 1 if late.any() else -1
        errors[name] = {
            quantity: np.where(late[:, None], (values[last] if quantity == "displacement" else 0.0) - values, 0.0)
            for quantity, values in own.values.items()
        }
    return Cause(END, "by the motion after the monitors are silent", errors, "measured")
