"""Stiffness of contacts and bonds, by hand."""

import numpy as np

from dembound.casefile.types import LAWS
from dembound.laws import Moduli, Stiffness

ROUNDING = 1e-14
"""Relative: a handful of operations of 1.1e-16 each."""


def stiffness(moduli: Moduli, radius_i: float, radius_j: float, distance: float) -> Stiffness:
    return LAWS["elastic"].stiffness(moduli, np.array([radius_i]), np.array([radius_j]), np.array([distance]))


def test_equal_disks_with_a_bond_as_wide_as_they_are() -> None:
    found = stiffness(Moduli(emod=3.0, pb_emod=5.0, fric=1.0), 0.5, 0.5, 1.0)

    # contact 3; bond 5/(0.5 + 0.5) per area, area 2·0.5, inertia 2·0.5³/3
    np.testing.assert_allclose(found.normal, [8.0], rtol=ROUNDING)
    np.testing.assert_allclose(found.shear, [8.0], rtol=ROUNDING)
    np.testing.assert_allclose(found.bending, [5.0 / 12.0], rtol=ROUNDING)
    np.testing.assert_allclose([found.arm_i, found.arm_j], [[0.5], [0.5]], rtol=ROUNDING)


def test_ratios_radii_and_the_bond_radius_enter_where_they_should() -> None:
    moduli = Moduli(emod=12.0, pb_emod=10.0, kratio=3.0, pb_kratio=2.0, pb_rmul=0.5, fric=0.1)
    found = stiffness(moduli, 1.0, 4.0, 5.0)

    # R̄ = 0.5·1; per area 10/5 = 2, area 1, inertia 2·0.125/3 = 1/12
    np.testing.assert_allclose(found.normal, [12.0 + 2.0], rtol=ROUNDING)
    np.testing.assert_allclose(found.shear, [12.0 / 3.0 + 2.0 / 2.0], rtol=ROUNDING)
    np.testing.assert_allclose(found.bending, [2.0 / 12.0], rtol=ROUNDING)


def test_without_friction_or_across_a_gap_only_the_bond_carries() -> None:
    np.testing.assert_allclose(stiffness(Moduli(emod=12.0, pb_emod=10.0), 1.0, 1.0, 2.0).shear, [10.0], rtol=ROUNDING)
    moduli = Moduli(emod=12.0, pb_emod=10.0, fric=1.0)
    for distance, contact in ((2.1, 0.0), (2.0, 12.0), (1.9, 12.0)):
        found = stiffness(moduli, 1.0, 1.0, distance)
        np.testing.assert_allclose([found.normal, found.shear], [[contact + 10.0]] * 2, rtol=ROUNDING)


def test_arms_meet_in_the_middle_of_overlap_or_gap() -> None:
    rng = np.random.default_rng(1)
    radius_i, radius_j = rng.uniform(0.5, 1.5, (2, 50))
    distance = (radius_i + radius_j) * rng.uniform(0.9, 1.1, 50)
    found = LAWS["elastic"].stiffness(Moduli(1.0, 1.0), radius_i, radius_j, distance)

    np.testing.assert_allclose(found.arm_i + found.arm_j, distance, rtol=ROUNDING)
    # either disk's surface is as far from the contact point
    np.testing.assert_allclose(found.arm_i - radius_i, found.arm_j - radius_j, atol=ROUNDING)
