"""Bonds that broke."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

MANY = 10
"""Largest number of broken bonds of a run without a note that it is one draw of many."""


@dataclass(frozen=True)
class Cracks:
    """Bonds that broke, k of them, in the order in which they broke.

    step (k,) int64; pair (k, 2) int64 nodes; position (k, 2) m, the middle of the pair in that step; shear (k,) bool,
    True for shear, False for tension.
    """

    step: np.ndarray
    pair: np.ndarray
    position: np.ndarray
    shear: np.ndarray

    def __len__(self) -> int:
        return len(self.step)

    def among(self, kept: np.ndarray) -> "Cracks":
        """The cracks between two of the nodes kept (m,), ascending, with the numbering of these nodes."""
        inside = np.isin(self.pair, kept).all(axis=1)
        pair = np.searchsorted(kept, self.pair[inside])
        return Cracks(self.step[inside], pair, self.position[inside], self.shear[inside])


NO_CRACKS = Cracks(np.zeros(0, np.int64), np.zeros((0, 2), np.int64), np.zeros((0, 2)), np.zeros(0, np.bool_))
"""An empty list."""


def joined(lists: Sequence[Cracks]) -> Cracks:
    """Several lists of cracks as one, in the order of their steps."""
    columns = [np.concatenate([getattr(part, field.name) for part in [NO_CRACKS, *lists]]) for field in fields(Cracks)]
    order = np.argsort(columns[0], kind="stable")
    return Cracks(*(column[order] for column in columns))
