"""Peaks of sampled histories that carry noise."""

from typing import NamedTuple

import numpy as np

SMALLEST = 0.01
"""Share of the largest value below which nothing counts as a peak."""

NOISE_FACTOR = 5.0
"""Standard deviations of the noise that a peak must reach: one in some 10⁶ samples does so by chance."""

CREST = 0.125
"""Reach of the smoothing to either side, in widths of the largest peak at half its height.

A crest of two straight slopes loses 3/16 of what they fall on average over that reach, so where they are alike
(3/16)(1/8) = 2.3 % of itself: all peaks of a pulse the same share.
"""

DIP = 0.05
"""Share of a history's whole range below which nothing counts as a maximum or minimum of it."""


class Peaks(NamedTuple):
    """Peaks in the order of time: time (k,) s and height (k,) in the history's unit."""

    time: np.ndarray
    height: np.ndarray


def positive_peaks(time: np.ndarray, values: np.ndarray, count: int | None = None) -> Peaks:
    """Peaks of a history above zero.

    The history is smoothed by parabolas over a quarter of its largest peak's width, and a peak is where the smoothed
    one is highest, by a parabola through the three samples there. It must stand out by `SMALLEST` of the largest and
    `NOISE_FACTOR` times the noise, be at least half as wide as the largest, and further from a higher one than that
    is wide. Where a crest is long and flat, noise decides on its place.

    Parameters
    ----------
    time : (k,) s, evenly spaced.
    values : (k,) in any unit.
    count : keep the first ones only; all by default.
    """
    if not values.max() > 0.0:
        return Peaks(np.empty(0), np.empty(0))
    width = _width(values)
    reach = max(1, round(CREST * width))
    smooth = _smooth(values, reach)
    least = max(SMALLEST * smooth.max(), NOISE_FACTOR * _noise(values) * _noise_left(reach))
    places = _summits(np.maximum(smooth, 0.0), prominence=least, width=0.5 * width, distance=width)[:count]
    before, here, after = (smooth[places + shift] for shift in (-1, 0, 1))
    bend = before - 2.0 * here + after
    offset = np.divide(0.5 * (before - after), bend, out=np.zeros(len(places)), where=bend != 0.0)
    times = np.interp(places + offset, np.arange(len(time)), time)
    return Peaks(times, here - 0.25 * (before - after) * offset)


def denoised(values: np.ndarray) -> np.ndarray:
    """A history (k,) smoothed by parabolas as far as its noise is worth it; a clean one stays as it is."""
    sizes = np.abs(values)
    return _smooth(values, _worthwhile_reach(_noise(values) / sizes.max(), _width(sizes)))


def first_fall(values: np.ndarray) -> float:
    """How far a history (k,), evenly sampled, falls from its first maximum to the minimum after it; nan without such.

    Both must stand out by `DIP` of its range and twice `NOISE_FACTOR` times the noise, which is then smoothed by
    parabolas as far as it is worth it.
    """
    noise = _noise(values)
    least = max(DIP * float(np.ptp(values)), 2.0 * NOISE_FACTOR * noise)
    tops, bottoms = (_summits(side * values, prominence=least) for side in (1.0, -1.0))
    after = bottoms[bottoms > tops[0]] if len(tops) else tops
    if not len(after):
        return np.nan
    top, bottom = int(tops[0]), int(after[0])
    reach = _worthwhile_reach(noise / (values[top] - values[bottom]), bottom - top)
    smooth = _smooth(values, reach)
    highest, lowest = (smooth[max(place - reach, 0) : place + reach + 1] for place in (top, bottom))
    return float(highest.max() - lowest.min())


def _summits(values: np.ndarray, **limits: float) -> np.ndarray:
    """Samples that are higher than those beside them, within the limits of `scipy.signal.find_peaks`."""
    from scipy.signal import find_peaks  # here, for it takes a second and other commands can do without

    return find_peaks(values, **limits)[0]


def _width(values: np.ndarray) -> int:
    """Samples around the largest that are above its half."""
    crest = int(values.argmax())
    low = np.flatnonzero(values < 0.5 * values[crest])
    return int(low[low > crest].min(initial=len(values)) - low[low < crest].max(initial=-1)) - 1


def _noise(values: np.ndarray) -> float:
    """Standard deviation of white noise: from the median second difference, which a smooth course hardly has."""
    return float(1.4826 * np.median(np.abs(np.diff(values, 2))) / np.sqrt(6.0))


def _worthwhile_reach(noise: float, width: int) -> int:
    """Reach r of the smoothing, in samples, at which a crest loses as much as is left of the noise, a share of it.

    A crest of two straight slopes, w samples wide at half its height, loses (3/16)(r/w) of itself, and 3/√(8r) of the
    noise is left.
    """
    return max(1, round((np.sqrt(32.0) * noise * width) ** (2.0 / 3.0)))


def _smooth(values: np.ndarray, reach: int) -> np.ndarray:
    """Each value that of a parabola through all up to `reach` samples away, which for one sample changes nothing."""
    if reach == 1:
        return values
    from scipy.signal import savgol_filter

    return savgol_filter(values, 2 * reach + 1, 2)


def _noise_left(reach: int) -> float:
    """Share of white noise that `_smooth` leaves: the root of its middle coefficient, as of any least squares."""
    return float(np.sqrt(3.0 * (3 * reach**2 + 3 * reach - 1) / ((2 * reach - 1) * (2 * reach + 1) * (2 * reach + 3))))
