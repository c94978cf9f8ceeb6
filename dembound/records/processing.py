"""From a measured channel to a motion that a case takes, to its measures, and to the file of a wave.

Measures are peaks, Arias intensity, duration, what is left at the end, and the usable band.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from dembound.errors import CaseError
from dembound.files import replacing
from dembound.gauge.baseline import FEWEST_QUIET, Filters, quiet_samples
from dembound.records.channel import Channel
from dembound.results.histories import UNITS
from dembound.spectra import fourier_spectrum, shown_frequencies, smoothed
from dembound.waves.unit_names import STANDARD_GRAVITY

Baseline = Literal["mean", "linear", "zero-velocity", "none"]
"""What is removed: a constant, a straight line, a constant and the velocity left at the end, or nothing."""

TAPER, HIGH_PASS = 2.0, 0.1
"""Usual length of tapers, s, and corner of the high pass, Hz."""

LONGEST_TAPER, FEWEST_PERIODS = 0.05, 4.0
"""Of short records: the usual taper over their length, and periods of the usual corner in them."""

PAD = 1.5
"""Zeros on either side of a record that is filtered, in periods of the lowest corner for each order of the filter."""

CERTAIN = 0.9
"""Share of the quiet samples before the first motion that is taken as noise."""

AT_REST = 0.01
"""Velocity at an end over the peak up to which a motion begins or ends at rest."""


@dataclass(frozen=True)
class Processing:
    """What is done to a channel, in this order; without arguments nothing.

    begin, end : times between which samples are kept, s. baseline : see `Baseline`. taper : length of the cosine tapers
    at both ends, s, of the samples and then of the velocity. filters : Butterworth, without shift of phase. peak : PGA
    (m/s²) to which the motion is scaled at last. factor : by which it is multiplied instead.
    """

    begin: float | None = None
    end: float | None = None
    baseline: Baseline = "none"
    taper: float = 0.0
    filters: Filters = field(default_factory=Filters)
    peak: float | None = None
    factor: float = 1.0


@dataclass(frozen=True)
class Motion:
    """A processed channel (n,): time, s; acceleration, m/s²; velocity, m/s; displacement, m; and what was done."""

    component: str
    time: np.ndarray
    acceleration: np.ndarray
    velocity: np.ndarray
    displacement: np.ndarray
    steps: tuple[str, ...]

    @property
    def time_step(self) -> float:
        """From one sample to the next, s."""
        return float(self.time[-1] - self.time[0]) / (len(self.time) - 1)

    def warnings(self) -> Iterator[str]:
        """Ends at which the motion is not at rest, and so jumps: outside its samples a wave is zero."""
        peak = float(np.abs(self.velocity).max())
        for verb, value in (("begins", self.velocity[0]), ("ends", self.velocity[-1])):
            if abs(value) > AT_REST * peak:
                yield f"{verb} with {value:.3g} m/s, {abs(value) / peak:.2g} of its peak, and is zero outside: taper it"


def usual(length: float) -> Processing:
    """What a record of this length (s) usually needs to become a wave: mean, tapers of 2 s, high pass at 0.1 Hz.

    Short records have shorter tapers and a higher corner.
    """
    taper = min(TAPER, LONGEST_TAPER * length)
    corner = max(HIGH_PASS, float(f"{FEWEST_PERIODS / length:.2g}"))
    return Processing(baseline="mean", taper=float(f"{taper:.2g}"), filters=Filters(high_pass=corner))


def processed(channel: Channel, settings: Processing) -> Motion:
    """The motion of a channel. Raises CaseError for windows, tapers and corners that the record does not have."""
    whole, channel = channel, windowed(channel, settings.begin, settings.end)
    step, count = channel.time_step, len(channel.values)
    time = channel.begin + step * np.arange(count)
    weights, slopes = tapers(count, step, settings.taper)
    of = f"{channel.quantity} in {channel.unit}" if channel.unit else channel.quantity
    steps = [f"samples: {count} of {of}, from {time[0]:g} to {time[-1]:g} s"]
    unit = UNITS[channel.quantity][0]
    offset, words = baseline(channel.values, settings.baseline, step, unit, before_motion(whole.values))
    values = weights * (channel.values - offset)
    steps += words
    if settings.taper > 0.0:
        steps.append(f"taper: cosine of {settings.taper:g} s at both ends of the {channel.quantity}")
    if settings.baseline == "zero-velocity":
        values, words = without_final_velocity(values, weights, whole, time)
        steps += words
    values, pad, words = filtered(values, step, settings.filters)
    steps += words
    acceleration, velocity = (each[pad : pad + count] for each in _motions(values, step, channel.quantity))
    derived = "integration: velocity", f"differentiation: acceleration of the {channel.quantity}"
    steps.append(f"{derived[channel.quantity != 'acceleration']} in the frequency domain")
    if settings.taper > 0.0:
        acceleration, velocity = weights * acceleration + slopes * velocity, weights * velocity
        steps.append(f"taper: cosine of {settings.taper:g} s at both ends of the velocity")
    factor, words = _factor(acceleration, settings)
    acceleration, velocity = factor * acceleration, factor * velocity
    displacement = integrated(velocity, step)
    return Motion(channel.component, time, acceleration, velocity, displacement, (*steps, *words))


def windowed(channel: Channel, begin: float | None, end: float | None) -> Channel:
    """The samples of a channel from one time to another, s. Raises CaseError if these are fewer than two."""
    time = channel.begin + channel.time_step * np.arange(len(channel.values))
    half = 0.5 * channel.time_step  # times are not exact
    first, last = time[0] if begin is None else begin, time[-1] if end is None else end
    inside = (time > first - half) & (time < last + half)
    if np.count_nonzero(inside) < 2:
        raise CaseError([f"--from, --to: keep no samples; the record is from {time[0]:g} to {time[-1]:g} s"])
    return replace(channel, values=channel.values[inside], begin=float(time[inside][0]))


def first_motion(values: np.ndarray) -> int:
    """Number of quiet samples (n,), as those of gauges, before the first motion; 0 if they are too few to tell."""
    quiet = quiet_samples(values - np.median(values))
    before = len(quiet) if quiet.all() else int(np.argmin(quiet))
    return before if FEWEST_QUIET <= before < len(values) else 0


def before_motion(values: np.ndarray) -> np.ndarray:
    """The samples before the first motion but for the last tenth, in which it may begin below the noise; or none."""
    return values[: int(CERTAIN * first_motion(values))]


def baseline(
    values: np.ndarray, kind: Baseline, step: float, unit: str, noise: np.ndarray
) -> tuple[np.ndarray | float, list[str]]:
    """What is removed from samples (n,), and words: the mean of noise (k,), else of all samples; or a fitted line.

    noise : before the motion, of the whole record, as a window may begin with motion that is small beside its peak.
    """
    if kind == "none":
        return 0.0, []
    if kind == "linear":
        along = np.arange(len(values))
        slope, level = np.polyfit(along, values, 1)
        line = level + slope * along
        return line, [f"baseline: line by least squares, from {line[0]:.3g} to {line[-1]:.3g} {unit}"]
    mean = float(np.mean(noise if len(noise) else values))
    of = f"the first {len(noise) * step:.4g} s of the record, before the motion" if len(noise) else "all samples"
    return mean, [f"baseline: mean of {of}, {mean:.3g} {unit}"]


def without_final_velocity(
    values: np.ndarray, weights: np.ndarray, channel: Channel, time: np.ndarray
) -> tuple[np.ndarray, list[str]]:
    """Accelerations (n,) at times (n,) s, less a tapered constant that makes their last velocity zero.

    It begins with the first motion of their whole channel.
    """
    if channel.quantity != "acceleration":
        own = f"{channel.component} is a {channel.quantity}"
        raise CaseError([f"--baseline: zero-velocity is for accelerations, {own}"])
    step = channel.time_step
    before = max(0, first_motion(channel.values) - round((time[0] - channel.begin) / step))
    shape = np.where(np.arange(len(values)) < before, 0.0, weights)
    last = float(integrated(values, step)[-1])
    constant = last / float(integrated(shape, step)[-1])
    words = f"baseline: {constant:.3g} m/s² from {time[0] + before * step:.4g} s on"
    return values - constant * shape, [f"{words}, as the velocity ends with {last:.3g} m/s"]


def tapers(count: int, step: float, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Weights (n,) that rise from 0 to 1 as half a cosine over a length (s) and fall so, and their slopes, 1/s.

    Raises CaseError for tapers that overlap.
    """
    if not 0.0 <= length <= 0.5 * step * (count - 1):
        half = f"half of the record, {0.5 * step * (count - 1):g} s"
        raise CaseError([f"--taper: is {length:g} s, must be from 0 to {half}"])
    if length == 0.0:
        return np.ones(count), np.zeros(count)
    time = step * np.arange(count)
    inner = np.minimum(time, time[::-1]) / length
    weights = np.where(inner < 1.0, 0.5 - 0.5 * np.cos(np.pi * inner), 1.0)
    slopes = np.where(inner < 1.0, 0.5 * np.pi / length * np.sin(np.pi * inner), 0.0)
    return weights, np.where(time < time[::-1], slopes, -slopes)


def filtered(values: np.ndarray, step: float, filters: Filters) -> tuple[np.ndarray, int, list[str]]:
    """Samples filtered between zeros (p + n + p,), in which the filters ring out, p, and words.

    Raises CaseError for corners that the record does not have.
    """
    corners = [corner for corner in (filters.high_pass, filters.low_pass) if corner is not None]
    if not corners:
        return values, 0, []
    filters.require(1.0 / step, len(values))
    pad = int(np.ceil(PAD * filters.order / (min(corners) * step)))
    padded = np.pad(values, pad)
    done, words = filters.apply(step * np.arange(len(padded)), padded)
    return done, pad, [*words, f"filter: between zeros of {pad * step:.3g} s, which are cut off again"]


def _motions(values: np.ndarray, step: float, quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Acceleration and velocity (n,) of samples of a quantity."""
    if quantity == "acceleration":
        return values, integrated(values, step)
    velocity = values if quantity == "velocity" else differentiated(values, step)
    return differentiated(velocity, step), velocity


def integrated(values: np.ndarray, step: float) -> np.ndarray:
    """∫ x dt (n,) from the first sample on, of the Fourier series through x (n,), `step` s apart, and of its mean."""
    mean = float(values.mean())
    circular = 2j * np.pi * np.fft.rfftfreq(len(values), step)
    spectrum = np.fft.rfft(values - mean)
    spectrum[1:] /= circular[1:]
    found = np.fft.irfft(spectrum, len(values)) + mean * step * np.arange(len(values))
    return np.asarray(found - found[0])


def differentiated(values: np.ndarray, step: float) -> np.ndarray:
    """dx/dt (n,) of the Fourier series through x (n,), `step` s apart, without the line between its ends."""
    line = (values[-1] - values[0]) / (step * max(len(values) - 1, 1))
    straight = values[0] + line * step * np.arange(len(values))
    spectrum = 2j * np.pi * np.fft.rfftfreq(len(values), step) * np.fft.rfft(values - straight)
    if len(values) % 2 == 0:
        spectrum[-1] = 0.0  # the slope of the highest wave is zero at all samples
    return np.asarray(np.fft.irfft(spectrum, len(values)) + line)


def _factor(acceleration: np.ndarray, settings: Processing) -> tuple[float, list[str]]:
    """The factor of a motion, and words."""
    if settings.peak is None:
        return settings.factor, [f"scale: by {settings.factor:g}"] if settings.factor != 1.0 else []
    peak = float(np.abs(acceleration).max())
    if peak == 0.0:
        raise CaseError(["--pga: the record has no motion to scale"])
    return settings.peak / peak, [f"scale: by {settings.peak / peak:.6g}, to a PGA of {settings.peak:g} m/s²"]


HEAD = "time (s),velocity (m/s)"
"""Line above the numbers."""


def write_wave(path: Path, motion: Motion, origin: Sequence[str]) -> None:
    """Write the velocity of a motion as CSV, completely or not at all, times counted from its first sample.

    origin : lines on where it is from; they and what was done are comments at the top. Raises FileNotFoundError if the
    folder of the path does not exist.
    """
    lines = [*origin, *motion.steps, f"times: from the first sample, {motion.time[0]:g} s of the record"]
    head = "".join(f"# {line}\n" for line in lines) + HEAD
    times = motion.time_step * np.arange(len(motion.time))
    columns = np.column_stack([times, motion.velocity + 0.0])
    with replacing(path) as file:
        np.savetxt(file, columns, "%.9g", ",", header=head, comments="", encoding="utf-8")


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
    samples before the motion of the whole record show the noise, it is also the range around the strongest frequency in
    which the smoothed Fourier amplitude is three times that of noise of equal length; noise is not judged at
    frequencies of which these samples have less than a period.
    """
    noise, channel = before_motion(channel.values), windowed(channel, settings.begin, settings.end)
    values, step = channel.values, channel.time_step
    filters = settings.filters
    low = max(filters.high_pass or 0.0, 1.0 / (step * len(values)))
    high = min(filters.low_pass or np.inf, SHARE_OF_RATE / step)
    before = len(noise)
    if not before:
        return low, high
    values, noise = values - noise.mean(), noise - noise.mean()
    centres = shown_frequencies(len(values), step)
    power, quiet = (
        smoothed(frequency, np.abs(spectrum) ** 2, centres)
        for frequency, spectrum in (fourier_spectrum(part, step) for part in (values, noise))
    )
    loud = power > SIGNAL_TO_NOISE**2 * quiet * len(values) / before
    loud |= centres < 1.0 / (step * before)
    strongest = int(np.argmax(power * centres**2 if channel.quantity != "acceleration" else power))
    if not loud[strongest]:
        return np.nan, np.nan
    first = strongest - int(np.argmin(np.append(loud[strongest::-1], False))) + 1
    last = strongest + int(np.argmin(np.append(loud[strongest:], False))) - 1
    return max(low, float(centres[first])), min(high, float(centres[last]))
