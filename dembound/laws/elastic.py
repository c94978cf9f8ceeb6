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


def elastic_stiffness(moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray, distance: np.ndarray) -> Stiffness:
    """Stiffnesses of contacts between disks of radii (b,) m whose centres are `distance` (b,) m apart.

    Contact: k_n = emod whatever the radii (two springs 2E_c in series at unit thickness), k_s = k_n/kratio but
    only with friction. It carries nothing across a gap. Bond: R̄ = pb_rmul·min(R), area 2R̄, inertia 2R̄³/3,
    k̄_n = pb_emod/(R_i + R_j) per area (Z eqs 7-9). The arms run to the middle of the overlap or gap and add up
    to the distance, so moments balance.
    """
    touching = distance <= (radius_i + radius_j) * (1.0 + 1e-9)
    contact_normal = np.where(touching, moduli.emod, 0.0)
    contact_shear = contact_normal / moduli.kratio if moduli.fric > 0.0 else np.zeros_like(contact_normal)
    bond_radius = moduli.pb_rmul * np.minimum(radius_i, radius_j)
    bond_per_area = moduli.pb_emod / (radius_i + radius_j)
    bond_normal = bond_per_area * 2.0 * bond_radius
    return Stiffness(
        normal=contact_normal + bond_normal,
        shear=contact_shear + bond_normal / moduli.pb_kratio,
        bending=bond_per_area * 2.0 * bond_radius**3 / 3.0,
        arm_i=(distance + radius_i - radius_j) / 2.0,
        arm_j=(distance + radius_j - radius_i) / 2.0,
    )
