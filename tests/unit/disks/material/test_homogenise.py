"""The springs between disks, and the motion of a strained brick's disks beyond the mean gradient."""

import numpy as np
import pytest

from dembound.casefile.disks.material import Material
from dembound.disks.material.homogenise import Network
from dembound.disks.material.packed_material import PackedMaterial, make_packed_material
from dembound.packings.dense import Recipe, pack_dense
from dembound.packings.square import Square

MATERIAL = Material(density=2500.0, p_wave_speed=1000.0, fric=0.5)

SOLVE = 1e-9
"""Relative error of a sparse solve: rounding times a condition number that a small brick keeps below 1e6."""


@pytest.fixture(scope="module")
def dense() -> PackedMaterial:
    brick = pack_dense(Recipe(size=(6.0, 5.0), radius=0.25, radius_ratio=1.5, pressure=0.008, bond_gap=0.0, seed=2))
    return make_packed_material(brick, MATERIAL, ())


def test_the_disks_of_a_strained_brick_are_in_equilibrium(dense: PackedMaterial) -> None:
    network = Network.of_brick(dense.brick, dense.stiffness)
    motions = network.motion_matrix()
    mean = network.gradient_matrix()
    relaxed = mean + motions @ dense.continuum.corrector.reshape(-1, 4)

    force, before = (motions.T @ (network.springs[:, None] * each) for each in (relaxed, mean))
    assert np.abs(force).max() <= SOLVE * np.abs(before).max()


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
