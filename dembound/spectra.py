"""Spectra of histories, as functions of arrays: Fourier amplitudes, transfer functions, response spectra."""

import math
from typing import NamedTuple

import numpy as np


def band_limited(values: np.ndarray, finer: int) -> np.ndarray:
    """The band-limited function through even samples (n,) that are zero outside, `finer` times as often.

    It is the sum of a sinc at every sample. Returns ((n − 1)·finer + 1,) values from the first to the last sample,
    themselves among them. As many zeros as samples keep both ends apart, since the Fourier transform is periodic.
    """
    from scipy.fft import irfft, next_fast_len, rfft

    length = int(next_fast_len(2 * len(values), real=True))
    spectrum = rfft(values, length)
    if length % 2 == 0:  # it stands for both signs of the highest frequency, in the finer spectrum for one
        spectrum[-1] *= 0.5
    fine = np.asarray(finer * irfft(spectrum, finer * length))[: (len(values) - 1) * finer + 1].copy()
    fine[::finer] = values
    return fine


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


DAMPING = 0.05
"""The usual share of the critical damping."""

FINER = 10
"""Number of samples that replace each one of a record, see `response_spectrum`."""

PERIODS = 100
"""Number of periods of a response spectrum."""

SAMPLES_PER_PERIOD = 8
"""Samples of a monitor in the shortest period shown. There the eighth-order differences of its velocity lose 0.02 %,
where central ones lose 10 %, and finer samples miss at most 1 − cos(π/80) = 0.08 % of a crest."""

FEWEST_PER_PERIOD = 2
"""The same of a measured acceleration, which contains nothing of shorter periods."""

LONGEST, WIDEST = 10.0, 10.0
"""Longest period shown, s, or over the shortest if that is more: those of structures end before."""

DIFFERENCES = (4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0)
"""Weights of x(t + kh) − x(t − kh), k = 1, 2, 3, 4, over h in the slope of eighth order."""


class Response(NamedTuple):
    """A response spectrum.

    period : (p,) s; displacement : (p,) largest displacement relative to the base, m; pseudo_velocity : ω times it,
    m/s; pseudo_acceleration : ω² times it, m/s².
    """

    period: np.ndarray
    displacement: np.ndarray
    pseudo_velocity: np.ndarray
    pseudo_acceleration: np.ndarray


def usual_periods(samples: int, time_step: float, shortest: int = SAMPLES_PER_PERIOD) -> np.ndarray:
    """Periods (p,) in s at equal ratios, from so many samples of a record in the shortest to its length, at most 10 s.

    Where the shortest is above 1 s they reach to ten times it.
    """
    begin = shortest * time_step
    return np.geomspace(begin, min(samples * time_step, max(LONGEST, WIDEST * begin)), PERIODS)


def slope(values: np.ndarray, time_step: float) -> np.ndarray:
    """dx/dt (n,) of values (n,) time_step (s) apart, by differences of eighth order, near both ends by central ones."""
    found, reach = np.gradient(values, time_step), len(DIFFERENCES)
    if (inner := len(values) - 2 * reach) > 0:
        ahead_and_behind = (
            weight * (values[reach + k :][:inner] - values[reach - k :][:inner])
            for k, weight in enumerate(DIFFERENCES, start=1)
        )
        found[reach:-reach] = sum(ahead_and_behind) / time_step
    return found


def response_spectrum(
    acceleration: np.ndarray, time_step: float, periods: np.ndarray, damping: float = DAMPING
) -> Response:
    """The response spectrum of a base's acceleration (n,) in m/s², sampled every time_step (s), zero outside.

    Between samples the record is the band-limited function through them, of which ten times as many samples, and twenty
    times for periods shorter than eight samples, are joined by straight lines; the motion under these lines is exact
    (`relative_displacement`). From two samples in a period on, spectra are within 0.5 %. The largest displacement is
    sought in the record and half a period beyond, after which the oscillator, then free, no longer reaches it.

    Parameters
    ----------
    periods : (p,) of the undamped oscillators, s. damping : ζ, share of the critical damping, below 1.
    """
    periods = np.asarray(periods, dtype=float)
    frequencies, largest = 2.0 * np.pi / periods, np.zeros(len(periods))
    is_long = periods >= SAMPLES_PER_PERIOD * time_step * (1.0 - 1e-9)
    for finer, those in ((FINER, is_long), (2 * FINER, ~is_long)):
        if those.any():
            fine = band_limited(acceleration, finer)
            largest[those] = [_largest(fine, time_step / finer, each, damping) for each in frequencies[those]]
    return Response(periods, largest, frequencies * largest, frequencies**2 * largest)


def _largest(acceleration: np.ndarray, time_step: float, frequency: float, damping: float) -> float:
    """Largest |displacement| (m) of an oscillator of circular frequency ω (1/s) up to half a period after the end."""
    after = int(np.ceil(np.pi / (frequency * np.sqrt(1.0 - damping**2)) / time_step))
    moved = relative_displacement(np.append(acceleration, np.zeros(after)), time_step, frequency, damping)
    return float(np.abs(moved).max())


def relative_displacement(
    acceleration: np.ndarray, time_step: float, frequency: float, damping: float = DAMPING
) -> np.ndarray:
    """Displacement u (n,) in m of an oscillator relative to its base, from rest: ü + 2ζωu̇ + ω²u = −a.

    Exact for an acceleration a (n,), m/s², of straight lines between samples time_step (s) apart (Nigam & Jennings
    1969): with λ = −ζω + iω√(1 − ζ²), u is −Im(z)/Im(λ), and ż = λz + a gives over a step h

        z' = e^(λh) z + h(φ₁ − φ₂)a + hφ₂a',   φ₁ = (e^(λh) − 1)/λh,   φ₂ = (φ₁ − 1)/λh.

    frequency : ω, 1/s. damping : ζ, below 1.
    """
    from scipy.signal import lfilter

    pole = complex(-damping, np.sqrt(1.0 - damping**2)) * frequency
    advance = pole * time_step
    whole = np.expm1(advance) / advance
    later = (np.expm1(advance) - advance) / advance**2
    steps = time_step * ((whole - later) * acceleration[:-1] + later * acceleration[1:])
    state = lfilter([1.0], [1.0, -np.exp(advance)], np.concatenate([[0.0], steps]))
    moved: np.ndarray = -state.imag / pole.imag
    return moved


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
