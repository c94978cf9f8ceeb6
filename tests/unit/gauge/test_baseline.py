"""Offset, drift and hum are found between the waves, and are left alone where there are none."""

import numpy as np
import pytest
from gauge_records import drift, hum, noise, offset, signal

from dembound.errors import CaseError
from dembound.gauge.baseline import find_baseline, quiet_samples
from dembound.gauge.filters import Filters
from dembound.gauge.noise import noise_of
from dembound.gauge.reading.signal import Signal
from dembound.gauge.treatment import Treatment, treated

TIME, VALUES = signal().T
LONG_TIME, LONG_VALUES = signal(20_000, 2e-6, 2e-3).T
QUIET = 1e-4
"""Waves that have decayed below a hundredth count as quiet: they move a baseline by some of their share of the time."""


def added(*changes, time=TIME):
    """The sum of the signals of some changes."""
    total = np.zeros_like(time)
    for change in changes:
        total = change(time, total)
    return total


@pytest.mark.parametrize(
    ("changes", "names"),
    [
        ((offset(0.2),), ("offset",)),
        ((drift(-0.4),), ("offset", "drift")),
        ((offset(-0.1), hum(0.1)), ("offset", "slow curve as of 50 Hz hum")),
    ],
)
def test_what_is_added_is_found(changes, names):
    exact = added(*changes)
    found = find_baseline(TIME, VALUES + exact)
    assert (found.names, found.worthwhile) == (names, True)
    np.testing.assert_allclose(found.values, exact, atol=10.0 * QUIET)


def test_mains_are_distinguished_in_long_records():
    frequency = 60.0
    exact = added(offset(0.1), hum(0.05, frequency), hum(0.02, 3.0 * frequency), time=LONG_TIME)
    found = find_baseline(LONG_TIME, LONG_VALUES + exact + added(noise(0.01), time=LONG_TIME))
    assert found.names == ("offset", f"{frequency:g} Hz hum")
    # 0.01 of noise in 18,000 samples leaves 0.0001 for each of seven terms
    np.testing.assert_allclose(found.values, exact, atol=5.0 * np.sqrt(7.0) * 1e-4)


def test_a_signal_without_a_baseline_keeps_its_bits():
    values = VALUES + added(noise(0.01))
    signal, _ = treated(Signal(TIME, values, "V"))
    np.testing.assert_array_equal(signal.values, values)
    assert "baseline: nothing to remove" in signal.notes[0]


def test_a_long_wave_has_the_offset_of_its_beginning():
    time = np.arange(1000.0)
    wave = np.sin(np.clip((time - 200.0) / 300.0, 0.0, None))  # never quiet again
    found = find_baseline(time, wave + 0.5 + 1e-3 * np.random.default_rng(1).standard_normal(1000))
    assert found.names == ("offset",)
    # a hundredth of the wave is counted as quiet, in its first three samples
    assert found.values[0] == pytest.approx(0.5, abs=0.01)
    assert found.before < 220


def test_terms_that_are_excluded_are_not_fitted():
    bent, tilted = VALUES + added(hum(0.1)), VALUES + added(drift(0.2))
    assert find_baseline(TIME, bent, drift=False).names == ("offset", "slow curve as of 50 Hz hum")
    assert find_baseline(TIME, tilted, mains=()).names == ("offset", "drift")
    assert find_baseline(TIME, tilted, drift=False, mains=()).names == ("offset",)


def test_quiet_samples_are_away_from_waves():
    quiet = quiet_samples(VALUES)
    arrival = 20e-6 + 0.6 / 2740.0
    width = 60e-6  # of the triangle, at half its height
    assert quiet[arrival - width > TIME].all()
    assert not quiet[(arrival - 0.2 * width < TIME) & (arrival + 120e-6 + 0.2 * width > TIME)].any()


def test_draws_are_as_the_noise_with_a_baseline_that_is_left_in_and_always_the_same():
    values = LONG_VALUES + added(noise(0.02), offset(0.1), time=LONG_TIME)
    found = find_baseline(LONG_TIME, values)
    noise_found = noise_of(values - found.values, found)
    draws = np.array(list(noise_found.draws()))
    assert len(draws) == 50
    # 1000 samples before the wave give the size of the noise to 1/√2000
    assert draws.std() == pytest.approx(0.02, rel=5.0 / np.sqrt(2000.0))
    np.testing.assert_array_equal(draws, np.array(list(noise_found.draws())))
    assert not np.array_equal(draws[0], draws[1])
    values = VALUES + 0.002  # below 0.3 %
    found = find_baseline(TIME, values)
    assert not found.worthwhile
    means = [float(draw.mean()) for draw in noise_of(values, found).draws()]
    assert np.std(means) == pytest.approx(0.002, rel=0.3)  # of 200 draws, known to 1/√400; 3/√100 for both


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


def test_filters_that_a_record_does_not_allow_are_refused():
    for filters, said in (
        (Filters(low_pass=6e5), "--low-pass: is 600000 Hz, must be from 600 to below 5e+05 Hz in this record"),
        (Filters(high_pass=10.0), "--high-pass: is 10 Hz, must be from 600"),
        (Filters(notches=(50.0,)), "--notch: is 50 Hz, must be from 600"),
        (Filters(low_pass=2e3, high_pass=3e3), "--high-pass: is 3000 Hz, must be below the low pass, 2000 Hz"),
    ):
        with pytest.raises(CaseError, match=said.replace("+", r"\+")):
            treated(Signal(TIME, VALUES, "V"), Treatment(filters=filters))
