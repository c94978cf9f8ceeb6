"""Signals that cannot be what they are taken for."""

import numpy as np
import pytest

from dembound.gauge.estimates import Estimate
from dembound.gauge.plausibility import (
    clipped,
    contradicting_speeds,
    first_return,
    implausible_length,
    implausible_signal,
    raised_by_noise,
    uncertain_decay,
    uncertain_speed,
    unlikely_speed,
)

TIME = np.arange(1000.0)
BELL = np.exp(-(((TIME - 500.0) / 80.0) ** 2))
TRIANGLE = np.clip(1.0 - np.abs(TIME - 500.0) / 100.0, 0.0, None)


def test_what_a_digitiser_makes_of_a_crest_is_not_clipped():
    for wave in (BELL, TRIANGLE):
        for levels in (16, 256, 4096):
            assert clipped(np.round(wave * levels) / levels) == 0


@pytest.mark.parametrize("noise", [0.0, 0.003])
def test_what_is_cut_is_clipped(noise):
    wave = TRIANGLE + noise * np.random.default_rng(1).standard_normal(1000)
    assert clipped(np.minimum(wave, 0.8)) == pytest.approx(41, abs=2)  # a fifth of both slopes
    assert clipped(np.minimum(wave, 0.97)) == 0  # seven samples of a width of a hundred do not matter
    (said,) = implausible_signal(-np.minimum(wave, 0.8))
    assert "have its smallest value, -0.8" in said
    assert not list(implausible_signal(-np.minimum(wave, 0.8), may_be_clipped=True))


@pytest.mark.parametrize("offset", [0.0, 100.0])
def test_noise_without_a_wave_and_few_samples_are_seen(offset):
    noise = np.random.default_rng(1).standard_normal(1000)
    (said,) = implausible_signal(offset + noise)
    assert said.startswith(f"the signal is noise: its largest value is {np.abs(noise - np.median(noise)).max():.1f}")
    assert not list(implausible_signal(offset + 20.0 * TRIANGLE + noise))
    assert "too coarse" in next(implausible_signal(20.0 * (TIME == 500.0) + noise))
    assert "the largest wave has 1 samples" in next(implausible_signal(TRIANGLE[::100]))
    assert not list(implausible_signal(TRIANGLE[::10]))


def test_units_are_guessed_from_the_speed_and_the_length():
    assert not list(unlikely_speed(2740.0))
    units = {
        2.74e6: "length in mm",
        2.74e9: "unit of time too small",
        2.74: "--time-unit ms",
        2.74e-3: "--time-unit us",
    }
    for speed, hint in units.items():
        assert hint in next(unlikely_speed(speed))
    for speed in (14_180.0, 60.0):  # peaks of bending between the returns: no option is named as the mistake
        said = next(unlikely_speed(speed))
        assert said.startswith("RECORD: the tension peaks give ")
        assert "bending" in said
        assert "--low-pass" in said
    for length, count in ((0.99, 0), (100.0, 0), (990.0, 1), (np.inf, 0), (np.nan, 0)):
        assert len(list(implausible_length(length))) == count


def test_first_passages_give_the_speed():
    values = -TRIANGLE + np.roll(0.6 * TRIANGLE, 300)
    first = first_return(TIME, values, 0.4, 1.0)
    assert first.value == pytest.approx(2.0 * 0.6 / 300.0, rel=1e-12)
    assert first.error == pytest.approx(first.value * np.sqrt(0.125) / 300.0, rel=1e-12)
    assert first_return(TIME, -values, 0.4, 1.0) is None


def test_speeds_agree_within_ten_of_their_errors_and_large_ones_are_reported():
    first = Estimate(1000.0, 2.0, 2)
    assert not list(contradicting_speeds(Estimate(1019.0, 0.0, 3), first))
    assert "2.1 % apart, must be within 2 %" in next(contradicting_speeds(Estimate(1021.0, 0.0, 3), first))
    assert not list(contradicting_speeds(Estimate(1021.0, 1.0, 3), first))
    assert not list(contradicting_speeds(Estimate(1009.0, np.nan, 2), Estimate(1000.0, 0.0, 2)))
    assert "has --scale the wrong sign" in next(contradicting_speeds(Estimate(1000.0), None))
    good, bad = Estimate(1000.0, 9.0, 3), Estimate(1000.0, 11.0, 3)
    assert not [*uncertain_speed(good), *uncertain_decay(Estimate(0.5, 0.09, 3))]
    assert len([*uncertain_speed(bad), *uncertain_decay(Estimate(0.5, 0.11, 3))]) == 2
    assert not [*uncertain_speed(Estimate(1000.0)), *uncertain_decay(Estimate(0.5))]
    assert len(list(raised_by_noise(0.016, 1.0))) == 1
    assert not list(raised_by_noise(0.014, 1.0))
