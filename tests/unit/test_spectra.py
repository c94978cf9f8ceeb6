"""Fourier spectra and their smoothing, response spectra, and transfer functions."""

import math

import numpy as np
import pytest

from dembound import spectra
from dembound.damping import fitted
from dembound.roots import root
from dembound.spectra import (
    BANDWIDTH,
    FADED,
    FINER,
    fourier_spectrum,
    relative_displacement,
    response_spectrum,
    shown_frequencies,
    slope,
    smoothed,
    transfer_function,
)

STEP = 0.01


@pytest.mark.parametrize("count", [100, 131])
def test_a_spectrum_has_the_energy_of_its_history(count):
    values = np.random.default_rng(1).standard_normal(count)
    frequency, spectrum = fourier_spectrum(values, STEP, 3 * count)  # 300, and the odd 393
    both_signs = np.full(len(frequency), 2.0)
    both_signs[0] = 1.0
    if 3 * count % 2 == 0:
        both_signs[-1] = 1.0
    # Parseval; rounding of the sums of some hundred squares
    energy = np.sum(both_signs * np.abs(spectrum) ** 2) * frequency[1]
    np.testing.assert_allclose(np.sum(values**2) * STEP, energy, rtol=1e-13)


def test_a_gaussian_has_its_known_spectrum():
    time = STEP * np.arange(-400, 401)
    frequency, spectrum = fourier_spectrum(np.exp(-((time / 0.2) ** 2)), STEP)
    # the transform is √π·0.2·exp(−(0.2πf)²), and of Gaussians sums are integrals to e^(−(0.2π·100)²) ≈ 0
    expected = np.sqrt(np.pi) * 0.2 * np.exp(-((0.2 * np.pi * frequency) ** 2))
    np.testing.assert_allclose(np.abs(spectrum), expected, rtol=0.0, atol=1e-15 * len(time))
    shift = np.exp(2j * np.pi * frequency * 4.0)  # its middle is 4 s after the first sample
    np.testing.assert_allclose((spectrum * shift).real, expected, rtol=0.0, atol=1e-12)


def test_smoothing_keeps_a_constant_and_weighs_like_the_window():
    frequency = np.linspace(0.0, 50.0, 5001)
    centres = shown_frequencies(1000, STEP)
    assert (centres[0], centres[-1]) == pytest.approx((0.1, 50.0))
    np.testing.assert_allclose(smoothed(frequency, np.full(5001, 3.0), centres), 3.0, rtol=1e-14)

    single = np.zeros(5001)
    single[1000] = 1.0  # 10 Hz
    at = np.array([10.0, 11.0, 12.5])  # 12.5 Hz is beyond the lobe, 10^(π/40) = 1.198
    z = BANDWIDTH * np.log10(np.outer(1.0 / at[:2], frequency[1:]))
    weights = np.where(np.abs(z) < np.pi, np.sinc(z / np.pi) ** 4, 0.0)
    expected = [*(weights[:, 999] / weights.sum(axis=1)), 0.0]
    np.testing.assert_allclose(smoothed(frequency, single, at), expected, rtol=1e-12, atol=1e-15)


OMEGA, DAMPING, STEP = 2.0 * np.pi / 0.5, 0.05, 0.01


def test_a_step_of_acceleration_has_the_exact_response():
    time = STEP * np.arange(500)
    # exact at any step, and after a thousandth of a period no digits are lost: errors are those of 1 − e^(λh), 1e-16/λh
    for fraction, tolerance in ((1.0, 1e-13), (1e-3, 1e-11)):
        found = relative_displacement(np.full(500, 3.0), fraction * STEP, OMEGA, DAMPING)
        at, damped = fraction * time, OMEGA * np.sqrt(1.0 - DAMPING**2)
        ring = np.cos(damped * at) + DAMPING / np.sqrt(1.0 - DAMPING**2) * np.sin(damped * at)
        expected = -3.0 / OMEGA**2 * (1.0 - np.exp(-DAMPING * OMEGA * at) * ring)
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=tolerance * 3.0 / OMEGA**2)


def test_a_harmonic_base_has_its_amplification():
    time = STEP * np.arange(6000)
    for ratio in (0.3, 1.0, 2.0):
        drive = ratio * OMEGA
        found = np.abs(relative_displacement(np.sin(drive * time), STEP, OMEGA, DAMPING)[4000:]).max()
        expected = 1.0 / OMEGA**2 / np.hypot(1.0 - ratio**2, 2.0 * DAMPING * ratio)
        # straight lines between samples are lower by (ωh)²/12; of crests samples miss up to (ωh)²/8
        assert found == pytest.approx(expected, rel=(drive * STEP) ** 2 * (1 / 12 + 1 / 8))


def test_the_spectrum_is_the_largest_response_also_after_the_record():
    pulse = np.sin(np.pi * np.arange(21) / 20.0) ** 2  # 0.2 s, and then free
    periods = np.array([20.0])
    found = response_spectrum(pulse, STEP, periods, damping=0.0)
    # a slow undamped oscillator has an impulse, u = ∫a dt/ω, ∫a dt = 0.1 m/s; less by (ω·0.1)²/6 < 2e-4, as it lasts,
    # by 1e-3 as the jump of its curvature at both ends is not band-limited
    assert found.displacement[0] == pytest.approx(0.1 * 20.0 / (2.0 * np.pi), rel=1.2e-3)
    assert found.period == pytest.approx(periods)
    assert found.pseudo_velocity == pytest.approx(2.0 * np.pi / 20.0 * found.displacement)
    assert found.pseudo_acceleration == pytest.approx((2.0 * np.pi / 20.0) ** 2 * found.displacement)


def test_short_periods_are_those_of_a_finer_record(monkeypatch):
    # noise of all frequencies, the worst a record can be; 20 samples in place of one: crests are missed by at most
    # 1 − cos(π/40) = 0.3 %, and straight lines take at most (π/40)²/3 = 0.2 %
    noise = np.random.default_rng(4).standard_normal(1000) * np.sin(np.pi * np.arange(1000) / 1000.0) ** 2
    periods = STEP * np.array([2.0, 2.7, 3.6, 5.0, 7.0, 8.0, 10.0])
    found = response_spectrum(noise, STEP, periods).pseudo_acceleration
    monkeypatch.setattr(spectra, "FINER", 100)
    np.testing.assert_allclose(found, response_spectrum(noise, STEP, periods).pseudo_acceleration, rtol=5e-3)


def test_slopes_of_eight_samples_in_a_period_are_right():
    phase = 2.0 * np.pi / 8.0 * np.arange(64)
    found = slope(np.sin(phase), STEP)[4:-4]
    expected = np.cos(phase)[4:-4] * 2.0 * np.pi / (8.0 * STEP)
    # the next term of the series is (2π/8)⁸/630 = 2.3e-4
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=2.3e-4 * np.abs(expected).max())
    np.testing.assert_allclose(slope(0.3 * np.arange(5.0), 1.0), 0.3)  # too few for it


def record() -> np.ndarray:
    """Noise of a Gaussian band below 10 Hz or so under half a sine squared, 8 s."""
    count = 800
    band = np.exp(-((np.fft.rfftfreq(count, STEP) / 8.0) ** 2))
    noise = np.fft.irfft(band * np.fft.rfft(np.random.default_rng(5).standard_normal(count)), count)
    return noise * np.sin(np.pi * np.arange(count) / count) ** 2


def test_spectra_are_those_of_another_program():
    # by pyrotd 0.6.1, `calc_spec_accels` with max_freq_ratio = 200 after 31 times its length of zeros, as its record is
    # periodic; samples miss crests by (2πh/T)²/8, at T = 0.05 s and h = 0.001 s 0.2 % at most, on average a third of it
    found = response_spectrum(record(), STEP, np.array([0.05, 0.1, 0.2, 0.5, 1.0, 2.0]))
    pyrotd = [0.75036269, 1.26220263, 2.4346898, 0.91279857, 0.71352009, 0.81979178]
    np.testing.assert_allclose(found.pseudo_acceleration, pyrotd, rtol=1e-3)
    assert FINER == 10


STEP, COUNT = 0.01, 1000


def pulse(at: float) -> np.ndarray:
    """A Ricker wavelet of 5 Hz whose crest is at a time (s)."""
    x = (np.pi * 5.0 * (STEP * np.arange(COUNT) - at)) ** 2
    return (1.0 - 2.0 * x) * np.exp(-x)


def test_a_delay_and_a_gain_are_found():
    found = transfer_function(-2.5 * pulse(1.37), pulse(1.0), STEP)
    clear = ~np.isnan(found.ratio)
    expected = -2.5 * np.exp(-2j * np.pi * found.frequency * 0.37)
    # both spectra have rounding errors of 1e-16·COUNT of their peak, and at least FADED of it
    np.testing.assert_allclose(found.ratio[clear], expected[clear], rtol=0.0, atol=2.5 * 1e-13 / FADED)
    np.testing.assert_allclose(found.amplitude[~np.isnan(found.amplitude)], 2.5, rtol=1e-10)


def test_no_ratio_where_the_input_has_no_energy():
    noise = 1e-6 * np.random.default_rng(2).standard_normal(COUNT)
    found = transfer_function(pulse(1.0) + noise, pulse(1.0), STEP)
    # the spectrum x² e^(1 − x²), x = f/5 Hz, is 1 % of its largest at x = 0.0609 and 2.754
    clear = found.centre[~np.isnan(found.amplitude)]
    assert 0.0609 * 5.0 / 1.2 < clear[0] < 0.0609 * 5.0 * 1.2
    assert 2.754 * 5.0 / 1.2 < clear[-1] < 2.754 * 5.0 * 1.2
    raw = found.frequency[~np.isnan(found.ratio)]
    assert clear[0] <= raw[0]
    assert raw[-1] <= clear[-1]


BAND, MIDDLE = (0.3, 10.0), 3.0**0.5


@pytest.mark.parametrize("quality", [5.0, 100.0])
@pytest.mark.parametrize(("count", "error"), [(2, 0.08), (3, 0.01), (4, 0.002)])
def test_q_is_nearly_constant_over_the_band(quality: float, count: int, error: float) -> None:
    found = fitted(quality, BAND, MIDDLE, count)

    assert abs(quality / found.quality(np.geomspace(*BAND, 500)) - 1.0).max() < error
    assert found.range[0] < quality < found.range[1]


@pytest.mark.parametrize("frequency", [0.3, MIDDLE, 10.0])
def test_the_speed_holds_at_its_frequency(frequency: float) -> None:
    """C = 1/Re √(ρ/M), so M/M₀ there has Re (M/M₀)^(−1/2) = 1; beyond all mechanisms M is M_U."""
    found = fitted(20.0, BAND, frequency, 3)

    assert np.real(found.relative_modulus(frequency) ** -0.5) == pytest.approx(1.0, rel=1e-12)
    assert abs(found.relative_modulus(1e9)) == pytest.approx(found.unrelaxed, rel=1e-7)


def test_memories_respond_as_the_modulus() -> None:
    """To e^{iωnΔt} they answer Σ g(1 + z)/(1 − e z), z = e^{−iωΔt}, which is Σ w/(1 + iωτ) to second order in Δt/τ."""
    found = fitted(20.0, BAND, MIDDLE, 3)
    frequency = np.geomspace(0.1, 20.0, 30)
    exact = 1.0 - found.relative_modulus(frequency) / found.unrelaxed
    errors = []
    for step in (2e-4, 1e-4):
        (e, g), z = found.per_step(step), np.exp(-2j * np.pi * frequency * step)[:, None]
        errors.append(abs((g * (1.0 + z) / (1.0 - e * z)).sum(axis=1) - exact).max())

    assert errors[1] == pytest.approx(errors[0] / 4.0, rel=0.05)
    assert errors[1] < 1e-6


@pytest.mark.parametrize("sought", [0.0, 0.3, 1.0, 2.0])
def test_the_root_of_a_line_is_its_own(sought) -> None:
    assert root(lambda x: sought - x, -1.0, 3.0) == pytest.approx(sought, rel=1e-15, abs=1e-300)


def test_the_sign_changes_at_the_root_found() -> None:
    found = root(math.cos, 0.0, 3.0)
    assert math.cos(math.nextafter(found, 0.0)) > 0.0 >= math.cos(found)
