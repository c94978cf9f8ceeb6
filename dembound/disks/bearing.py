"""The springs of a bottom of dashpots on its motion relative to the ground beyond."""

from typing import NamedTuple

import numpy as np

from dembound.boundaries.edge import BoundaryMedium, Edge
from dembound.boundaries.viscous import Bearing, BearingDashpots
from dembound.kernels import follower  # noqa: F401  # it registers its tie
from dembound.kernels.tables.motion import Bearings
from dembound.motion.part import Tie
from dembound.motion.state import Layout


class Springs(NamedTuple):
    """Springs of nodes (k,), ascending: twin (k,) or −1, weight (k,) in the mean motion, stiffness (k, 2) N/m."""

    node: np.ndarray
    twin: np.ndarray
    weight: np.ndarray
    stiffness: np.ndarray


def bearing_springs(
    bearing: Bearing, table: BearingDashpots, edge: Edge, medium: BoundaryMedium, twin: np.ndarray | None
) -> Springs:
    """The springs (αG/L)D at the particles of a bottom; twin (n,) : of each node in the free-field column, if any.

    G is that of the dashpots' medium, or of the rock beyond the bottom, L the length of the bottom.
    """
    modulus = medium.shear_modulus if table.rock is None else table.rock.shear_modulus
    stiffness = np.outer(edge.widths * modulus / edge.length, (bearing.alpha_s, bearing.alpha_n))
    order = np.argsort(edge.nodes, kind="stable")
    node, weight = edge.nodes[order], edge.widths[order] / edge.widths.sum()
    return Springs(node, np.full(len(node), -1) if twin is None else twin[node], weight, stiffness[order])


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
