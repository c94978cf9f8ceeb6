"""Faults of a recorder or an amplifier that a single pulse shows, without its returns.

Values are positive in the pulse: a gauge's stress has the opposite sign, the velocity of a free end its own.
"""

from collections.abc import Iterator

import numpy as np

from dembound.gauge.peaks import NOISE_FACTOR, smooth, white_noise, width_of
from dembound.words import percent

JUMP, ALONE = 0.1, 5.0
"""Least change of a pulse in one sample, over its crest, and over the next largest near it, where samples are lost.

The slopes of a pulse are of many samples, and its steps are alike: the largest is up to twice the next one.
"""

QUIET = 0.05
"""Share of the crest at which a pulse begins: a front may be abrupt."""

NARROW = 10.0
"""The slower slope of a pulse, T for 0.8 of its crest, over the range of the running median."""

LOWERED, SPIKE = 0.06, 0.02
"""Largest lowering of a sharp crest by that median, over its height, and least excess of a spike: half the range
times the slope is (T/20)(0.8/T) = 0.04 for straight slopes, and with T from 0.9 to 0.5 of the crest, 2τ ln 1.8,
0.059 for a fall exp(−t/τ) behind an abrupt front."""

SPIKE_NOISE = 6.0
"""Least excess of a spike in standard deviations of noise, which a sample in 10⁹ has."""

UNDERSHOOT, MOST_UNDERSHOOT = 0.03, 0.5
"""Opposite signal behind a pulse, over its crest, from which and up to which it indicates AC coupling: less is an
uncertain baseline, more is another wave."""

UNEXPLAINED = 0.2
"""Largest deviation of this signal from the effect of AC coupling on the pulse, over its own size."""


def faults(time: np.ndarray, values: np.ndarray, what: str, cure: str) -> Iterator[str]:
    """Message about samples that are lost in a pulse, or else about spikes on it.

    time, values : (k,) s and any unit. what : signal with the pulse, in words; cure : remedy for spikes.
    """
    if (jump := lost_samples(values)) is not None:
        share = abs(values[jump + 1] - values[jump]) / float(values.max())
        yield (
            f"{what} jumps by {percent(share)} of its crest in one sample, at {time[jump + 1]:.6g} s: are samples lost "
            "there? then it is too short, and strengths are wrong"
        )
    elif (spike := largest_spike(values)) is not None:
        place, share = spike
        yield (
            f"{what} has a spike or a burst of noise at {time[place]:.6g} s, too narrow for its slopes and "
            f"{percent(share)} of its crest off them: a strength, from largest values, has it in it; {cure}"
        )


def lost_samples(values: np.ndarray) -> int | None:
    """The sample before a jump within a pulse (k,); None without one. Abrupt fronts and ends are not jumps."""
    crest, width = float(values.max()), width_of(values)
    steps = np.abs(np.diff(values))
    begins = np.abs(values[:-1]) < max(QUIET * crest, NOISE_FACTOR * white_noise(values))
    inner = np.where(begins, 0.0, steps)
    at = int(inner.argmax())
    others = np.delete(inner[max(0, at - width) : at + width + 1], min(at, width))
    if steps[at] < max(JUMP * crest, ALONE * float(others.max(initial=0.0))):
        return None
    ends = abs(float(values[at + 1])) < QUIET * crest
    abrupt = float(np.where(begins, steps, 0.0)[:at].max(initial=0.0))
    return None if ends and abrupt > 0.5 * steps[at] else at


def largest_spike(values: np.ndarray) -> tuple[int, float] | None:
    """Sample and height, over the crest, of the largest deviation of a pulse (k,) from its running median.

    The median keeps slopes and jumps, and takes out what is narrower than half its range. None if noise or the crest
    itself explains the deviation, and for a pulse whose slopes have too few samples.
    """
    from scipy.ndimage import median_filter

    crest = float(values.max())
    reach = round(_slope_length(values) / NARROW / 2.0)
    if reach < 1:
        return None
    off = np.abs(values - median_filter(values, 2 * reach + 1, mode="nearest"))
    place = int(off.argmax())
    least = LOWERED * crest + max(SPIKE * crest, SPIKE_NOISE * white_noise(values))
    return (place, float(off[place]) / crest) if off[place] > least else None


def _slope_length(values: np.ndarray) -> float:
    """Samples in which a pulse (k,) falls by 0.8 of its crest on its slower side, as from 0.9 to half or its lowest."""
    top, crest, lengths = float(values.max()), int(values.argmax()), []
    for part in (values[crest::-1], values[crest:]):
        high = int(np.flatnonzero(part > 0.9 * top)[-1])
        low = max(0.5, float(part[high:].min()) / top + SPIKE)
        if low < 0.8 and len(reached := np.flatnonzero(part[high:] < low * top)):
            lengths.append(0.8 * int(reached[0]) / (0.9 - low))
    return max(lengths, default=0.0)


def ac_coupling(time: np.ndarray, values: np.ndarray, begun: int) -> Iterator[str]:
    """Message about a pulse that an amplifier coupled by a capacitor has changed.

    Such a coupling with the time constant τ makes v of x with v + (1/τ)∫v dt = x. Behind the pulse, where x = 0, the
    signal is thus −1/τ of its own integral, of the other sign and slowly decaying.

    Parameters
    ----------
    time, values : (k,) of the pulse until something else is due, as recorded, with its baseline. begun : sample at
    which it begins; as many as the pulse is wide before it are its offset.
    """
    width = width_of(values)
    before = values[max(0, begun - width) : begun]
    if len(before) < NOISE_FACTOR or width < NOISE_FACTOR:
        return
    signal = values - np.median(before)
    crest = int(signal.argmax())
    smoothed = smooth(signal, max(1, width // 16)) if len(signal) > width else signal
    ended = crest + int(smoothed[crest:].argmin())
    if len(signal) - ended < width // 4:
        return
    step = float(time[1] - time[0])
    integral, behind = (step * np.cumsum(signal))[ended:], signal[ended:]
    rate = -float(behind @ integral) / float(integral @ integral)
    size = rate * float(integral.max()) / float(signal[crest])
    off = float(np.sqrt(np.mean((behind + rate * integral) ** 2))) / float(signal[crest])
    if UNDERSHOOT < size < MOST_UNDERSHOOT and off < UNEXPLAINED * size + 2.0 * white_noise(values) / signal[crest]:
        yield (
            f"behind the pulse the signal is {percent(size)} of the crest on the other side and decays in "
            f"{1.0 / rate:.2g} s, as by AC coupling: pulse and strength are wrong; record it with DC coupling"
        )
