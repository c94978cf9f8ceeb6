"""Neighbours in a periodic box."""

import numpy as np

from dembound.packings.brick import strip_order, wrap

BOX = np.array([10.0, 6.0])


def test_wrap_never_returns_the_far_face():
    positions = np.array([[-1e-17, 6.0], [10.0, -0.5], [25.0, 3.0]])
    assert wrap(positions, BOX).tolist() == [[0.0, 0.0], [0.0, 5.5], [5.0, 3.0]]


def test_strips_run_upwards_one_after_the_other():
    positions = np.array([[2.5, 0.0], [0.5, 4.0], [0.9, 1.0], [2.1, 5.0]])
    assert strip_order(positions, 1.0).tolist() == [2, 1, 0, 3]
