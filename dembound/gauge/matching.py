"""Times and heights of passages of one pulse from its shape: a matched filter.

Noise shifts the crest of a peak much more than its shape. Each passage is therefore fitted by a·g(t − τ), with g
the first tension peak of the smoothed history; noise σ then leaves an error σ/√(Σ ġ²)/a of a time and σ/√(Σ g²) of a
height, sums over all samples of the peak.
"""

import numpy as np

from dembound.gauge.peaks import CREST, Peaks, smooth, width_of

FOOT = 0.1
"""Height over the crest's at which the shape of a peak ends."""

RANGE = 0.5
"""Largest shift of a passage from its crest, in widths of the first one."""


def matched(time: np.ndarray, values: np.ndarray, peaks: Peaks) -> Peaks:
    """The peaks of a history with times and heights at which the shape of the first one fits them best.

    Parameters
    ----------
    time, values : (k,) s, evenly spaced, and any unit. peaks : of this history, by `peaks.positive_peaks`. A peak whose
    whole shape is not within the history does not change.
    """
    if len(peaks.time) < 2:
        return peaks
    width = width_of(values)
    reach = max(1, round(CREST * width))
    smoothed = smooth(values, reach)
    places = np.rint(np.interp(peaks.time, time, np.arange(len(time)))).astype(int)
    first, last = _extent(smoothed, places[0])
    shape = smoothed[first:last]
    step = float(time[1] - time[0])
    times, heights = peaks.time.copy(), peaks.height.copy()
    for index, place in enumerate(places):
        shifts = np.arange(-round(RANGE * width) - 1, round(RANGE * width) + 2) + place - places[0]
        if first + shifts[0] < 0 or last + shifts[-1] > len(values):
            continue
        fits = np.array([smoothed[first + shift : last + shift] @ shape for shift in shifts]) / (shape @ shape)
        best = int(np.clip(fits.argmax(), 1, len(fits) - 2))
        before, here, after = fits[best - 1 : best + 2]
        bend = before - 2.0 * here + after
        offset = 0.5 * (before - after) / bend if bend < 0.0 else 0.0
        times[index] = peaks.time[0] + step * (shifts[best] + offset)
        heights[index] = peaks.height[0] * (here - 0.25 * (before - after) * offset)
    return Peaks(times, heights) if (heights > 0.0).all() else peaks


def _extent(values: np.ndarray, crest: int) -> tuple[int, int]:
    """First sample of the peak around a crest, and the one after its last."""
    low = np.flatnonzero(values < FOOT * values[crest])
    return int(low[low < crest].max(initial=-1)) + 1, int(low[low > crest].min(initial=len(values)))
