"""The forces inside a scene of disks at rest: of contacts and bonds, through the seam, of ties to continua."""

from collections.abc import Mapping

import numpy as np

from dembound.disks.body import DiskBody
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.stepping.contact_lists import contact_lists
from dembound.disks.stepping.continuum_ties import disks_on_foot
from dembound.disks.stepping.disk_parts import DiskParts


class RestForces:
    """Forces and moments (3, n) N and N·m on all nodes of a scene at rest at some displacements (3, n) m and rad.

    Parameters
    ----------
    scene : the scene. disks : its parts of disks, whose contacts keep the last forces computed.
    """

    def __init__(self, scene: DiskBody, disks: DiskParts) -> None:
        self._scene, self._disks = scene, disks

    def elastic(self, displacement: np.ndarray) -> np.ndarray:
        """Forces (3, n) of contacts and of the seam under the elastic law."""
        force = np.zeros_like(displacement)
        for part in self._disks.parts:
            part.add_elastic_forces(displacement, force)
        for tie in self._disks.seams:
            force[:, tie.nodes] += tie.elastic_forces(displacement)
        return force

    def with_history(self, displacement: np.ndarray, *, fresh: bool) -> np.ndarray:
        """Forces (3, n) of contacts and of the seam under the history-dependent law.

        fresh : contacts have no history yet, and are first set to the state of the elastic law.
        """
        if fresh:
            self._disks.adopt(displacement)
        for pairs in self._disks.contacts.values():
            pairs.push(displacement)
        return self.last(self._disks.contacts)

    def as_built(self) -> np.ndarray:
        """Forces (3, n) of contacts and of the seam under the stress at rest, whatever friction and strength are."""
        contacts = self._disks.contacts or contact_lists(self._scene)
        for pairs in contacts.values():
            pairs.push(np.zeros((3, self._scene.count)), reference=True)
        return self.last(contacts)

    def last(self, contacts: Mapping[str, ContactList]) -> np.ndarray:
        """The last forces of the pairs of each part by name, and the forces across the seam that belong to them."""
        force = np.zeros((3, self._scene.count))
        for pairs in contacts.values():
            pairs.add_forces(force)
        return force + self.across(contacts)

    def across(self, contacts: Mapping[str, ContactList]) -> np.ndarray:
        """The forces that act through the seam of a free field, from the last forces of the column's pairs."""
        force = np.zeros((3, self._scene.count))
        for tie in self._disks.seams:
            if contacts:
                force[:, tie.nodes] += tie.last_forces(contacts[tie.column.name])
        return force

    def of_ties(self, displacement: np.ndarray) -> np.ndarray:
        """Forces (3, n) of the ties to continua."""
        scene = self._scene
        force, u = np.zeros_like(displacement), scene.layout.spread(displacement)
        for each in scene.continua:
            each.add_tie_forces(scene.layout, u, force)
        if scene.foot is not None:
            assert scene.twin is not None
            disks = disks_on_foot(scene)
            force[:, disks] += force[:, scene.twin[disks]]
        return force

    def shift(self, datum: np.ndarray) -> np.ndarray:
        """Forces that shift the zero of the springs of supports, and of the ties to continua, to a datum (3, n)."""
        return self._scene.supports.springs_at(datum) - self.of_ties(datum)
