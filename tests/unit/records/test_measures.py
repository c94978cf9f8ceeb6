"""Measures of ground motions beside closed forms."""

import numpy as np
import pytest

from dembound.records.channel import Channel
from dembound.records.processing import Processing, measures_of, processed, usable_band
from dembound.waves.unit_names import STANDARD_GRAVITY

STEP = 0.01


def test_a_sine_has_its_closed_forms() -> None:
    # ten periods of 2 s: ∫a² = A²T/2, over which sums of evenly spaced squares are exact; velocity A/ω (1 − cos) and
    # displacement A/ω (t − sin(ωt)/ω); crests are on samples
    count, omega, peak = 2000, np.pi, 3.0
    found = measures_of(
        processed(Channel("", "acceleration", peak * np.sin(omega * STEP * np.arange(count)), STEP), Processing())
    )
    assert found.pga == pytest.approx(peak, rel=1e-12)
    assert found.pgv == pytest.approx(2.0 * peak / omega, rel=1e-12)
    # at the last sample, one before the end of the period: 2000 STEP less a step, and sin(ω STEP)/ω = STEP but for 2e-6
    assert found.pgd == pytest.approx(peak / omega * 20.0, rel=1e-5)
    assert found.final_displacement == found.pgd
    assert found.final_velocity == pytest.approx(peak / omega * (1.0 - np.cos(omega * STEP)), rel=1e-6)
    assert found.arias == pytest.approx(np.pi / (2.0 * STANDARD_GRAVITY) * 0.5 * peak**2 * 20.0, rel=1e-12)
    # it grows as t/20 s − sin(2ωt)/(40ω s): at 5 and 95 %, 1 and 19 s, the sine is zero; sums are half a step late
    assert found.duration == pytest.approx(18.0, abs=STEP)


def test_noise_before_the_motion_bounds_the_band() -> None:
    count, rng = 6000, np.random.default_rng(2)
    frequency = np.fft.rfftfreq(count, STEP)
    noise = rng.standard_normal(count)
    envelope = np.where(np.arange(count) < 2000, 0.0, np.sin(np.pi * (np.arange(count) - 2000) / 4000.0) ** 2)
    # amplitudes of e^(−f/1 Hz), over those of noise, whose power is that of all 60 s: equal to 3 of it at f₃
    motion = envelope * np.fft.irfft(np.exp(-frequency) * np.fft.rfft(rng.standard_normal(count)), count)
    size = 0.002
    low, high = usable_band(Channel("", "acceleration", motion + size * noise, STEP), Processing())
    # power of motion e^(−2f)·Σ envelope², of noise size²·6000; signal and noise together are 9 times the noise at f₃
    expected = 0.5 * np.log((envelope**2).sum() / (8.0 * size**2 * count))
    # smoothed over a range of f/1.2 to 1.2 f, of power that falls as e^(−2f): some tenths; both spectra are random
    assert high == pytest.approx(expected, rel=0.1)
    assert low == pytest.approx(1.0 / 60.0)
    silent = Channel("", "acceleration", noise, STEP)
    assert usable_band(silent, Processing()) == pytest.approx((1.0 / 60.0, 40.0))  # all is motion: noise is not known
