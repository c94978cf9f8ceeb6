"""Dashpots of contacts: viscosities from PFC's ratios, which are shares of the critical damping of two disks."""

from dataclasses import dataclass

import numpy as np

from dembound.casefile.disks.material import Material
from dembound.casefile.disks.model import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.tables import Contacts
from dembound.laws import Law, Stiffness
from dembound.pairwise import P


@dataclass(frozen=True, eq=False)
class Dashpots:
    """The dashpots of a part's contacts: normal and shear ratio, mass (m,) kg of its disks by slot, and the law.

    damps_bonds : whether they also act beside intact bonds.
    """

    normal: float
    shear: float
    mass: np.ndarray
    law: Law
    damps_bonds: bool

    @classmethod
    def of(cls, case: DiskCase, mass: np.ndarray) -> "Dashpots | None":
        """The dashpots of the contacts of a case; None if it has none."""
        material, own = case.material, LAWS[case.material.law]
        if not material.has_dashpots:
            return None
        return cls(material.dp_nratio, material.dp_sratio, mass, own, case.damps_bonds)

    def at(self, contacts: Contacts) -> np.ndarray:
        """Viscosities (2, b) N·s/m in all places of contacts, 0 where there is none."""
        return self.between(contacts.first, contacts.second, contacts.constants[contacts.contact_type])

    def between(self, first: np.ndarray, second: np.ndarray, constants: np.ndarray) -> np.ndarray:
        """Viscosities (2, b) N·s/m of contacts of disks in slots (b,), with their constants (b, c)."""
        springs = np.ascontiguousarray(self.law.dashpot_springs(constants).T)
        return viscosity(np.array([[self.normal], [self.shear]]), springs, self.mass[first], self.mass[second])


def viscosity(
    ratio: float | np.ndarray, spring: np.ndarray, one: float | np.ndarray, other: float | np.ndarray
) -> np.ndarray:
    """2β√(m_c k) in N·s/m with m_c = m₁m₂/(m₁ + m₂), of contacts of stiffness k (N/m) between masses (kg)."""
    found: np.ndarray = 2.0 * ratio * np.sqrt(one * other / (one + other) * spring)
    return found


def brick_dashpots(ground: PackedMaterial, material: Material, pairing: tuple[int, int]) -> Stiffness:
    """Viscosities of the brick's contacts between two zones, in N·s/m, in place of stiffnesses; all are closed."""
    brick = ground.brick
    first, second = brick.pairs.T
    own = [ground.zones[zone].material for zone in pairing] if isinstance(ground, LayeredGround) else [ground, ground]
    radii = brick.radii[first], brick.radii[second]
    constants = ground.pair_constants(radii, brick.vectors, pairing, gaps_close=False)
    springs = ground.law.dashpot_springs(constants)
    if ground.overlaps is not None:
        springs = np.column_stack([ground.stiffness.normal, ground.stiffness.shear])
    masses = own[0].mass[first], own[1].mass[second]
    normal, shear = (
        viscosity(ratio, spring, *masses)
        for ratio, spring in zip((material.dp_nratio, material.dp_sratio), springs.T, strict=True)
    )
    arm = 0.5 * constants[:, P.rest] + constants[:, P.offset]
    return Stiffness(normal, shear, np.zeros_like(normal), arm, constants[:, P.rest] - arm)
