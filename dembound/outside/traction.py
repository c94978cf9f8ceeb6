"""A uniform traction on the free edges of a mesh, as forces on its nodes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dembound.boundaries.sides import SIDES, normal_axis
from dembound.outside.mesh import Mesh
from dembound.table import Box

ROUNDING = 1e-9
"""Distance over the size of the mesh up to which places are the same."""

NO_DEPTH: Mapping[str, float] = {}


@dataclass(frozen=True, eq=False)
class Traction:
    """A uniform traction on the part of the free edges of a mesh in a rectangle.

    Attributes
    ----------
    node : (k,) on which it acts, ascending. share : (k,) of the whole force: shape functions integrated over the part,
    so that resultant and moment are those of the traction. length : m, of the part. least : m, the longest of the
    elements' edges in it. absorbs : whether it reaches elements that absorb, whose nodes are left out.
    """

    node: np.ndarray
    share: np.ndarray
    length: float
    least: float
    absorbs: bool


def traction_in(mesh: Mesh, region: Box, depth: Mapping[str, float] = NO_DEPTH) -> Traction:
    """The uniform traction on the free edges in a region; without any its length is zero.

    depth : by side, how deep the mesh's edge lies below that of the ground, m; the region may contain either.
    """
    parts = [_part(mesh, side, region, depth.get(side, 0.0)) for side in SIDES if _is_free(mesh, side)]
    parts.append(_NOWHERE)
    node, place = np.unique(np.concatenate([part.node.ravel() for part in parts]), return_inverse=True)
    forces = np.concatenate([part.force.ravel() for part in parts])
    length = sum(part.length for part in parts)
    share = np.bincount(place, forces, len(node)) / (length or 1.0)
    return Traction(node, share, length, max(part.least for part in parts), any(part.absorbs for part in parts))


class _Part(NamedTuple):
    """A traction of 1 N/m on one side: nodes (q, N), forces on them (q, N) N, and as in `Traction`."""

    node: np.ndarray
    force: np.ndarray
    length: float
    least: float
    absorbs: bool


_NOWHERE = _Part(np.zeros(0, dtype=np.int64), np.zeros(0), 0.0, 0.0, absorbs=False)


def _is_free(mesh: Mesh, side: str) -> bool:
    """Whether a mesh ends at a side, with a free edge."""
    axis, end = normal_axis(side), int(side in ("right", "top"))
    return not (mesh.periodic[axis] or mesh.layer.along(axis)[end] or mesh.mirror.along(axis)[end])


def _part(mesh: Mesh, side: str, region: Box, depth: float) -> _Part:
    """The part of a side in a region."""
    axis, end = normal_axis(side), int(side in ("right", "top"))
    along, near = 1 - axis, ROUNDING * float(mesh.size.max())
    level = float(mesh.origin[axis] + end * mesh.size[axis])
    levels = level, level + (depth if end else -depth)
    if region[axis] > max(levels) + near or region[2 + axis] < min(levels) - near:
        return _NOWHERE
    element = np.flatnonzero(mesh.elements[:, axis] == end * (mesh.cells[axis] - 1))
    node = (mesh.nodes if axis == 1 else mesh.nodes.swapaxes(1, 2))[element, -end]
    begin, size = mesh.positions[node[:, 0], along], mesh.element_sizes[element, along]
    first, last = np.maximum(begin, region[along]), np.minimum(begin + size, region[2 + along])
    inside, absorbs = last - first > near, mesh.absorbs[element].any(axis=1)
    kept = inside & ~absorbs
    node, begin, size, first, last = (values[kept] for values in (node, begin, size, first, last))
    force = size[:, None] * _integrals(mesh, (first - begin) / size, (last - begin) / size)
    reaches = bool((inside & absorbs).any())
    return _Part(node, force, float(np.sum(last - first)), float(size.max(initial=0.0)), reaches)


def _integrals(mesh: Mesh, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Integrals (q, N) of shape functions along an edge of length 1, between places (q,) on it, 0 … 1."""
    points, weights = np.polynomial.legendre.leggauss(mesh.order)  # exact beyond the degree of the shape functions
    local = (first + last - 1.0)[:, None] + (last - first)[:, None] * points
    shape = mesh.rule.shape(local.ravel()).reshape(*local.shape, mesh.rule.count)
    return 0.5 * (last - first)[:, None] * np.einsum("g,qgk->qk", weights, shape)
