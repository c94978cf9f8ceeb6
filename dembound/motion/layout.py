"""The order of the nodes of a scene in kernels: every node has a slot, and some slots have no node."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

ALIGNMENT = 64
"""Bytes at whose multiples arrays of slots begin: a line of the caches, and eight doubles."""


def aligned_zeros(*shape: int, dtype: Any = np.float64) -> np.ndarray:
    """Zeros of this shape and type, at an aligned address (`ALIGNMENT`)."""
    kind = np.dtype(dtype)
    size = int(np.prod(shape)) * kind.itemsize
    room = np.zeros(size + ALIGNMENT, dtype=np.uint8)
    first = -room.ctypes.data % ALIGNMENT
    return room[first : first + size].view(kind).reshape(shape)


@dataclass(frozen=True, eq=False)
class Layout:
    """The assignment of n nodes to slots.

    Attributes
    ----------
    slot : (n,) int64, the slot of each node.
    count : number of slots.
    """

    slot: np.ndarray
    count: int

    @classmethod
    def plain(cls, nodes: int) -> "Layout":
        """Every node in the slot of its own number."""
        return cls(np.arange(nodes), nodes)

    @cached_property
    def node(self) -> np.ndarray:
        """(slots,) the node in each slot, −1 where there is none."""
        node = np.full(self.count, -1)
        node[self.slot] = np.arange(len(self.slot))
        return node

    @cached_property
    def is_plain(self) -> bool:
        """Whether each slot holds the node of the same number."""
        return len(self.slot) == self.count and bool((self.slot == np.arange(self.count)).all())

    def spread(self, values: np.ndarray) -> np.ndarray:
        """Values (..., n) of nodes as a new array of slots (..., slots), zero where there is no node."""
        spread = aligned_zeros(*values.shape[:-1], self.count)
        spread[..., self.slot] = values
        return spread

    def gather(self, values: np.ndarray) -> np.ndarray:
        """Values (..., slots) reordered by node (..., n), not to be written to; a view where possible.

        It is contiguous by row, as in a checkpoint, because numpy's order of summation depends on this.
        """
        gathered = values[...] if self.is_plain else np.take(values, self.slot, axis=-1)
        gathered.flags.writeable = False
        return gathered
