"""The outer edges of a mesh: its free surface and sides, and tractions on them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from dembound.boundaries.edge import SIDES, is_far, normal_axis
from dembound.continuum.mesh import Mesh
from dembound.table import Box


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


ROUNDING = 1e-9
"""Distance over the size of the mesh up to which places are regarded as equal."""

NO_DEPTH: Mapping[str, float] = {}


@dataclass(frozen=True, eq=False)
class Traction:
    """A uniform traction on the part of the free edges of a mesh in a rectangle.

    Attributes
    ----------
    node : (k,) on which it acts, ascending. share : (k,) of the total force: shape functions integrated over the part,
    so that resultant and moment are those of the traction. length : m, of the part. least : m, the longest of the
    elements' edges in it. absorbs : whether it reaches absorbing elements, whose nodes are left out.
    """

    node: np.ndarray
    share: np.ndarray
    length: float
    least: float
    absorbs: bool


def traction_in(mesh: Mesh, region: Box, depth: Mapping[str, float | np.ndarray] = NO_DEPTH) -> Traction:
    """The uniform traction on the free edges in a region; without any its length is zero.

    depth : by side, depth of the mesh's edge below that of the ground, m, uniform or at each node (n,); the
    region may contain either.
    """
    parts = [_part(mesh, side, region, depth.get(side, 0.0)) for side in SIDES if is_free(mesh, side)]
    nodes = [np.zeros(0, dtype=np.int64), *(part.node.ravel() for part in parts)]
    node, place = np.unique(np.concatenate(nodes), return_inverse=True)
    forces = np.concatenate([np.zeros(0), *(part.share.ravel() for part in parts)])
    length, least = sum(part.length for part in parts), max((part.least for part in parts), default=0.0)
    share = np.bincount(place, forces, len(node)) / (length or 1.0)
    return Traction(node, share, length, least, any(part.absorbs for part in parts))


def _part(mesh: Mesh, side: str, region: Box, depth: float | np.ndarray) -> Traction:
    """The traction of 1 N/m on the part of a side in a region: nodes (q, N), and as shares the forces on them, N."""
    axis, end = normal_axis(side), int(is_far(side))
    along, near = 1 - axis, ROUNDING * float(mesh.size.max())
    element, node = elements_at(mesh, side), nodes_at(mesh, side)
    level = mesh.positions[node[:, 0], axis]
    beyond = level + (2 * end - 1) * np.broadcast_to(depth, mesh.count)[node[:, 0]]
    there = (region[axis] <= np.maximum(level, beyond) + near) & (region[2 + axis] >= np.minimum(level, beyond) - near)
    begin, size = mesh.positions[node[:, 0], along], mesh.element_sizes[element, along]
    first, last = np.maximum(begin, region[along]), np.minimum(begin + size, region[2 + along])
    inside, absorbs = there & (last - first > near), mesh.absorbs[element].any(axis=1)
    kept = inside & ~absorbs
    node, begin, size, first, last = (values[kept] for values in (node, begin, size, first, last))
    force = size[:, None] * _integrals(mesh, (first - begin) / size, (last - begin) / size)
    reaches = bool((inside & absorbs).any())
    return Traction(node, force, float(np.sum(last - first)), float(size.max(initial=0.0)), reaches)


def _integrals(mesh: Mesh, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Integrals (q, N) of shape functions along an edge of length 1, between places (q,) on it, 0 … 1."""
    points, weights = np.polynomial.legendre.leggauss(mesh.order)  # exact beyond the degree of the shape functions
    local = (first + last - 1.0)[:, None] + (last - first)[:, None] * points
    shape = mesh.rule.shape(local.ravel()).reshape(*local.shape, mesh.rule.count)
    return 0.5 * (last - first)[:, None] * np.einsum("g,qgk->qk", weights, shape)
