"""Reflection of oblique plane waves by dashpots: the lattice's exact reflection is that of the continuum's formula."""

import pytest
from oblique import dashpot_formula, lattice, reflection

HALF = {"type": "viscous", "half_mass": True}
PER_WAVELENGTH = 400.0


@pytest.mark.parametrize("motion", ["p", "s"])
@pytest.mark.parametrize("angle", [0.0, 30.0, 43.0, 47.0, 85.0])
def test_lattice_and_formula_agree(motion, angle):
    """Up to the lattice's dispersion, (qa)²/24 = 1e-5 of wave numbers: seen near grazing and critical angles.

    There a change δ of k_y changes k_x by δ k_y/k_x, k_y/k_x = 11 at 85°, and amplitudes by no more than twice that:
    1e-5·11·11·2 = 2.5e-3. P waves of an S wave of 43° have k_x = 0.26 k_p.
    """
    found, expected = reflection(HALF, motion, angle, PER_WAVELENGTH), dashpot_formula(motion, angle)
    for kind in ("p", "s", "energy"):
        assert found[kind] == pytest.approx(expected[kind], abs=2.5e-3)


@pytest.mark.parametrize("motion", ["p", "s"])
def test_half_of_the_energy_comes_back_at_grazing_incidence(motion):
    """The thresholds of the page: below 1 % up to 35° for P and 15° for S; above a half from 84° and 80° on."""
    small, large = {"p": (35.0, 84.0), "s": (15.0, 80.0)}[motion]
    assert reflection(HALF, motion, small, PER_WAVELENGTH)["energy"] < 0.01
    assert reflection(HALF, motion, large, PER_WAVELENGTH)["energy"] > 0.5


@pytest.mark.parametrize(
    ("motion", "angle", "energy"),
    [("p", 30, 0.0003), ("s", 30, 0.036), ("p", 60, 0.036), ("s", 60, 0.113), ("p", 75, 0.20), ("s", 75, 0.35)],
)
def test_energies_of_the_page_on_limits(motion, angle, energy):
    """Those of ν = ¼, c_s/c_p = 1/√3, rounded to two or three digits."""
    assert dashpot_formula(motion, float(angle), 3.0**-0.5)["energy"] == pytest.approx(energy, rel=0.04)


@pytest.mark.parametrize("motion", ["p", "s"])
def test_a_free_and_a_rigid_side_return_all(motion):
    for side in ({"type": "free"}, {"type": "viscous", "beta_p": 1e9, "beta_s": 1e9}):
        assert reflection(side, motion, 30.0)["energy"] == pytest.approx(1.0, abs=1e-6)


def test_the_lattice_is_isotropic():
    tensor = lattice(HALF).ground.tensor
    assert tensor[0, 0] - tensor[0, 1] == pytest.approx(2.0 * tensor[3, 3], rel=1e-12)
