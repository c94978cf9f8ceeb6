"""The depth of a continuum's free surface below that of a packing."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.casefile.disks.material import Material
from dembound.disks.free_surface import _curved, skin_of
from dembound.disks.homogenise import Network, homogenise
from dembound.disks.packed_material import PackedMaterial, make_packed_material
from dembound.laws import Stiffness
from dembound.packings.brick import Brick
from dembound.packings.dense import Recipe, pack_dense
from dembound.packings.square import Square
from dembound.packings.tiling import tile

MATERIAL = Material(density=2500.0, p_wave_speed=1000.0)


@pytest.fixture(scope="module")
def dense() -> PackedMaterial:
    brick = pack_dense(Recipe(size=(6.0, 5.0), radius=0.25, radius_ratio=1.5, pressure=0.008, bond_gap=0.0, seed=2))
    return make_packed_material(brick, MATERIAL, ())


def square(fric: float = 0.0) -> PackedMaterial:
    material = MATERIAL.model_copy(update={"fric": fric})
    return make_packed_material(Square(size=(1.0, 2.0), radius=0.25).pack(1.25e9), material, ())


@pytest.mark.parametrize("fric", [0.0, 0.5])
def test_rows_of_a_square_lattice_have_no_skin(fric: float) -> None:
    # every row carries K D whatever is above it
    assert square(fric).skin == pytest.approx((0.0, 0.0), abs=1e-9)


def test_a_layer_of_unequal_rows_lies_where_its_stiff_rows_are() -> None:
    row, beside = np.arange(4), np.zeros(4, dtype=np.int64)
    brick = Brick(
        size=np.array([0.5, 2.0]),
        positions=np.column_stack([np.full(4, 0.25), 0.25 + 0.5 * row]),
        radii=np.full(4, 0.25),
        pairs=np.vstack([np.column_stack([row, row]), np.column_stack([row, (row + 1) % 4])]),
        images=np.vstack([np.column_stack([beside + 1, beside]), np.column_stack([beside, row == 3])]).astype(np.int64),
        edge_rows=np.zeros((4, 2), dtype=np.bool_),
        stress=np.zeros(3),
        residual_ratio=0.0,
    )
    made = make_packed_material(brick, MATERIAL, ())
    times = np.concatenate([1.0 + row, np.ones(4)])  # rows of 1, 2, 3 and 4 times the stiffness, upwards
    stiffness = replace(made.stiffness, normal=made.stiffness.normal * times)
    skin = skin_of(brick, stiffness, homogenise(brick, stiffness, ()).tensor, bricks=1)

    # ν = 0, so rows share no load: N = E'H, and M/N = Σ k y/Σ k − H/2
    higher = float(np.dot(1.0 + row, brick.positions[:, 1]) / 10.0 - 1.0)
    assert higher == pytest.approx(0.25)
    assert skin == pytest.approx((higher, -higher), abs=1e-9)


def test_a_random_packing_is_softer_near_its_surface(dense: PackedMaterial) -> None:
    diameter = dense.brick.mean_diameter
    assert all(0.0 < depth < diameter for depth in dense.skin)
    assert sum(dense.skin) > 0.5 * diameter
    # the skins of both surfaces are apart: what is left at their distance has decayed by e^(−2π H/L) with the brick's
    # width L = 6 m and H = 10 m, to 3e-5; of the moment only as (δ/H)², to 1e-3
    higher = skin_of(dense.brick, dense.stiffness, dense.material_tensor, bricks=4)
    assert sum(higher) == pytest.approx(sum(dense.skin), abs=1e-4 * diameter)
    assert higher.top == pytest.approx(dense.skin.top, abs=5e-3 * diameter)


def test_curvature_strains_contacts_as_a_beam_that_is_bent(dense: PackedMaterial) -> None:
    strip = tile(dense.brick, (1, 2), (False, False))
    stiffness: Stiffness = dense.stiffness
    network = Network.of_assembly(dense.brick, stiffness, strip)
    x, y = strip.positions.T
    bent = np.concatenate([x * (y - 5.0), -0.5 * x**2, -x])

    # elongations are differences of values up to x²: rounding of 36
    np.testing.assert_allclose(_curved(network, strip.positions, 5.0), network.motion_matrix() @ bent, atol=1e-13 * 36)


def test_a_softer_contact_of_the_surface_makes_it_deeper(dense: PackedMaterial) -> None:
    half = replace(dense.stiffness, shear=0.5 * dense.stiffness.shear, bending=0.5 * dense.stiffness.bending)
    softer = skin_of(dense.brick, half, homogenise(dense.brick, half, ()).tensor)
    assert sum(softer) > sum(dense.skin)
