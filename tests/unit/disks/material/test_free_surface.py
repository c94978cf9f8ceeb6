"""The depth of a continuum's free surface below that of a packing."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.casefile.disks.material import Material
from dembound.disks.material import free_surface
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.free_surface import _curved, _turned, cut_at, skin_depths
from dembound.disks.material.homogenise import Network, homogenise
from dembound.disks.material.packed_material import PackedMaterial
from dembound.packings.brick import Brick
from dembound.packings.square import Square

SIDES = ("left", "right", "bottom", "top")
MATERIAL = Material(density=2500.0, p_wave_speed=1000.0)


@pytest.fixture(scope="module")
def dense(random_brick) -> PackedMaterial:
    return make_packed_material(random_brick, MATERIAL, ())


def square(fric: float = 0.0) -> PackedMaterial:
    material = MATERIAL.model_copy(update={"fric": fric})
    return make_packed_material(Square(size=(1.0, 2.0), radius=0.25).pack(1.25e9), material, ())


@pytest.mark.parametrize("fric", [0.0, 0.5])
def test_rows_of_a_square_lattice_have_no_skin(fric: float) -> None:
    # every row carries K D whatever is above it
    assert [square(fric).skin(side) for side in SIDES] == pytest.approx([0.0] * 4, abs=1e-9)


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
    tensor = homogenise(brick, stiffness, ()).tensor

    # ν = 0, so rows share no load: N = E'H, and M/N = Σ k y/Σ k − H/2
    higher = float(np.dot(1.0 + row, brick.positions[:, 1]) / 10.0 - 1.0)
    assert higher == pytest.approx(0.25)
    assert skin_depths(brick, stiffness, tensor) == pytest.approx((higher, -higher), abs=1e-9)
    # rows end at the left and right: all columns have the same stiffness
    assert skin_depths(brick, stiffness, tensor, axis=0) == pytest.approx((0.0, 0.0), abs=1e-9)


def test_bricks_that_end_elsewhere_are_the_same_packing(dense: PackedMaterial) -> None:
    """The disks and contacts are the same, with another numbering of bricks."""
    height = 1.7
    cut = cut_at(dense.brick, height)

    assert ((cut.positions >= 0.0) & (cut.positions < cut.size)).all()
    np.testing.assert_allclose(cut.vectors, dense.brick.vectors, atol=1e-12)
    moved = (cut.positions[:, 1] + height) % cut.size[1]
    np.testing.assert_allclose(moved, dense.brick.positions[:, 1], atol=1e-12)


@pytest.mark.parametrize("height", [0.01, 0.24, 0.26, 0.49])
def test_a_lattice_that_is_cut_ends_between_its_rows(height: float) -> None:
    """Rows are 0.5 m apart, the first one at 0.25 m: cuts above it end at 0.5 m, those below at 0."""
    end = 0.5 if height > 0.25 else 0.0

    assert np.add(square().cut(height), height) == pytest.approx([end, end], abs=1e-9)


def test_a_random_packing_is_softer_near_its_surface(dense: PackedMaterial, monkeypatch) -> None:
    diameter = dense.brick.mean_diameter
    depths = [dense.skin(side) for side in SIDES]
    assert all(0.0 < depth < diameter for depth in depths)
    assert sum(depths) > diameter
    # the skins of both surfaces are apart: what is left at their distance has decayed by e^(−2π H/L) with the brick's
    # width L = 6 m and H = 15 m, to 1e-7; of the moment only as (δ/H)², to 1e-3
    monkeypatch.setattr(free_surface, "SLENDER", 4.0)
    higher = skin_depths(dense.brick, dense.stiffness, dense.material_tensor)
    assert sum(higher) == pytest.approx(sum(depths[2:]), abs=1e-4 * diameter)
    assert higher[1] == pytest.approx(depths[3], abs=5e-3 * diameter)


def test_a_turned_packing_has_its_skins_at_other_sides(dense: PackedMaterial) -> None:
    """Contacts have the same constants in the mirror image, as shear and rotation change their signs together."""
    turned = make_packed_material(_turned(dense.brick), MATERIAL, ())
    of = dict(zip(("bottom", "top", "left", "right"), SIDES, strict=True))
    assert turned.material_tensor[0] == pytest.approx(dense.material_tensor[1, [1, 0, 3, 2]], rel=1e-9)
    for side, before in of.items():
        assert turned.skin(side) == pytest.approx(dense.skin(before), rel=1e-6)


def test_contacts_of_a_bent_strip_have_the_elongations_of_its_disks(dense: PackedMaterial) -> None:
    """Both disks of each contact alone, moved as u_x = xy, u_y = −½x², θ = −x about its middle."""
    network, middle = Network.of_brick(dense.brick, dense.stiffness), 2.0
    apart = network._replace(disks=2 * len(network.pairs), pairs=np.arange(network.pairs.size).reshape(-1, 2))
    x = np.outer(network.vectors[:, 0], [-0.5, 0.5]).ravel()
    low = dense.brick.positions[network.pairs[:, 0], 1] - middle
    y = np.column_stack([low, low + network.vectors[:, 1]]).ravel()
    moved = apart.motion_matrix() @ np.concatenate([x * y, -0.5 * x**2, -x])

    np.testing.assert_allclose(_curved(network, dense.brick.positions, middle), moved, atol=1e-14)
