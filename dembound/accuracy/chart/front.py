"""The Pareto front: choices for which no other is both cheaper and more accurate, the same in every run of a chart.

Errors and work are the same to the bit in every run of a choice; its CPU time varies, on a busy machine by a quarter
and more, and laws, which cost more for the same work, differ by a factor of two and more. Two choices are therefore
compared by their CPU times only if these differ clearly, else by their work:

- In every round all choices run one after the other, and so under nearly the same load. The ratio of their costs is the
  median over the rounds of the ratios within a round.
- If it is below 1 + NOISE, or within half the range of these ratios, or if the median costs differ by less than
  LEAST_TIME, the ratio of the work is used instead, and works that differ by less than EQUAL_WORK are the same cost.
- Errors that differ by less than EQUAL are the same error, and all below ROUNDING are.

A choice is on the front unless another has the same or a smaller error at a lower cost, or a smaller error at the same
cost.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

NOISE = 0.5
"""Relative difference of two CPU times up to which work decides."""

LEAST_TIME = 1e-3
"""Difference (s) of two CPU times up to which work decides: starting a run takes as long."""

SHORTEST = 1e-9
"""Smallest CPU time (s): clocks of coarse ticks have 0 for a short run."""

EQUAL = 0.01
"""Relative difference of two errors up to which they count as equal."""

EQUAL_WORK = 0.05
"""Relative difference of two works up to which they count as equal: one more row of disks is no cost."""

ROUNDING = 1e-9
"""Relative error up to which a result is exact: what remains are rounding errors."""


@dataclass(frozen=True)
class Point:
    """A choice as a point of the chart: relative error, CPU time (s) of every round, and work."""

    error: float
    cpu: Sequence[float]
    work: int

    @property
    def level(self) -> float:
        """The error without rounding errors."""
        return max(self.error, ROUNDING)


def front(points: Sequence[Point]) -> list[int]:
    """Numbers of the points on the front, the most accurate first."""
    kept = [k for k, point in enumerate(points) if not any(_beats(other, point) for other in points)]
    return sorted(kept, key=lambda k: points[k].error)


def cost_ratio(first: Point, second: Point) -> float:
    """Cost of the first point over that of the second; 1 where they are equal within the noise."""
    rounds = min(len(first.cpu), len(second.cpu))
    ratios = np.divide(*(np.maximum(each.cpu[:rounds], SHORTEST) for each in (first, second)))
    ratio, spread = float(np.median(ratios)), 0.5 * float(np.ptp(ratios))
    apart = abs(np.median(first.cpu[:rounds]) - np.median(second.cpu[:rounds]))
    if apart > LEAST_TIME and abs(np.log(ratio)) > np.log1p(max(NOISE, spread / ratio)):
        return ratio
    ratio = first.work / second.work
    return 1.0 if abs(ratio - 1.0) < EQUAL_WORK else ratio


def _beats(other: Point, point: Point) -> bool:
    """Whether a point rules out another one."""
    ratio = cost_ratio(other, point)
    if ratio < 1.0:
        return other.level <= point.level * (1.0 + EQUAL)
    return ratio == 1.0 and other.level < point.level * (1.0 - EQUAL)


def cheapest_within(points: Sequence[Point], level: float) -> int | None:
    """Number of the cheapest point on the front with an error of at most `level`; None if all errors are larger.

    Of several at the same cost the one with the least work, then the first.
    """
    within = [k for k in front(points) if points[k].error <= level]
    if not within:
        return None
    return min(
        (k for k in within if cost_ratio(points[k], points[within[-1]]) == 1.0), key=lambda k: (points[k].work, k)
    )
