"""Constants of pairs by hand, and beside those of the elastic law."""

from dataclasses import replace

import numpy as np

from dembound.casefile.types import LAWS
from dembound.laws import Law, Moduli, Springs
from dembound.laws.law import K

MODULI = Moduli(emod=6e9, pb_emod=3e9, kratio=2.0, pb_kratio=3.0, pb_rmul=0.5, fric=0.4)
RADII = np.array([0.2, 0.2, 0.2]), np.array([0.4, 0.4, 0.4])
VECTORS = np.array([[0.3, 0.4], [0.0, -0.6], [0.65, 0.0]])
"""An overlap of 0.1 m, disks that touch, and a gap of 0.05 m."""


def constants(**words: float) -> np.ndarray:
    return LAWS["linearpbond"].pair_constants(MODULI, *RADII, VECTORS, **{"bonded": True, **words})


def test_the_columns_are_those_of_the_law() -> None:
    # R̄ = 0.5 · 0.2, A = 2 R̄, J = 2 R̄³/3; k̄_n = 3e9/0.6 per area
    area, moment, per_area = 0.2, 2e-3 / 3.0, 5e9
    expected = [0.3, 0.4, 0.5, 0.5, -0.1, 6e9, 3e9]
    expected += [per_area * area, per_area * area / 3.0, per_area * moment, 1.0 / area, 0.1 / moment, 0.0, 0.0, 0.0]

    np.testing.assert_allclose(constants()[0], expected, rtol=1e-14)


def test_overlapping_disks_just_touch_and_push_by_their_part_of_a_locked_in_stress() -> None:
    np.testing.assert_allclose(constants()[:, 3], [0.5, 0.6, 0.6], rtol=1e-15)
    for part in (0.25, 3.0):
        np.testing.assert_allclose(constants(locked_in=part)[:, 3], [0.5 + part * 0.1, 0.6, 0.6], rtol=1e-15)
    ahead = np.array([[0.6 * (1.0 + 1e-12), 0.0]])  # touches but for rounding
    (row,) = LAWS["linearpbond"].pair_constants(MODULI, *(radii[:1] for radii in RADII), ahead, bonded=True)
    assert row[3] == row[2]


def test_at_rest_a_pair_is_as_stiff_as_under_the_elastic_law() -> None:
    found = constants(gaps_close=False)
    elastic = LAWS["elastic"].stiffness(MODULI, *RADII, np.hypot(*VECTORS.T))

    np.testing.assert_allclose(found[:, 5] + found[:, 7], elastic.normal, rtol=1e-15)
    np.testing.assert_allclose(found[:, 6] + found[:, 8], elastic.shear, rtol=1e-15)
    np.testing.assert_allclose(found[:, 9], elastic.bending, rtol=1e-15)
    np.testing.assert_allclose(found[:, 2] / 2.0 + found[:, 4], elastic.arm_i, rtol=1e-15)


def test_a_law_that_gives_springs_alone_is_complete() -> None:
    class Stiffer(Law):
        name = "stiffer"

        def springs(self, moduli: Moduli, radius_i: np.ndarray, radius_j: np.ndarray) -> Springs:
            return LAWS["elastic"].springs(replace(moduli, emod=2.0 * moduli.emod), radius_i, radius_j)

    found = Stiffer().pair_constants(MODULI, *RADII, VECTORS, bonded=True)
    assert found[:, K.kn].tolist() == (2.0 * constants()[:, K.kn]).tolist()
