"""The advice for a case and one error bound, as a flat mapping, for tests."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from dembound.accuracy.choice import Choice
from dembound.accuracy.estimate import advise
from dembound.casefile import Case


class Advised(NamedTuple):
    """The best choice of a case for one bound, with its numbers."""

    given: Case
    choice: Choice
    holds: bool
    error: float
    upper: float
    by: Mapping[str, float]
    cost: float
    own_cost: float
    tried: int

    @property
    def case(self) -> Case:
        """The case of the choice."""
        return self.choice.case

    @property
    def words(self) -> str:
        """The choice in words."""
        return self.choice.name


def advised(case: Case, bound: float, kept: Sequence[str] = ()) -> Advised:
    """The best choice for a bound."""
    found = advise(case, (bound,), kept=kept)
    best, worst = found.best[bound], found.best[bound].budget.worst()
    numbers = worst.share.value, worst.share.upper, worst.by, best.cost, found.given.cost, found.tried
    return Advised(case, best.choice, best.holds(bound), *numbers)
