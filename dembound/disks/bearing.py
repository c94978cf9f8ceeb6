"""The springs of a bottom of dashpots on its motion relative to the ground beyond, as arrays."""

from typing import NamedTuple

import numpy as np

from dembound.boundaries.support import BoundaryMedium, Edge
from dembound.boundaries.viscous import Bearing, BearingDashpots


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
