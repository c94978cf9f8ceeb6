"""Memories of past forces, by which ground is damped: of the disks of a part, and of the forces of ties."""

import numpy as np

from dembound.disks.contacts.layout import Rows
from dembound.kernels.damped import remember_crossing
from dembound.kernels.lanes import LANES
from dembound.kernels.tables import Crossing, Drag, LaneRows, Memories, NoDrag, TieMemories
from dembound.motion.layout import Layout, aligned_zeros
from dembound.motion.part import Tie
from dembound.motion.state import Arrays


class DiskMemories:
    """Memories of the contact forces on the disks of a part.

    Parameters
    ----------
    factors : (layers, 2, K) see `factors_of`. layer : (m,) number of the layer of each disk. rows : their contacts.
    nodes : their range among the scene's nodes. layout : the slots of these. supported : (k,) ascending slots of all
    supported nodes. crossing : memories of contacts between layers. drag : on the disks.
    """

    def __init__(
        self,
        factors: np.ndarray,
        layer: np.ndarray,
        rows: Rows,
        nodes: slice,
        layout: Layout,
        supported: np.ndarray,
        crossing: Crossing,
        drag: Drag | NoDrag,
    ) -> None:
        slot = layout.slot[nodes]
        block = int(slot.min()) // LANES
        end = int(rows.group_block[-1]) if isinstance(rows, LaneRows) else -(-(int(slot.max()) + 1) // LANES)
        layers = np.zeros(layout.count, dtype=np.uint8)
        layers[slot] = layer
        empty = np.ones(layout.count, dtype=bool)
        empty[slot] = False
        special = np.zeros(-(-layout.count // LANES), dtype=np.uint8)
        special[np.union1d(supported, crossing.target) // LANES] = 1
        inner, unused = (each[LANES * block : LANES * end].reshape(-1, LANES) for each in (layers, empty))
        inner[unused] = np.repeat(np.where(unused, 0, inner).max(axis=1), unused.sum(axis=1))
        special[block:end] |= 2 * (inner.min(axis=1) != inner.max(axis=1)).astype(np.uint8)
        self._slot = slot - LANES * block
        memory = aligned_zeros(3 * factors.shape[2], LANES * (end - block))
        force = aligned_zeros(3, layout.count)
        rest, held = np.zeros((3, 0)), np.zeros(1)
        self.arrays = Memories(block, layers, special, factors, memory, rest, force, held, crossing, drag)

    def rest_at(self, u: np.ndarray, force: np.ndarray) -> None:
        """Remember only differences from contact forces (3, slots) at rest, at displacements u (3, slots)."""
        crossing = self.arrays.crossing
        memory, factors = np.zeros((len(crossing.target), 3, 1)), np.zeros((len(crossing.target), 2, 1))
        factors[:, 1] = 1.0
        rest = np.zeros_like(crossing.rest)
        remember_crossing(crossing._replace(factors=factors, memory=memory, rest=np.zeros_like(rest), taken=rest), u, u)
        self.arrays = self.arrays._replace(rest=force, crossing=crossing._replace(rest=rest))

    def saved_arrays(self) -> Arrays:
        """The memories (3K, m) of the disks, and (t, 3, K) of contacts between layers."""
        return {"memory": np.take(self.arrays.memory, self._slot, axis=1), "crossing": self.arrays.crossing.memory}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        self.arrays.memory[:, self._slot] = saved["memory"]
        self.arrays.crossing.memory[...] = saved["crossing"]


class DampedTies(Tie):
    """Memories of the forces of all ties of a scene; the last of its ties.

    Parameters
    ----------
    nodes : (t,) on which ties act, ascending. factors : (t, 2, K) of each, see `factors_of`.
    """

    name = "damped_ties"

    def __init__(self, nodes: np.ndarray, factors: np.ndarray) -> None:
        self._nodes, self._factors = nodes, factors
        self._memory = np.zeros((len(nodes), 3, factors.shape[2]))
        self._rest = np.zeros((len(nodes), 3))

    @property
    def nodes(self) -> np.ndarray:
        """Nodes (t,) that ties act on, ascending."""
        return self._nodes

    def bundle(self, supported: np.ndarray) -> TieMemories:
        """The arrays of the tie for the kernels; supported (s,) are all nodes of the support table, ascending."""
        line = np.searchsorted(supported, self._nodes)
        return TieMemories(line, self._factors, self._memory, self._rest)

    def rest_at(self, force: np.ndarray) -> None:
        """Remember only differences from these forces (3, n) of ties on all nodes at rest."""
        self._rest = np.ascontiguousarray(force[:, self._nodes].T)

    def saved_arrays(self) -> Arrays:
        """The memories."""
        return {"memory": self._memory}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        self._memory[...] = saved["memory"]
