"""Transfer functions: the spectrum of one history over that of another."""

from typing import NamedTuple

import numpy as np

from dembound.spectra.fourier import fourier_spectrum, shown_frequencies, smoothed

FADED = 0.01
"""Share of its largest amplitude below which the input has no energy to compare with."""


class Transfer(NamedTuple):
    """A transfer function from an input to an output.

    frequency : (m,) Hz; ratio : (m,) complex, output over input. centre : (c,) Hz; amplitude : (c,), √ of the smoothed
    power of the output over that of the input. Both ratios are nan where the smoothed amplitude of the input is below
    `FADED` of its largest.
    """

    frequency: np.ndarray
    ratio: np.ndarray
    centre: np.ndarray
    amplitude: np.ndarray


def transfer_function(output: np.ndarray, given: np.ndarray, time_step: float) -> Transfer:
    """The transfer function from a history to another one, both (n,) at the same times, time_step (s) apart.

    Without any input all ratios are nan. An output g·x(t − τ) has the ratio g·e^(−2πifτ) if all of it has arrived, and
    the amplitude |g|.
    """
    frequency, spectrum = fourier_spectrum(given, time_step)
    _, response = fourier_spectrum(output, time_step)
    centre = shown_frequencies(len(given), time_step)
    power = smoothed(frequency, np.abs(spectrum) ** 2, centre)
    has_energy = np.sqrt(power) >= FADED * np.sqrt(power.max())
    has_energy &= power > 0.0
    amplitude = np.full(len(centre), np.nan)
    np.divide(smoothed(frequency, np.abs(response) ** 2, centre), power, out=amplitude, where=has_energy)
    covered = np.interp(frequency, centre, has_energy, left=0.0, right=0.0) == 1.0
    ratio = np.full(len(frequency), np.nan, dtype=complex)
    np.divide(response, spectrum, out=ratio, where=covered & (spectrum != 0.0))
    return Transfer(frequency, ratio, centre, np.sqrt(amplitude))
