"""The springs of sides of dashpots on their motion relative to the ground beyond."""

from collections.abc import Sequence
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
    bearing: Bearing, table: BearingDashpots, media: Sequence[tuple[Edge, BoundaryMedium]], twin: np.ndarray | None
) -> Springs:
    """The springs (αG/L)D at the particles of a side; twin (n,) : of each node in the free-field column, if any.

    media : the parts of the side, by layer. G is that of the dashpots' medium, or of the rock beyond, L the length of
    the side.
    """
    length = sum(edge.length for edge, _ in media)
    across, along = bearing.alpha_n, bearing.alpha_s
    parts = []
    for edge, medium in media:
        modulus = medium.shear_modulus if table.rock is None else table.rock.shear_modulus
        factors = (across, along) if edge.axis == 0 else (along, across)
        parts.append(np.outer(edge.widths * modulus / length, factors))
    node, stiffness = np.concatenate([edge.nodes for edge, _ in media]), np.concatenate(parts)
    widths = np.concatenate([edge.widths * (edge.axis == 1) for edge, _ in media])
    order = np.argsort(node, kind="stable")
    node, weight = node[order], widths[order] / max(widths.sum(), np.finfo(float).tiny)
    return Springs(node, np.full(len(node), -1) if twin is None else twin[node], weight, stiffness[order])


def together(each: Sequence[Springs]) -> Springs:
    """The springs of several sides in one table; a node of two sides has those of both."""
    node, first = np.unique(np.concatenate([one.node for one in each]), return_index=True)
    twin, weight = np.concatenate([one.twin for one in each])[first], np.zeros(len(node))
    stiffness = np.zeros((len(node), 2))
    for one in each:
        at = np.searchsorted(node, one.node)
        weight[at] += one.weight
        stiffness[at] += one.stiffness
    return Springs(node, twin, weight, stiffness)


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
        self.nodes = springs.node

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
        twin, line = np.where(twin >= 0, slot[twin], -1), np.searchsorted(supported, node)
        return Bearings(slot[node], twin, line, weight, stiffness, self._rest, self.force_on(supported))
