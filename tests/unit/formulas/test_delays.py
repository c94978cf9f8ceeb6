"""Errors of delays: sign, size, and where nothing is known."""

import numpy as np
import pytest

from dembound.formulas.history import error_of_delay, error_of_steps

TIME = np.linspace(0.0, 4.0, 801)
LATE = 0.05


def pulse(t):
    return np.exp(-((t - 1.5) ** 2) / 0.08)


def test_a_constant_delay_is_taken_out_of_the_record():
    # The record is late by LATE, so the exact motion is pulse(t), and the error of the record the difference. The FFT
    # of a pulse that is 7 standard deviations off both ends of the record is exact to its values there, below 1e-10.
    record = np.column_stack([pulse(TIME - LATE), 2.0 * pulse(TIME - LATE)])
    velocity, displacement = error_of_delay(TIME, record, lambda omega: np.full_like(omega, LATE))
    expected = pulse(TIME - LATE) - pulse(TIME)
    np.testing.assert_allclose(velocity[:, 0], expected, atol=1e-5)
    np.testing.assert_allclose(velocity[:, 1], 2.0 * expected, atol=2e-5)
    # the displacement lags by at most LATE times the largest velocity, and catches up with the exact one
    assert displacement[:, 0].min() == pytest.approx(-LATE, rel=1e-2)
    assert abs(displacement[-1, 0]) < 1e-4


def test_motion_that_no_wave_can_carry_is_an_error_as_large_as_itself():
    record = pulse(TIME)[:, None]
    velocity, _ = error_of_delay(TIME, record, lambda omega: np.full_like(omega, np.nan))
    np.testing.assert_allclose(velocity, record, atol=1e-9)
    for error in error_of_delay(TIME, record, np.zeros_like):  # and without a delay there is none
        np.testing.assert_allclose(error, 0.0, atol=1e-12)


@pytest.mark.parametrize(("last", "off"), [(2.4, 0.1), (2.0, 0.3)], ids=["on a slope", "on a bend"])
def test_a_record_may_end_within_a_wave(last, off):
    """A delay τ = κω² adds κ times the third derivative, and κ²/2 times the sixth, below 1 % of it here.

    The motion rises from rest to a constant slope, where its continuation is exact. On the bend to it the curvature is
    2.6 % of the largest one; what is added then by its jump is as large as the largest error, but only in the last
    κ^(1/3) = 0.01 s of some 0.3 s: the root of 1/30 or so, times 1/2 as it decays. A corner there would add 1 or more.
    """
    kappa, width = 1e-6, 0.1
    time = np.linspace(0.0, last, round(200 * last) + 1)
    x = (time - 1.5) / width
    sigmoid = 1.0 / (1.0 + np.exp(-x))
    expected = kappa * sigmoid * (1.0 - sigmoid) * (1.0 - 2.0 * sigmoid) / width**2

    velocity, _ = error_of_delay(time, width * np.logaddexp(0.0, x)[:, None], lambda omega: kappa * omega**2)

    assert np.linalg.norm(velocity[:, 0] - expected) < off * np.linalg.norm(expected)


def test_steps_make_velocities_smaller_and_displacements_larger():
    # a mass that is driven by the velocity v at half steps: u grows by Δt v(t + Δt/2), and the mean of two half steps
    # is recorded, so that what is found is exact but for (ωΔt)⁴, 4e-4 of it here
    step, omega = 0.2, 1.0
    time = np.linspace(0.0, 40.0, 201)
    halves = np.cos(omega * (time + 0.5 * step))
    recorded = 0.5 * (halves[1:] + halves[:-1])
    displacement = np.cumsum(step * halves)[:-1]
    exact = np.cos(omega * time)[1:], np.sin(omega * time)[1:] / omega
    velocity_error, displacement_error = error_of_steps(time[1:], recorded[:, None], step)
    inside = slice(2, -2)  # differences at the ends are one-sided
    drift = displacement - exact[1] - displacement_error[:, 0]  # a constant, as u begins with half a step
    np.testing.assert_allclose(velocity_error[inside, 0], (recorded - exact[0])[inside], atol=0.04 * step**2 / 8.0)
    assert np.ptp(drift[inside]) < 0.04 * step**2 / 24.0
