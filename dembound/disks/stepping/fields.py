"""Recorded fields of a system of disks besides its motion: stresses, contacts, and fields of its continuum."""

from collections.abc import Sequence
from itertools import chain

import numpy as np

from dembound.disks.body import DiskBody
from dembound.disks.contacts.arrays import plain_contacts
from dembound.disks.contacts.forces import contact_columns, pieces
from dembound.disks.stepping.damped_ground import unrelaxed
from dembound.disks.stepping.disk_parts import DiskParts
from dembound.disks.stepping.part import DiskPart
from dembound.disks.stepping.stress import part_stress
from dembound.kernels.contacts import REFERENCE
from dembound.motion.part import Part, System, Tie
from dembound.outside.part import GridPart


class RecordedDisks(System):
    """A system of disks with its recorded fields.

    Parameters
    ----------
    scene : the scene. disks : its parts of disks. beyond : its continua. ties : all of the scene. load : (3, n) N and
    N·m, steady forces and moments.
    """

    def __init__(
        self, scene: DiskBody, disks: DiskParts, beyond: Sequence[Part], ties: Sequence[Tie], load: np.ndarray
    ) -> None:
        super().__init__([*disks.parts, *beyond], ties, load)
        self.scene, self.disks = scene, disks
        self._stress_at_rest: np.ndarray | None = None

    @property
    def recorded_parts(self) -> tuple[DiskPart, ...]:
        """The parts whose nodes are recorded as particles, those of disks."""
        return self.disks.parts

    def stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (m, 3) xx, yy, xy in Pa of all particles at displacements (3, n), tension positive.

        In damped ground differences from the stress at rest are those of the moduli of the given wave speeds, which are
        right at their frequency.
        """
        stress = self._unrelaxed_stress(displacement)
        if not self.disks.are_damped:
            return stress
        rest = 0.0 if self._stress_at_rest is None else self._stress_at_rest
        return rest + (stress - rest) / unrelaxed(self.scene)[: len(stress), None]

    def _unrelaxed_stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (m, 3) at displacements (3, n) that have just been reached."""
        return np.concatenate([part_stress(self.scene, part, displacement) for part in self.disks.parts])

    def _note_rest(self, datum: np.ndarray) -> None:
        """Note the stress at rest at displacements (3, n), if it will be needed."""
        if self.disks.are_damped and self.scene.case.output.stress:
            self._stress_at_rest = self._unrelaxed_stress(datum)

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Fields of every disk at displacements (3, n) other than its motion; stress only with output.stress."""
        known = super().snapshot(displacement)
        if self.scene.case.output.stress:
            known["stress"] = self.stress(displacement), "Pa"
        return known

    def snapshot_beside(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Stress of the nodes of the continuum, if there is one, at displacements (3, n)."""
        return next((part.snapshot(displacement) for part in self.parts if isinstance(part, GridPart)), {})

    def contact_forces(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """The contacts and bonds of the whole scene at displacements (3, n) of this one, see `contact_columns`.

        Only with output.contacts. If this scene is stepped in place of a larger one, which is under the elastic law,
        the contacts are those of the larger one.
        """
        scene, whole = self.scene, self.scene.whole
        if not scene.case.output.contacts:
            return {}
        lists = [(part.stressed_pairs, part.geometry) for part in self.disks.parts]
        if whole is not scene:
            assert isinstance(whole, DiskBody)
            displacement = scene.widened("displacement", displacement.T).T
            lists = [(plain_contacts(whole.ground, whole.assembly, whole.layout.slot), REFERENCE)]
        each = (pieces(whole.layout, pairs, displacement, geometry) for pairs, geometry in lists)
        return contact_columns(chain.from_iterable(each))
