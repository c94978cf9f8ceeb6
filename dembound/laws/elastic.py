"""The elastic law: linear contact plus parallel bond, without history; contacts never open.

PFC2D's linear parallel bond for total small displacements. It is exact as long as no contact opens or slips and no
bond breaks, which a confining stress above ρcv ensures for waves of particle velocity v.
"""

from typing import ClassVar

import numpy as np

from dembound.laws.law import Law, Moduli, Springs


class Elastic(Law):
    """Contacts and parallel bonds whose forces are linear in small displacements."""

    name: ClassVar[str] = "elastic"
    elsewhere: ClassVar[tuple[str, ...]] = ("linear", "hooke", "hookean")
    help: ClassVar[str] = "linear"

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
