"""Pairs of disks with a history in rows of copies, as their first disks are, for kernels/bonded_lanes.py."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.disks.contacts.row_plan import RowPlan
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.compiler.start_strain import began_of_rows
from dembound.kernels.tables import PairRows
from dembound.pairwise import P, of_law

LEAST_SHARE = 0.3
"""Share of the lanes of a pair row that have to hold pairs; others are computed one by one."""

EMPTY = 2**40
"""Shift of a row without pairs."""


def _alike(plan: RowPlan) -> np.ndarray:
    """A number (g,) of each group of disks, the same for those whose disks may have rows of pairs with each other."""
    if not plan.by_level:
        return np.arange(len(plan.columns))
    shapes = np.diff(plan.group_row) * (plan.columns.max() + 1) + plan.columns
    return np.unique(shapes, return_inverse=True)[1]


@dataclass(frozen=True, eq=False)
class PairPlan:
    """The rows of pairs, q of them: all copies of a contact whose disks are as many slots apart.

    A pair is in the column and lane of its first disk. The second disk is in the same group of disks, or, where these
    are the rows of bricks, in another one with as many rows and columns; such groups have as many rows of pairs, of
    which the last may be empty, so that a disk finds its pairs of any group at the same distance in each column.

    first_block : that of the part's disks. key (q,), ascending: row of the first disk times `types`, plus the type of
    the contact; shift (q,) slots from the first disk to the second, `EMPTY` for rows without pairs; other (q,) row of
    the second; step_column, step_lane (q,) columns and lanes from the first to the second. group_row, group_block
    (g + 1,) rows and blocks of pairs in each group of disks.
    """

    plan: RowPlan
    first_block: int
    types: int
    key: np.ndarray
    shift: np.ndarray
    other: np.ndarray
    step_column: np.ndarray
    step_lane: np.ndarray
    group_row: np.ndarray
    group_block: np.ndarray

    @property
    def count(self) -> int:
        """Number of places for pairs in rows."""
        return LANES * int(self.group_block[-1])

    @classmethod
    def of(
        cls, i: np.ndarray, j: np.ndarray, contact_type: np.ndarray, types: int, plan: RowPlan, first_block: int
    ) -> "PairPlan":
        """Rows for pairs of particles i, j (b,) of so many types, whose disks begin with a block."""
        shift = plan.slot[j] - plan.slot[i]
        far = int(np.abs(shift).max(initial=0)) + 1
        key = plan.row[i] * types + contact_type
        _, sample, counts = np.unique(key * (2 * far) + shift + far, return_index=True, return_counts=True)
        most = np.lexsort((-counts, key[sample]))
        most = most[np.diff(key[sample][most], prepend=-1) > 0]
        group = plan.group[plan.row]
        kept = counts[most] >= LEAST_SHARE * LANES * plan.columns[group[i[sample[most]]]]
        sample, alike = sample[most[kept]], _alike(plan)
        sample = sample[alike[group[i[sample]]] == alike[group[j[sample]]]]
        i, j, key = i[sample], j[sample], key[sample]
        count = np.bincount(group[i], minlength=len(alike))
        width = np.zeros_like(count)
        np.maximum.at(width, alike, count)
        last = np.repeat(plan.group_row[1:], width[alike] - count) - 1  # the last row of disks of each empty row
        still = np.zeros(len(last), dtype=np.int64)
        filled = np.concatenate([key, (last + 1) * types - 1])
        order = np.argsort(filled, kind="stable")  # which is the order of groups
        return cls(
            plan=plan,
            first_block=first_block,
            types=types,
            key=filled[order],
            shift=np.concatenate([shift[sample], still + EMPTY])[order],
            other=np.concatenate([plan.row[j], last])[order],
            step_column=np.concatenate([plan.column[j] - plan.column[i], still])[order],
            step_lane=np.concatenate([plan.lane[j] - plan.lane[i], still])[order],
            group_row=np.concatenate([[0], np.cumsum(width[alike])]),
            group_block=np.concatenate([[0], np.cumsum(width[alike] * plan.columns)]),
        )

    def place(self, first: np.ndarray, second: np.ndarray, contact_type: np.ndarray) -> np.ndarray:
        """Place (b,) of pairs of particles (b,) in the rows, −1 for those that are in none."""
        plan = self.plan
        place = np.full(len(first), -1)
        if len(self.key) == 0 or len(first) == 0:
            return place
        slot, group = plan.slot, plan.group
        key = plan.row[first] * self.types + contact_type
        q = np.minimum(np.searchsorted(self.key, key), len(self.key) - 1)
        fits = (contact_type < self.types) & (self.key[q] == key) & (self.shift[q] == slot[second] - slot[first])
        q, i = q[fits], first[fits]
        g = group[plan.row[i]]
        block = self.group_block[g] + plan.column[i] * np.diff(self.group_row)[g] + q - self.group_row[g]
        place[fits] = LANES * block + plan.lane[i]
        return place

    def rows(self, place: np.ndarray, constants: np.ndarray) -> PairRows:
        """The rows for kernels; place (b,) of the pairs that are in them, constants (types, c + 3) of contacts."""
        exists = np.zeros(int(self.group_block[-1]), dtype=np.uint8)
        np.bitwise_or.at(exists, place // LANES, np.left_shift(1, place % LANES).astype(np.uint8))
        lines = constants[self.key % self.types]
        way = lines[:, :2] / lines[:, P.rest, None]
        return self._empty._replace(exists=exists, constants=of_law(lines), way=way, began=began_of_rows(lines))

    @cached_property
    def _empty(self) -> PairRows:
        """The rows without pairs."""
        plan = self.plan
        owner, group = self.key // self.types, plan.group[self.key // self.types]
        within = np.arange(len(self.key)) - self.group_row[group]
        apart = self.group_block[group] - self.group_block[plan.group[self.other]]
        back = LANES * (apart + within - self.step_column * np.diff(self.group_row)[group]) - self.step_lane
        row, offset = np.concatenate([owner, self.other]), np.concatenate([LANES * within, back])
        mask, masks = self._masks(group)
        mask = np.concatenate([np.full(len(owner), -1), mask])
        kind = np.repeat([0, 1], len(owner)) + (mask >= 0)
        order = np.lexsort((offset, kind, row))
        order = order[np.tile(self.shift < EMPTY, 2)[order]]
        row, kind = row[order], kind[order]
        counts = np.bincount(3 * row + kind, minlength=3 * int(plan.group_row[-1])).reshape(-1, 3)
        return PairRows(
            group_row=self.group_row,
            group_block=self.group_block,
            disk_block=self.first_block + plan.group_block[:-1],
            disk_rows=np.diff(plan.group_row),
            step=np.column_stack([owner - plan.group_row[group], self.shift]),
            constants=np.zeros((0, 0)),
            way=np.zeros((0, 2)),
            began=0.0,
            exists=np.zeros(0, dtype=np.uint8),
            start=np.concatenate([[0], np.cumsum(counts)]),
            offset=offset[order],
            mask=mask[order],
            masks=masks,
            contact_type=(self.key % self.types).astype(np.uint32),
        )

    def _masks(self, group: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Offsets and bytes of masks of columns and lanes whose second disk has its pair within the rows.

        Offset −1 : the pair is in the same column and lane. group (q,) of each row of pairs.
        """
        apart = np.flatnonzero((self.step_column != 0) | (self.step_lane != 0))
        steps = np.column_stack([self.plan.columns[group], self.step_column, self.step_lane])[apart]
        kinds, kind = np.unique(steps, axis=0, return_inverse=True)
        masks = [np.zeros(0, np.uint8)]
        for columns, step_column, step_lane in kinds:
            column = np.arange(columns) - step_column
            lane = np.arange(LANES) - step_lane
            byte = np.packbits((lane >= 0) & (lane < LANES), bitorder="little")[0]
            masks.append(np.where((column >= 0) & (column < columns), byte, 0).astype(np.uint8))
        mask = np.full(len(group), -1)
        mask[apart] = np.concatenate([[0], np.cumsum(kinds[:, 0])])[kind.reshape(-1)]
        return mask, np.concatenate(masks)
