"""Properties common to all waves, checked on each type; and values of single types."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from dembound.waves import Constant, Cosine, CubicSpline, Ricker, SineBurst, Triangle
from dembound.waves.wave import Shape

WAVES = [
    Cosine(type="cosine", start=0.3, amplitude=0.5, period=0.4),
    CubicSpline(type="cubic_spline", start=0.2, amplitude=0.6, period=0.8),
    Triangle(type="triangle", start=0.2, amplitude=-0.9, rise=0.1, fall=0.5),
    Ricker(type="ricker", start=0.1, amplitude=-0.7, frequency=3.0),
    SineBurst(type="sine_burst", start=0.2, amplitude=1.3, frequency=5.0, cycles=1),
    SineBurst(type="sine_burst", amplitude=1.3, frequency=5.0, cycles=4),
    SineBurst(type="sine_burst", amplitude=-1.3, frequency=4.0, cycles=3, taper=False),
    Constant(type="constant", start=0.2, amplitude=0.8, rise=0.5),
]
PULSES = [wave for wave in WAVES if math.isfinite(wave.duration())]
STEP = Constant(type="constant", start=0.2, amplitude=-0.8)


def name_of(wave: Shape) -> str:
    return f"{wave.type}-{wave.amplitude}"


@pytest.mark.parametrize("wave", [*WAVES, STEP], ids=name_of)
@pytest.mark.parametrize("end", [0.25, 2.0])
def test_displacement_is_the_integral_of_velocity(wave: Shape, end: float) -> None:
    # before -1 s every wave is at rest; the Ricker pulse, 4.8 periods before its crest, is e^-(4.8π)² = 1e-99
    ends = [wave.start, wave.start + getattr(wave, "rise", 0.0), min(wave.duration(), end)]
    integral, error = quad(wave.velocity, -1.0, end, points=ends, limit=200, epsabs=1e-12)

    # quad bounds its own error; round-off of a closed form of size ≤ 2 m adds a few 1e-16
    assert abs(wave.displacement(np.array(end)) - integral) <= error + 1e-14


@pytest.mark.parametrize("wave", WAVES, ids=name_of)
def test_peak_is_the_largest_speed_and_is_first_reached_at_the_peak_time(wave: Shape) -> None:
    times = np.linspace(0.0, 3.0, 300_001)
    speeds = np.abs(wave.velocity(times))

    # at the peak time exactly the peak, up to the round-off of the sine's argument (1e-15 · some radians)
    assert abs(wave.velocity(np.array(wave.peak_time()))) == pytest.approx(wave.peak(), rel=1e-12)
    assert speeds.max() <= wave.peak() * (1.0 + 1e-12)
    # and not yet 0.01 s before: the flattest crests lack (2π²/3)(0.01/rise)³ = 5e-5 (ramp), (0.01π/T)² = 4e-4
    before = times < wave.peak_time() - 0.01
    assert speeds[before].max() < wave.peak() * (1.0 - 4e-5)


@pytest.mark.parametrize("wave", PULSES, ids=name_of)
def test_at_rest_outside_start_and_duration(wave: Shape) -> None:
    outside = np.array([-10.0, wave.start - 1e-9, wave.duration() + 1e-9, 100.0])

    # the Ricker pulse is 2a·exp(-a) = 1e-8 there, a = (1.5π)²; the others are zero but for round-off
    assert np.abs(wave.velocity(outside)).max() <= 1.01e-8 * abs(wave.amplitude)


@pytest.mark.parametrize("wave", PULSES, ids=name_of)
def test_spectrum_is_below_one_percent_above_the_highest_frequency_and_not_far_below_it(wave: Shape) -> None:
    # an independent spectrum, with bins of 0.05 Hz up to 26 kHz, far above every band
    samples = 2**20
    spectrum = np.abs(np.fft.rfft(wave.velocity(np.linspace(0.0, 20.0, samples, endpoint=False))))
    frequencies = np.fft.rfftfreq(samples, 20.0 / samples)
    share = spectrum / spectrum.max()

    assert share[frequencies > wave.highest_frequency()].max() <= 0.01
    # side lobes are no wider than 1/length, so one lies in the upper half of the band
    assert share[frequencies > 0.5 * wave.highest_frequency()].max() > 0.01


def test_cosine_follows_its_equation() -> None:
    wave = Cosine(type="cosine", amplitude=0.5, period=0.5)
    t = np.array([0.0, 0.125, 0.25, 0.375, 0.5, 0.6])

    # Z eq. 12 at quarters of the period: 0, M/2, M, M/2, 0, and rest; and its area MT/2
    assert wave.velocity(t) == pytest.approx([0.0, 0.25, 0.5, 0.25, 0.0, 0.0], abs=1e-15)
    assert wave.displacement(np.array([0.5, 9.0])) == pytest.approx([0.125, 0.125], rel=1e-14)
    assert wave.duration() == 0.5
    assert wave.dominant_frequency() == 2.0


def test_cubic_spline_follows_its_equation() -> None:
    wave = CubicSpline(type="cubic_spline", amplitude=0.5, period=2.0)
    tau = np.linspace(-0.2, 1.2, 141)
    terms = zip((1.0, -4.0, 6.0, -4.0, 1.0), (0.0, 0.25, 0.5, 0.75, 1.0), strict=True)
    printed = 0.5 * 16.0 * sum(factor * np.maximum(tau - shift, 0.0) ** 3 for factor, shift in terms)

    # Z eq. 19 as printed: its terms reach 8·6·1.2³ = 80, so it is known to 80 · 1e-16 times a few
    assert wave.velocity(2.0 * tau) == pytest.approx(printed, abs=1e-13)
    # quarters of the pulse: 0, 1/4, 1, 1/4, 0 of M; and its area 3MT/8, at once and for ever
    assert wave.velocity(np.array([0.0, 0.5, 1.0, 1.5, 2.0, 1e9])).tolist() == [0.0, 0.125, 0.5, 0.125, 0.0, 0.0]
    assert wave.displacement(np.array([2.0, 1e9])).tolist() == [0.375, 0.375]
    assert (wave.duration(), wave.dominant_frequency()) == (2.0, 0.5)


def test_triangle_follows_its_equation() -> None:
    wave = Triangle(type="triangle", start=1.0, amplitude=2.0, rise=0.5, fall=2.0)
    t = np.array([0.9, 1.0, 1.25, 1.5, 2.5, 3.5, 9.0])

    # straight legs, and the areas under them: M t_r/8 half-way up, M t_r/2 at the crest, M(t_r + t_f)/2 at the end
    assert wave.velocity(t).tolist() == [0.0, 0.0, 1.0, 2.0, 1.0, 0.0, 0.0]
    assert wave.displacement(t).tolist() == [0.0, 0.0, 0.125, 0.5, 2.0, 2.5, 2.5]
    assert (wave.peak_time(), wave.duration(), wave.dominant_frequency()) == (1.5, 3.5, 0.4)


def test_a_step_and_a_ramp_hold_their_velocity() -> None:
    ramp = Constant(type="constant", amplitude=2.0, rise=0.5)
    assert ramp.velocity(np.array([0.25, 0.5, 7.0])) == pytest.approx([1.0, 2.0, 2.0], rel=1e-15)
    assert ramp.highest_frequency() == pytest.approx(3.2743 / 0.5, rel=1e-4)  # x³ − x = 100/π
    times = np.array([0.1999, 0.2, 0.2 + 2e-16, 0.2001, 5.0])
    assert STEP.velocity(times).tolist() == [0.0, -0.4, -0.4, -0.8, -0.8]
    assert STEP.model_copy(update={"start": 0.0}).velocity(np.zeros(1)).tolist() == [-0.4]
    assert (STEP.peak_time(), STEP.duration(), STEP.highest_frequency()) == (0.2, math.inf, math.inf)


def test_spectra_fade_where_the_closed_forms_say() -> None:
    spline = CubicSpline(type="cubic_spline", amplitude=1.0, period=4.0)
    even, sudden = (Triangle(type="triangle", amplitude=1.0, rise=rise, fall=1.0) for rise in (1.0, 1e-12))
    # sinc⁴ f at T = 4 s, and sinc² f with legs of 1 s; slopes there are below 0.1
    assert np.sinc(spline.highest_frequency()) ** 4 == pytest.approx(0.01, rel=1e-12)
    assert np.sinc(even.highest_frequency()) ** 2 == pytest.approx(0.01, rel=1e-10)
    # a sudden front's fades as |1 − e^(−iπx) sinc x|/(πx), which is 0.01 at 100/π but for sinc x < 0.01
    assert sudden.highest_frequency() == pytest.approx(100.0 / math.pi, rel=0.01)


def test_ricker_troughs_and_vanishing_displacement() -> None:
    wave = Ricker(type="ricker", amplitude=2.0, frequency=4.0)
    trough = wave.peak_time() + math.sqrt(1.5) / (4.0 * math.pi)  # a = 3/2

    assert wave.velocity(np.array(trough)) == pytest.approx(-4.0 * math.exp(-1.5), rel=1e-12)
    # M·τ·exp(-(πfτ)²), τ = 1.5/f: 2 · 0.375 · 2.3e-10
    assert abs(wave.displacement(np.array(wave.duration()))) < 2e-10


@pytest.mark.parametrize("value", [0.0, math.nan])
def test_amplitude_must_be_a_finite_number_other_than_zero(value: float) -> None:
    with pytest.raises(ValueError, match=r"must not be 0|finite"):
        Cosine(type="cosine", amplitude=value, period=1.0)
