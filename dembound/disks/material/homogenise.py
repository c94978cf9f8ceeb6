"""The continuum equivalent to a periodic brick, from one linear solve.

The brick is strained by each unit mean displacement gradient in turn while its particles relax periodically: the energy
½ Σ k e² of all elongations e is minimised over the particles' motions beyond the mean gradient, the correctors χ.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dembound.disks.material.kept import Kept
from dembound.errors import CaseError
from dembound.laws import Stiffness
from dembound.packings.brick import Brick
from dembound.packings.tiling import Assembly

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix, csr_matrix

GRADIENTS = ("xx", "yy", "xy", "yx")
"""The four unit displacement gradients ∂u_a/∂b, in this order in every homogenised matrix."""


class Network(NamedTuple):
    """Disks and the springs between them: pairs (b, 2), vectors (b, 2) m from the first disk to the second."""

    disks: int
    pairs: np.ndarray
    vectors: np.ndarray
    stiffness: Stiffness

    @classmethod
    def of_brick(cls, brick: Brick, stiffness: Stiffness) -> Network:
        """The infinite tiling of a brick with these constants of its contacts."""
        return cls(len(brick.radii), brick.pairs, brick.vectors, stiffness)

    @classmethod
    def of_assembly(cls, brick: Brick, stiffness: Stiffness, assembly: Assembly) -> Network:
        """The network of an assembly of copies of a brick."""
        of = assembly.contact_type
        return cls(len(assembly.radii), assembly.pairs, brick.vectors[of], stiffness.of(of))

    @property
    def springs(self) -> np.ndarray:
        """Constants (3b,) of the elongations: normal, shear, bending."""
        return np.concatenate([self.stiffness.normal, self.stiffness.shear, self.stiffness.bending])

    @property
    def directions(self) -> tuple[np.ndarray, np.ndarray]:
        """Components (b,) along x and y of the contacts' normals."""
        c, s = (self.vectors / np.hypot(*self.vectors.T)[:, None]).T
        return c, s

    def motion_matrix(self, phase: np.ndarray | float = 1.0) -> csr_matrix:
        """Elongations (3b) per unit motion of the disks (3n): all x, all y, all rotations.

        As in the law they are n·Δu, t·Δu − l_iθ_i − l_jθ_j and θ_j − θ_i. phase : (b,) by which the motion of the
        second disk of a contact is multiplied.
        """
        from scipy.sparse import coo_matrix

        count, contacts = self.disks, len(self.vectors)
        c, s = self.directions
        i, j = self.pairs.T.astype(np.int64)
        row = np.arange(contacts)
        first, second = np.ones(contacts), np.ones(contacts) * phase
        entries = [
            (row, j, c * second), (row, i, -c), (row, count + j, s * second), (row, count + i, -s),
            (contacts + row, j, -s * second), (contacts + row, i, s),
            (contacts + row, count + j, c * second), (contacts + row, count + i, -c),
            (contacts + row, 2 * count + i, -self.stiffness.arm_i),
            (contacts + row, 2 * count + j, -self.stiffness.arm_j * second),
            (2 * contacts + row, 2 * count + j, second), (2 * contacts + row, 2 * count + i, -first),
        ]  # fmt: skip
        rows, columns, values = (np.concatenate(part) for part in zip(*entries, strict=True))
        return coo_matrix((values, (rows, columns)), shape=(3 * contacts, 3 * count)).tocsr()

    def gradient_matrix(self) -> np.ndarray:
        """Elongations (3b, 4) per unit mean gradient."""
        c, s = self.directions
        dx, dy = self.vectors.T
        normal = np.stack([c * dx, s * dy, c * dy, s * dx], axis=1)
        shear = np.stack([-s * dx, c * dy, -s * dy, c * dx], axis=1)
        return np.concatenate([normal, shear, np.zeros((len(dx), 4))])

    def relaxed(self, elongations: np.ndarray, held: tuple[int, ...] = (), faint: float = 0.0) -> np.ndarray:
        """Motions (3n, k) of least energy in addition to elongations (3b, k), with some components held.

        faint : springs against every single motion, over those of the contacts; with them disks that hang by one
        contact and can roll do not make the solve singular.

        Raises CaseError when disks can move without resistance, as without bonds and friction.
        """
        from scipy.sparse import diags
        from scipy.sparse.linalg import splu

        motion = np.zeros((3 * self.disks, elongations.shape[1]))
        free = free_columns(self.disks, held)
        if len(free) == 0:
            return motion
        k = diags(self.springs)
        ways = self.motion_matrix()[:, free]
        matrix: csc_matrix = (ways.T @ k @ ways).tocsc()
        matrix += faint * diags(matrix.diagonal(), format="csc")
        try:
            solver = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        except RuntimeError:  # raised by SuperLU for a singular matrix
            raise CaseError(["material: gives no stiffness to some motion; give bonds or friction"]) from None
        motion[free] = -solver.solve(ways.T @ (k @ elongations))
        return motion


@dataclass(frozen=True)
class HomogenisedMaterial:
    """The continuum equivalent to a brick.

    Attributes
    ----------
    tensor : (4, 4) Pa, stiffness against the displacement gradients `GRADIENTS`: entry [a, b] is the mean stress
    conjugate to gradient a under unit gradient b. With free rotations xy and yx are the same shear, so C66 = C[yx, yx];
    c² = C/ρ for plane waves.
    corrector : (3, n, 4) m and rad, motion of the brick's disks beyond the unit mean gradient; the mean of the
    translations, weighted by the disks' areas, is zero.
    """

    tensor: np.ndarray
    corrector: np.ndarray


def homogenise(brick: Brick, stiffness: Stiffness, held: tuple[int, ...]) -> HomogenisedMaterial:
    """The continuum of the infinite tiling of a brick; held : components (0 x, 1 y, 2 rotation) that do not move.

    Raises CaseError when disks can move without resistance, as without bonds and friction.
    """
    arrays = brick.size, brick.positions, brick.radii, brick.pairs, brick.images, *vars(stiffness).values()
    return _FOUND.get(lambda: _homogenised(brick, stiffness, held), held, *arrays)


_FOUND: Kept[HomogenisedMaterial] = Kept()


def _homogenised(brick: Brick, stiffness: Stiffness, held: tuple[int, ...]) -> HomogenisedMaterial:
    """See `homogenise`."""
    network = Network.of_brick(brick, stiffness)
    gradients = network.gradient_matrix()
    motion = network.relaxed(gradients, held)
    elongations = gradients + network.motion_matrix() @ motion
    tensor = gradients.T @ (network.springs[:, None] * elongations) / float(np.prod(brick.size))
    corrector = motion.reshape(3, network.disks, 4)
    area = brick.radii**2 / np.sum(brick.radii**2)
    for component in {0, 1} - set(held):
        corrector[component] -= area @ corrector[component]
    return HomogenisedMaterial(tensor, corrector)


def free_columns(count: int, held: tuple[int, ...]) -> np.ndarray:
    """Unknowns of the periodic problem: no held components, and one disk fixed against rigid motion."""
    free = np.ones((3, count), dtype=bool)
    free[list(held)] = False
    free[:2, 0] = False
    return np.flatnonzero(free.ravel())
