"""Measures of a ground motion: peaks, Arias intensity, duration, what is left at the end, and the usable band."""

from typing import NamedTuple

import numpy as np

from dembound.records.channel import Channel
from dembound.records.processing import Motion, Processing, before_motion, windowed
from dembound.spectra import fourier_spectrum, shown_frequencies, smoothed
from dembound.waves.unit_names import STANDARD_GRAVITY

DURATION = (0.05, 0.95)
"""Shares of the Arias intensity at the begin and the end of the significant duration."""

SHARE_OF_RATE = 0.4
"""Highest usable frequency over the sampling rate: recorders have their filters between it and half of the rate."""

SIGNAL_TO_NOISE = 3.0
"""Least amplitude of the Fourier spectrum over that of the noise."""


class Measures(NamedTuple):
    """Measures of a motion.

    pga : largest |acceleration|, m/s². pgv, pgd : the same of velocity, m/s, and displacement, m. arias : Arias
    intensity π/2g ∫a² dt, m/s. duration : time from 5 to 95 % of it, s. final_velocity, final_displacement : at
    the last sample, m/s and m; the displacement is zero at the first one.
    """

    pga: float
    pgv: float
    pgd: float
    arias: float
    duration: float
    final_velocity: float
    final_displacement: float


def measures_of(motion: Motion) -> Measures:
    """The measures of a motion; those of samples, which may miss a crest between two of them."""
    intensity = np.pi / (2.0 * STANDARD_GRAVITY) * motion.time_step * np.cumsum(motion.acceleration**2)
    begin, end = np.interp(np.array(DURATION) * intensity[-1], intensity, motion.time)
    pga, pgv, pgd = (float(np.abs(each).max()) for each in (motion.acceleration, motion.velocity, motion.displacement))
    left = float(motion.velocity[-1]), float(motion.displacement[-1])
    return Measures(pga, pgv, pgd, float(intensity[-1]), float(end - begin), *left)


def usable_band(channel: Channel, settings: Processing) -> tuple[float, float]:
    """Lowest and highest usable frequency, Hz; (nan, nan) if noise is everywhere too strong.

    It is that of the filters that are applied, below 0.4 of the sampling rate and above one period in the record. If
    samples before the motion show the noise, it is also the range around the strongest frequency in which the smoothed
    Fourier amplitude is three times that of noise of equal length; noise is not judged at frequencies of which
    these samples have less than a period.
    """
    channel = windowed(channel, settings.begin, settings.end)
    values, step = channel.values, channel.time_step
    filters = settings.filters
    low = max(filters.high_pass or 0.0, 1.0 / (step * len(values)))
    high = min(filters.low_pass or np.inf, SHARE_OF_RATE / step)
    before = len(before_motion(values))
    if not before:
        return low, high
    values = values - values[:before].mean()
    centres = shown_frequencies(len(values), step)
    power, noise = (
        smoothed(frequency, np.abs(spectrum) ** 2, centres)
        for frequency, spectrum in (fourier_spectrum(part, step) for part in (values, values[:before]))
    )
    loud = power > SIGNAL_TO_NOISE**2 * noise * len(values) / before
    loud |= centres < 1.0 / (step * before)
    strongest = int(np.argmax(power * centres**2 if channel.quantity != "acceleration" else power))
    if not loud[strongest]:
        return np.nan, np.nan
    first = strongest - int(np.argmin(np.append(loud[strongest::-1], False))) + 1
    last = strongest + int(np.argmin(np.append(loud[strongest:], False))) - 1
    return max(low, float(centres[first])), min(high, float(centres[last]))
