"""Waves moved along a bar, and distinguished by two gauges."""

import numpy as np
import pytest

from dembound.exact.pochhammer import wavenumber
from dembound.gauge.hopkinson.separation import FADED, LongBar, moved, separated

TIME = 1e-6 * np.arange(4000)
SPEED, WAY = 5000.0, 0.5


def pulse(time):
    """A smooth pulse of 200 µs after 100 µs."""
    phase = (time - 100e-6) / 200e-6
    return np.where((phase > 0.0) & (phase < 1.0), np.sin(np.pi * phase) ** 2, 0.0)


def passages(place, decay, sign):
    """Waves at a place of a bar of 2 m with free ends: to the right or to the left."""
    ways = [4.0 * turn + place for turn in range(6)] if sign > 0.0 else [4.0 * (turn + 1) - place for turn in range(6)]
    return sum(sign * np.exp(-decay * way) * pulse(TIME - way / SPEED) for way in ways)


@pytest.mark.parametrize(("decay", "way"), [(0.0, -0.0333), (0.1, 0.7371)])
def test_a_wave_arrives_later_and_smaller(decay, way):
    start = pulse(TIME - 200e-6)
    expected = np.exp(-decay * way) * pulse(TIME - 200e-6 - way / SPEED)
    # a pulse of 200 samples with continuous slope has (1/200)²/2 of its spectrum beyond the Nyquist frequency
    np.testing.assert_allclose(moved(TIME, start, way, LongBar(SPEED, decay)), expected, atol=2e-5)


def test_two_gauges_tell_to_and_fro():
    decay = 0.1
    right, left = passages(1.0, decay, 1.0), passages(1.0, decay, -1.0)
    other = passages(1.0 + WAY, decay, 1.0) + passages(1.0 + WAY, decay, -1.0)
    found = separated(TIME, right + left, other, WAY, LongBar(SPEED, decay))
    # the end of the record, where waves still run, begins again with FADED of itself
    np.testing.assert_allclose(found[0], right, atol=1.5 * FADED)
    np.testing.assert_allclose(found[1], left, atol=1.5 * FADED)
    with pytest.raises(ValueError, match="must be above 0"):
        separated(TIME, TIME, TIME, 0.0, LongBar(SPEED))


def test_each_frequency_of_a_round_bar_has_its_own_delay():
    bar, way = LongBar(SPEED, 0.0, 0.01, 0.3), 2.0
    frequency = 2.0 * np.pi * 60e3
    burst = np.exp(-(((TIME - 500e-6) / 100e-6) ** 2)) * np.cos(frequency * (TIME - 500e-6))
    after = moved(TIME, burst, way, bar)
    # crests are late by k/ω, the envelope by dk/dω; the spectrum is 1/(π 100 µs) = 3 kHz wide, over which the group
    # delay changes by its slope: the envelope widens by less than a hundredth
    near = np.array([0.999, 1.0, 1.001]) * frequency
    k = wavenumber(near, 0.01, 0.3, SPEED)
    phase, group = k[1] / frequency * way, (k[2] - k[0]) / (near[2] - near[0]) * way
    expected = np.exp(-(((TIME - 500e-6 - group) / 100e-6) ** 2)) * np.cos(frequency * (TIME - 500e-6 - phase))
    assert phase - way / SPEED > 3e-6  # some tenths of a period: it is seen
    np.testing.assert_allclose(after, expected, atol=0.05)
    np.testing.assert_allclose(moved(TIME, after, -way, bar), burst, atol=1e-6)
