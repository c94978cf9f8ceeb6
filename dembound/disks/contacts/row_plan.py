"""Rows of the copies of each disk of the brick, and contacts as entries between them."""

from dataclasses import dataclass

import numpy as np

from dembound.kernels.compiler.lanes import LANES
from dembound.packings.tiling import Assembly

WASTE = 1.04
"""Largest relative increase in blocks for lanes of whole lengths of the shorter side; masks are then equal in all
lanes."""


@dataclass(frozen=True, eq=False)
class RowPlan:
    """The places of the disks of an assembly: r rows of copies in g groups, each with as many columns of eight copies.

    row (n,) row of each disk; column, lane (n,) its place there. group_row (g + 1,) the rows of each group, columns
    (g,) its columns, group_block (g + 1,) its blocks from 0 on, column by column, in each one block for every row.
    by_level : whether each row of bricks, or part of it, is a group, or two, of its own, as in layered ground.
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


def plan_rows(assembly: Assembly, levels: np.ndarray | None = None) -> RowPlan:
    """Rows of the copies of each disk of the brick, those in rows that close the frame in groups of their own.

    Copies are numbered along the shorter side of the scene first, and cut into eight lengths, one for each lane: the
    neighbour in the next copy is then in the next column, in the same lane. levels : (n,) numbers of the disks for
    layers, whose disks differ with height, the same in a row of bricks or a part of it; each level is then a group of
    its own, with copies along x only, and groups as wide have the same columns.
    """
    (across, up), tile = assembly.copies, assembly.tile.astype(np.int64)
    closing = 2 * (tile[:, 0] >= across) + (tile[:, 1] >= up)
    if levels is not None:
        kinds, group = np.unique(2 * levels + (closing >= 2), return_inverse=True)
        first, end = np.zeros(len(kinds), np.int64), np.full(len(kinds), across)
        if not np.array_equal(levels, tile[:, 1]):
            first, end = np.full((2, len(kinds)), [[across], [0]])
            np.minimum.at(first, group, tile[:, 0])
            np.maximum.at(end, group, tile[:, 0] + 1)
        copy = np.where(closing >= 2, 0, tile[:, 0] - first[group])
        columns = np.where(kinds % 2 == 0, -(-(end - first) // LANES), 1)
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
        by_level=levels is not None,
    )


def columns_of(short: int, long: int) -> int:
    """Number of columns for `short` × `long` copies along the two sides."""
    least = -(-short * long // LANES)
    even = -(-long // LANES) * short
    return even if even <= WASTE * least else least


ROUNDS = 6
"""Number of candidate shifts between slots tried for the contacts of one row and type."""

STRAY_COST, BLOCK_COST, SKIP_COST = 30.0, 10.0, 2.0
"""Cycles for a contact end on its own, for eight at once, and for eight of which none exists; they decide nothing but
speed."""

AT_ONCE = 1 << 20
"""Contact ends whose bits are set at once, which limits the RAM for it."""

BITS = np.unpackbits(np.arange(256, dtype=np.uint8)[:, None], axis=1).sum(axis=1)
"""Number of bits in each byte."""


@dataclass(frozen=True, eq=False)
class Ends:
    """Ends of contacts: slots of owner and neighbour (e,) int32 from 0 on, lines (e,) int32 of a table of `lines`."""

    slot: np.ndarray
    other: np.ndarray
    line: np.ndarray
    lines: int

    @classmethod
    def of(cls, assembly: Assembly, slot: np.ndarray, row_of: np.ndarray) -> "Ends":
        """Entries of an assembly with its disks in slots (n,); row_of (2b,) : line of each contact for either disk."""
        slot, row_of = slot.astype(np.int32), row_of.astype(np.int32)
        i, j = assembly.pairs.T
        kind = 2 * assembly.contact_type
        return cls(
            np.concatenate([slot[i], slot[j]]),
            np.concatenate([slot[j], slot[i]]),
            np.concatenate([row_of[kind], row_of[kind + 1]]),
            len(row_of),
        )

    def at(self, chosen: np.ndarray) -> "Ends":
        """The chosen ends."""
        return Ends(self.slot[chosen], self.other[chosen], self.line[chosen], self.lines)


@dataclass(frozen=True, eq=False)
class Entries:
    """Contacts shared by many disks of a row: row, line, shift (slots to the neighbour) and mask (k,), masks (m,)."""

    row: np.ndarray
    line: np.ndarray
    shift: np.ndarray
    mask: np.ndarray
    masks: np.ndarray


def entries_of(ends: Ends, plan: RowPlan) -> tuple[Entries, Ends]:
    """The contacts that are worth an entry, and the ends of all others."""
    found: list[Entries] = []
    for _ in range(ROUNDS):
        if len(ends.line) == 0:
            break
        entries, ends = _take_most(ends, plan)
        found.append(entries)
    return _joined(found), ends


def _joined(lists: list[Entries]) -> Entries:
    begin = np.cumsum([0, *(len(entries.masks) for entries in lists)])
    mask = [np.where(e.mask < 0, e.mask, e.mask + at) for e, at in zip(lists, begin[:-1], strict=True)]
    nothing = np.zeros(0, dtype=np.int64)
    return Entries(
        np.concatenate([nothing, *(e.row for e in lists)]),
        np.concatenate([nothing, *(e.line for e in lists)]),
        np.concatenate([nothing, *(e.shift for e in lists)]),
        np.concatenate([nothing, *mask]),
        np.concatenate([np.zeros(0, np.uint8), *(e.masks for e in lists)]),
    )


def _take_most(ends: Ends, plan: RowPlan) -> tuple[Entries, Ends]:
    """One entry per row and line, of the ends whose neighbour is at one shift of slots; and the remaining ends.

    The shift tried is that of the last end listed. Ends of entries that are not worth a mask remain.
    """
    row_of_block, column_of_block, group = plan.row_of_block, plan.column_of_block, plan.group
    # a line belongs to one disk of the brick, so line and group determine the row
    key = ends.line + ends.lines * group.astype(np.int32)[row_of_block][ends.slot // LANES]
    last = np.full(ends.lines * len(plan.columns), -1, dtype=np.int32)
    last[key] = np.arange(len(key), dtype=np.int32)
    listed = np.flatnonzero(last >= 0)
    last = last[listed]
    number = np.zeros(ends.lines * len(plan.columns), dtype=np.int32)
    number[listed] = np.arange(len(listed))
    entry = number[key]
    tried = ends.other[last].astype(np.int64) - ends.slot[last]
    row, to = row_of_block[ends.slot[last] // LANES], row_of_block[ends.other[last] // LANES]
    alike = ends.other - ends.slot == tried.astype(np.int32)[entry]
    columns = plan.columns[group[row]]
    begin = np.cumsum(columns) - columns
    masks = np.zeros(int(columns.sum()), dtype=np.uint8)
    for at in range(0, len(entry), AT_ONCE):
        part = at + np.flatnonzero(alike[at : at + AT_ONCE])
        slot = ends.slot[part]
        bit = np.left_shift(1, slot % LANES).astype(np.uint8)
        np.bitwise_or.at(masks, begin[entry[part]] + column_of_block[slot // LANES], bit)
    lanes_used, blocks_used = np.add.reduceat(BITS[masks], begin), np.add.reduceat(masks != 0, begin, dtype=np.int64)
    cost = BLOCK_COST * blocks_used + SKIP_COST * (columns - blocks_used)
    worth = cost <= STRAY_COST * lanes_used
    live = np.bincount(plan.row)
    whole = (group[row] == group[to]) & (tried == LANES * (to - row))
    whole &= (lanes_used == live[row]) & (lanes_used == live[to])
    masked = worth & ~whole
    size = np.where(masked, columns, 0)
    mask = np.where(masked, np.cumsum(size) - size, -1)
    entries = Entries(
        row[worth], listed[worth] % ends.lines, tried[worth], mask[worth], masks[np.repeat(masked, columns)]
    )
    return entries, ends.at(~(alike & worth[entry]))
