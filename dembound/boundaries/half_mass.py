"""Sides whose particles are half cells: half their mass, and half the contacts along the side.

The end disk of a chain has its whole mass, so it extends half a diameter beyond the position of its dashpot, and
reflects |R| = tan(qa/4) of a wave. With half the mass it reflects tan²(qa/4). A row of such disks is half a row of the
lattice. So the contacts between them, which resist the rotation of the disks under S waves, are half contacts, too.

The last disk of such a row, at a corner, is also a particle of the side across. There only half of its diameter is
inside the scene, so that dashpots, springs and mirror contacts of that side are halved as well: the row has the
impedance ρcD/2. With whole diameters there a side of N disks between two sides of half cells has N/(N − 1) times the
impedance of the scene and reflects −1/(2N − 1) of a P wave.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.support import Edge


def mass_factor(count: int, edges: Mapping[str, Edge], boundary: Mapping[str, Boundary]) -> np.ndarray:
    """Factor (n,) of the mass and moment of inertia of all `count` particles.

    A half for the particles of every side with ``half_mass``, so a quarter where two of them meet.
    edges and boundary: side -> its particles, side -> its table.
    """
    factor = np.ones(count)
    for edge in half_edges(edges, boundary):
        factor[edge.nodes] *= 0.5
    return factor


def with_shares(count: int, edges: Mapping[str, Edge], boundary: Mapping[str, Boundary]) -> dict[str, Edge]:
    """The sides with the shares of their particles: a half for those in a row of half cells of another side."""
    shared = {}
    for side, edge in edges.items():
        others = {name: other for name, other in edges.items() if name != side}
        shared[side] = replace(edge, shares=mass_factor(count, others, boundary)[edge.nodes])
    return shared


def half_edges(edges: Mapping[str, Edge], boundary: Mapping[str, Boundary]) -> Iterator[Edge]:
    """The sides whose particles are half cells."""
    for side, edge in edges.items():
        if side in boundary and boundary[side].half_cells:
            yield edge


def half_contacts(
    first: np.ndarray,
    second: np.ndarray,
    vectors: np.ndarray,
    edges: Mapping[str, Edge],
    boundary: Mapping[str, Boundary],
) -> np.ndarray:
    """Mask (b,) of contacts that run along a side of half cells, between particles first and second (b,).

    vectors (b, 2) m between their centres, of either sign.
    """
    halved = np.zeros(len(first), dtype=np.bool_)
    for edge in half_edges(edges, boundary):
        along = np.abs(vectors[:, 1 - edge.axis]) > np.abs(vectors[:, edge.axis])
        halved |= along & np.isin(first, edge.nodes) & np.isin(second, edge.nodes)
    return halved
