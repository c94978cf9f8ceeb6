"""The stress of every particle, from the forces across its contacts."""

import numpy as np

from dembound.disks.body import DiskBody
from dembound.disks.contacts.forces import pieces
from dembound.disks.stepping.part import DiskPart
from dembound.kernels.tables import Contacts


def part_stress(scene: DiskBody, part: DiskPart, displacement: np.ndarray) -> np.ndarray:
    """Total stress (m, 3) of one part's particles, including that of a static stage, see `particle_stress`.

    displacement (3, n) m and rad. Under the history-dependent law its forces are those at the beginning of the last
    step.
    """
    return particle_stress(scene, part.stressed_pairs, displacement, part.geometry)[part.nodes]


def particle_stress(scene: DiskBody, contacts: Contacts, displacement: np.ndarray, geometry: int) -> np.ndarray:
    """Stress (n, 3) xx, yy, xy in Pa of all particles, tension positive; xy is the mean of both shear stresses.

    A particle's stress is Σ f_a l n_b over its area, πR² plus its share of the pores, half of that for half cells, with
    f the force on it at a contact and l n the vector from its centre to the contact (Love's and Weber's mean). Forces
    from outside on a side are no contact forces and are not included.

    Parameters
    ----------
    scene : the scene of the particles.
    contacts : its pairs.
    displacement : (3, n) m and rad.
    geometry : of the forces and vectors of the pairs, see `forces.pieces`.
    """
    moments = np.zeros((3, scene.disk_count))
    for piece in pieces(scene.layout, contacts, displacement, geometry):
        (x, y), (pull_x, pull_y) = piece.vector, piece.force
        for total, dyad in zip(moments, (pull_x * x, pull_y * y, 0.5 * (pull_x * y + pull_y * x)), strict=True):
            np.add.at(total, piece.first, piece.near * dyad)
            np.add.at(total, piece.second, (1.0 - piece.near) * dyad)
    area = np.pi * scene.assembly.radii**2 * scene.cell_fraction / scene.ground.brick.solid_fraction
    return (moments / area).T
