"""Masses and the continuum a brick is equivalent to, against closed forms of the square lattice."""

import numpy as np
import pytest

from dembound.casefile.disks.material import Material
from dembound.disks.material.case_material import make_packed_material
from dembound.disks.material.packed_material import PackedMaterial
from dembound.errors import CaseError
from dembound.packings.brick import Brick
from dembound.packings.square import Square

DENSITY = 2500.0
K = 2.5e9
"""ρ c_p², Pa, for c_p = 1000 m/s."""

MATERIAL = {"density": DENSITY, "p_wave_speed": 1000.0}

SOLVE = 1e-9
"""Relative error of a sparse solve: rounding times a condition number that a small brick keeps below 1e6."""


def lattice() -> Brick:
    return Square(size=(0.5, 0.5), radius=0.25).pack(1.25e9)


def ground(brick: Brick, held: tuple[str, ...] = (), **material: object) -> PackedMaterial:
    return make_packed_material(brick, Material(**{**MATERIAL, **material}), held)


def test_masses_add_up_to_density_times_area(random_brick: Brick) -> None:
    made = ground(random_brick)

    # a sum of some 150 terms
    assert made.mass.sum() == pytest.approx(DENSITY * 6.0 * 5.0, rel=1e-13)
    # one disk density for all: mass over disk area is the same everywhere
    np.testing.assert_allclose(made.mass / random_brick.radii**2, made.mass[0] / random_brick.radii[0] ** 2, rtol=1e-14)
    np.testing.assert_allclose(made.inertia, made.mass * random_brick.radii**2 / 2.0, rtol=1e-14)


@pytest.mark.parametrize(("fric", "shear"), [(0.0, 0.5 * K / 4.0), (0.5, 0.5 * K / 4.0 + 0.5 * K / 2.0)])
def test_the_lattice_has_its_closed_form_stiffness(fric: float, shear: float) -> None:
    # k_n = K; k_s of the bond is K/2/pb_kratio, of the contact K/2/kratio, with friction only
    made = ground(lattice(), fric=fric, kratio=2.0, pb_kratio=4.0)
    tensor = made.tensor
    expected = np.array([[K, 0, 0, 0], [0, K, 0, 0], [0, 0, shear / 2, shear / 2], [0, 0, shear / 2, shear / 2]])

    np.testing.assert_allclose(tensor, expected, atol=SOLVE * K)


def test_locked_rotations_double_the_lattices_shear_stiffness() -> None:
    made = ground(lattice(), held=("rotation",))

    # each of the two gradients strains its own kind of contacts, c_s = D√(k_s/m) = √(k_s/ρ)
    np.testing.assert_allclose(made.tensor, np.diag([K, K, K / 2.0, K / 2.0]), atol=SOLVE * K)
    np.testing.assert_allclose(made.wave_speeds(0), [1000.0, np.sqrt(K / 2.0 / DENSITY)], rtol=SOLVE)


def test_wave_speeds_are_the_closed_form_and_nan_where_motion_is_held() -> None:
    # μ = 0: c_s = c_p/2
    np.testing.assert_allclose(ground(lattice()).wave_speeds(0), [1000.0, 500.0], rtol=SOLVE)
    np.testing.assert_allclose(ground(lattice()).wave_speeds(1), [1000.0, 500.0], rtol=SOLVE)
    np.testing.assert_allclose(ground(lattice(), held=("y",)).wave_speeds(0), [1000.0, np.nan], rtol=SOLVE)
    np.testing.assert_allclose(ground(lattice(), held=("y",)).wave_speeds(1), [np.nan, 500.0], rtol=SOLVE)


@pytest.mark.parametrize(("held", "axis"), [((), 0), (("y",), 0), (("x",), 1)])
def test_an_assembly_can_be_given_the_speed_asked_for(random_brick: Brick, held: tuple[str, ...], axis: int) -> None:
    nominal, matched = ground(random_brick, held), ground(random_brick, held, match="assembly")

    assert matched.wave_speeds(axis)[0] == pytest.approx(1000.0, rel=SOLVE)
    assert nominal.wave_speeds(axis)[0] != pytest.approx(1000.0, rel=1e-3)
    # both moduli by one factor
    assert matched.moduli.emod / nominal.moduli.emod == pytest.approx(matched.moduli.pb_emod / nominal.moduli.pb_emod)


def test_a_material_that_resists_no_shear_is_refused(random_brick: Brick) -> None:
    for brick in (lattice(), random_brick):
        with pytest.raises(CaseError, match="give bonds or friction"):
            _ = ground(brick, contact_share=1.0).tensor


def test_bonds_of_a_lattice_have_their_share_of_its_stiffness() -> None:
    # along the rows contacts and bonds act side by side, whatever friction and shear springs there are
    for changes in ({}, {"fric": 0.5, "kratio": 2.0, "pb_kratio": 3.0}, {"pb_rmul": 0.5}):
        assert ground(lattice(), contact_share=0.3, **changes).bond_share == pytest.approx(0.7, rel=SOLVE)
    assert ground(lattice(), contact_share=1.0, fric=0.5).bond_share == 0.0
    assert ground(lattice(), contact_share=0.0).bond_share == pytest.approx(1.0, rel=SOLVE)


def test_disks_that_only_touch_cannot_be_locked_in() -> None:
    with pytest.raises(CaseError, match=r"material\.locked_in: needs disks that were packed under stress"):
        ground(lattice(), law="linearpbond", locked_in=1e6)


def test_no_more_is_locked_in_than_a_tenth_of_the_contact_modulus(random_brick: Brick) -> None:
    # E_c = ρc²/2
    most = 0.1 * 0.5 * K
    made = ground(random_brick, law="linearpbond", locked_in=most * (1.0 - 1e-12))
    assert made.moduli.emod == 0.5 * K
    allowed = r"is 126 MPa, must be at most 125 MPa, 0\.1 of the contact modulus"
    with pytest.raises(CaseError, match=rf"material\.locked_in: {allowed}"):
        ground(random_brick, law="linearpbond", locked_in=1.008 * most)
