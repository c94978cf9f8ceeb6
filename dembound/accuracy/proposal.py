"""Choices with the error and the cost that are expected of them, and those that are advised for a case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from dembound.accuracy.budget import Budget
from dembound.accuracy.choice import Choice
from dembound.casefile import Case


@dataclass(frozen=True)
class Proposal:
    """A choice for a case, without changes if it is the case itself.

    cost : predicted CPU time of its steps, s. budget : its errors, of the truth that was asked for.
    """

    choice: Choice
    cost: float
    budget: Budget

    @property
    def case(self) -> Case:
        """The case of the choice."""
        return self.choice.case

    def holds(self, bound: float) -> bool:
        """Whether its error, with all that it may be larger, is within a bound at all monitors."""
        share = self.budget.worst().share
        return share.upper <= bound and not share.at_least


@dataclass(frozen=True)
class Advice:
    """What is advised for a case.

    given : the case as it is. best : by error bound the cheapest choice that keeps it; where none does, that with the
    smallest error. tried : number of choices whose error was found. cpu_seconds : CPU time that it took, s.
    """

    given: Proposal
    best: Mapping[float, Proposal]
    tried: int
    cpu_seconds: float = 0.0
