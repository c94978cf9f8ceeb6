"""Displacements of a mesh and their slopes at any points."""

from typing import NamedTuple

import numpy as np

from dembound.outside.mesh import Mesh


class Interpolation(NamedTuple):
    """Interpolation of nodal displacements at k points: Σ weight·u over node, both (k, N²)."""

    node: np.ndarray
    weight: np.ndarray


def located(mesh: Mesh, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The element (k,) of a mesh nearest to each of the points (k, 2) m, and their places (k, 2) in it, −1 … 1 inside.

    Above the free surface beside the box it is the highest element there, beyond periodic sides the element at the
    image.
    """
    places = np.asarray(points) - mesh.origin
    places = np.where(mesh.periodic, places % mesh.size, places)
    column, row = (mesh.axes[a].cell_at(places[:, a]) for a in (0, 1))
    chosen = mesh.element_at[np.minimum(row, mesh.tops[column] - 1), column]
    in_box = chosen < 0
    chosen[in_box] = _nearest_to_box(mesh, places[in_box])
    first = np.stack([mesh.axes[a].edges[mesh.elements[chosen, a]] for a in (0, 1)], axis=1)
    return chosen, 2.0 * (places - first) / mesh.element_sizes[chosen] - 1.0


def _nearest_to_box(mesh: Mesh, places: np.ndarray) -> np.ndarray:
    """The element (k,) beside the box that is nearest to each of these places (k, 2) m from the origin."""
    if mesh.box is None:
        return np.zeros(0, dtype=np.int64)
    near = (mesh.elements >= np.array(mesh.box[:2]) - 1) & (mesh.elements <= mesh.box[2:])
    beside = np.flatnonzero(near.all(axis=1))
    beyond = np.zeros((len(places), len(beside)))
    for a, axis in enumerate(mesh.axes):
        cell, place = mesh.elements[beside, a], places[:, a, None]
        beyond += np.maximum(np.maximum(axis.edges[cell] - place, place - axis.edges[cell + 1]), 0.0) ** 2
    return beside[np.argmin(beyond, axis=1)]


def interpolation(mesh: Mesh, points: np.ndarray) -> Interpolation:
    """The interpolation of nodal displacements at points (k, 2) m.

    Displacements of a point within no element are extrapolated from the nearest one.
    """
    chosen, local = located(mesh, points)
    x, y = (mesh.rule.shape(local[:, a]) for a in (0, 1))
    count = len(local)
    return Interpolation(mesh.nodes[chosen].reshape(count, -1), (y[:, :, None] * x[:, None, :]).reshape(count, -1))


def slopes(mesh: Mesh, points: np.ndarray) -> np.ndarray:
    """Derivatives (2, k, N²) along x and along y, 1/m, of the weights of `interpolation`."""
    chosen, local = located(mesh, points)
    (x, x_slope), (y, y_slope) = (
        (
            mesh.rule.shape(local[:, a]),
            mesh.rule.slope(local[:, a]) * (2.0 / mesh.element_sizes[chosen, a])[:, None],
        )
        for a in (0, 1)
    )
    each = y[:, :, None] * x_slope[:, None, :], y_slope[:, :, None] * x[:, None, :]
    return np.stack(each).reshape(2, len(local), -1)
