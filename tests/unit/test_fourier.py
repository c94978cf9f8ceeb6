"""Fourier spectra and their smoothing."""

import numpy as np
import pytest

from dembound.spectra import BANDWIDTH, fourier_spectrum, shown_frequencies, smoothed

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
    np.testing.assert_allclose(
        np.sum(values**2) * STEP, np.sum(both_signs * np.abs(spectrum) ** 2) * frequency[1], rtol=1e-13
    )


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
