"""Rows of the copies of each disk of the brick, and the contacts between rows, for kernels/elastic_lanes.py."""

from dataclasses import dataclass, fields

import numpy as np

from dembound.disks.packed_material import PackedMaterial
from dembound.disks.rows import elastic_constants
from dembound.kernels.lanes import LANES
from dembound.kernels.tables import LaneRows
from dembound.packings.tiling import Assembly

ROUNDS = 6
"""How many lists of contacts of one kind, with different ways between their slots, are tried for a row."""

STRAY_COST, BLOCK_COST, SKIP_COST = 30.0, 10.0, 2.0
"""Cycles for a contact end on its own, for eight at once, and for eight of which none exists; they decide nothing but
speed."""


WASTE = 1.04
"""What whole lengths of the shorter side for each lane may cost in blocks; masks are then the same for all lanes."""


@dataclass(frozen=True, eq=False)
class RowPlan:
    """Where the disks of an assembly stand: r rows of copies in g groups, each with as many columns of eight copies.

    row (n,) row of each disk; column, lane (n,) its place there. group_row (g + 1,) the rows of each group, columns
    (g,) its columns, group_block (g + 1,) its blocks from 0 on, column by column, in each one block for every row.
    """

    row: np.ndarray
    column: np.ndarray
    lane: np.ndarray
    group_row: np.ndarray
    columns: np.ndarray
    group_block: np.ndarray

    @property
    def group(self) -> np.ndarray:
        """(r,) group of each row."""
        return np.repeat(np.arange(len(self.columns)), np.diff(self.group_row))

    @property
    def block(self) -> np.ndarray:
        """(n,) block of each disk."""
        group = self.group[self.row]
        rows = np.diff(self.group_row)[group]
        return self.group_block[group] + self.column * rows + self.row - self.group_row[group]

    @property
    def slot(self) -> np.ndarray:
        """(n,) slot of each disk, from 0 on."""
        return LANES * self.block + self.lane


def plan_rows(assembly: Assembly) -> RowPlan:
    """Rows of the copies of each disk of the brick, those in rows that close the frame in groups of their own.

    Copies are numbered along the shorter side of the scene first, and cut into eight lengths, one for each lane: the
    neighbour in the next copy is then in the next column, in the same lane.
    """
    (across, up), tile = assembly.copies, assembly.tile.astype(np.int64)
    closing = 2 * (tile[:, 0] >= across) + (tile[:, 1] >= up)
    along_x = bool(assembly.size[0] < assembly.size[1])
    regular = tile[:, 1] * across + tile[:, 0] if along_x else tile[:, 0] * up + tile[:, 1]
    copy = np.choose(closing, [regular, tile[:, 0], tile[:, 1], 0])
    short, long = (across, up) if along_x else (up, across)
    columns = np.array([_columns(short, long), -(-across // LANES), -(-up // LANES), 1])
    kinds, group = np.unique(closing, return_inverse=True)
    brick_rows, row = np.unique(
        group * (assembly.brick_particle.max() + 1) + assembly.brick_particle, return_inverse=True
    )
    group_row = np.searchsorted(brick_rows // (assembly.brick_particle.max() + 1), np.arange(len(kinds) + 1))
    columns = columns[kinds]
    return RowPlan(
        row=row,
        column=copy % columns[group],
        lane=copy // columns[group],
        group_row=group_row,
        columns=columns,
        group_block=np.concatenate([[0], np.cumsum(np.diff(group_row) * columns)]),
    )


def _columns(short: int, long: int) -> int:
    """Columns for so many copies along the shorter and the longer side."""
    least = -(-short * long // LANES)
    even = -(-long // LANES) * short
    return even if even <= WASTE * least else least


def lane_rows(
    assembly: Assembly, ground: PackedMaterial, plan: RowPlan, begin: int, slots: int, fraction: np.ndarray
) -> LaneRows:
    """The contacts of an assembly between its rows.

    begin : slot of the first block; slots : number of slots of the scene; fraction (n,) of its mass that each disk has.
    """
    table, row_of = elastic_constants(ground)
    constants = matrices(table)
    first_block, rows = begin // LANES, int(plan.group_row[-1])
    ends = _Ends.of(assembly, plan, row_of)
    entries: list[_Entries] = []
    for _ in range(ROUNDS):
        if len(ends.line) == 0:
            break
        found, ends = _take_most(ends, plan)
        entries.append(found)
    joined = _Entries.joined(entries)
    whole = joined.mask < 0
    order = np.lexsort((~whole, joined.row))
    own = np.zeros((rows, 3))
    np.add.at(own, joined.row[whole], constants[joined.line[whole], 8:])
    start = np.zeros((rows + 1, 2), dtype=np.int64)
    start[1:, 0] = np.cumsum(np.bincount(joined.row, minlength=rows))
    start[:-1, 1] = start[:-1, 0] + np.bincount(joined.row[whole], minlength=rows)
    special = np.zeros(first_block + plan.group_block[-1], dtype=np.bool_)
    slot = begin + plan.slot
    special[slot[fraction != 1.0] // LANES] = True
    special[(begin + ends.slot) // LANES] = True
    mass, inertia = np.zeros(rows), np.zeros(rows)
    mass[plan.row] = ground.mass[assembly.brick_particle]
    inertia[plan.row] = ground.inertia[assembly.brick_particle]
    return LaneRows(
        group_row=plan.group_row,
        group_block=first_block + plan.group_block,
        inverse_mass=1.0 / mass,
        inverse_inertia=1.0 / inertia,
        start=start,
        shift=joined.shift[order],
        mask=joined.mask[order],
        masks=joined.masks,
        constants=np.ascontiguousarray(constants[joined.line[order], :8]),
        turn=np.ascontiguousarray(constants[joined.line[order], 8:]),
        own=own,
        special=special,
        **_strays(ends, begin),
        stray_constants=table,
        extra=np.zeros((3, slots if len(ends.line) else LANES)),
    )


def matrices(table: np.ndarray) -> np.ndarray:
    """Constants (p, 11) of rows (p, 6) of elastic.py: what a contact does as a matrix.

    Of the force on i by Δx, Δy of j relative to i and by θ_j: [xx, xy, yy, xθ, yθ], of the moment [θx, θy, θθ], and
    what θ_i adds to force and moment, [x, y, θ].
    """
    x, y, ratio, arm_i, arm_j, bending = table.T
    across, up = -ratio * y, ratio * x  # √k_s t
    return np.stack(
        [
            x * x + across * across,
            x * y + across * up,
            y * y + up * up,
            -across * arm_j,
            -up * arm_j,
            arm_i * across,
            arm_i * up,
            bending - arm_i * arm_j,
            -across * arm_i,
            -up * arm_i,
            -bending - arm_i * arm_i,
        ],
        axis=1,
    )


@dataclass(frozen=True, eq=False)
class _Ends:
    """Ends of contacts: slots of owner and neighbour (e,) from 0 on, rows and the owner's column, line of the table."""

    slot: np.ndarray
    other: np.ndarray
    row: np.ndarray
    other_row: np.ndarray
    column: np.ndarray
    line: np.ndarray

    @classmethod
    def of(cls, assembly: Assembly, plan: RowPlan, row_of: np.ndarray) -> "_Ends":
        i, j = assembly.pairs.T
        slot = plan.slot
        owner, other = np.concatenate([i, j]), np.concatenate([j, i])
        lines = np.concatenate([row_of[2 * assembly.contact_type], row_of[2 * assembly.contact_type + 1]])
        return cls(slot[owner], slot[other], plan.row[owner], plan.row[other], plan.column[owner], lines)

    def at(self, chosen: np.ndarray) -> "_Ends":
        return _Ends(*(getattr(self, each.name)[chosen] for each in fields(self)))


@dataclass(frozen=True, eq=False)
class _Entries:
    """Contacts that many disks of a row have: row, line, shift (slots to the neighbour) and mask (k,), masks (m,)."""

    row: np.ndarray
    line: np.ndarray
    shift: np.ndarray
    mask: np.ndarray
    masks: np.ndarray

    @classmethod
    def joined(cls, lists: list["_Entries"]) -> "_Entries":
        begin = np.cumsum([0, *(len(entries.masks) for entries in lists)])
        mask = [np.where(e.mask < 0, e.mask, e.mask + at) for e, at in zip(lists, begin[:-1], strict=True)]
        nothing = np.zeros(0, dtype=np.int64)
        return cls(
            np.concatenate([nothing, *(e.row for e in lists)]),
            np.concatenate([nothing, *(e.line for e in lists)]),
            np.concatenate([nothing, *(e.shift for e in lists)]),
            np.concatenate([nothing, *mask]),
            np.concatenate([np.zeros(0, np.uint8), *(e.masks for e in lists)]),
        )


def _take_most(ends: _Ends, plan: RowPlan) -> tuple[_Entries, _Ends]:
    """One entry for each row and line, of the ends whose neighbour is as many slots away; and the ends left over.

    Which distance is tried is that of the last end listed. Entries that are not worth a mask are given up as a whole.
    """
    keys = ends.row * (int(ends.line.max()) + 1) + ends.line
    _, first, entry = np.unique(keys, return_index=True, return_inverse=True)
    shift = ends.other - ends.slot
    tried = np.empty(len(first), dtype=np.int64)
    last = np.empty(len(first), dtype=np.int64)
    tried[entry], last[entry] = shift, np.arange(len(shift))
    alike = shift == tried[entry]
    row, line, to = ends.row[first], ends.line[first], ends.other_row[last]
    live, columns, group = np.bincount(plan.row), plan.columns[plan.group], plan.group
    lanes_used = np.bincount(entry[alike], minlength=len(tried))
    blocks_used = np.bincount(np.unique(np.stack([entry[alike], ends.column[alike]]), axis=1)[0], minlength=len(tried))
    cost = BLOCK_COST * blocks_used + SKIP_COST * (columns[row] - blocks_used)
    worth = cost <= STRAY_COST * lanes_used
    whole = (group[row] == group[to]) & (tried == LANES * (to - row))
    whole &= (lanes_used == live[row]) & (lanes_used == live[to])
    masked = worth & ~whole
    size = np.where(masked, columns[row], 0)
    mask = np.where(masked, np.cumsum(size) - size, -1)
    masks = np.zeros(int(size.sum()), dtype=np.uint8)
    listed = alike & masked[entry]
    bit = np.left_shift(1, ends.slot[listed] % LANES).astype(np.uint8)
    np.bitwise_or.at(masks, mask[entry[listed]] + ends.column[listed], bit)
    return _Entries(row[worth], line[worth], tried[worth], mask[worth], masks), ends.at(~(alike & worth[entry]))


def _strays(ends: _Ends, begin: int) -> dict[str, np.ndarray]:
    """The ends that are in no entry, by their owners, see `LaneRows`."""
    ends = ends.at(np.lexsort((ends.other, ends.line, ends.slot)))
    slot, start = np.unique(ends.slot, return_index=True)
    return {
        "stray": begin + slot,
        "stray_start": np.append(start, len(ends.slot)),
        "stray_neighbour": (begin + ends.other).astype(np.uint32),
        "stray_type": ends.line.astype(np.uint32),
    }
