"""The elastic law: linear contact plus parallel bond, without history; contacts never open.

PFC2D's linear parallel bond for total small displacements. It is exact as long as no contact opens or slips and no
bond breaks, which a confining stress above ρcv ensures for waves of particle velocity v.
"""

from typing import ClassVar, NamedTuple

import numpy as np

from dembound.laws.law import Law, Moduli, Springs
from dembound.pairwise import PLACE, Column, index

COLUMNS = (
    *PLACE,
    Column("kn", "N/m", "normal stiffness of the contact", in_half=0.5),
    Column("ks", "N/m", "shear stiffness of the contact", in_half=0.5),
    Column("bond_kn", "N/m", "normal stiffness of the bond, k̄_n A", in_half=0.5),
    Column("bond_ks", "N/m", "shear stiffness of the bond, k̄_s A", in_half=0.5),
    Column("bending", "N·m/rad", "stiffness of the bond against rotation, k̄_n J", in_half=0.5),
    Column("per_area", "1/m", "stress of the bond over its force, 1/A", in_half=2.0),
    Column("per_section", "1/m²", "stress at the edge of the bond over its moment, R̄/J", in_half=2.0),
)
"""Constants of a pair."""

K = index(COLUMNS)
"""Numbers of the constants by name."""


class Limits(NamedTuple):
    """Friction of contacts and strength of bonds: numbers, or columns (p,) by row of constants (pairwise.limit_of).

    friction, tan_fa : pure numbers; tension, cohesion : Pa; geometry : one of those in kernels/contacts.py. Kernels for
    columns are compiled separately, so all four are numbers or all are columns. factor : 1.0, or (b,) by which the
    strengths of each pair's bond, tension and cohesion, are multiplied (kernels/compiler/limits.py), which is compiled
    separately too.
    """

    friction: float | np.ndarray
    tension: float | np.ndarray
    cohesion: float | np.ndarray
    tan_fa: float | np.ndarray
    geometry: int
    factor: float | np.ndarray = 1.0


def in_columns(limits: np.ndarray, geometry: int) -> Limits:
    """Limits (p, 4) of rows of constants as columns: friction, tension, cohesion and tan_fa."""
    friction, tension, cohesion, tan_fa = np.ascontiguousarray(limits.T)
    return Limits(friction, tension, cohesion, tan_fa, geometry)


class Elastic(Law):
    """Contacts and parallel bonds whose forces are linear in small displacements."""

    name: ClassVar[str] = "elastic"
    columns: ClassVar[tuple[Column, ...]] = COLUMNS

    def without_limits(self, geometry: int) -> Limits:
        """Limits that no contact or bond reaches, in a geometry of kernels/contacts.py."""
        return Limits(0.0, np.inf, np.inf, 0.0, geometry)

    def springs(self, moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray) -> Springs:
        """Springs of closed, bonded contacts between disks of radii (b,) m.

        Contact: k_n = emod for all radii (two springs 2E_c in series at unit thickness), k_s = k_n/kratio but only with
        friction. Bond: R̄ = pb_rmul·min(R), area 2R̄, inertia 2R̄³/3, k̄_n = pb_emod/(R_i + R_j) per area (Z eqs 7-9).
        """
        contact_normal = np.full(np.shape(radius_i), moduli.emod)
        bond_radius = moduli.pb_rmul * np.minimum(radius_i, radius_j)
        per_area = moduli.pb_emod / (radius_i + radius_j)
        return Springs(
            contact_normal=contact_normal,
            contact_shear=contact_normal / moduli.kratio if moduli.fric > 0.0 else np.zeros_like(contact_normal),
            bond_normal=per_area * 2.0 * bond_radius,
            bond_shear=per_area * 2.0 * bond_radius / moduli.pb_kratio,
            bending=per_area * 2.0 * bond_radius**3 / 3.0,
            area=2.0 * bond_radius,
            bond_radius=bond_radius,
        )

    def own_constants(
        self, moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray, acts: np.ndarray, *, bonded: bool
    ) -> np.ndarray:
        """Constants (b, 7) of pairs, in the columns after their place."""
        pair, has_bond = self.springs(moduli, radius_i, radius_j), float(bonded)
        return np.column_stack(
            [
                np.where(acts, pair.contact_normal, 0.0),
                np.where(acts, pair.contact_shear, 0.0),
                has_bond * pair.bond_normal,
                has_bond * pair.bond_shear,
                has_bond * pair.bending,
                1.0 / pair.area,
                1.5 / pair.bond_radius**2,  # R̄/J
            ]
        )
