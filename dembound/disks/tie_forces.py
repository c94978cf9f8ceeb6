"""Forces of ties, and of the bonds they stand for, as sums over amplitudes of waves."""

from dataclasses import dataclass

import numpy as np

from dembound.disks.wall import Wall
from dembound.kernels.wall import tie_forces


@dataclass(frozen=True, eq=False, kw_only=True)
class TieForces:
    """Forces by which waves enter, on tied disks and on nodes of the grid, per unit of amplitudes.

    Attributes
    ----------
    disk : (d,) the tied disks, as numbered in the ties. bonds, ties : (3, d, count) N and N·m on them, of the bonds
    of the undisturbed packing, and of the ties.
    node : (m,) the nodes of the mesh that have ties. reactions : (2, m, count) N on them, of the ties.
    lag : η of the ties, s.
    """

    disk: np.ndarray
    bonds: np.ndarray
    ties: np.ndarray
    node: np.ndarray
    reactions: np.ndarray
    lag: float

    @property
    def on_disks(self) -> tuple[np.ndarray, np.ndarray]:
        """Degrees of freedom (2, r), component and number in `disk`, and forces (2·count, r) on them.

        The forces are N or N·m per unit of the displacements, and of the velocities that ties see, of all amplitudes.
        """
        return self._factors(self.bonds + self.ties, self.ties)

    @property
    def on_nodes(self) -> tuple[np.ndarray, np.ndarray]:
        """The same of nodes: component and number in `node`."""
        return self._factors(self.reactions, self.reactions)

    def _factors(self, at_once: np.ndarray, lagged: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Those of forces (c, k, count) per unit of displacements, and with the lag of velocities."""
        where = np.indices(at_once.shape[:2]).reshape(2, -1)
        factors = np.concatenate([at_once, self.lag * lagged], axis=2).reshape(where.shape[1], -1).T
        return where, np.ascontiguousarray(factors)


def forces_at_rest(wall: Wall, disk: np.ndarray, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Forces of ties (3, d, q) on disks (d,) with motions (3, d, q), and (2, m, q) on the nodes, which are at rest.

    disk : all that are tied, ascending.
    """
    count = len(disk) + len(wall.nodes)
    own, node = np.zeros(int(disk.max()) + 1, dtype=np.int64), np.zeros(wall.mesh.count, dtype=np.int64)
    own[disk], node[wall.nodes] = np.arange(len(disk)), np.arange(len(disk), count)
    ties = wall.ties(own, node, np.arange(count), None)
    forces = np.zeros((motion.shape[2], count, 3))
    for force, each in zip(forces, np.moveaxis(motion, 2, 0), strict=True):
        u = np.zeros((3, count))
        u[:, : len(disk)] = each
        tie_forces(ties, u, np.zeros_like(u), force, 0.0)
    of_all = np.moveaxis(forces, 0, 2).swapaxes(0, 1)
    return of_all[:, : len(disk)], of_all[:2, len(disk) :]
