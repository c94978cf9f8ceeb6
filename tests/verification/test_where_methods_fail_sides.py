"""The thresholds of dashpots, springs and columns in docs/evidence/where_methods_fail.md, measured again."""

import numpy as np
import pytest
import sides
from oblique import reflection

pytestmark = pytest.mark.slow


def test_lagged_dampers_halve_the_stable_step():
    """With half end masses to 1/√(1 + β²) of the limit without dashpots, 0.447 for β = 2; with whole ones to 0.799."""
    for beta in (0.5, 1.0, 2.0, 4.0):
        assert sides.lagged_limit(beta) == pytest.approx(1.0 / np.sqrt(1.0 + beta**2), rel=1e-5)
    assert sides.lagged_limit(2.0, end_mass=1.0) == pytest.approx(0.7994, abs=1e-3)
    assert sides.lagged_limit(4.0, centred=True) == pytest.approx(1.0, rel=1e-5)


@pytest.mark.parametrize("beta", [1.04, 1e4])
def test_strong_dashpots_reflect_but_cost_no_step(beta):
    """(β − 1)/(β + 1) comes back, 2 % at β = 1.04; waves of 2000 disks lose (qa/4)² by the end's mass in addition."""
    reflected, grows = sides.strong_dashpot(beta)
    assert reflected == pytest.approx((beta - 1.0) / (beta + 1.0), abs=1e-4)
    assert not grows


@pytest.mark.parametrize(("names", "diameters"), [(("left",), 0.0454), (("left", "bottom"), 0.0588)])
def test_springs_limit_the_step_only_at_a_twentieth_of_a_diameter(names, diameters):
    assert sides.reach_of_springs(0.01, names) == pytest.approx(diameters * sides.DIAMETER, rel=0.05)


@pytest.mark.parametrize("distance", [1.0, 0.005])
def test_noise_on_corner_springs_stays_bounded(distance):
    """Springs of both sides act on a corner; without them in the eigenvalue the step would be twice the stable one."""
    assert not sides.corner(distance)


def test_dashpots_creep_under_a_steady_load():
    """At F/ΣC: what else moves is absorbed within a few travel times of 10 ms; after 0.6 s 1e-6 of it is left."""
    velocity, expected = sides.drift()
    assert velocity == pytest.approx(expected, rel=1e-5)
    assert expected == pytest.approx(1.0 * 10.0 / (2.0 * 1000.0), rel=1e-12)  # aL/2c


@pytest.mark.parametrize("ratio", [1.0, 10.0])
def test_springs_reflect_long_waves(ratio):
    """Half cells reflect less than 1e-5 of these waves of 400 disks and more."""
    measured, formula = sides.on_springs(ratio)
    assert measured == pytest.approx(formula, abs=2e-5)
    assert measured == pytest.approx({1.0: 0.0398, 10.0: 0.3697}[ratio], abs=1e-4)


def test_the_foot_of_a_column_needs_half_cells():
    """Whole cells return (qa/4)(1 + d) of S waves, half cells its square and less.

    Half a disk too much mass, as for P, and an end disk that only one bond turns. With φ the excess rotation over that
    of the bar, θ = F/k_sD under a force F per row, and κ = k_r/k_sD², 1/12 for bonds of full radius that alone carry
    shear, balance of moments reads φ = κ(φ₊ + φ₋ − 2φ): φ falls by λ from disk to disk, λ + 1/λ = 2 + 1/κ, and the end
    disk has φ(1 + κ(1 − λ)) = −θ/2. The end is stiffer by (D/2)(θ + φ_end) = (F/2k_s)(1 − ½/(1 + κ(1 − λ))), that share
    d of k_s.
    """
    kappa = 1.0 / 12.0
    decay = (1.0 + 0.5 / kappa) - np.sqrt((1.0 + 0.5 / kappa) ** 2 - 1.0)
    stiffer = 0.5 * (1.0 - 0.5 / (1.0 + kappa * (1.0 - decay)))
    for count in (100.0, 500.0):
        whole, half = sides.foot(False, count), sides.foot(True, count)
        assert whole == pytest.approx((1.0 + stiffer) * 0.5 * np.pi / count, rel=0.01)
        assert half < 1.2 * whole**2


def test_free_edges_change_beta_of_narrow_bars():
    """By 1.9 % at a height of 10 m, half of that at twice the height, and nothing where it is periodic sideways."""
    assert sides.narrow(10.0) == pytest.approx(-0.0192, abs=1e-3)
    assert sides.narrow(20.0) == pytest.approx(0.5 * sides.narrow(10.0), abs=5e-4)
    assert abs(sides.narrow(10.0, free=False)) < 5e-4


def test_a_side_with_beta_off_by_four_per_cent_reflects_two():
    assert reflection({"type": "viscous", "beta_p": 1.04}, "p", 0.0, 2000.0)["p"] == pytest.approx(0.0196, abs=2e-4)
