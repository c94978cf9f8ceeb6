"""Neighbours in a periodic box."""

import numpy as np

from dembound.packings.contacts import near_pairs, strip_order, wrap

BOX = np.array([10.0, 6.0])


def test_wrap_never_returns_the_far_face():
    positions = np.array([[-1e-17, 6.0], [10.0, -0.5], [25.0, 3.0]])
    assert wrap(positions, BOX).tolist() == [[0.0, 0.0], [0.0, 5.5], [5.0, 3.0]]


def test_pairs_through_faces_and_corners():
    positions = np.array([[0.3, 0.3], [9.7, 5.7], [0.3, 5.6], [5.0, 3.0]])
    pairs, images = near_pairs(positions, np.full(4, 0.5), BOX, 0.0)
    assert pairs.tolist() == [[0, 1], [0, 2], [1, 2]]
    assert images.tolist() == [[-1, -1], [0, -1], [1, 0]]


def test_strips_run_upwards_one_after_the_other():
    positions = np.array([[2.5, 0.0], [0.5, 4.0], [0.9, 1.0], [2.1, 5.0]])
    assert strip_order(positions, 1.0).tolist() == [2, 1, 0, 3]
