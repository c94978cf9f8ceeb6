"""The outer edges of a mesh: its free surface and its sides."""

import numpy as np

from dembound.boundaries.sides import SIDES, normal_axis
from dembound.outside.mesh import Mesh


def is_free(mesh: Mesh, side: str) -> bool:
    """Whether a mesh ends at a side with a free edge."""
    axis, end = divmod(SIDES.index(side), 2)
    return not (mesh.periodic[axis] or mesh.layer.along(axis)[end] or mesh.mirror.along(axis)[end])


def elements_at(mesh: Mesh, side: str) -> np.ndarray:
    """The elements (k,) with an edge on a side; at the top the highest of each column that does not end at the box."""
    axis, end = divmod(SIDES.index(side), 2)
    column, place = mesh.elements[:, 0], mesh.elements[:, axis]
    if end == 0:
        return np.flatnonzero(place == 0)
    return np.flatnonzero(place + 1 == (mesh.cells[0] if axis == 0 else mesh.tops[column]))


def nodes_at(mesh: Mesh, side: str) -> np.ndarray:
    """Nodes (k, N) on the edges of `elements_at`, in order along the side."""
    end = SIDES.index(side) % 2
    nodes = mesh.nodes if normal_axis(side) == 1 else mesh.nodes.swapaxes(1, 2)
    return nodes[elements_at(mesh, side), -end]


def edge_lengths(mesh: Mesh, side: str) -> np.ndarray:
    """(n,) m, of the quadrature along the outer edges at a side, for the nodes on them; 0 for others."""
    along = mesh.element_sizes[elements_at(mesh, side), 1 - normal_axis(side), None]
    return np.bincount(nodes_at(mesh, side).ravel(), (0.5 * along * mesh.rule.weights).ravel(), mesh.count)


def free_edges(mesh: Mesh) -> np.ndarray:
    """(k, 4) m, the ends x, y, x, y of the elements' edges that are free and do not face the box."""
    each, corners = [np.zeros((0, 4))], mesh.rectangles
    for side in SIDES:
        if is_free(mesh, side):
            axis, end = divmod(SIDES.index(side), 2)
            edge = corners[elements_at(mesh, side)]
            edge[:, [axis, axis + 2]] = edge[:, [axis + 2 * end]]
            each.append(edge)
    return np.concatenate(each)
