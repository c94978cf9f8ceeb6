"""Estimates of a gauge, from histories whose speed, attenuation and strengths are known."""

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
"""Relative fall of the crest of the gauge's history per sample, as the mean of both sides."""

SPALL = 0.79
FALL = 200e-6
CREST = 25.5e6 * FALL * SPEED / (2.0 * (LENGTH - SPALL))
"""Crest in Pa of a pulse with this fall whose image leaves 25.5 MPa at the spall, (2d/c)/t_d of it."""


def spread(x, weights, errors):
    """How far errors (k,) of points at x (k,) can move the slope of a weighted line, all at once."""
    weights = weights**2
    from_middle = x - np.average(x, weights=weights)
    return np.abs(weights * from_middle / np.sum(weights * from_middle**2) * errors).sum()


def test_a_clean_history_gives_back_speed_and_attenuation(felt):
    peaks = tension_peaks(*felt())
    assert len(peaks.time) == 5  # the sixth has e^(−5·1.03) = 0.6 % of the first, less than a hundredth
    speed = wave_speed(peaks.time, LENGTH)
    decay = attenuation(*peaks, speed.value)
    # all crests are alike but for where the samples fall, so a time is known to half a sample, and a height to what
    # the crest falls on that way; a height changes β by its own share, the speed by its own
    off = spread(np.arange(5), np.ones(5), np.full(5, 0.5e-6))
    assert speed.value == pytest.approx(SPEED, rel=off * SPEED / (2.0 * LENGTH))
    off = spread(SPEED * peaks.time, peaks.height, np.full(5, 0.5 * SLOPE))
    assert decay.value == pytest.approx(DECAY, abs=off + abs(speed.value / SPEED - 1.0) * DECAY)
    assert speed.points == decay.points == 5


def test_lines_have_their_usual_standard_error():
    # times 0, 2, 1 + 2·2: the slope is 5/2, deviations are 1/6 · (1, −2, 1), so its error is √(1/6 / 1 / 2)
    speed = wave_speed(np.array([0.0, 2.0, 5.0]), 5.0)
    assert speed.value == pytest.approx(4.0, rel=1e-12)
    assert speed.error == pytest.approx(4.0 / 2.5 * np.sqrt(1.0 / 12.0), rel=1e-12)
    # logarithms that fall evenly, by 0.1 on 2 m, leave no error but rounding's
    decay = attenuation(np.arange(4.0), np.exp(-0.1 * np.arange(4.0)), 2.0)
    assert (decay.value, decay.error) == (pytest.approx(0.05, rel=1e-12), pytest.approx(0.0, abs=1e-12))
    with pytest.raises(CaseError, match="--wave-speed: needs two tension peaks to be estimated, 1 found; give it"):
        wave_speed(np.array([1.0]), 2.0)
    # weak peaks count less: the last one's square weight, 1e-8, times its time's deviation of 1 from the line through
    # the others and its number of 3, is what the slope of 1 is moved by; the others' moment about the first is 0.01
    times = np.array([0.0, 1.0, 2.0, 4.0])
    weighted = wave_speed(times, 1.0, np.array([1.0, 0.1, 0.01, 1e-4]))
    assert weighted.value == pytest.approx(2.0, rel=1e-8 * 3.0 / 0.01 * 1.1)
    assert wave_speed(times, 1.0).value < 1.6  # 2/1.3


def test_the_incident_pulse_is_what_comes_before_its_front_is_back(felt):
    time, stress = felt()
    alone, pulse = incident_pulse(time, stress, *BAR)
    arrival, back = 20e-6 + POSITION / SPEED, 20e-6 + (2.0 * LENGTH - POSITION) / SPEED
    # a hundredth of the crest is reached within half a sample, and found at the next one
    assert 0.0 <= alone[-1] - back < 2e-6
    assert pulse[alone <= back].tolist() == stress[time <= back].tolist()
    assert not pulse[alone < arrival].any()
    assert pulse.min() == stress.min()
    alone, pulse = incident_pulse(time, stress, *BAR, end=300e-6)  # or up to an end that is given
    assert len(pulse) == np.count_nonzero(time <= 300e-6)
    assert alone[-1] == time[len(alone) - 1]


NOT_ENDED = "--pulse-end: give it, the pulse has not ended when its reflection is back at the gauge; or bending follows"


def test_pulses_that_cannot_be_found_are_refused(felt):
    time, stress = felt(rise=100e-6, fall=300e-6)
    with pytest.raises(CaseError, match=NOT_ENDED):
        incident_pulse(time, stress, *BAR)
    assert incident_pulse(time, stress, *BAR, end=400e-6)[0][-1] == pytest.approx(400e-6, abs=1e-6)
    # half its crest comes after 20 + 20 µs and 0.6 m at 2740 m/s, at 258.98 µs, and so is passed in sample 259
    for end in (-1.0, 2e-4, np.nan):
        with pytest.raises(CaseError, match=r"--pulse-end: is \S+ s, must be after 0.000259 s, when the pulse is half"):
            incident_pulse(*felt(), *BAR, end=end)


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


def strong_test(felt):
    """The incident pulse of a test that spalls the bar, in Pa, from a history that ends before anything returns."""
    time, stress = felt(fall=FALL)
    return incident_pulse(time, CREST * stress / np.abs(stress).max(), *BAR, 20e-6 + 1.38 / SPEED)


def test_nominal_and_attenuated_strength_are_those_of_the_paper(felt):
    strength, when, _ = nominal_strength(*strong_test(felt), *BAR, SPALL)
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
    assert found == pytest.approx((strength, when, 0.0), rel=1e-14)


def test_the_pull_back_of_the_first_arrival_gives_the_strength_of_a_sharp_spall():
    density, strength, crest = 2620.0, 18.76e6, 35e6
    # the free end takes twice the pulse's velocity, until it has fallen by as much as the strength makes up
    per_stress = 2.0 / (density * SPEED)
    knots = np.array([0.0, 100e-6, 140e-6, 240e-6, 270e-6, 400e-6])
    velocity = per_stress * np.array([0.0, 0.0, crest, crest - strength, crest, crest])
    time = 1e-6 * np.arange(400)
    found = pull_back_strength(time, np.interp(time, knots, velocity), density, SPEED, LENGTH)
    assert found == pytest.approx(strength, rel=1e-12)  # all knots are samples
    # 2L/c = 200 µs after it came at 100 µs the pulse is back at the end of a bar that has not spalled
    time, bar = 1e-6 * np.arange(500), (2000.0, 1000.0, 0.1)
    twice = np.interp(time, 1e-6 * np.array([100, 140, 180, 300, 340, 380]), [0.0, 10.0, 0.0, 0.0, 9.0, 0.0])
    assert np.isnan(pull_back_strength(time, twice, *bar))
    # and it tells of one only if it rises before that; something small before it came does not count
    early = np.interp(time, 1e-6 * np.array([20, 30, 40]), [0.0, 1.0, 0.0])
    again = np.interp(time, 1e-6 * np.array([180, 240, 300]), [0.0, 3.0, 0.0])
    assert pull_back_strength(time, twice + early + again, *bar) == pytest.approx(0.5 * 2e6 * 10.0, rel=1e-12)
