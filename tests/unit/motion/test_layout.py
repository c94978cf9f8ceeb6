"""The slots of nodes, and arrays by slot and by node."""

import numpy as np
import pytest

from dembound.motion.state import Layout

SPREAD = Layout(np.array([9, 2, 4, 7]), 12)


@pytest.mark.parametrize("layout", [SPREAD, Layout.plain(4)])
def test_values_come_back_as_they_were_spread(layout: Layout) -> None:
    values = np.arange(12.0).reshape(3, 4)
    spread = layout.spread(values)

    assert spread.shape == (3, layout.count)
    assert spread.sum() == values.sum()
    assert np.array_equal(layout.gather(spread), values)
    assert np.array_equal(layout.gather(spread[1]), values[1])
    # row after row in memory, as those from a checkpoint lie: sums of them then have one order of terms
    assert layout.gather(spread).flags.c_contiguous
    assert not layout.gather(spread).flags.writeable


def test_only_a_layout_of_every_node_in_its_own_slot_is_plain() -> None:
    assert Layout.plain(3).is_plain
    assert not SPREAD.is_plain
    assert not Layout(np.array([0, 1]), 3).is_plain
    assert SPREAD.node.tolist() == [-1, -1, 1, -1, 2, -1, -1, 3, -1, 0, -1, -1]
