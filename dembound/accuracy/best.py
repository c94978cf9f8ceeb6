"""What was chosen for a case, with the error and the cost that are expected of it."""

from __future__ import annotations

from dataclasses import dataclass

from dembound.accuracy.differences import differences, in_toml
from dembound.casefile import Case


@dataclass(frozen=True)
class Choice:
    """What was chosen.

    given : the case. case : with which it is to be run; itself if nothing is better. words : the choice in words.
    error : expected at the worst monitor, RMS over RMS, by : its causes. bound : that was asked for. cost, own_cost :
    predicted CPU time (s) of its steps, and of the given case's. tried : number of choices whose error was found.
    reserve : factor by which the error is to be below the bound, as true ones scatter about those that are expected.
    """

    given: Case
    case: Case
    words: str
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
    def changes(self) -> list[str]:
        """Keys that are changed, a line of TOML each."""
        return in_toml(differences(self.given, self.case))
