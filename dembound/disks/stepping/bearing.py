"""The springs of a bottom of dashpots on its motion relative to the ground beyond it.

Forces of the static stage are constant, and dashpots have no force at rest: after changes within the body, as by
cracks, nothing would bring its bottom back. These springs do; they have no force on the motion of ground without the
body, which is that of the free-field column or, without a column, the mean motion of the bottom.
"""

from typing import NamedTuple

import numpy as np

from dembound.disks.bearing import Springs
from dembound.kernels import bearing  # noqa: F401  # it registers its tie
from dembound.kernels.tables import Bearings
from dembound.motion.layout import Layout
from dembound.motion.part import Tie


class BearingTie(Tie):
    """The springs as a tie.

    Parameters
    ----------
    springs : of the scene. layout : the slots of its nodes.
    """

    name = "bearing"

    def __init__(self, springs: Springs, layout: Layout) -> None:
        self._springs, self._layout = springs, layout
        self._rest = np.zeros((len(springs.node), 2))
        self._force = np.zeros((0, 3))

    @property
    def nodes(self) -> np.ndarray:
        """Nodes (k,) that it acts on, ascending."""
        return self._springs.node

    def rest_at(self, datum: np.ndarray) -> None:
        """Have no force at displacements (3, n)."""
        node, twin, weight, _ = self._springs
        moved = datum[:2, node].T
        self._rest[...] = moved - np.where(twin[:, None] >= 0, datum[:2, twin].T, weight @ moved)

    def force_on(self, supported: np.ndarray) -> np.ndarray:
        """The last forces (s, 3) on all nodes of the support table (s,), filled by the kernel."""
        if len(self._force) != len(supported):
            self._force = np.zeros((len(supported), 3))
        return self._force

    def bundle(self, supported: np.ndarray) -> NamedTuple:
        """The arrays for the kernels; supported (s,) are all nodes of the support table, ascending."""
        node, twin, weight, stiffness = self._springs
        slot = self._layout.slot
        return Bearings(
            node=slot[node],
            twin=np.where(twin >= 0, slot[twin], -1),
            line=np.searchsorted(supported, node),
            weight=weight,
            stiffness=stiffness,
            rest=self._rest,
            force=self.force_on(supported),
        )
