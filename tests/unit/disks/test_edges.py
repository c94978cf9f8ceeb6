"""What a side is when particles of it are taken away."""

import numpy as np
import pytest

from dembound.boundaries.support import Edge
from dembound.disks.edges import left_of
from dembound.errors import CaseError

DIAMETERS = np.array([0.4, 0.6, 0.5, 0.8, 0.7])
EDGE = Edge("right", np.array([2, 3, 5, 7, 11]), np.column_stack([np.full(5, 9.0), np.arange(5.0)]), DIAMETERS, 3.6)


def test_what_is_left_of_a_side_stands_for_its_own_share_of_the_length() -> None:
    left = left_of(EDGE, np.array([1, 2, 4, 5, 9, 11]))

    # by diameters: 0.4 + 0.5 + 0.7 of 3.0 m, whatever the number of disks; so every one stands for as much as before,
    # 1.2 of its diameter
    assert left.length == pytest.approx(1.6 * 1.2, rel=1e-14)
    assert left.nodes.tolist() == [1, 3, 5]  # where 2, 5 and 11 stand among what is kept
    assert left.diameters.tolist() == [0.4, 0.5, 0.7]
    assert left.positions[:, 1].tolist() == [0.0, 2.0, 4.0]
    assert left.side == "right"


def test_a_side_of_which_nothing_is_left_is_refused() -> None:
    with pytest.raises(CaseError, match="hole: leaves nothing of the right side"):
        left_of(EDGE, np.array([0, 1, 4]))
