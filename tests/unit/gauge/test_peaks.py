"""Peaks of sampled histories, clean and noisy."""

import numpy as np
import pytest

from dembound.gauge.peaks import Peaks, denoised, first_fall, matched, positive_peaks

TIME = 0.5 * np.arange(1000)
CRESTS, HEIGHTS, LENGTH = np.array([100.15, 231.8, 360.05]), np.array([2.0, 1.0, 0.3]), 40.0


def bells(time):
    """Raised cosines 40 s long, 20 s at half their height, and troughs between them."""
    total = np.zeros_like(time)
    for summit, height in zip(CRESTS, HEIGHTS, strict=True):
        for sign, place in ((1.0, summit), (-1.0, summit + 55.0)):
            phase = np.clip((time - place) / LENGTH, -0.5, 0.5)
            total += sign * height * 0.5 * (1.0 + np.cos(2.0 * np.pi * phase))
    return total


def test_peaks_are_found_between_samples():
    found = positive_peaks(TIME, bells(TIME))
    # 40 samples wide, so smoothed over 5 to either side. The bell's fourth derivative, q⁴/2 per sample⁴ with q = 2π/80,
    # changes the smoothed crest by 1/24 of it times Σ|c_i|i⁴ < 5⁴; the parabola's vertex misses by less than that
    assert found.height == pytest.approx(HEIGHTS, rel=(2.0 * np.pi / 80.0) ** 4 / 2.0 / 24.0 * 5.0**4)
    # even about its crest, the smoothed bell has a slope of q²x(1 − q²x²/6) beside it; the parabola takes x² for 1
    # and bends by q²(1 − q²/12): by q²/6 of at most half a sample it is out
    assert found.time == pytest.approx(CRESTS, abs=0.5 * 0.5 * (2.0 * np.pi / 80.0) ** 2 / 6.0)
    first = positive_peaks(TIME, bells(TIME), 2)
    assert (first.time.tolist(), first.height.tolist()) == (found.time[:2].tolist(), found.height[:2].tolist())
    nothing = Peaks(*positive_peaks(TIME, -np.abs(bells(TIME))))
    assert len(nothing.time) == len(nothing.height) == 0


@pytest.mark.parametrize("seed", range(2))
def test_noise_and_ringing_make_no_peaks_and_hide_none(seed):
    noise = 0.05 * np.random.default_rng(seed).standard_normal(len(TIME))
    found = positive_peaks(TIME, bells(TIME) + noise)
    # smoothed over 5 samples to either side, 3/√(8·5) = 0.47 of the noise is left: the lowest crest is 12 times that,
    # and five times that is found with a probability of 1e-6 a sample where nothing is
    assert found.height == pytest.approx(HEIGHTS, abs=5.0 * 0.47 * 0.05)
    ringing = 0.2 * np.sin(2.0 * np.pi * (TIME - 130.0) / 8.0) * (np.abs(TIME - 145.0) < 15.0)  # 4 s wide
    assert len(positive_peaks(TIME, bells(TIME) + ringing).time) == len(CRESTS)


def test_a_clean_history_is_not_smoothed_and_a_noisy_one_is():
    clean = np.clip(100.0 - np.abs(TIME - 200.0), 0.0, None)
    noise = np.random.default_rng(1).standard_normal(len(TIME))
    assert denoised(clean).tolist() == clean.tolist()
    left = denoised(clean + noise) - clean
    # r = (√32 · 0.01 · 200)^(2/3) = 5 samples, and of the noise 3/√(8·5) = 0.47 is left, known from 1000 samples of
    # which one in 2r + 1 is independent to 1/√(2·91) = 7 %, four times which is allowed; beside the crest alone it is
    # (3/16)·5 samples · 0.5 s off
    assert left[np.abs(TIME - 200.0) > 10.0].std() == pytest.approx(0.47, rel=0.3)
    assert abs(left[400] + 3.0 / 16.0 * 5 * 0.5) < 4.0 * 0.47


def test_the_first_fall_ends_where_it_rises_again_and_bears_noise():
    # up to 4, down to 1.5, up to 2, down to 0
    values = np.interp(TIME, [0.0, 50.0, 100.0, 150.0, 450.0], [0.0, 4.0, 1.5, 2.0, 0.0])
    assert first_fall(values) == pytest.approx(2.5, rel=1e-12)
    for seed in range(3):
        noisy = values + 0.04 * np.random.default_rng(seed).standard_normal(len(TIME))
        # r = (√32 · 0.04/2.5 · 100)^(2/3) = 4: the top loses (3/16)·4 samples of (0.04 + 0.025)/2 each, the bottom of
        # (0.025 + 0.005)/2: 0.036 in all; of the noise 3/√(8·4) = 0.53 is left on each, of which four are allowed
        assert first_fall(noisy) == pytest.approx(2.5, abs=0.036 + 4.0 * np.sqrt(2.0) * 0.53 * 0.04)
    risen = noisy[:301]  # the same backwards and upside down: sums of nine samples, the other way round
    assert first_fall(-risen[::-1]) == pytest.approx(first_fall(risen), rel=1e-13)
    for without in (np.zeros(1000), TIME, -TIME, np.minimum(TIME, 200.0), -np.abs(TIME - 200.0)):
        assert np.isnan(first_fall(without))


TIMES = 0.5 * np.arange(2000)


def passages(time):
    """A skew pulse, and the same later and smaller, between samples."""
    shape = np.interp(time, [100.0, 120.0, 160.0], [0.0, 1.0, 0.0])
    return sum(
        height * np.interp(time - late, time, shape) for late, height in ((0.0, 1.0), (300.13, 0.5), (600.4, 0.2))
    )


def test_each_has_its_shift_and_its_share():
    values = passages(TIMES)
    found = matched(TIMES, values, positive_peaks(TIMES, values))
    # the correlation of a shape with straight sides bends by its slopes squared, and is not a parabola between samples:
    # a hundredth of a sample
    np.testing.assert_allclose(np.diff(found.time), [300.13, 300.27], atol=0.01)
    np.testing.assert_allclose(found.height / found.height[0], [1.0, 0.5, 0.2], rtol=1e-3)
