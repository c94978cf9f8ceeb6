"""Offset and drift are found between the waves; signals that cannot be what they are taken for are refused."""

import numpy as np
import pytest
from gauge_records import drift, noise, offset, signal

from dembound.gauge.baseline import Filters, find_baseline, treated
from dembound.gauge.gauge_io import clipped, unfit_signal
from dembound.gauge.reading.signal import Signal

TIME, VALUES = signal().T
QUIET = 1e-4
"""Waves that have decayed below a hundredth count as quiet: they move a baseline by some of their share of the time."""


def added(*changes):
    """The sum of the signals of some changes."""
    total = np.zeros_like(TIME)
    for change in changes:
        total = change(TIME, total)
    return total


@pytest.mark.parametrize(
    ("changes", "drifts"), [((offset(0.2),), False), ((drift(-0.4),), True), ((offset(-0.1), drift(0.3)), True)]
)
def test_what_is_added_is_found(changes, drifts):
    exact = added(*changes)
    found = find_baseline(VALUES + exact)
    assert (found.drifts, found.worthwhile) == (drifts, True)
    np.testing.assert_allclose(found.values, exact, atol=10.0 * QUIET)
    tilted = find_baseline(VALUES + exact, drift=False)
    assert (tilted.drifts, np.ptp(tilted.values)) == (False, 0.0)


def test_a_signal_without_a_baseline_keeps_its_bits():
    values = VALUES + added(noise(0.01))
    signal = treated(Signal(TIME, values, "V"))
    np.testing.assert_array_equal(signal.values, values)
    assert "baseline: nothing to remove" in signal.notes[0]


def test_filters_keep_waves_where_they_are():
    time = 1e-6 * np.arange(20_000)
    slow, fast = np.cos(2.0 * np.pi * 1e3 * time), np.cos(2.0 * np.pi * 50e3 * time)
    for filters, kept in (
        (Filters(low_pass=10e3), slow),
        (Filters(high_pass=10e3), fast),
        (Filters(notches=(50e3,)), slow),
        (Filters(low_pass=250e3, high_pass=10e3), fast),
    ):
        values, notes = filters.apply(time, slow + fast)
        # a decade from the corner, or five times as far, Butterworth's fourth order twice has 1e-8 left
        np.testing.assert_allclose(values[2000:-2000], kept[2000:-2000], atol=1e-4)
        assert all(note.startswith("filter: ") for note in notes)
    at_corner, _ = Filters(low_pass=1e3).apply(time, slow)
    assert np.ptp(at_corner[5000:-5000]) == pytest.approx(1.0, rel=1e-3)  # half of 2: 6 dB


STEPS = np.arange(1000.0)
BELL = np.exp(-(((STEPS - 500.0) / 80.0) ** 2))
TRIANGLE = np.clip(1.0 - np.abs(STEPS - 500.0) / 100.0, 0.0, None)


def test_what_a_digitiser_makes_of_a_crest_is_not_clipped():
    for wave in (BELL, TRIANGLE):
        for levels in (16, 256, 4096):
            assert clipped(np.round(wave * levels) / levels) == 0


@pytest.mark.parametrize("noise", [0.0, 0.003])
def test_what_is_cut_is_clipped(noise):
    wave = TRIANGLE + noise * np.random.default_rng(1).standard_normal(1000)
    assert clipped(np.minimum(wave, 0.8)) == pytest.approx(41, abs=2)  # a fifth of both slopes
    assert clipped(np.minimum(wave, 0.97)) == 0  # seven samples of a width of a hundred do not matter
    (said,) = unfit_signal(-np.minimum(wave, 0.8))
    assert "have its smallest value, -0.8" in said
    assert not list(unfit_signal(-np.minimum(wave, 0.8), may_be_clipped=True))


@pytest.mark.parametrize("offset", [0.0, 100.0])
def test_noise_without_a_wave_and_few_samples_are_seen(offset):
    noise = np.random.default_rng(1).standard_normal(1000)
    (said,) = unfit_signal(offset + noise)
    assert said.startswith(f"the signal is noise: its largest value is {np.abs(noise - np.median(noise)).max():.1f}")
    assert not list(unfit_signal(offset + 20.0 * TRIANGLE + noise))
    assert "too coarse" in next(unfit_signal(20.0 * (STEPS == 500.0) + noise))
    assert "the largest wave has 1 samples" in next(unfit_signal(TRIANGLE[::100]))
    assert not list(unfit_signal(TRIANGLE[::10]))
