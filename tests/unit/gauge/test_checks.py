"""Signals that cannot be what they are taken for."""

import numpy as np
import pytest

from dembound.gauge.checks import clipped, unfit_signal

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
    (said,) = unfit_signal(-np.minimum(wave, 0.8))
    assert "have its smallest value, -0.8" in said
    assert not list(unfit_signal(-np.minimum(wave, 0.8), may_be_clipped=True))


@pytest.mark.parametrize("offset", [0.0, 100.0])
def test_noise_without_a_wave_and_few_samples_are_seen(offset):
    noise = np.random.default_rng(1).standard_normal(1000)
    (said,) = unfit_signal(offset + noise)
    assert said.startswith(f"the signal is noise: its largest value is {np.abs(noise - np.median(noise)).max():.1f}")
    assert not list(unfit_signal(offset + 20.0 * TRIANGLE + noise))
    assert "too coarse" in next(unfit_signal(20.0 * (TIME == 500.0) + noise))
    assert "the largest wave has 1 samples" in next(unfit_signal(TRIANGLE[::100]))
    assert not list(unfit_signal(TRIANGLE[::10]))
