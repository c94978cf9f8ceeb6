"""Passages timed by all of their shape."""

import numpy as np

from dembound.gauge.matching import matched
from dembound.gauge.peaks import Peaks, positive_peaks

TIME = 0.5 * np.arange(2000)


def passages(time):
    """A skew pulse, and the same later and smaller, between samples."""
    shape = np.interp(time, [100.0, 120.0, 160.0], [0.0, 1.0, 0.0])
    return sum(
        height * np.interp(time - late, time, shape) for late, height in ((0.0, 1.0), (300.13, 0.5), (600.4, 0.2))
    )


def test_each_has_its_shift_and_its_share():
    values = passages(TIME)
    found = matched(TIME, values, positive_peaks(TIME, values))
    # the correlation of a shape with straight sides bends by its slopes squared, and is not a parabola between samples:
    # a hundredth of a sample
    np.testing.assert_allclose(np.diff(found.time), [300.13, 300.27], atol=0.01)
    np.testing.assert_allclose(found.height / found.height[0], [1.0, 0.5, 0.2], rtol=1e-3)


def test_a_peak_that_the_record_cuts_remains_as_it_is():
    values = passages(TIME)[:1500]  # the last crest is at 720.4 of 750, and ends at 760
    peaks = positive_peaks(TIME[:1500], values)
    found = matched(TIME[:1500], values, peaks)
    assert (found.time[2], found.height[2]) == (peaks.time[2], peaks.height[2])
    one = Peaks(peaks.time[:1], peaks.height[:1])
    assert matched(TIME, passages(TIME), one) is one
