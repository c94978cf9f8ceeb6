"""Pairs of disks with a history in rows of copies, as their first disks are, for kernels/bonded_lanes.py."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.disks.contacts.row_plan import RowPlan
from dembound.kernels.lanes import LANES
from dembound.kernels.tables import PairRows

LEAST_SHARE = 0.3
"""Share of the lanes of a pair row that have to hold pairs; others are computed one by one."""


@dataclass(frozen=True, eq=False)
class PairPlan:
    """The rows of pairs, q of them: all copies of a contact whose disks are as many slots apart.

    A pair is in the column and lane of its first disk. first_block : that of the part's disks. key (q,), ascending: row
    of the first disk times `types`, plus the type of the contact; shift (q,) slots from the first disk to the second;
    other (q,) row of the second; step_column, step_lane (q,) columns and lanes from the first to the second. group_row,
    group_block (g + 1,) rows and blocks of pairs in each group of disks.
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
        sample = sample[most[kept]]
        sample = sample[group[i[sample]] == group[j[sample]]]
        i, j, key = i[sample], j[sample], key[sample]
        group_row = np.searchsorted(group[i], np.arange(len(plan.columns) + 1))  # rows are in the order of groups
        return cls(
            plan=plan,
            first_block=first_block,
            types=types,
            key=key,
            shift=shift[sample],
            other=plan.row[j],
            step_column=plan.column[j] - plan.column[i],
            step_lane=plan.lane[j] - plan.lane[i],
            group_row=group_row,
            group_block=np.concatenate([[0], np.cumsum(np.diff(group_row) * plan.columns)]),
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
        """The rows for kernels; place (b,) of the pairs that are in them, constants (types, 15) of contacts."""
        exists = np.zeros(int(self.group_block[-1]), dtype=np.uint8)
        np.bitwise_or.at(exists, place // LANES, np.left_shift(1, place % LANES).astype(np.uint8))
        lines = constants[self.key % self.types]
        return self._empty._replace(exists=exists, constants=np.column_stack([lines, lines[:, :2] / lines[:, 2:3]]))

    @cached_property
    def _empty(self) -> PairRows:
        """The rows without pairs."""
        plan = self.plan
        owner, group = self.key // self.types, plan.group[self.key // self.types]
        within = np.arange(len(self.key)) - self.group_row[group]
        back = LANES * (within - self.step_column * np.diff(self.group_row)[group]) - self.step_lane
        row, offset = np.concatenate([owner, self.other]), np.concatenate([LANES * within, back])
        mask, masks = self._masks(group)
        mask = np.concatenate([np.full(len(owner), -1), mask])
        kind = np.repeat([0, 1], len(owner)) + (mask >= 0)
        order = np.lexsort((offset, kind, row))
        counts = np.bincount(3 * row + kind, minlength=3 * int(plan.group_row[-1])).reshape(-1, 3)
        return PairRows(
            group_row=self.group_row,
            group_block=self.group_block,
            disk_block=self.first_block + plan.group_block[:-1],
            disk_rows=np.diff(plan.group_row),
            step=np.column_stack([owner - plan.group_row[group], self.shift]),
            constants=np.zeros((0, 17)),
            exists=np.zeros(0, dtype=np.uint8),
            start=np.concatenate([[0], np.cumsum(counts)]),
            offset=offset[order],
            mask=mask[order],
            masks=masks,
        )

    def _masks(self, group: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Offsets and bytes of masks of columns and lanes whose second disk has its pair within the rows.

        Offset −1 : the pair is in the same column and lane. group (q,) of each row of pairs.
        """
        apart = (self.step_column != 0) | (self.step_lane != 0)
        mask, masks, begin = np.full(len(group), -1), [np.zeros(0, np.uint8)], 0
        for q in np.flatnonzero(apart):
            columns = int(self.plan.columns[group[q]])
            column = np.arange(columns) - self.step_column[q]
            lane = np.arange(LANES) - self.step_lane[q]
            byte = np.packbits((lane >= 0) & (lane < LANES), bitorder="little")[0]
            masks.append(np.where((column >= 0) & (column < columns), byte, 0).astype(np.uint8))
            mask[q], begin = begin, begin + columns
        return mask, np.concatenate(masks)
