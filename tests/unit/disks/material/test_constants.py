"""The constants of contacts."""

import numpy as np

from dembound.disks.material.constants import shared_constants


def test_rows_that_differ_by_rounding_alone_are_shared() -> None:
    row = np.arange(1.0, 13.0)
    apart = np.array([0.0, 1e-9, 1.0, 1.0 + 1e-9, 0.0])[:, None] * np.eye(12)[2]
    constants, row_of = shared_constants(row + apart, np.zeros((5, 2)), length=0.1, width=12)

    # what lies within 1e-6 of the length is one place
    assert np.array_equal(constants[:, 2], [3.0, 4.0])
    assert row_of.tolist() == [0, 0, 1, 1, 0]
