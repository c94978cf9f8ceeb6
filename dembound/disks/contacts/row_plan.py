"""Rows of the copies of each disk of the brick: their groups, columns of eight copies, and lanes."""

from dataclasses import dataclass

import numpy as np

from dembound.kernels.lanes import LANES
from dembound.packings.tiling import Assembly

WASTE = 1.04
"""Largest relative increase in blocks for lanes of whole lengths of the shorter side; masks are then equal in all
lanes."""


@dataclass(frozen=True, eq=False)
class RowPlan:
    """The places of the disks of an assembly: r rows of copies in g groups, each with as many columns of eight copies.

    row (n,) row of each disk; column, lane (n,) its place there. group_row (g + 1,) the rows of each group, columns
    (g,) its columns, group_block (g + 1,) its blocks from 0 on, column by column, in each one block for every row.
    by_level : whether each row of bricks is a group, or two, of its own, as in layered ground.
    """

    row: np.ndarray
    column: np.ndarray
    lane: np.ndarray
    group_row: np.ndarray
    columns: np.ndarray
    group_block: np.ndarray
    by_level: bool = False

    @property
    def group(self) -> np.ndarray:
        """Group (r,) of each row."""
        return np.repeat(np.arange(len(self.columns)), np.diff(self.group_row))

    @property
    def block(self) -> np.ndarray:
        """Block (n,) of each disk."""
        group = self.group[self.row]
        rows = np.diff(self.group_row)[group]
        return self.group_block[group] + self.column * rows + self.row - self.group_row[group]

    @property
    def row_of_block(self) -> np.ndarray:
        """Row (blocks,) of the disks in each block."""
        rows = np.split(np.arange(self.group_row[-1]), self.group_row[1:-1])
        return np.concatenate([np.tile(each, columns) for each, columns in zip(rows, self.columns, strict=True)])

    @property
    def column_of_block(self) -> np.ndarray:
        """Column (blocks,) of each block in its group."""
        rows = np.diff(self.group_row)
        return np.concatenate([np.repeat(np.arange(c), r) for c, r in zip(self.columns, rows, strict=True)])

    @property
    def slot(self) -> np.ndarray:
        """Slot (n,) of each disk, from 0 on."""
        return LANES * self.block + self.lane


def plan_rows(assembly: Assembly, *, by_level: bool = False) -> RowPlan:
    """Rows of the copies of each disk of the brick, those in rows that close the frame in groups of their own.

    Copies are numbered along the shorter side of the scene first, and cut into eight lengths, one for each lane: the
    neighbour in the next copy is then in the next column, in the same lane. by_level : for layers, whose disks differ
    with height; each row of bricks is then a group of its own, with copies along x only, and all these groups have the
    same columns.
    """
    (across, up), tile = assembly.copies, assembly.tile.astype(np.int64)
    closing = 2 * (tile[:, 0] >= across) + (tile[:, 1] >= up)
    if by_level:
        kinds, group = np.unique(2 * tile[:, 1] + (closing >= 2), return_inverse=True)
        copy = np.where(closing >= 2, 0, tile[:, 0])
        columns = np.where(kinds % 2 == 0, -(-across // LANES), 1)
    else:
        along_x = bool(assembly.size[0] < assembly.size[1])
        regular = tile[:, 1] * across + tile[:, 0] if along_x else tile[:, 0] * up + tile[:, 1]
        copy = np.choose(closing, [regular, tile[:, 0], tile[:, 1], 0])
        short, long = (across, up) if along_x else (up, across)
        kinds, group = np.unique(closing, return_inverse=True)
        columns = np.array([columns_of(short, long), -(-across // LANES), -(-up // LANES), 1])[kinds]
    disks = int(assembly.brick_particle.max()) + 1
    brick_rows, row = np.unique(group * disks + assembly.brick_particle, return_inverse=True)
    group_row = np.searchsorted(brick_rows // disks, np.arange(len(kinds) + 1))
    return RowPlan(
        row=row,
        column=copy % columns[group],
        lane=copy // columns[group],
        group_row=group_row,
        columns=columns,
        group_block=np.concatenate([[0], np.cumsum(np.diff(group_row) * columns)]),
        by_level=by_level,
    )


def columns_of(short: int, long: int) -> int:
    """Number of columns for `short` × `long` copies along the two sides."""
    least = -(-short * long // LANES)
    even = -(-long // LANES) * short
    return even if even <= WASTE * least else least
