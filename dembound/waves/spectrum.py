"""The highest frequency in a wave's amplitude spectrum."""

import math

import numpy as np

from dembound.spectra.fourier import PADDING, fourier_spectrum

FADED = 0.01
"""Share of its largest value below which an amplitude spectrum is treated as faded."""

HANN_FADE = 2.0 / math.sqrt(3.0) * math.cosh(math.acosh(1.5 * math.sqrt(3.0) / (math.pi * FADED)) / 3.0)
"""Frequency times length at which the spectrum of one Hann lobe, ½(1 − cos 2πt/T) on 0…T, has faded: 3.274.

The spectrum is T/2 · sin(πx)/[πx(1 − x²)], x = fT. Its envelope has faded where x³ − x = 1/(π · FADED), which
Cardano's formula solves.
"""


def amplitude_spectrum(velocities: np.ndarray, time_step: float) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (m,), Hz, and amplitudes (m,), m, of velocities (n,), m/s, sampled every `time_step` s."""
    frequencies, spectrum = fourier_spectrum(velocities, time_step, PADDING * len(velocities))
    return frequencies, np.abs(spectrum)


def faded_frequency(frequencies: np.ndarray, amplitudes: np.ndarray) -> float:
    """First frequency, Hz, from which all amplitudes are faded; the last one if they never are."""
    last_alive = int(np.flatnonzero(amplitudes >= FADED * amplitudes.max())[-1])
    return float(frequencies[min(last_alive + 1, len(frequencies) - 1)])
