"""Elements of a continuum in steady oscillation, with the images of nodes a period along them.

Exact for the steps of its kernels (kernels/grid.py): with z = e^{iωΔt} a velocity half a step behind is (1 − 1/z)/Δt
times the displacement, and a convolution variable ψ of a layer multiplies a derivative or force by 1 + A/(1 − B/z)
(outside/layer.py).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dembound.disks.reflection.condensed import Oscillation
from dembound.outside.layer import Profile
from dembound.outside.medium import Medium
from dembound.outside.mesh import Mesh

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix


class Layer(NamedTuple):
    """The layer beyond a side.

    axis : of its normal. profile : of σ, α and τ. along : part of σ for derivatives along the layer.
    """

    axis: int
    profile: Profile
    along: float


class Elements:
    """Equal elements, periodic along one axis, with an absorbing layer along the other.

    Parameters
    ----------
    mesh, medium : the elements, and density and moduli. layer : at one of its sides.

    Attributes
    ----------
    nodes, periods : (E, N²) nodes of every element, and how many periods ahead of their own they are in it, 0 or 1.
    count : number of degrees of freedom, x of all nodes and then y. imaged : (i,) those of nodes that some element has
    a period ahead. moving : (count,) bool, those that are not at rest.
    """

    def __init__(self, mesh: Mesh, medium: Medium, layer: Layer) -> None:
        self._mesh, self._medium, self._layer = mesh, medium, layer
        elements = len(mesh.elements)
        self.nodes = mesh.nodes.reshape(elements, -1)
        periodic = 1 - layer.axis
        lines = mesh.order * mesh.elements[:, periodic, None] + np.arange(mesh.order + 1)
        passed = lines // mesh.axes[periodic].lines
        across = passed[:, None, :] if periodic == 0 else passed[:, :, None]
        self.periods = np.broadcast_to(across, mesh.nodes.shape).reshape(elements, -1)
        self.count = 2 * mesh.count
        self.moving = np.tile(~mesh.held, 2)
        own = self.numbers(np.arange(elements)).reshape(elements, -1)
        ahead = np.tile(self.periods, 2) > 0
        self.imaged = np.unique(own[ahead])
        self._places = np.where(ahead, self.count + np.searchsorted(self.imaged, own), own)

    def numbers(self, elements: np.ndarray) -> np.ndarray:
        """Degrees of freedom (k, 2, N²) of some elements (k,)."""
        return np.stack([self.nodes[elements], self._mesh.count + self.nodes[elements]], axis=1)

    def stiffness(self, oscillation: Oscillation) -> csc_matrix:
        """Dynamic stiffness (count + i, count + i) at a frequency; the last degrees of freedom are the images."""
        from scipy.sparse import coo_matrix

        across = self._mesh.elements[:, self._layer.axis]
        _, first, kind = np.unique(across, return_index=True, return_inverse=True)
        each = np.stack([self._of_element(element, oscillation) for element in first])[kind.ravel()]
        rows, columns = (
            np.broadcast_to(of, each.shape).ravel() for of in (self._places[:, :, None], self._places[:, None, :])
        )
        every = self.count + len(self.imaged)
        return coo_matrix((each.ravel(), (rows, columns)), shape=(every, every)).tocsc()

    def _of_element(self, element: int, oscillation: Oscillation) -> np.ndarray:
        """Dynamic stiffness (2N², 2N²) of one element."""
        mesh, rule = self._mesh, self._mesh.rule
        one, (width, height) = np.eye(rule.count), mesh.element_sizes[element]
        plain = 2.0 / width * np.kron(one, rule.derivative), 2.0 / height * np.kron(rule.derivative, one)
        stretch, delay = self._absorption(element, oscillation)
        along_x, along_y = (of[:, None] * matrix * delay for of, matrix in zip(stretch, plain, strict=True))
        back_x, back_y = (of[:, None] * matrix.T for of, matrix in zip(stretch, plain, strict=True))
        zero = np.zeros_like(along_x)
        strain = np.block([[along_x, zero], [zero, along_y], [along_y, along_x]])
        weight = mesh.quadrature[element].ravel()
        xx, yy, xy = np.split(np.kron(self._medium.matrix, np.diag(weight)) @ strain, 3)
        stiffness = np.vstack([back_x @ xx + back_y @ xy, back_x @ xy + back_y @ yy])
        return stiffness - oscillation.square * self._medium.density * np.diag(np.tile(weight, 2))

    def _absorption(self, element: int, oscillation: Oscillation) -> tuple[np.ndarray, np.ndarray]:
        """At the points of an element: factors (2, N²) of derivatives along x and y, and (N²,) of delayed motion."""
        mesh, (axis, profile, along) = self._mesh, self._layer
        stretch = np.ones((2, self.nodes.shape[1]), dtype=complex)
        if not mesh.absorbs[element, axis]:
            return stretch, np.ones(self.nodes.shape[1])
        q, step = mesh.depth[self.nodes[element], axis], oscillation.time_step
        beside = profile.part_along(q) if profile.is_stretched_along else along
        for direction, part in ((axis, 1.0), (1 - axis, beside)):
            memory = profile.gain(q, step, part) / (1.0 - profile.decay(q, step, part) * oscillation.back)
            stretch[direction] += memory
        return stretch, 1.0 + profile.delay(q, step) * oscillation.lagging
