"""The Pareto front, which noise of the machine must not change."""

import numpy as np
import pytest

from dembound.accuracy.chart.front import NOISE, Point, cheapest_within, cost_ratio, front


def point(error: float, cost: float, work: int = 0, noise: float = 0.0, seed: int = 0, rounds: int = 3) -> Point:
    """A point of this cost (s), by default with work in proportion, and with noise by these parts of it."""
    factors = 1.0 + noise * np.random.default_rng(seed).standard_normal(rounds)
    return Point(error, list(cost * factors), work or round(1e6 * cost))


def test_no_point_on_the_front_is_beaten() -> None:
    points = [point(0.1, 1.0), point(0.05, 4.0), point(0.2, 2.0), point(0.01, 16.0), point(0.01, 64.0)]
    assert front(points) == [3, 1, 0]


def test_the_smaller_error_wins_at_equal_work_whatever_the_clock_shows() -> None:
    # three sides of one scene: the times differ by 20 %, which is less than what a busy machine adds
    points = [point(0.1, 1.0, work=100), point(0.05, 1.2, work=100), point(0.2, 0.9, work=100)]
    assert front(points) == [1]


def test_a_law_that_takes_twice_as_long_for_the_same_work_is_dearer() -> None:
    points = [point(0.1, 1.0, work=100), point(0.05, 2.0, work=100), point(0.2, 2.0, work=100)]
    assert front(points) == [1, 0]


def test_work_decides_between_times_that_differ_little() -> None:
    assert cost_ratio(point(0.1, 1.1, work=90), point(0.1, 1.0, work=100)) == pytest.approx(0.9)
    above = 1.0 + 1.1 * NOISE
    assert cost_ratio(point(0.1, above, work=90), point(0.1, 1.0, work=100)) == pytest.approx(above)
    assert cost_ratio(point(0.1, 1.0, work=1000), point(0.1, 1.0, work=1001)) == 1.0


def test_work_decides_between_the_shortest_runs() -> None:
    assert cost_ratio(point(0.1, 1.2e-3, work=50), point(0.1, 0.4e-3, work=100)) == 0.5
    assert cost_ratio(point(0.1, 3.2e-3, work=50), point(0.1, 1.6e-3, work=100)) == 2.0


def test_a_row_of_disks_more_is_no_cost() -> None:
    assert front([point(0.2, 1.0, work=100), point(0.1, 1.0, work=104)]) == [1]
    assert front([point(0.2, 1.0, work=100), point(0.1, 1.0, work=106)]) == [1, 0]


def test_a_load_that_slows_a_whole_round_does_not_count() -> None:
    first = Point(0.1, [1.0, 5.0, 1.0], 300)
    second = Point(0.1, [0.5, 2.5, 0.5], 100)
    assert cost_ratio(first, second) == 2.0


def test_rounds_that_contradict_each_other_leave_it_to_the_work() -> None:
    first, second = Point(0.1, [1.0, 2.0, 6.0], 50), Point(0.1, [1.0, 1.0, 1.0], 100)
    assert cost_ratio(first, second) == 0.5


def test_errors_of_rounding_are_equal() -> None:
    assert front([point(1e-14, 1.0), point(1e-16, 4.0)]) == [0]


def test_equal_errors_are_those_within_a_hundredth() -> None:
    assert front([point(0.1000, 1.0), point(0.0995, 4.0)]) == [0]
    assert front([point(0.1000, 1.0), point(0.0980, 4.0)]) == [1, 0]


def test_noise_does_not_change_the_front() -> None:
    # radii and sides: work falls by 1, 8, 64; three sides each at the same work; 10 % noise of single times
    errors = {0: (0.02, 0.01, 0.5), 1: (0.03, 0.02, 0.5), 2: (0.2, 0.15, 0.6)}
    found = {
        tuple(
            front(
                [
                    point(error, 8.0**-level, noise=0.1, seed=1000 * seed + 10 * level + k)
                    for level, row in errors.items()
                    for k, error in enumerate(row)
                ]
            )
        )
        for seed in range(200)
    }
    assert found == {(1, 4, 7)}


def test_the_cheapest_within_a_level() -> None:
    points = [point(0.1, 1.0), point(0.05, 4.0), point(0.01, 16.0)]
    assert [cheapest_within(points, level) for level in (0.2, 0.06, 0.01, 0.001)] == [0, 1, 2, None]


def test_of_equal_costs_and_errors_the_least_work_then_the_first_is_named() -> None:
    # errors within 1 % of each other: none rules out another
    points = [point(0.1, 1.0, work=100), point(0.1004, 1.3, work=98), point(0.1005, 0.9, work=98), point(0.5, 1.0)]
    assert front(points) == [0, 1, 2]
    assert cheapest_within(points, 0.2) == 1
    assert cheapest_within(points[:1] + points[2:], 0.2) == 1
    # a choice that costs less is named before one with the same error
    assert cheapest_within([point(0.1, 1.0), point(0.15, 0.2)], 0.2) == 1
