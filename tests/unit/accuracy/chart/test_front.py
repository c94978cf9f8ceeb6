"""The Pareto front, which noise of the machine must not change."""

import numpy as np
import pytest

from dembound.accuracy.chart.front import NOISE, Point, cheapest_within, cost_ratio, front


def point(error: float, cost: float, work: int = 0, noise: float = 0.0, seed: int = 0, rounds: int = 3) -> Point:
    """A point of this cost (s), by default with work in proportion, and with noise by these parts of it."""
    factors = 1.0 + noise * np.random.default_rng(seed).standard_normal(rounds)
    return Point(error, list(cost * factors), work or round(1e6 * cost))


@pytest.mark.parametrize(
    ("points", "expected"),
    [
        # no point on the front is beaten
        ([point(0.1, 1.0), point(0.05, 4.0), point(0.2, 2.0), point(0.01, 16.0), point(0.01, 64.0)], [3, 1, 0]),
        # three sides of one scene: the times differ by 20 %, which is less than what a busy machine adds
        ([point(0.1, 1.0, work=100), point(0.05, 1.2, work=100), point(0.2, 0.9, work=100)], [1]),
        # a law that takes twice as long for the same work is dearer
        ([point(0.1, 1.0, work=100), point(0.05, 2.0, work=100), point(0.2, 2.0, work=100)], [1, 0]),
        # a row of disks more is no cost
        ([point(0.2, 1.0, work=100), point(0.1, 1.0, work=104)], [1]),
        ([point(0.2, 1.0, work=100), point(0.1, 1.0, work=106)], [1, 0]),
        # equal errors are those of rounding, and those within a hundredth
        ([point(1e-14, 1.0), point(1e-16, 4.0)], [0]),
        ([point(0.1000, 1.0), point(0.0995, 4.0)], [0]),
        ([point(0.1000, 1.0), point(0.0980, 4.0)], [1, 0]),
    ],
)
def test_the_front_is_of_those_that_none_beats(points: list[Point], expected: list[int]) -> None:
    assert front(points) == expected


ABOVE = 1.0 + 1.1 * NOISE


@pytest.mark.parametrize(
    ("one", "other", "ratio"),
    [
        # work decides between times that differ little
        (point(0.1, 1.1, work=90), point(0.1, 1.0, work=100), 0.9),
        (point(0.1, ABOVE, work=90), point(0.1, 1.0, work=100), ABOVE),
        (point(0.1, 1.0, work=1000), point(0.1, 1.0, work=1001), 1.0),
        # and between the shortest runs
        (point(0.1, 1.2e-3, work=50), point(0.1, 0.4e-3, work=100), 0.5),
        (point(0.1, 3.2e-3, work=50), point(0.1, 1.6e-3, work=100), 2.0),
        # a load that slows a whole round does not count; rounds that contradict each other leave it to the work
        (Point(0.1, [1.0, 5.0, 1.0], 300), Point(0.1, [0.5, 2.5, 0.5], 100), 2.0),
        (Point(0.1, [1.0, 2.0, 6.0], 50), Point(0.1, [1.0, 1.0, 1.0], 100), 0.5),
    ],
)
def test_costs_are_compared_by_times_or_by_work(one: Point, other: Point, ratio: float) -> None:
    assert cost_ratio(one, other) == pytest.approx(ratio, rel=1e-12)


def test_of_equal_costs_and_errors_the_least_work_then_the_first_is_named() -> None:
    levels = [point(0.1, 1.0), point(0.05, 4.0), point(0.01, 16.0)]
    assert [cheapest_within(levels, level) for level in (0.2, 0.06, 0.01, 0.001)] == [0, 1, 2, None]
    # errors within 1 % of each other: none rules out another
    points = [point(0.1, 1.0, work=100), point(0.1004, 1.3, work=98), point(0.1005, 0.9, work=98), point(0.5, 1.0)]
    assert front(points) == [0, 1, 2]
    assert cheapest_within(points, 0.2) == 1
    assert cheapest_within(points[:1] + points[2:], 0.2) == 1
    # a choice that costs less is named before one with the same error
    assert cheapest_within([point(0.1, 1.0), point(0.15, 0.2)], 0.2) == 1
