"""Forces of ties that are repeated at other lines of the support table."""

import numpy as np

from dembound.kernels.tables import Repeats
from dembound.kernels.wall import repeated_forces


def test_repeated_forces_are_added_at_other_lines() -> None:
    force, still = np.arange(15.0).reshape(5, 3), np.zeros((3, 5))
    repeated_forces(Repeats(np.array([0, 4, 4]), np.array([1, 2, 3])), still, still, force)

    before = np.arange(15.0).reshape(5, 3)
    expected = before.copy()
    expected[1:4] += before[[0, 4, 4]]
    assert np.array_equal(force, expected)
