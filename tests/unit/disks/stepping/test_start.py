"""A body at rest to start from."""

import numpy as np

from dembound.disks.stepping.start import Start


def test_displacements_of_a_start_lie_row_after_row_in_memory() -> None:
    """As those that are read from a record do: sums of them then have one order of terms."""
    moved = np.arange(12.0).reshape(4, 3).T
    assert not moved.flags.c_contiguous
    assert Start(moved).displacement.flags.c_contiguous
    assert np.array_equal(Start(moved).displacement, moved)
