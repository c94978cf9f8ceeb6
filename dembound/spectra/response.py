"""Response spectra: largest motion of damped oscillators whose base has a given acceleration."""

from typing import NamedTuple

import numpy as np

from dembound.spectra.band_limited import band_limited

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
