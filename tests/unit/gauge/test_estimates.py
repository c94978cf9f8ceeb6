"""What a gauge tells, from histories whose speed, attenuation and strengths are known."""

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.gauge.estimates import (
    attenuated_strength,
    attenuation,
    incident_pulse,
    near_free_end,
    nominal_strength,
    path_via_free_end,
    pull_back_strength,
    tension_peaks,
    wave_speed,
)

POSITION, LENGTH, SPEED, DECAY = 0.6, 0.99, 2740.0, 0.52
BAR = POSITION, LENGTH, SPEED
SLOPE = 0.5 * (1.0 / 40.0 + 1.0 / 80.0)
"""What the crest of the gauge's history falls per sample, of itself, as the mean of both sides."""

SPALL = 0.79
FALL = 200e-6
CREST = 25.5e6 * FALL * SPEED / (2.0 * (LENGTH - SPALL))
"""Crest in Pa of a pulse with this fall whose image leaves 25.5 MPa at the spall, (2d/c)/t_d of it."""


def spread(x, weights, errors):
    """How far errors (k,) of points at x (k,) can move the slope of a weighted line, all at once and as noise."""
    weights = weights**2
    from_middle = x - np.average(x, weights=weights)
    shares = weights * from_middle / np.sum(weights * from_middle**2)
    return np.abs(shares * errors).sum(), np.linalg.norm(shares * errors)


def test_a_clean_history_gives_back_speed_and_attenuation(felt):
    peaks = tension_peaks(*felt())
    assert len(peaks.time) == 5  # the sixth has e^(−5·1.03) = 0.6 % of the first, less than a hundredth
    speed = wave_speed(peaks.time, LENGTH)
    decay = attenuation(*peaks, speed.value)
    # all crests are alike but for where the samples fall, so a time is known to half a sample, and a height to what
    # the crest falls on that way; a height changes β by its own share, the speed by its own
    off, _ = spread(np.arange(5), np.ones(5), np.full(5, 0.5e-6))
    assert speed.value == pytest.approx(SPEED, rel=off * SPEED / (2.0 * LENGTH))
    off, _ = spread(SPEED * peaks.time, peaks.height, np.full(5, 0.5 * SLOPE))
    assert decay.value == pytest.approx(DECAY, abs=off + abs(speed.value / SPEED - 1.0) * DECAY)
    assert speed.points == decay.points == 5


@pytest.mark.parametrize("seed", range(4))
def test_one_percent_of_noise_leaves_speed_and_attenuation(felt, seed):
    peaks = tension_peaks(*felt(noise=0.01, seed=seed))
    count, height = len(peaks.time), peaks.height / peaks.height[0]
    assert count >= 4
    speed = wave_speed(peaks.time, LENGTH, peaks.height)
    decay = attenuation(*peaks, speed.value)
    # smoothed over r = 7 samples to either side, with coefficients (9/8r)(1 − 5x²/3r²), the crest bends by
    # 2·SLOPE·9/(8r); the noise's slope is 1/r·√(9.4/r + 1.1) of itself, from the coefficients and from where they end
    reach, noise = 7, 0.01
    jitter = noise * np.sqrt(9.4 / reach + 1.1) / reach / (2.0 * SLOPE * 9.0 / (8.0 * reach))
    _, off = spread(np.arange(count), height, 1e-6 * jitter / height)
    assert speed.value == pytest.approx(SPEED, rel=4.0 * off * SPEED / (2.0 * LENGTH))
    # of the noise 3/√(8r) is left on each height, beside what a clean history is off by
    _, off = spread(SPEED * peaks.time, height, noise * 3.0 / np.sqrt(8.0 * reach) / height)
    clean, _ = spread(SPEED * peaks.time, height, np.full(count, 0.5 * SLOPE))
    assert decay.value == pytest.approx(DECAY, abs=4.0 * off + clean)


def test_lines_have_their_usual_standard_error():
    # times 0, 2, 1 + 2·2: the slope is 5/2, deviations are 1/6 · (1, −2, 1), so its error is √(1/6 / 1 / 2)
    speed = wave_speed(np.array([0.0, 2.0, 5.0]), 5.0)
    assert speed.value == pytest.approx(4.0, rel=1e-12)
    assert speed.error == pytest.approx(4.0 / 2.5 * np.sqrt(1.0 / 12.0), rel=1e-12)
    # logarithms that fall evenly, by 0.1 on 2 m, leave no error but rounding's
    decay = attenuation(np.arange(4.0), np.exp(-0.1 * np.arange(4.0)), 2.0)
    assert (decay.value, decay.error) == (pytest.approx(0.05, rel=1e-12), pytest.approx(0.0, abs=1e-12))


def test_weak_peaks_count_less():
    alike = wave_speed(np.array([0.0, 1.0, 2.0, 4.0]), 1.0)
    weighted = wave_speed(np.array([0.0, 1.0, 2.0, 4.0]), 1.0, np.array([1.0, 0.1, 0.01, 1e-4]))
    # the last one's square weight, 1e-8, times its time's deviation of 1 from the line through the others and its
    # number of 3, is what the slope of 1 is moved by; the others' moment about the first is 0.01
    assert weighted.value == pytest.approx(2.0, rel=1e-8 * 3.0 / 0.01 * 1.1)
    assert alike.value < 1.6  # 2/1.3


def test_two_peaks_have_no_standard_error_and_one_makes_no_line():
    speed = wave_speed(np.array([1.0, 3.0]), 2.0)
    assert (speed.value, speed.points) == (2.0, 2)
    assert np.isnan(speed.error)
    with pytest.raises(CaseError, match="--wave-speed: needs two tension peaks to be estimated, 1 found; give it"):
        wave_speed(np.array([1.0]), 2.0)


def test_what_rings_behind_a_pulse_that_is_not_back_is_no_tension_peak(felt):
    time, stress = felt()
    stress[time > 1e-6 * 370.0] = 0.0  # the pulse has passed, 20 + 0.6/2740 + 120 µs, and is not back
    rings = np.abs(stress).max() * np.cos(2.0 * np.pi * time / 50e-6)
    assert len(tension_peaks(time, stress + 0.0099 * rings).time) == 0
    assert len(tension_peaks(time, stress + 0.0101 * rings).time) > 0


def test_the_incident_pulse_is_what_comes_before_its_front_is_back(felt):
    time, stress = felt()
    alone, pulse = incident_pulse(time, stress, *BAR)
    arrival, back = 20e-6 + POSITION / SPEED, 20e-6 + (2.0 * LENGTH - POSITION) / SPEED
    # a hundredth of the crest is reached within half a sample, and found at the next one
    assert 0.0 <= alone[-1] - back < 2e-6
    assert pulse[alone <= back].tolist() == stress[time <= back].tolist()
    assert not pulse[alone < arrival].any()
    assert pulse.min() == stress.min()


def test_the_end_of_the_pulse_may_be_told(felt):
    time, stress = felt()
    alone, pulse = incident_pulse(time, stress, *BAR, end=300e-6)
    assert len(pulse) == np.count_nonzero(time <= 300e-6)
    assert alone[-1] == time[len(alone) - 1]


def test_a_pulse_that_goes_on_is_refused_unless_its_end_is_told(felt):
    time, stress = felt(rise=100e-6, fall=300e-6)
    with pytest.raises(CaseError, match="--pulse-end: give it, the pulse has not ended when its reflection is back"):
        incident_pulse(time, stress, *BAR)
    assert incident_pulse(time, stress, *BAR, end=400e-6)[0][-1] == pytest.approx(400e-6, abs=1e-6)


@pytest.mark.parametrize("end", [-1.0, 2e-4, np.nan])
def test_a_pulse_does_not_end_before_it_has_come(felt, end):
    # half its crest comes after 20 + 20 µs and 0.6 m at 2740 m/s, at 258.98 µs, and so is passed in sample 259
    with pytest.raises(
        CaseError, match=r"--pulse-end: is \S+ s, must be after 0.000259 s, when the pulse is half risen"
    ):
        incident_pulse(*felt(), *BAR, end=end)


def test_a_front_that_is_back_before_the_pulse_has_risen_is_refused(felt):
    with pytest.raises(CaseError, match="--pulse-end: give it, the pulse has not ended when its reflection is back"):
        incident_pulse(*felt(rise=400e-6), POSITION, POSITION + 0.01, SPEED)


def test_a_pulse_of_two_samples_is_refused():
    with pytest.raises(CaseError, match="--pulse-end: leaves 2 samples of the incident pulse, must leave three"):
        incident_pulse(np.arange(4.0), np.array([0.0, -1.0, 0.0, 1.0]), 0.5, 1.0, 1.01)


def test_without_compression_there_is_no_pulse(felt):
    time, stress = felt()
    with pytest.raises(CaseError, match="--scale: gives no compression"):
        incident_pulse(time, np.abs(stress), *BAR)


def test_the_image_frees_the_end_and_leaves_the_rest(felt):
    alone, pulse = incident_pulse(*felt(), *BAR)
    times = np.linspace(0.0, 1e-3, 777)
    at_gauge, at_end = near_free_end(alone, pulse, *BAR, np.array([POSITION, LENGTH]), times)
    # times of up to 1 ms are rounded by 1e-19 s, in which the steeper side changes by 3e-15; some such errors add up
    rounding = 2e-14
    assert at_end == pytest.approx(np.zeros(len(times)), abs=rounding)
    before = times < 20e-6 + (2.0 * LENGTH - POSITION) / SPEED - 1e-6  # straight lines begin at the sample before
    assert at_gauge[before] == pytest.approx(np.interp(times[before], alone, pulse), abs=rounding)
    # it comes back as it went, upside down, but for the last sample that the pulse is cut at
    late = times - 2.0 * (LENGTH - POSITION) / SPEED
    returned = (times > alone[-1]) & (late < alone[-1])
    assert at_gauge[returned] == pytest.approx(-np.interp(late[returned], alone, pulse), abs=rounding)


def strong_test(felt, noise=0.0, seed=0):
    """The incident pulse of a test that spalls the bar, in Pa, from a history that ends before anything returns."""
    time, stress = felt(fall=FALL)
    stress = stress / np.abs(stress).max()
    noise = noise * np.random.default_rng(seed).standard_normal(len(time))
    return incident_pulse(time, CREST * (stress + noise), *BAR, 20e-6 + 1.38 / SPEED)


def test_nominal_and_attenuated_strength_are_those_of_the_paper(felt):
    strength, when = nominal_strength(*strong_test(felt), *BAR, SPALL)
    # the crest lies between two samples; rising in 40 and falling in 200, it is up to 1/240 above the higher of them,
    # by which the pulse was scaled
    assert 25.5e6 * (1.0 - 1e-12) <= strength <= 25.5e6 / (1.0 - 1.0 / 240.0)
    # the tension lasts from when the crest comes back until the pulse's end comes
    crest_back = 60e-6 + (2.0 * LENGTH - SPALL) / SPEED
    assert crest_back - 2e-6 < when < 60e-6 + FALL + SPALL / SPEED + 2e-6
    way = path_via_free_end(POSITION, LENGTH, SPALL)
    assert way == pytest.approx(0.59, rel=1e-12)
    assert attenuated_strength(25.5e6, DECAY, way) == pytest.approx(18.76e6, abs=0.005e6)  # as printed: 18.8


@pytest.mark.parametrize(
    ("knots", "heights", "when"),
    [
        ([0.0, 0.4, 0.8, 2.4], [0.0, -1.0, -0.25, 0.0], 0.4 + 1.25),  # as the image's crest comes
        ([0.0, 0.4, 1.6, 2.0, 2.4], [0.0, -1.0, -0.875, -0.875, 0.0], 2.4 + 0.25),  # as the pulse has passed
    ],
    ids=["image", "pulse"],
)
def test_the_nominal_strength_of_straight_lines_is_exact(knots, heights, when):
    # at 0.5 m of 1 m and at 1 m/s the pulse comes 0.25 s after it was at the gauge, its image 1 s later. When the
    # image's crest comes, the pulse is down to 1/4 · (2.4 − 1.4)/1.6; when the other pulse has passed, its image is at
    # 1.4 s, where it has fallen by 1/8 · (1.4 − 0.4)/1.2
    strength = {0.4 + 1.25: 1.0 - 0.25 / 1.6, 2.4 + 0.25: 1.0 - 0.125 / 1.2}[when]
    found = nominal_strength(np.array(knots), np.array(heights), 0.25, 1.0, 1.0, 0.5)
    assert found == pytest.approx((strength, when), rel=1e-14)


@pytest.mark.parametrize("seed", range(4))
def test_one_percent_of_noise_leaves_the_nominal_strength(felt, seed):
    clean, _ = nominal_strength(*strong_test(felt), *BAR, SPALL)
    noisy, _ = nominal_strength(*strong_test(felt, 0.01, seed), *BAR, SPALL)
    # 120 samples wide, the pulse is smoothed over (√32 · 0.01 · 120)^(2/3) = 4 samples to either side, which leaves
    # 3/√(8·4) = 0.53 of the noise, √2 times that on the sum of pulse and image; largest of those 75 samples, it adds
    # up to four times that
    assert noisy == pytest.approx(clean, abs=4.0 * np.sqrt(2.0) * 0.53 * 0.01 * CREST)


def test_the_pull_back_gives_the_strength_of_a_sharp_spall():
    density, strength, crest = 2620.0, 18.76e6, 35e6
    # the free end takes twice the pulse's velocity, until it has fallen by as much as the strength makes up
    per_stress = 2.0 / (density * SPEED)
    knots = np.array([0.0, 100e-6, 140e-6, 240e-6, 270e-6, 400e-6])
    velocity = per_stress * np.array([0.0, 0.0, crest, crest - strength, crest, crest])
    time = 1e-6 * np.arange(400)
    found = pull_back_strength(time, np.interp(time, knots, velocity), density, SPEED, LENGTH)
    assert found == pytest.approx(strength, rel=1e-12)  # all knots are samples


def test_only_the_first_arrival_tells_of_a_pull_back():
    # 2L/c = 200 µs after it came at 100 µs the pulse is back at the end of a bar that has not spalled
    time, bar = 1e-6 * np.arange(500), (2000.0, 1000.0, 0.1)
    twice = np.interp(time, 1e-6 * np.array([100, 140, 180, 300, 340, 380]), [0.0, 10.0, 0.0, 0.0, 9.0, 0.0])
    assert np.isnan(pull_back_strength(time, twice, *bar))
    # and it tells of one only if it rises before that; something small before it came does not count
    early = np.interp(time, 1e-6 * np.array([20, 30, 40]), [0.0, 1.0, 0.0])
    again = np.interp(time, 1e-6 * np.array([180, 240, 300]), [0.0, 3.0, 0.0])
    assert pull_back_strength(time, twice + early + again, *bar) == pytest.approx(0.5 * 2e6 * 10.0, rel=1e-12)


@pytest.mark.parametrize("velocity", [np.linspace(0.0, 1.0, 100), -np.ones(100), np.zeros(100)])
def test_an_end_that_does_not_fall_tells_no_pull_back(velocity):
    assert np.isnan(pull_back_strength(1e-6 * np.arange(100), velocity, 2620.0, SPEED, LENGTH))


def test_a_bar_shorter_than_two_samples_tells_no_pull_back():
    velocity = np.interp(np.arange(100), [10, 20, 30, 40], [0.0, 10.0, 4.0, 8.0])
    assert np.isnan(pull_back_strength(1e-6 * np.arange(100), velocity, 2620.0, 1000.0, 0.001))
