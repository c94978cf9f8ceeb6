"""The motion of a strained brick's disks beyond the mean gradient."""

import numpy as np

from dembound.casefile.disks.material import Material
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.packed_material import PackedMaterial
from dembound.packings.square import Square

MATERIAL = Material(density=2500.0, p_wave_speed=1000.0, fric=0.5)

SOLVE = 1e-9
"""Relative error of a sparse solve: rounding times a condition number that a small brick keeps below 1e6."""


def test_disks_of_a_square_lattice_move_with_the_mean_gradient() -> None:
    made = make_packed_material(Square(size=(1.0, 1.0), radius=0.25).pack(1.25e9), MATERIAL, ())
    corrector = made.continuum.corrector

    # and rotate with it by ½(∂u_y/∂x − ∂u_x/∂y); with equal springs along x and y no more than that
    np.testing.assert_allclose(corrector[:2], 0.0, atol=SOLVE)
    np.testing.assert_allclose(corrector[2], np.tile([0.0, 0.0, -0.5, 0.5], (corrector.shape[1], 1)), atol=SOLVE)


def test_the_mass_stays_where_the_mean_gradient_moves_it(dense: PackedMaterial) -> None:
    mean = dense.mass @ dense.continuum.corrector[:2]
    assert np.abs(mean).max() <= 1e-12 * dense.mass.sum() * np.abs(dense.continuum.corrector[:2]).max()
    assert np.abs(dense.continuum.corrector[:2]).max() > 0.01 * dense.brick.mean_diameter
