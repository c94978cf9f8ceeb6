"""Choices with their expected error and cost, and the choices advised for a case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from dembound.accuracy.budget import Budget
from dembound.accuracy.choice import Choice
from dembound.casefile import Case


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
        share = self.budget.worst().share
        return share.upper <= bound and not share.at_least


class Receiver:
    """Receives proposals as soon as they are known; the default ignores them."""

    def given(self, proposal: Proposal) -> None:
        """The errors of the case itself are known."""

    def best(self, bound: float, proposal: Proposal) -> None:
        """The best choice for an error bound is known; bounds come from the largest to the smallest."""


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
