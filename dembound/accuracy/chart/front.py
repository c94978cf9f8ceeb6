"""The Pareto front: choices for which no other is both cheaper and more accurate.

One error and one cost of every choice decide it, and are drawn: no choice that the picture shows as dominated is on it,
and every other one is. So that a second run of a chart has the same front, differences that a busy machine can cause
are ignored:

- The cost is the least CPU time of the timed runs, as whatever else a machine does only adds to it.
- Costs that differ by less than `TIE` are one cost, their median: the nearest are put together first, as long as all of
  them remain within it. So costs that differ by more are never equal, and costs of one scene with other sides are.
- Errors are the same to the bit in every run. Those within `EQUAL` are put together in the same way, and all below
  `NONE`, which a logarithmic axis cannot show, are equal.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

TIE = 1.25
"""Ratio of two costs below which they are equal: in two charts on a busy machine they differed by 15 % at most."""

EQUAL = 1.05
"""Ratio of two errors below which they are equal."""

NONE = 1e-6
"""Relative error up to which there is none."""

SHORTEST = 1e-9
"""Smallest CPU time (s): clocks of coarse ticks have 0 for a short run."""


class Point(NamedTuple):
    """A choice as compared and drawn: relative error, and cost, s of CPU time."""

    error: float
    cost: float


def points_of(errors: Sequence[float], costs: Sequence[float]) -> list[Point]:
    """The points of choices with these errors and least CPU times (s); nearly equal ones are equal."""
    seen, spent = np.maximum(errors, NONE), np.maximum(costs, SHORTEST)
    return [Point(*each) for each in zip(alike(seen, EQUAL), alike(spent, TIE), strict=True)]


def alike(values: np.ndarray, ratio: float) -> list[float]:
    """The positive values, with nearly equal ones replaced by the median of their group.

    Groups are put together, the two with the nearest extremes first, as long as these differ by less than a ratio.
    """
    groups = [[k] for k in np.argsort(values, kind="stable")]
    while len(groups) > 1:
        spans = [values[after[-1]] / values[before[0]] for before, after in pairwise(groups)]
        first = int(np.argmin(spans))
        if spans[first] >= ratio:
            break
        groups[first : first + 2] = [groups[first] + groups[first + 1]]
    found = np.empty(len(values))
    for group in groups:
        found[group] = np.median(values[group])
    return [float(each) for each in found]


def front(points: Sequence[Point]) -> list[int]:
    """Indices of the points on the front, the most accurate first; of several equal points the first."""
    kept = [k for k, point in enumerate(points) if not any(_dominates(other, point) for other in points)]
    return sorted(kept, key=lambda k: points[k])


def _dominates(other: Point, point: Point) -> bool:
    """Whether `other` is cheaper or more accurate than `point`, and neither costlier nor less accurate."""
    return other.error <= point.error and other.cost <= point.cost and other != point


def cheapest_within(points: Sequence[Point], level: float) -> int | None:
    """Number of the cheapest point with an error of at most `level`, which is on the front; None if there is none."""
    return min(
        (k for k, point in enumerate(points) if point.error <= level),
        key=lambda k: (points[k].cost, points[k].error),
        default=None,
    )
