"""The constants of contacts."""

import numpy as np

from dembound.disks.material.constants import shared_constants


def test_pairs_of_one_place_share_a_row() -> None:
    row = np.arange(1.0, 13.0)
    apart = np.array([0.0, 0.0, 1.0, 1.0, 0.0])[:, None] * np.eye(12)[2]
    constants, row_of = shared_constants(row + apart, np.zeros((5, 2)), width=12)

    assert np.array_equal(constants[:, 2], [3.0, 4.0])
    assert row_of.tolist() == [0, 0, 1, 1, 0]
