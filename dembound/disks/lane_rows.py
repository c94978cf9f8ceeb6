"""Rows of the copies of each disk of the brick, and the contacts between rows, for kernels/elastic_lanes.py."""

from dataclasses import dataclass

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


@dataclass(frozen=True, eq=False)
class RowPlan:
    """Where the disks of an assembly stand in rows of copies, r of them.

    row (n,) row of each disk; lane (n,) its place there; first (r + 1,) the block of eight slots each row begins with,
    from 0 on.
    """

    row: np.ndarray
    lane: np.ndarray
    first: np.ndarray

    @property
    def slot(self) -> np.ndarray:
        """(n,) slot of each disk, from 0 on."""
        return LANES * self.first[self.row] + self.lane


def plan_rows(assembly: Assembly) -> RowPlan:
    """Rows of the copies of each disk of the brick, those in rows that close the frame apart.

    Copies follow each other along the shorter side of the scene first.
    """
    (across, up), tile = assembly.copies, assembly.tile.astype(np.int64)
    closes_x, closes_y = tile[:, 0] >= across, tile[:, 1] >= up
    along_x = assembly.size[0] < assembly.size[1]
    regular = tile[:, 1] * across + tile[:, 0] if along_x else tile[:, 0] * up + tile[:, 1]
    place = np.where(closes_x, tile[:, 1], np.where(closes_y, tile[:, 0], regular))
    group = 4 * assembly.brick_particle.astype(np.int64) + 2 * closes_x + closes_y
    _, row = np.unique(group, return_inverse=True)
    count = int(row.max()) + 1
    low, high = np.full(count, np.iinfo(np.int64).max), np.zeros(count, dtype=np.int64)
    np.minimum.at(low, row, place)
    np.maximum.at(high, row, place)
    blocks = (high - low) // LANES + 1
    return RowPlan(row, place - low[row], np.concatenate([[0], np.cumsum(blocks)]))


def lane_rows(
    assembly: Assembly, ground: PackedMaterial, plan: RowPlan, begin: int, slots: int, fraction: np.ndarray
) -> LaneRows:
    """The contacts of an assembly between its rows.

    begin : slot of the first block; slots : number of slots of the scene; fraction (n,) of its mass that each disk has.
    """
    table, row_of = elastic_constants(ground)
    constants = matrices(table)
    first_block = begin // LANES
    first = first_block + plan.first
    rows, blocks = len(first) - 1, np.diff(plan.first)
    live = np.bincount(plan.row, minlength=rows)
    ends = _Ends.of(assembly, plan, row_of)
    entries: list[_Entries] = []
    for _ in range(ROUNDS):
        if len(ends.line) == 0:
            break
        found, ends = _take_most(ends, plan, blocks, live)
        entries.append(found)
    joined = _Entries.joined(entries)
    order = np.argsort(joined.row, kind="stable")
    whole = joined.mask < 0
    own = np.zeros((rows, 3))
    np.add.at(own, joined.row[whole], constants[joined.line[whole], 8:])
    start = np.concatenate([[0], np.cumsum(np.bincount(joined.row, minlength=rows))])
    special = np.zeros(first_block + plan.first[-1], dtype=np.bool_)
    slot = begin + plan.slot
    special[slot[fraction != 1.0] // LANES] = True
    special[(begin + ends.slot) // LANES] = True
    mass, inertia = np.zeros(rows), np.zeros(rows)
    mass[plan.row] = ground.mass[assembly.brick_particle]
    inertia[plan.row] = ground.inertia[assembly.brick_particle]
    return LaneRows(
        first=first,
        mass=mass,
        inertia=inertia,
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
    """Ends of contacts: owner and neighbour slot (e,) from 0 on, row of the owner, line, of the table of constants."""

    slot: np.ndarray
    other: np.ndarray
    row: np.ndarray
    line: np.ndarray

    @classmethod
    def of(cls, assembly: Assembly, plan: RowPlan, row_of: np.ndarray) -> "_Ends":
        i, j = assembly.pairs.T
        slot = plan.slot
        owner, other = np.concatenate([i, j]), np.concatenate([j, i])
        lines = np.concatenate([row_of[2 * assembly.contact_type], row_of[2 * assembly.contact_type + 1]])
        return cls(slot[owner], slot[other], plan.row[owner], lines)

    def at(self, chosen: np.ndarray) -> "_Ends":
        return _Ends(self.slot[chosen], self.other[chosen], self.row[chosen], self.line[chosen])


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


def _take_most(ends: _Ends, plan: RowPlan, blocks: np.ndarray, live: np.ndarray) -> tuple[_Entries, _Ends]:
    """One list for each row and line, of the ends whose neighbour is as many slots away; and the ends left over.

    Which distance is tried is that of the last end listed. Lists that are not worth a mask are given up as a whole.
    """
    _, representative, group = np.unique(
        ends.row * (int(ends.line.max()) + 1) + ends.line, return_index=True, return_inverse=True
    )
    shift = ends.other - ends.slot
    tried = np.empty(len(representative), dtype=np.int64)
    tried[group] = shift
    alike = shift == tried[group]
    lanes_used = np.bincount(group[alike], minlength=len(tried))
    row, line = ends.row[representative], ends.line[representative]
    block = ends.slot // LANES
    block_used = np.unique(np.stack([group[alike], block[alike]]), axis=1)[0]
    blocks_used = np.bincount(block_used, minlength=len(tried))
    cost = BLOCK_COST * blocks_used + SKIP_COST * (blocks[row] - blocks_used)
    worth = cost <= STRAY_COST * lanes_used
    to = np.searchsorted(LANES * plan.first, LANES * plan.first[row] + tried, side="right") - 1
    inside = (to >= 0) & (to < len(blocks))
    to = np.where(inside, to, 0)
    whole = inside & (tried == LANES * (plan.first[to] - plan.first[row])) & (blocks[to] == blocks[row])
    whole &= (lanes_used == live[row]) & (lanes_used == live[to])
    masked = worth & ~whole
    mask = np.full(len(tried), -1)
    size = np.where(masked, blocks[row], 0)
    mask[masked] = (np.cumsum(size) - size)[masked]
    masks = np.zeros(int(size.sum()), dtype=np.uint8)
    listed = alike & masked[group]
    at = mask[group[listed]] + block[listed] - plan.first[ends.row[listed]]
    np.bitwise_or.at(masks, at, np.left_shift(1, ends.slot[listed] % LANES).astype(np.uint8))
    taken = alike & worth[group]
    left = ends.at(~taken)
    return _Entries(row[worth], line[worth], tried[worth], mask[worth], masks), left


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
