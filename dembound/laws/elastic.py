"""The elastic law: linear contact plus parallel bond, no memory, contacts never open.

PFC2D's linear parallel bond for total small displacements. It is exact as long as no contact opens or slips and no
bond breaks, which a confining stress above ρcv ensures for waves of particle velocity v.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Moduli:
    """Micro-parameters under their PFC names: emod, pb_emod in Pa; kratio, pb_kratio, pb_rmul, fric pure numbers."""

    emod: float
    pb_emod: float
    kratio: float = 1.0
    pb_kratio: float = 1.0
    pb_rmul: float = 1.0
    fric: float = 0.0


@dataclass(frozen=True)
class Stiffness:
    """Constants of contacts, (b,) each: normal and shear in N/m, bending in N·m/rad, arms in m."""

    normal: np.ndarray
    shear: np.ndarray
    bending: np.ndarray
    arm_i: np.ndarray
    arm_j: np.ndarray


@dataclass(frozen=True)
class Springs:
    """Contact and bond of pairs apart, (b,) each: stiffnesses in N/m and N·m/rad, bond area (m) and radius (m)."""

    contact_normal: np.ndarray
    contact_shear: np.ndarray
    bond_normal: np.ndarray
    bond_shear: np.ndarray
    bending: np.ndarray
    area: np.ndarray
    bond_radius: np.ndarray


def springs(moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray) -> Springs:
    """Springs of closed, bonded contacts between disks of radii (b,) m.

    Contact: k_n = emod whatever the radii (two springs 2E_c in series at unit thickness), k_s = k_n/kratio but
    only with friction. Bond: R̄ = pb_rmul·min(R), area 2R̄, inertia 2R̄³/3, k̄_n = pb_emod/(R_i + R_j) per area
    (Z eqs 7-9).
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


def touching(radius_i: np.ndarray, radius_j: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """Which disks (b,) bool touch or overlap, rounding forgiven; all in m."""
    return distance <= (radius_i + radius_j) * (1.0 + 1e-9)


def elastic_stiffness(moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray, distance: np.ndarray) -> Stiffness:
    """Stiffnesses of contacts between disks of radii (b,) m whose centres are `distance` (b,) m apart.

    Contact and bond together, see `springs`; across a gap the bond alone. The arms run to the middle of the overlap or
    gap and add up to the distance, so moments balance.
    """
    pair = springs(moduli, radius_i, radius_j)
    closed = touching(radius_i, radius_j, distance)
    return Stiffness(
        normal=np.where(closed, pair.contact_normal, 0.0) + pair.bond_normal,
        shear=np.where(closed, pair.contact_shear, 0.0) + pair.bond_shear,
        bending=pair.bending,
        arm_i=(distance + radius_i - radius_j) / 2.0,
        arm_j=(distance + radius_j - radius_i) / 2.0,
    )
