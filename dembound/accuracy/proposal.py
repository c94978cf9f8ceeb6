"""Choices for a case, each with its error and cost, and the advice that is made of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from dembound.accuracy.budget import Budget
from dembound.accuracy.choice import Choice
from dembound.casefile.model import Case
from dembound.formulas.cause import Causes


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
