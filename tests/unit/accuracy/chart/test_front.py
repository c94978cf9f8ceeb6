"""The Pareto front, which is that of the points as they are drawn, and which noise of the machine does not change."""

import numpy as np
import pytest

from dembound.accuracy.chart.study import TIE, Point, alike, cheapest_within, front, points_of


@pytest.mark.parametrize(
    ("points", "expected"),
    [
        ([(0.1, 1.0), (0.05, 4.0), (0.2, 2.0), (0.01, 16.0), (0.01, 64.0)], [3, 1, 0]),
        # three sides of one scene: the times differ by 20 %, which a busy machine may add
        ([(0.1, 1.0), (0.05, 1.1), (0.2, 0.92)], [1]),
        ([(0.1, 1.0), (0.05, 1.3), (0.2, 0.9)], [1, 0]),
        # nothing is left of errors that cannot be drawn, and errors within a twentieth are one
        ([(1e-14, 1.0), (1e-16, 4.0)], [0]),
        ([(0.1000, 1.0), (0.0970, 4.0)], [0]),
        ([(0.1000, 1.0), (0.0930, 4.0)], [1, 0]),
        # at one place all are on the front
        ([(0.1, 1.0), (0.1, 1.0), (0.2, 1.0)], [0, 1]),
    ],
)
def test_the_front_is_of_those_that_none_dominates(points: list[tuple[float, float]], expected: list[int]) -> None:
    assert front(points_of(*zip(*points, strict=True))) == expected


@pytest.mark.parametrize("seed", range(4))
def test_all_that_is_dominated_is_off_the_front_and_nothing_else(seed: int) -> None:
    rng = np.random.default_rng(seed)
    errors, costs = 10.0 ** rng.uniform(-8, 0, 30), 10.0 ** rng.uniform(-2, 0, 30)
    errors[rng.integers(30, size=5)], costs[rng.integers(30, size=5)] = errors[0], costs[0]
    points = points_of(errors, costs)
    on = set(front(points))
    for k, (error, cost) in enumerate(points):
        others = [other for other in points if other != (error, cost)]
        assert (k in on) == (not any(other.error <= error and other.cost <= cost for other in others))
        if k not in on:  # what dominates it, or what dominates that, is on the front
            assert any(points[n].error <= error and points[n].cost <= cost for n in on)
    for level in (1e-9, 1e-4, 1e-2, 1.0):
        found = cheapest_within(points, level)
        assert found is None or found in on


def test_groups_are_of_the_nearest_and_no_wider_than_the_ratio() -> None:
    # a chain in which each is within 1.2 of the next: 1.1 and 1.15 first, then with 1.0, as 1.15 < 1.25; 1.35 is apart
    assert alike(np.array([1.35, 1.0, 1.15, 1.1]), TIE) == [1.35, 1.1, 1.1, 1.1]
    assert alike(np.array([0.3, 3.0]), TIE) == [0.3, 3.0]
    chain = np.geomspace(1.0, 10.0, 40)
    found = alike(chain, TIE)
    for value in set(found):
        group = [each for each, own in zip(chain, found, strict=True) if own == value]
        assert max(group) / min(group) < TIE


def test_of_equal_costs_the_most_accurate_then_the_first_is_named() -> None:
    points = [Point(0.1, 1.0), Point(0.05, 4.0), Point(0.01, 16.0), Point(0.01, 16.0), Point(0.02, 16.0)]
    assert [cheapest_within(points, level) for level in (0.2, 0.06, 0.01, 0.001)] == [0, 1, 2, None]
    assert cheapest_within([Point(0.1, 1.0), Point(0.15, 0.2)], 0.2) == 1
    assert cheapest_within([Point(0.15, 1.0), Point(0.1, 1.0)], 0.2) == 1
