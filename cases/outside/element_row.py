"""One row of the elements of a continuum beside a side of disks, under a wave e^(i(k_y y − ωt)) along the side.

Exact for the discrete equations of the kernels, in time too: with z = e^(iωΔt), which takes a motion back by a step,

    ω² becomes (2 sin(ωΔt/2)/Δt)²,  a velocity half a step behind u(1 − z)/Δt,  1 plus memory 1 + A/(1 − Bz).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.continuum.layer import Profile
from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody
from dembound.disks.scene import DiskScene
from dembound.disks.surroundings.continuum import Surroundings
from dembound.kernels.wall import tie_forces

ROWS = 3
"""Rows of elements along the side; the middle one is used."""


def layer_profile(body: GridBody) -> Profile:
    """The layer on the right side of a mesh."""
    mesh = body.mesh
    x = mesh.positions[mesh.nodes[mesh.absorbs[:, 0]], 0]
    return Profile(float(np.ptp(x)), body.medium.normal_speed(0), mesh.inner, body.absorption)


@dataclass(frozen=True, eq=False)
class Row:
    """The middle row of elements under a wave.

    Attributes
    ----------
    scene : disks with a continuum on their right side. step : Δt, s. frequency : ω, rad/s. along : k_y, 1/m.
    """

    scene: DiskScene
    step: float
    frequency: float
    along: float

    @property
    def outside(self) -> Surroundings:
        """The continuum and its ties."""
        assert self.scene.outside is not None
        return self.scene.outside

    @property
    def mesh(self) -> Mesh:
        """All elements."""
        return self.outside.body.mesh

    @property
    def back(self) -> complex:
        """The factor z = e^(iωΔt)."""
        return complex(np.exp(1j * self.frequency * self.step))

    @property
    def rate(self) -> complex:
        """Velocity half a step behind over displacement, 1/s."""
        return (1.0 - self.back) / self.step

    @property
    def accelerated(self) -> float:
        """2 sin(ωΔt/2)/Δt, rad/s."""
        return 2.0 / self.step * float(np.sin(0.5 * self.frequency * self.step))

    @cached_property
    def elements(self) -> np.ndarray:
        """Elements (E,) of the row, from the wall on."""
        place = self.mesh.elements
        row = np.flatnonzero(place[:, 1] == ROWS // 2)
        return row[np.argsort(place[row, 0])]

    @property
    def count(self) -> int:
        """Number of components of motion of the nodes, with those on the outer edge."""
        p = self.mesh.order
        return 2 * p * (p * len(self.elements) + 1)

    def spread(self, element: int) -> np.ndarray:
        """Matrix (2Q, count) from the motion of the row's nodes to that of an element's nodes, x of all and then y.

        The upper end of the row is the lower one of the next, a phase e^(ik_y h) ahead.
        """
        p = self.mesh.order
        y, x = np.divmod(np.arange((p + 1) ** 2), p + 1)
        node = (p * element + x) * p + y % p
        phase = np.where(y == p, np.exp(1j * self.along * self.size[1]), 1.0)
        matrix = np.zeros((2, len(node), self.count), dtype=complex)
        for component in range(2):
            matrix[component, np.arange(len(node)), 2 * node + component] = phase
        return matrix.reshape(-1, self.count)

    @cached_property
    def size(self) -> tuple[float, float]:
        """Width and height of an element, m."""
        width, height = np.ptp(self.mesh.positions[self.mesh.nodes[self.elements[0]].ravel()], axis=0).tolist()
        return width, height

    def _layer(self, element: int) -> tuple[np.ndarray, np.ndarray]:
        """Per point across an element (N,): the factor 1 + A/(1 − Bz) of derivatives, and 1 + τ(1 − z)/Δt."""
        q = self.mesh.depth[self.mesh.nodes[self.elements[element], 0], 0]
        profile = layer_profile(self.outside.body)
        memory = profile.gain(q, self.step) / (1.0 - profile.decay(q, self.step) * self.back)
        return 1.0 + memory, 1.0 + profile.delay(q, self.step) * self.rate

    def element_forces(self, element: int) -> np.ndarray:
        """(2Q, 2Q) forces on the nodes of an element per displacement, gradients, stresses, divergence."""
        mesh, rule = self.mesh, self.mesh.rule
        one, (width, height) = np.eye(mesh.order + 1), self.size
        memory, delay = (np.tile(values, mesh.order + 1) for values in self._layer(element))
        plain = [2.0 / width * np.kron(one, rule.derivative), 2.0 / height * np.kron(rule.derivative, one)]
        along_x, along_y = (matrix * delay for matrix in (memory[:, None] * plain[0], plain[1]))
        zero = np.zeros_like(along_x)
        strain = np.block([[along_x, zero], [zero, along_y], [along_y, along_x]])
        weight = 0.25 * width * height * np.outer(rule.weights, rule.weights).ravel()
        stress = np.kron(self.outside.body.medium.matrix, np.diag(weight)) @ strain
        xx, yy, xy = np.split(stress, 3)
        of_x, of_y = -(memory[:, None] * plain[0].T), -plain[1].T
        return np.vstack([of_x @ xx + of_y @ xy, of_x @ xy + of_y @ yy])

    def grid(self) -> np.ndarray:
        """Forces (count, count) on the row's nodes per displacement, including inertia."""
        mesh, body = self.mesh, self.outside.body
        weight = 0.25 * np.prod(self.size) * np.outer(mesh.rule.weights, mesh.rule.weights).ravel()
        inertia = body.medium.density * self.accelerated**2 * np.diag(np.tile(weight, 2))
        total = np.zeros((self.count, self.count), dtype=complex)
        for element in range(len(self.elements)):
            spread = self.spread(element)
            total += spread.conj().T @ (self.element_forces(element) + inertia) @ spread
        return total

    @cached_property
    def moving(self) -> np.ndarray:
        """(m,) components of nodes that are not at rest on the outer edge."""
        return np.arange(self.count - 2 * self.mesh.order)

    @cached_property
    def disks(self) -> np.ndarray:
        """Disks (ROWS, n) beside each row, by number in the scene."""
        bonds = self.outside.wall.bonds
        return bonds.particle[np.argsort(bonds.point[:, 1])].reshape(ROWS, -1)

    @cached_property
    def at_the_wall(self) -> np.ndarray:
        """(ROWS, N²) nodes of the element of each row that is at the wall, by number in the scene."""
        place, first = self.mesh.elements, self.scene.count - self.outside.count
        wall = np.flatnonzero(place[:, 0] == place[self.elements[0], 0])
        return first + self.mesh.nodes[wall].reshape(ROWS, -1)

    def ties(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Forces of the ties per displacement: on disks by disks and by nodes, on nodes by disks and by nodes.

        Disks have x, y, rotation of each; nodes are all of the row, (count,).
        """
        turns = np.exp(1j * self.along * self.size[1] * (np.arange(ROWS) - ROWS // 2))
        n, edge, spread = self.disks.shape[1], 2 * self.mesh.order * (self.mesh.order + 1), self.spread(0)
        moved = np.zeros((3 * n + edge, 3, self.scene.count), dtype=complex)
        for row, turn in enumerate(turns):
            for component in range(3):
                moved[np.arange(component, 3 * n, 3), component, self.disks[row]] = turn
            moved[3 * n :, :2, self.at_the_wall[row]] = turn * spread[:, :edge].T.reshape(edge, 2, -1)
        forces = self._tie_forces(moved)
        on_disks = forces[:, :, self.disks[ROWS // 2]].transpose(2, 1, 0).reshape(3 * n, -1)
        order = self.mesh.order
        own = self.at_the_wall[ROWS // 2].reshape(order + 1, -1)[:order].T.ravel()  # line by line across x, upwards
        on_nodes = np.zeros((self.count, 3 * n + edge), dtype=complex)
        on_nodes[:edge] = forces[:, :2, own].transpose(2, 1, 0).reshape(edge, -1)
        by_nodes = np.zeros((3 * n + self.count, self.count), dtype=complex)
        by_nodes[:, :edge] = np.vstack([on_disks, on_nodes])[:, 3 * n :]
        return on_disks[:, : 3 * n], by_nodes[: 3 * n], on_nodes[:, : 3 * n], by_nodes[3 * n :]

    def _tie_forces(self, moved: np.ndarray) -> np.ndarray:
        """Forces of all ties at displacements, of the same shape (k, 3, n), with their dashpots."""
        outside, layout = self.outside, self.scene.layout
        kernel, forces = outside.ties(layout, outside.tied), np.zeros_like(moved)
        for motion, force in zip(moved, forces, strict=True):
            for part, factor in ((motion.real, 1.0), (motion.imag, 1.0j)):
                u, of_ties = layout.spread(part), np.zeros((len(outside.tied), 3))
                tie_forces(kernel, u, np.zeros_like(u), of_ties, 0.0)
                force[:, outside.tied] += factor * of_ties.T
        return (1.0 + outside.wall.lag * self.rate) * forces
