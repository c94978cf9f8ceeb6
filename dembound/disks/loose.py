"""Bounds of the eigenvalues of loose disks, of which debris consists: the smallest ones, each on six neighbours."""

import numpy as np

from dembound.disks.body import DiskBody
from dembound.disks.contacts.dashpots import viscosity
from dembound.disks.material.packed_material import PackedMaterial

RESERVE, LOOSE = 4.0, 1e-2
"""Overlap for which the step limit holds under a law whose stiffness grows with it.

The first is times the largest one at rest, the second a share of the smallest radius, without pressure. The step goes
with their power −¼: for four times the overlap it is 0.71 times as long.
"""


def loose_eigenvalue(ground: PackedMaterial) -> float:
    """Bound of ω² (1/s²) for the smallest disks, each rolling on six neighbours, as in broken or loose ground.

    With contacts and no bonds. On the hexagonal lattice the normal springs give at most 6k_n/m, and the tangential ones
    24k_s/m, when all disks rotate in the same way; the sum is a bound for both together. Springs k_s R̄² against rolling
    add nothing to this motion, and less to others than its distance from them.
    """
    normal, shear = loose_springs(ground)
    return (6.0 * normal + 24.0 * shear) / float(ground.mass.min())


def beyond_neighbours(scene: DiskBody) -> tuple[float, float]:
    """By how much walls raise bounds of M⁻¹K (1/s²) and M⁻¹C (1/s): where they are stiffer than a disk in their place.

    A contact of stiffness k_w with a wall takes as much from a disk, k_w/m and 3k_sw/m, as one of k_w/2 with an equal
    disk, 2k/m and 6k_s/m, and more than six neighbours have no room. A disk may be between two walls. Where a wall
    resists rolling, by k_sw R² on the rotation, the 3 is ½(5 + √17).
    """
    stiffer, slower = 0.0, 0.0
    for ground in scene.inside.zone_materials:
        (normal, shear), mass = loose_springs(ground), float(ground.mass.min())
        for wall in scene.case.wall:
            kn = wall.kn or 2.0 * ground.moduli.emod
            ks = (wall.ks or kn / ground.moduli.kratio) if wall.fric > 0.0 else 0.0
            sheared = (0.5 * (5.0 + np.sqrt(17.0)) if wall.rr_fric > 0.0 else 3.0) * ks - 6.0 * shear
            stiffer = max(stiffer, 2.0 * max(kn - 2.0 * normal, sheared) / mass)
            ratios, springs = np.array([wall.dp_nratio, scene.case.material.dp_nratio]), np.array([kn, 0.5 * normal])
            own, pair = viscosity(ratios, springs, 2.0 * mass, 2.0 * mass).tolist()  # m_c of a wall is the whole mass
            slower = max(slower, 2.0 * (own - 2.0 * pair) / mass)
    return stiffer, slower


def loose_springs(ground: PackedMaterial) -> tuple[float, float]:
    """Largest normal and shear stiffness (N/m) of contacts of the smallest disks, up to `reserve` where they vary."""
    moduli, radii = ground.moduli, ground.brick.radii
    if ground.overlaps is None:
        return moduli.emod, moduli.emod / moduli.kratio if moduli.fric > 0.0 else 0.0
    found = ground.law.springs_at(moduli, radii.min(), radii.max(), np.array(reserve(ground)))
    return float(found.contact_normal), float(found.contact_shear)


def reserve(ground: PackedMaterial) -> float:
    """Overlap (m) up to which the step limit holds, where contacts are stiffer with it."""
    assert ground.overlaps is not None
    return RESERVE * float(ground.overlaps.max()) if ground.has_stiffness else LOOSE * float(ground.brick.radii.min())


def loose_viscosity(scene: DiskBody, ground: PackedMaterial) -> float:
    """The largest eigenvalue of M⁻¹C (1/s) of the hexagonal lattice of the smallest disks, see `loose_eigenvalue`.

    With dashpots c_n and c_s it is 24c_s/m, when all disks rotate in the same way, or (6c_n + 2c_s)/m.
    """
    material, mass = scene.case.material, float(ground.mass.min())
    springs, ratios = np.array(loose_springs(ground)), np.array([material.dp_nratio, material.dp_sratio])
    normal, sheared = viscosity(ratios, springs, mass, mass).tolist()
    return max(24.0 * sheared, 6.0 * normal + 2.0 * sheared) / mass


def loose_modes(scene: DiskBody, ground: PackedMaterial) -> list[tuple[float, float]]:
    """Bounds of M⁻¹K (1/s²) and M⁻¹C (1/s) of loose disks on six others: all turn alike, or do not turn.

    By ½(a + b)² ≤ a² + b² of the ends of contacts M⁻¹K is at most twice the block of one disk with its neighbours held:
    24k_s/m for rotations, and 6(k_n + k_s)/m for displacements, with dashpots in place of springs alike. The hexagonal
    lattice has 24k_s/m and (6k_n + 2k_s)/m.
    """
    material, mass, springs = scene.case.material, float(ground.mass.min()), np.array(loose_springs(ground))
    dashpots = viscosity(np.array([material.dp_nratio, material.dp_sratio]), springs, mass, mass)
    ways = np.array([[0.0, 24.0], [6.0, 6.0]]) / mass
    return list(zip((ways @ springs).tolist(), (ways @ dashpots).tolist(), strict=True))
