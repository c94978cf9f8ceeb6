"""The first longitudinal mode of a round bar, beside what is known of it in closed form, and published values."""

import numpy as np
import pytest

from dembound.exact.pochhammer import SHORT, phase_speed, short_wave_speed, wavenumber


@pytest.mark.parametrize("poisson", [0.1, 0.45])
def test_long_waves_have_rayleighs_correction(poisson):
    # its next term is of the order of (a/Λ)⁴, with a factor of a few π⁴ at most
    for ratio in (0.5e-3, 2e-3, 0.01, 0.03):
        expected = 1.0 - (poisson * np.pi * ratio) ** 2
        assert phase_speed(ratio, poisson) == pytest.approx(expected, rel=0.0, abs=3.0 * (np.pi * ratio) ** 4 + 1e-13)


@pytest.mark.parametrize("poisson", [0.1, 0.45])
def test_at_the_speed_of_two_s_waves_it_is_a_zero_of_a_bessel_function(poisson):
    # with c² = 2 c_2² is q = k, and what is left of the equation is J_1(ka) = ka J_0(ka): J_1'(ka) = 0, at 1.841184
    assert phase_speed(1.8411837813406593 / (2.0 * np.pi), poisson) == pytest.approx((1.0 + poisson) ** -0.5, rel=1e-12)


@pytest.mark.parametrize("poisson", [0.1, 0.3, 0.45])
def test_short_waves_have_the_speed_of_rayleigh_waves(poisson):
    limit = short_wave_speed(poisson)
    # the curvature of the surface changes it by a share of the order of 1/(ka)
    assert phase_speed(SHORT, poisson) == pytest.approx(limit, rel=0.1 / SHORT)
    assert abs(phase_speed(20.0, poisson) / limit - 1.0) < abs(phase_speed(5.0, poisson) / limit - 1.0)


def test_wave_numbers_are_those_of_the_speeds():
    radius, poisson, speed = 0.01, 0.3, 5000.0
    for ratio in (1e-5, 0.013, 0.31, 1.77):
        k = 2.0 * np.pi * ratio / radius
        frequency = k * speed * phase_speed(ratio, poisson)
        assert wavenumber(np.array([frequency]), radius, poisson, speed)[0] == pytest.approx(k, rel=1e-6)
    assert wavenumber(np.array([0.0]), radius, poisson, speed)[0] == 0.0
    last = SHORT * phase_speed(SHORT, poisson)
    beyond = wavenumber(2.0 * np.pi * speed / radius * np.array([last, 2.0 * last]), radius, poisson, speed)
    assert beyond[1] == pytest.approx(2.0 * beyond[0], rel=1e-12)


@pytest.mark.parametrize(("ratio", "poisson"), [(-0.1, 0.3), (np.nan, 0.3), (0.1, 0.0), (0.1, 0.5)])
def test_what_is_no_bar_is_refused(ratio, poisson):
    with pytest.raises(ValueError, match="must not be negative"):
        phase_speed(ratio, poisson)
