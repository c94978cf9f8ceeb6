"""The stress of every particle, from the forces across its contacts."""

from collections.abc import Iterator

import numpy as np

from dembound.disks.body import DiskBody
from dembound.disks.memory import PIECE
from dembound.disks.part import DiskPart
from dembound.kernels.common import CHUNKS
from dembound.kernels.contacts import REFERENCE, push
from dembound.kernels.tables import Contacts, Limits

UNYIELDING = Limits(friction=0.0, tension=np.inf, cohesion=np.inf, tan_fa=0.0, geometry=REFERENCE)
"""Under the elastic law there are no strength and friction limits."""


def part_stress(scene: DiskBody, part: DiskPart, displacement: np.ndarray) -> np.ndarray:
    """Stress (m, 3) of one part's particles, see `particle_stress`: the total stress, that of a static stage included.

    displacement (3, n) m and rad. Under the history-dependent law its forces are those at the beginning of the last
    step.
    """
    slid = part.contacts is not None and part.contacts.keeps_slip
    stress = particle_stress(scene, part.pairs, displacement, elastic=not part.uses_history, slid=slid)
    return stress[part.nodes]


def particle_stress(
    scene: DiskBody, contacts: Contacts, displacement: np.ndarray, *, elastic: bool, slid: bool = False
) -> np.ndarray:
    """Stress (n, 3) xx, yy, xy in Pa of all particles, tension positive; xy is the mean of both shear stresses.

    A particle's stress is Σ f_a l n_b over its area, πR² plus its share of the pores, half of that for half cells, with
    f the force on it at a contact and l n the vector from its centre to the contact (Love's and Weber's mean). Forces
    from outside on a side are not contact forces and are not included.

    Parameters
    ----------
    scene : the scene of the particles.
    contacts : its pairs.
    displacement : (3, n) m and rad.
    elastic : use the forces of the elastic law, and the vectors of the start; else the pairs' last forces. slid :
    whether contacts have slid before the elastic law.
    """
    moments, node = np.zeros((3, scene.count)), scene.layout.node
    u = scene.layout.spread(displacement)
    for piece, force in _pieces(contacts, u, elastic=elastic, slid=slid):
        first, second = node[contacts.first[piece]], node[contacts.second[piece]]
        rows = contacts.constants[contacts.contact_type[piece]]
        x, y = rows[:, :2].T if elastic else rows[:, :2].T + displacement[:2, second] - displacement[:2, first]
        part = 0.5 + rows[:, 4] / np.hypot(x, y)  # part of the vector on the side of the first disk
        pull_x, pull_y = force[:2]
        for total, dyad in zip(moments, (pull_x * x, pull_y * y, 0.5 * (pull_x * y + pull_y * x)), strict=True):
            np.add.at(total, first, part * dyad)
            np.add.at(total, second, (1.0 - part) * dyad)
    area = np.pi * scene.assembly.radii**2 * scene.cell_fraction / scene.ground.brick.solid_fraction
    return (moments / area).T


def _pieces(contacts: Contacts, u: np.ndarray, *, elastic: bool, slid: bool) -> Iterator[tuple[slice, np.ndarray]]:
    """Pieces of the list of pairs and their forces (4, k) at displacements u (3, slots); no pair is changed."""
    for begin in range(0, len(contacts.first), PIECE):
        piece = slice(begin, begin + PIECE)
        if not elastic:
            yield piece, contacts.force[:, piece]
            continue
        count = len(contacts.first[piece])
        pairs = contacts._replace(
            first=contacts.first[piece],
            second=contacts.second[piece],
            contact_type=contacts.contact_type[piece],
            state=contacts.state[piece],
            shear=np.zeros(count),
            slip=contacts.slip[piece] if slid else np.zeros(count),
            cracked=np.full(count, -1),
            force=np.empty((4, count)),
        )
        push(u, u, 0.0, 0, pairs, UNYIELDING, np.empty((CHUNKS, 2)))  # zero step: at rest
        yield piece, pairs.force
