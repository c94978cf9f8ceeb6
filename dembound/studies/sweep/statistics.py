"""Means over members that differ only in seeds, their spread, and confidence intervals."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dembound.studies.sweep.members import Member
from dembound.studies.sweep.perform import Outcome

CONFIDENCE = 0.95
"""Probability with which the interval round the mean has the true mean, if values are distributed normally."""


@dataclass(frozen=True)
class Statistic:
    """The mean of a quantity over the members of a group.

    group : keys and values that they share. count : members with this quantity. spread : standard deviation of a single
    member, √(Σ(x − mean)²/(count − 1)). interval : half the width of the confidence interval of the mean. Both are nan
    for a single member.
    """

    group: Mapping[str, Any]
    quantity: str
    count: int
    mean: float
    spread: float
    interval: float

    @property
    def ends(self) -> tuple[float, float]:
        """Lower and upper end of the confidence interval."""
        return self.mean - self.interval, self.mean + self.interval


def statistic(group: Mapping[str, Any], quantity: str, values: Sequence[float]) -> Statistic:
    """Mean, spread and confidence of values; the interval is Student's, t·spread/√count of count − 1 degrees."""
    from scipy.special import stdtrit

    count, mean = len(values), float(np.mean(values))
    if count == 1:
        return Statistic(group, quantity, count, mean, np.nan, np.nan)
    spread = float(np.std(values, ddof=1))
    t = float(stdtrit(count - 1, 0.5 + 0.5 * CONFIDENCE))
    return Statistic(group, quantity, count, mean, spread, t * spread / np.sqrt(count))


def statistics(members: Sequence[Member], outcomes: Sequence[Outcome | None]) -> Iterator[Statistic]:
    """Statistics of every group of members and every quantity, in the order of the members."""
    groups: list[tuple[Mapping[str, Any], list[Outcome]]] = []
    for member, outcome in zip(members, outcomes, strict=True):
        found = next((each for group, each in groups if group == member.group), None)
        if found is None:
            groups.append((member.group, found := []))
        if outcome is not None and not outcome.failure:
            found.append(outcome)
    for group, inside in groups:
        for quantity in quantities(inside):
            yield statistic(group, quantity, [each.values[quantity] for each in inside if quantity in each.values])


def quantities(outcomes: Sequence[Outcome | None]) -> list[str]:
    """Names of all values of these outcomes."""
    return list(dict.fromkeys(name for outcome in outcomes if outcome is not None for name in outcome.values))
