"""Sides whose particles keep half their mass.

The end disk of a chain stands half a diameter beyond what its dashpot should bound, with its whole mass: it returns
|R| = tan(qa/4) of a wave. With half the mass it returns tan²(qa/4).
"""

from collections.abc import Mapping

import numpy as np

from dembound.boundaries.support import Edge
from dembound.boundaries.viscous import Dashpots
from dembound.table import Table


def mass_factor(count: int, edges: Mapping[str, Edge], boundary: Mapping[str, Table]) -> np.ndarray:
    """Factor (n,) of the mass and moment of inertia of all `count` particles.

    A half for the particles of every side with ``half_mass``, so a quarter where two of them meet.
    edges and boundary: side -> its particles, side -> its table.
    """
    factor = np.ones(count)
    for side, edge in edges.items():
        table = boundary.get(side)
        if isinstance(table, Dashpots) and table.half_mass:
            factor[edge.nodes] *= 0.5
    return factor
