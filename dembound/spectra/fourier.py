"""Fourier spectra of evenly sampled histories, and their smoothing."""

import math

import numpy as np

BANDWIDTH = 40.0
"""Exponent b of the smoothing window, with a main lobe from f/1.2 to 1.2 f, as usual for seismograms."""

PADDING = 8
"""Number of samples with zeros over that of a history: bins are eight times finer than 1/length."""

SHOWN = 400
"""Number of frequencies of smoothed spectra."""


def fourier_spectrum(values: np.ndarray, time_step: float, length: int | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies f (m,) in Hz, and the spectrum X = ∫ x e^(−2πift) dt (m,), complex, unit of x times s.

    Parameters
    ----------
    values : x (n,), zero before and after.
    time_step : from one to the next, s.
    length : samples with the zeros appended to them; by default at least 8n, a number for which the transform is fast;
        the smoothing window then has three frequencies or more.

    Σ|x|²·time_step is 1/(length·time_step) times the sum of |X|² over frequencies of both signs (Parseval).
    """
    if length is None:
        from scipy.fft import next_fast_len

        length = next_fast_len(PADDING * len(values), real=True)
    return np.fft.rfftfreq(length, time_step), time_step * np.fft.rfft(values, length)


def shown_frequencies(samples: int, time_step: float) -> np.ndarray:
    """Frequencies (SHOWN,) in Hz at equal ratios, from one period in the record to two samples in a period."""
    return np.geomspace(1.0 / (samples * time_step), 0.5 / time_step, SHOWN)


def smoothed(frequencies: np.ndarray, power: np.ndarray, centres: np.ndarray) -> np.ndarray:
    """Means (c,) of a power spectrum around frequencies, weighted by the window of Konno & Ohmachi (1998, eq. 4).

    The window is (sin z / z)⁴ with z = b·log₁₀(f/f_c); its main lobe, |z| < π, is used.

    Parameters
    ----------
    frequencies, power : Hz and |X|², (m,), ascending and evenly spaced from 0.
    centres : f_c (c,), Hz, above 0. Where no frequency is in the lobe, the nearest two are interpolated.
    """
    half_lobe = 10.0 ** (math.pi / BANDWIDTH)
    means = np.interp(centres, frequencies, power)
    first = np.maximum(np.searchsorted(frequencies, centres / half_lobe, side="right"), 1)
    last = np.searchsorted(frequencies, centres * half_lobe, side="left")
    for number, (centre, begin, end) in enumerate(zip(centres, first, last, strict=True)):
        if end - begin > 1:
            weights = np.sinc(BANDWIDTH / math.pi * np.log10(frequencies[begin:end] / centre)) ** 4
            means[number] = np.average(power[begin:end], weights=weights)
    return means
