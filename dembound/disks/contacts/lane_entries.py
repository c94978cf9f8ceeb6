"""Contacts between rows of copies: common ones as entries of the rows, and the remaining contact ends."""

from dataclasses import dataclass

import numpy as np

from dembound.disks.contacts.row_plan import RowPlan
from dembound.kernels.lanes import LANES
from dembound.packings.tiling import Assembly

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
