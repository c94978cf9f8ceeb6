"""Which group, column and row a block of eight is in."""

from typing import NamedTuple

import numpy as np

from dembound.kernels.lane_step import next_place, place_of


class Rows(NamedTuple):
    """Groups of rows: the first row of each, and its first block."""

    group_row: np.ndarray
    group_block: np.ndarray


def test_blocks_one_after_the_other_are_where_each_of_them_is_also_past_groups_without_rows() -> None:
    rows, columns = np.array([0, 2, 0, 0, 3, 1, 0, 2, 0]), np.array([3, 2, 1, 1, 2, 4, 5, 1, 1])
    table = Rows(np.cumsum([0, *rows]), np.cumsum([0, *rows * columns]))
    at = place_of(table, 0)
    for block in range(1, int(table.group_block[-1])):
        at = next_place(table, block, *at)
        assert at == place_of(table, block)
    assert at == (7, 0, 7)
