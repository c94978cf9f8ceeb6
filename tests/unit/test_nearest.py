"""One of several equally near points is chosen, however they are numbered and rounded."""

import numpy as np
import pytest

from dembound.places import nearest, nearest_number

LATTICE = np.stack(np.meshgrid(np.arange(12.0), np.arange(9.0)), axis=-1).reshape(-1, 2)


def chosen(points: np.ndarray, places: np.ndarray) -> np.ndarray:
    return points[nearest(points, places)]


def test_far_from_ties_it_is_the_nearest_one() -> None:
    places = np.random.default_rng(0).uniform(-2.0, 14.0, (200, 2))
    expected = LATTICE[np.argmin(np.hypot(*(LATTICE[:, None] - places).transpose(2, 0, 1)), axis=0)]
    np.testing.assert_array_equal(chosen(LATTICE, places), expected)


def test_of_equally_near_points_the_lowest_and_of_those_the_leftmost_is_taken() -> None:
    places = np.array([[4.5, 3.0], [4.0, 3.5], [4.5, 3.5], [-7.0, 3.5], [4.5, 20.0]])
    assert chosen(LATTICE, places).tolist() == [[4.0, 3.0], [4.0, 3.0], [4.0, 3.0], [0.0, 3.0], [4.0, 8.0]]

    ring = LATTICE[np.hypot(*(LATTICE - [5.0, 4.0]).T) > 2.1]  # eight are equally near to the middle of this hole
    assert chosen(ring, np.array([[5.0, 4.0]])).tolist() == [[4.0, 2.0]]


@pytest.mark.parametrize("size", [0.1, 0.7, 1.0 / 3.0, 1e-3])
def test_rounding_and_numbering_do_not_decide(size: float) -> None:
    """The lattice from origins at which its coordinates round differently, in any order: the same one of its points."""
    rng = np.random.default_rng(1)
    halves = 0.5 * rng.integers(2, 16, (60, 2))
    expected = chosen(LATTICE, halves)
    naive = set()
    for origin in (0.0, 96.0, 1234.5, 1e5):
        order = rng.permutation(len(LATTICE))
        points, places = size * LATTICE[order] + size * origin, size * (halves + origin)
        found = order[nearest(points, places)]
        np.testing.assert_array_equal(LATTICE[found], expected)
        distance = np.hypot(*(points[:, None] - places).transpose(2, 0, 1))
        naive.add(tuple(order[distance.argmin(axis=0)]))
    assert len(naive) > 1  # the smallest distance alone finds others


def test_half_way_between_numbers_the_smaller_one_is_taken() -> None:
    assert [nearest_number(value) for value in (0.0, 0.49, 0.5, 0.51, 1.5, 2.5, 7.0)] == [0, 0, 0, 1, 1, 2, 7]
    assert nearest_number(0.35 / 0.1) == nearest_number(3.5 + 1e-12) == 3
