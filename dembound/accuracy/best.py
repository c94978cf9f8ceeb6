"""What was chosen for a case, with the error and the cost that are expected of it."""

from __future__ import annotations

from dataclasses import dataclass

from dembound.accuracy.choice import Choice
from dembound.casefile import Case


@dataclass(frozen=True)
class Best:
    """The best choice that was found for an error bound.

    given : the case. choice : with which it is to be run, without changes if nothing is better. error : expected at the
    worst monitor, RMS over RMS, by : its causes. bound : that was asked for. cost, own_cost : predicted CPU time (s) of
    the steps, and of those of the given case. tried : number of choices whose error was found. reserve : factor by
    which the error is to be below the bound, as true ones scatter about those that are expected.
    """

    given: Case
    choice: Choice
    error: float
    by: dict[str, float]
    bound: float
    cost: float
    own_cost: float
    tried: int
    reserve: float

    @property
    def holds(self) -> bool:
        """Whether it keeps the bound, with a reserve."""
        return self.reserve * self.error <= self.bound

    @property
    def case(self) -> Case:
        """The case of the choice."""
        return self.choice.case

    @property
    def words(self) -> str:
        """The choice in words."""
        return self.choice.name
