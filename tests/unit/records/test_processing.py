"""Processing of measured ground motions beside exact formulas, and measures of motions beside closed forms."""

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.gauge.baseline import Filters
from dembound.records.channel import Channel
from dembound.records.processing import Processing, differentiated, measures_of, processed, usable_band
from dembound.waves.unit_names import STANDARD_GRAVITY

STEP, COUNT = 0.01, 4000
TIME = STEP * np.arange(COUNT)
CENTRE = 20.0


def burst(frequency: float = 2.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Displacement, velocity and acceleration (n,) of a sine of 2 Hz in a Gaussian, which is zero at both ends."""
    phase, away = 2.0 * np.pi * frequency * (TIME - CENTRE), (TIME - CENTRE) / 2.0
    # derivatives of Re e^(iφ − s²), φ' = ω, (s²)' = s: factors of d/dt are iω − s, and −1/2 from s' = 1/2
    wave = np.exp(1j * phase - away**2)
    rate = 2j * np.pi * frequency - away
    return wave.real, (rate * wave).real, ((rate**2 - 0.5) * wave).real


def record(values: np.ndarray, quantity: str = "acceleration") -> Channel:
    return Channel("EW", quantity, values, STEP)  # type: ignore[arg-type]


@pytest.mark.parametrize("quantity", ["displacement", "acceleration"])
def test_a_burst_has_its_exact_integrals_and_derivatives(quantity: str) -> None:
    displacement, velocity, acceleration = burst()
    given = {"displacement": displacement, "velocity": velocity, "acceleration": acceleration}
    found = processed(record(given[quantity], quantity), Processing())
    # band-limited but for e^(−(2π·48)²) and zero at its ends but for e^(−100): only rounding is left, 1e-16 of the
    # largest values, times the 4000 samples that each integral sums up, and times π/STEP for each derivative
    for got, expected, largest in (
        (found.acceleration, acceleration, 160.0),
        (found.velocity, velocity, 13.0),
        (found.displacement, displacement, 1.0),
    ):
        np.testing.assert_allclose(got, expected, rtol=0.0, atol=1e-9 * largest)
    assert not list(found.warnings())


def test_filters_shift_no_phase_and_keep_their_pass_band() -> None:
    _, _, acceleration = burst()
    found = processed(record(acceleration), Processing(filters=Filters(high_pass=0.1, low_pass=25.0)))
    # Butterworth of order 4, twice: at 2 Hz 1 − (0.1/2)⁸ and 1 − (2/25)⁸, both within 2e-9; the burst's band of ±0.5 Hz
    # reaches down to 1 Hz at 1e-4 of its peak, where they are 1 − 1e-8; phases cancel exactly
    np.testing.assert_allclose(found.acceleration, acceleration, rtol=0.0, atol=1e-6 * np.abs(acceleration).max())
    # and an impulse in the middle stays symmetric: rounding of recursive filters, whose poles are 0.1/100 from 1
    impulse = np.zeros(COUNT + 1)
    impulse[COUNT // 2] = 1.0
    answer = processed(record(impulse), Processing(filters=Filters(high_pass=0.5, low_pass=10.0))).acceleration
    np.testing.assert_allclose(answer, answer[::-1], rtol=0.0, atol=1e-6 * answer.max())
    # |H|² of the low pass, squared, at its corner: 1/2 in amplitude, at the frequency that warping leaves in place
    tone = np.sin(2.0 * np.pi * 10.0 * TIME) * np.sin(np.pi * TIME / TIME[-1]) ** 2
    corner = processed(record(tone), Processing(filters=Filters(low_pass=10.0))).acceleration
    assert np.abs(corner).max() == pytest.approx(0.5 * np.abs(tone).max(), rel=1e-3)  # band of 1/40 s: 0.05 Hz, squared


def test_a_velocity_ends_at_exactly_zero() -> None:
    values = burst()[2] + 0.05 * (TIME > 17.0)  # tilted as the motion begins
    before = processed(record(values), Processing(baseline="mean"))
    assert before.velocity[-1] == pytest.approx(0.05 * 23.0, rel=0.01)  # a mean of what comes before, 2e-4, over 40 s
    assert [text.split()[0] for text in before.warnings()] == ["ends"]
    found = processed(record(values), Processing(baseline="zero-velocity"))
    assert abs(found.velocity[-1]) < 1e-12 * np.abs(found.velocity).max()  # rounding of sums over 4000 samples
    assert not list(found.warnings())
    # what was added is removed: the constant begins at the first motion, up to a second before 17 s
    # at 1 % of its peak
    assert np.abs(found.velocity - burst()[1]).max() < 0.05 * 1.5
    with pytest.raises(CaseError, match="zero-velocity is for accelerations"):
        processed(record(values, "velocity"), Processing(baseline="zero-velocity"))


def test_means_are_those_before_the_motion_and_lines_of_all_samples() -> None:
    displacement, _, _ = burst()
    noise = 1e-4 * np.random.default_rng(3).standard_normal(COUNT)
    found = processed(record(displacement + 0.7 + noise), Processing(baseline="mean"))
    assert "before the motion" in found.steps[1]
    # the mean of more than 1000 samples of noise of 1e-4: five standard errors
    assert found.acceleration[:1000].mean() == pytest.approx(0.0, abs=5 * 1e-4 / np.sqrt(1000.0))
    line = processed(record(0.2 - 0.01 * TIME), Processing(baseline="linear"))
    np.testing.assert_allclose(line.acceleration, 0.0, atol=1e-13)  # rounding of the fit


def test_a_window_that_begins_with_motion_has_the_mean_and_the_noise_before_it() -> None:
    """Motion at the beginning of a window that is below 1 % of its peak is no noise."""
    rng = np.random.default_rng(3)
    frequency = np.fft.rfftfreq(COUNT, STEP)
    strong = (TIME > 25.0) * np.fft.irfft(np.exp(-frequency) * np.fft.rfft(rng.standard_normal(COUNT)), COUNT)
    early = 0.002 * np.abs(strong).max() * np.clip(TIME - 10.0, 0.0, 1.0) * (TIME < 25.0) * rng.standard_normal(COUNT)
    channel = record(strong + early + 0.02 + 1e-5 * rng.standard_normal(COUNT))
    found = processed(channel, Processing(begin=20.0, baseline="mean"))
    # the mean of more than 800 samples of noise: five standard errors
    assert (channel.values[2000:] - found.acceleration).mean() == pytest.approx(0.02, abs=5e-5 / np.sqrt(800.0))
    # no less than that of the whole record, in which more noise is beside the motion; 26 Hz with early motion as noise
    whole, own = (usable_band(channel, Processing(begin=begin))[1] for begin in (None, 20.0))
    assert own >= whole > 20.0


def test_tapers_begin_and_end_at_zero_and_acceleration_stays_the_derivative() -> None:
    values = np.cos(2.0 * np.pi * 0.5 * TIME) + 0.1
    found = processed(record(values, "velocity"), Processing(taper=2.0))
    assert found.velocity[0] == found.velocity[-1] == 0.0
    assert found.velocity[COUNT // 2] == pytest.approx(values[COUNT // 2], abs=1e-12)
    # tapers of 2 s have jumps in their second derivative alone: their Fourier series is off by (STEP/2 s)² at the ends
    np.testing.assert_allclose(found.acceleration, differentiated(found.velocity, STEP), atol=1e-2)
    with pytest.raises(CaseError, match="--taper: is 30 s, must be from 0 to half of the record"):
        processed(record(values), Processing(taper=30.0))


def test_a_pga_is_reached_exactly_in_a_window() -> None:
    for settings in (Processing(15.0, 25.0, peak=2.0), Processing(15.0, 25.0, "linear", 1.0, Filters(20.0, 0.5), 2.0)):
        found = processed(record(burst()[2]), settings)
        assert np.abs(found.acceleration).max() == pytest.approx(2.0, rel=1e-15)
        assert (len(found.time), found.time[0], found.time[-1]) == (1001, 15.0, 25.0)
        assert found.steps[-1].endswith("to a PGA of 2 m/s²")
    factor = processed(record(burst()[2]), Processing(factor=-0.5))
    np.testing.assert_array_equal(factor.acceleration, -0.5 * burst()[2])
    with pytest.raises(CaseError, match=r"keep no samples; the record is from 0 to 39\.99 s"):
        processed(record(burst()[2]), Processing(50.0, 60.0))
    with pytest.raises(CaseError, match="no motion to scale"):
        processed(record(np.zeros(COUNT)), Processing(peak=1.0))


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
