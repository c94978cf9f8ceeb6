"""Which disks of damped ground can do two steps in one sweep, see kernels/tables `Ahead`."""

from collections.abc import Iterator

import numpy as np

from dembound.disks.contacts.layout import Rows
from dembound.kernels.common import CHUNKS
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.damped_rows import PARTS, TILE
from dembound.kernels.lane_step import blocks_of
from dembound.kernels.tables import LaneRows
from dembound.kernels.tables.grid import Ahead
from dembound.motion.state import aligned_zeros

LEAST_BLOCKS = 40_000
"""Blocks of eight disks, with three mechanisms 46 MB, from which on sweeps of two steps are faster."""

LARGEST_LAG = 48
"""Tiles between both steps: with three mechanisms their motion and memories are 0.9 MB, and stay in a core's cache."""

LEAST_SHARE = 0.5
"""Least share of early blocks for which a second sweep over the others is worth it."""


def steps_ahead(rows: Rows, special: np.ndarray) -> Ahead:
    """Which blocks of a part are early, and their lag; special : (blocks,) of the scene, see `Memories`."""
    early, lag = np.zeros(len(special), dtype=np.uint8), 0
    if isinstance(rows, LaneRows) and rows.group_block[-1] - rows.group_block[0] >= LEAST_BLOCKS:
        found, far = _early(rows, special)
        if found.mean() >= LEAST_SHARE:
            early[rows.group_block[0] : rows.group_block[-1]], lag = found, far
    return Ahead(early, lag, np.zeros(2, dtype=np.int64), aligned_zeros(CHUNKS, 6 * LANES))


def _early(rows: LaneRows, special: np.ndarray) -> tuple[np.ndarray, int]:
    """Whether each block of the rows is early, and the lag in tiles."""
    begin, end = int(rows.group_block[0]), int(rows.group_block[-1])
    each = CHUNKS // PARTS
    first = np.array([blocks_of(rows, each * part)[0] for part in range(PARTS)])
    blocks = np.arange(begin, end)
    part = np.searchsorted(first, blocks, side="right") - 1
    tile = (blocks - first[part]) // TILE
    moves = ~(rows.special[begin:end].astype(bool) | (special[begin:end] & 1).astype(bool))
    early, far = moves.copy(), np.zeros(end - begin, dtype=np.int64)
    for reader, needed in _needed(rows):
        inside = (needed >= 0) & (needed < end - begin)
        early[reader[~inside]] = False
        reader, needed = reader[inside], needed[inside]
        early[reader[~moves[needed]]] = False
        apart = part[reader] != part[needed]
        tiles = np.where(apart, end, np.abs(tile[reader] - tile[needed]))
        np.maximum.at(
            far, reader, tiles
        )  # blocks in reach are those that need it, too: without strays both ends are here
    near = far[early & (far <= LARGEST_LAG)]
    lag = max(1, int(near.max(initial=0)))
    return early & (far <= lag), lag


def _needed(rows: LaneRows) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Blocks, from the first of the rows on, and others whose displacements their forces depend on, in pairs (k,)."""
    begin = int(rows.group_block[0])
    for group in range(len(rows.group_row) - 1):
        first, last = rows.group_row[group : group + 2].astype(np.int64)
        count = last - first
        columns = np.arange((rows.group_block[group + 1] - rows.group_block[group]) // count)[:, None]
        entry = np.arange(rows.start[first, 0], rows.start[last, 0])
        row = np.searchsorted(rows.start[first : last + 1, 0], entry, side="right") - 1
        block = rows.group_block[group] + columns * count + row
        exists = np.broadcast_to(entry < rows.start[first + row, 1], block.shape).copy()
        some = np.flatnonzero(~exists[0])
        exists[:, some] = rows.masks[rows.mask[entry[some]] + columns] != 0
        slot = LANES * block + rows.shift[entry]
        reader = block[exists] - begin
        for end in (0, LANES - 1):  # eight neighbours may be in two blocks
            yield reader, (slot[exists] + end) // LANES - begin
