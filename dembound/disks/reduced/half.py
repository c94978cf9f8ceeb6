"""One half of a symmetric scene, stepped in place of both: disks of the other half move as mirror images of its own.

The mirror line is the middle line along x or y. The image of (u_n, u_s, θ), with n across the line, is (−u_n, u_s, −θ);
in an antisymmetric motion all three have the other sign. Disks on the line are halves: they have half their mass, half
their contacts along the line and half of the forces from outside, and do not move in the components that their image
would move the other way. A contact of a disk with its own image acts as springs on its disk: the two move apart by
2u_n and their bond bends by 2θ, so that it pushes with −2k_n·u_n and turns with −2k_b·θ.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.disks.contacts.arrays import plain_contacts
from dembound.disks.reduced.mirror import mirror_line, not_mirrored, signs_of_images
from dembound.disks.reduced.smaller import DRIVES, LOADS, SmallerScene
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.contact_measures import strain_energy
from dembound.kernels.contacts import REFERENCE
from dembound.kernels.tables import Contacts


@dataclass(frozen=True, kw_only=True)
class HalfScene(SmallerScene):
    """The left or lower half of a scene, disks on the mirror line included; m of n disks.

    Attributes
    ----------
    axis : the axis across the mirror line.
    antisymmetric : whether images move the other way.
    image : (n,) bool, disks of the larger scene that are images of its own.
    fraction : (m,) part of a disk's cell inside this half.
    across : (q,) contacts of the larger scene between a disk and its image.
    """

    axis: int
    antisymmetric: bool
    image: np.ndarray
    fraction: np.ndarray
    across: np.ndarray

    def system(self, time_step: float) -> "HalfSystem":
        """Its body at rest as built, to be stepped by time_step (s)."""
        return HalfSystem(self, time_step)

    @property
    def saved(self) -> str:
        """The mirror line, and the number of disks that need not be stepped."""
        motion = "an antisymmetric" if self.antisymmetric else "a symmetric"
        disks = f"{self.count:,} of {self.of.count:,} disks"
        return f"symmetry: one half of {motion} scene about {mirror_line(self.of, self.axis)} is stepped, {disks}"

    def differs(self, what: str) -> str:
        """In words, that something of the larger scene, in the plural, has no mirror images."""
        lacking = (
            " (antisymmetric ones need disks on this line)" if len(self.across) and what in (LOADS, DRIVES) else ""
        )
        return f"{not_mirrored(self.of, self.axis, what)}{lacking}"

    @cached_property
    def cell_fraction(self) -> np.ndarray:
        """(m,) part of a disk's cell inside this half."""
        return self.fraction

    @cached_property
    def signs(self) -> np.ndarray:
        """(3,) factors of displacements, velocities and forces of images, by component."""
        return signs_of_images(self.axis, self.antisymmetric)

    def of_all(self, name: str, values: np.ndarray) -> np.ndarray:
        """Values (m, …) of its disks as those of the disks (n, …) of the larger scene.

        name : "displacement", "velocity" or "stress", which change sign in images; all others do not.
        """
        wide = values[self.like]
        if name in ("displacement", "velocity"):
            wide[self.image] *= self.signs
        elif name == "stress":
            wide[self.image] *= (-1.0 if self.antisymmetric else 1.0) * np.array([1.0, 1.0, -1.0])
        return wide

    def observed(self, record: np.ndarray, times: np.ndarray) -> np.ndarray:
        """The motion of the monitors, some of which are images."""
        image = self.image[self.of.probes]
        return self.of.observed(record * np.where(image[:, None], np.tile(self.signs, 2), 1.0), times)

    def tracked_peaks(self, peaks: np.ndarray) -> np.ndarray:
        """Smallest and largest velocities (p, 3, 2); of an image the largest is the smallest with the other sign."""
        wide = super().tracked_peaks(peaks)
        turned = self.image[self.of.tracked][:, None] & (self.signs < 0.0)
        return np.where(turned[..., None], -wide[..., ::-1], wide)

    def elastic_stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (m, 3) Pa at displacements (3, m), computed on all disks, as half of the contacts are not its own."""
        wide = self.widened("displacement", displacement.T)
        return self.whole.elastic_stress(wide.T)[self.places_in_whole]

    @cached_property
    def _pairs_across(self) -> tuple[np.ndarray, np.ndarray, Contacts]:
        """Of the contacts across: disks (2q,) and signs (3, 2q) of all first and then all second ends; the contacts."""
        assembly = self.of.assembly
        ends, count = assembly.pairs[self.across].T.ravel(), len(self.across)
        pairs = np.arange(2 * count, dtype=np.int32).reshape(2, count).T
        alone = replace(assembly, pairs=pairs, contact_type=assembly.contact_type[self.across])
        contacts = plain_contacts(self.ground, alone, np.arange(2 * count))
        return self.like[ends], np.where(self.image[ends], self.signs[:, None], 1.0), contacts

    def energy_across(self, displacement: np.ndarray) -> tuple[float, float]:
        """Its half of the energy (J) in the contacts and bonds with images at displacements (3, m)."""
        contact, bond = 0.0, 0.0
        if isinstance(self.of, HalfScene):
            contact, bond = self.of.energy_across(self.of_all("displacement", displacement.T).T)
        if len(self.across) > 0:
            disks, signs, contacts = self._pairs_across
            own = strain_energy(signs * displacement[:, disks], contacts, REFERENCE)
            contact, bond = contact + own[0], bond + own[1]
        return 0.5 * contact, 0.5 * bond


class HalfSystem(DiskSystem):
    """The moving disks of one half; its energies include half of those in contacts with images."""

    scene: HalfScene

    def stored(self, u: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) at displacements (3, slots): in contacts and in bonds."""
        across = self.scene.energy_across(self.scene.layout.gather(u))
        pairs = zip(super().stored(u), across, strict=True)
        contact, bond = (own + across for own, across in pairs)
        return contact, bond

    def counted_outside(self, u: np.ndarray) -> float:
        """Energy (J) at displacements (3, slots) in contacts with images, which act as springs of the support table."""
        return sum(self.scene.energy_across(self.scene.layout.gather(u)))

    def stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (m, 3) xx, yy, xy in Pa of all disks at displacements (3, m), tension positive."""
        return self.scene.elastic_stress(displacement)
