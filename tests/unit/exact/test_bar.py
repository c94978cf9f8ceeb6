"""d'Alembert's bar against the wave equation and its ends, and its spall against a search over place and time."""

import numpy as np
import pytest
from scipy.integrate import quad

from dembound.exact import Lattice, bar_stress, bar_velocity, cells_per_wavelength, courant_limit, triangle_spall
from dembound.exact.bar import End

LENGTH, SPEED, IMPEDANCE = 3.0, 2000.0, 5e6
WAIT = LENGTH / SPEED
CREST = 12e6


def bump(time: np.ndarray) -> np.ndarray:
    """A smooth pulse of 0.6 ms."""
    return CREST * np.where((time > 0.0) & (time < 6e-4), np.sin(np.pi * time / 6e-4) ** 4, 0.0)


def triangle(rise: float, fall: float):
    return lambda time: np.interp(time, [0.0, rise, rise + fall], [0.0, CREST, 0.0], left=0.0, right=0.0)


def both(place: float, time: np.ndarray, far_end: End) -> tuple[np.ndarray, np.ndarray]:
    stress = bar_stress(place, time, bump, LENGTH, SPEED, far_end)
    return stress, bar_velocity(place, time, bump, LENGTH, SPEED, IMPEDANCE, far_end)


@pytest.mark.parametrize("far_end", ["free", "fixed"])
def test_momentum_and_stiffness_are_kept(far_end: End) -> None:
    """ρ∂v/∂t = ∂σ/∂x and ∂σ/∂t = ρc²∂v/∂x, in central differences.

    Those are off by h²/6 of the third derivatives, which of sin⁴ ωt = ⅜ − ½cos 2ωt + ⅛cos 4ωt are at
    most 12ω³, ω = π/t_0. Two passages at most meet, and both sides have such an error.
    """
    step = 1e-7
    time = np.linspace(2e-4, 5.3 * WAIT, 500)
    bound = 2.0 * step**2 / 6.0 * 12.0 * (np.pi / 6e-4) ** 3 * 2.0 * CREST
    for place in (0.4, 1.5, 2.9):
        left, right = (both(place + d * SPEED, time, far_end) for d in (-step, step))
        before, after = (both(place, time + d, far_end) for d in (-step, step))
        stress, velocity = ((b - a) / (2.0 * step) for a, b in zip(left, right, strict=True))
        stress_rate, velocity_rate = ((b - a) / (2.0 * step) for a, b in zip(before, after, strict=True))
        np.testing.assert_allclose(IMPEDANCE * velocity_rate, stress, rtol=0, atol=bound)
        np.testing.assert_allclose(stress_rate, IMPEDANCE * velocity, rtol=0, atol=bound)


@pytest.mark.parametrize(
    ("rise", "fall", "share"), [(0.2e-3, 0.5e-3, 0.1), (0.4e-3, 0.3e-3, 0.55), (0.5e-3, 0.05e-3, 0.95)]
)
def test_spall_is_the_first_place_at_its_strength(rise: float, fall: float, share: float) -> None:
    """A search in steps of 0.4 µs, and of the way h of a wave in one, until some steps after the moment expected.

    A place within h of the first one follows it within a step, and is seen within another: two steps late. Until then
    tension may have gone 4h times a slope of the pulse beyond the strength, and it is reached that much over the
    difference of both slopes farther: in all within 2h + 4h·min/|t_f − t_r|, less than four times max/|t_f − t_r|.
    """
    step = 4e-7
    place, moment = triangle_spall(LENGTH, SPEED, rise, fall, CREST, share * CREST)
    time = np.arange(0.9 * WAIT, moment + 5.0 * step, step)
    places = np.arange(0.0, LENGTH, step * SPEED)[-1250:]
    stress = np.array([bar_stress(x, time, triangle(rise, fall), LENGTH, SPEED) for x in places])
    reached = stress >= share * CREST * (1.0 - 1e-9)  # but for rounding
    assert reached.any()
    first = np.argmax(reached.any(axis=0))
    apart = max(rise, fall) / abs(rise - fall)
    assert time[first] == pytest.approx(moment, abs=2.0 * step)
    assert np.abs(places[reached[:, first]] - place).max() <= 4.0 * apart * step * SPEED


@pytest.mark.parametrize("far_end", ["free", "fixed"])
def test_ends_do_what_they_are_to(far_end: End) -> None:
    early = both(1.2, np.array([0.0, 0.99, 1.0]) * 1.2 / SPEED, far_end)
    assert not np.any(early)  # nothing comes before the wave does
    time = np.linspace(0.0, 6.0 * WAIT, 1000)
    rounding = 6 * np.finfo(float).eps * 4.0 * np.pi * 6.0 * WAIT / 6e-4 * CREST  # of the times of six passages
    np.testing.assert_allclose(both(0.0, time, far_end)[0], -bump(time), rtol=0, atol=rounding)
    stress, velocity = both(LENGTH, time, far_end)
    if far_end == "free":
        np.testing.assert_allclose(stress, 0.0, rtol=0, atol=rounding)
        assert velocity.max() == pytest.approx(2.0 * CREST / IMPEDANCE, rel=1e-3)
    else:
        np.testing.assert_allclose(velocity, 0.0, rtol=0, atol=rounding / IMPEDANCE)
        assert stress.min() == pytest.approx(-2.0 * CREST, rel=1e-3)


HORIZONS = [1, 2, 3, 8]


def lattice(horizon: int, courant: float) -> Lattice:
    """A lattice with Δx = 1 m and c = 1 m/s, so that Δt = ν and k = θ."""
    return Lattice(horizon, spacing=1.0, time_step=courant, wave_speed=1.0)


def printed_sum(horizon: int, phase: np.ndarray) -> np.ndarray:
    """(2/m²) Σ (w_p/p)(cos pkΔx − 1), L eq. 12 with the outermost neighbour's half weight once."""
    weights = np.array((horizon - 1) * [1.0] + [0.5]) / np.arange(1, horizon + 1)
    return 2.0 / horizon**2 * sum(w * (np.cos(p * phase) - 1.0) for p, w in enumerate(weights, start=1))


@pytest.mark.parametrize("horizon", HORIZONS)
@pytest.mark.parametrize("share", [0.1, 0.99])
def test_frequency_solves_the_printed_equation(horizon: int, share: float) -> None:
    courant = share * courant_limit(horizon)
    phase = np.linspace(0.01, np.pi, 200)
    # each side is a sum of up to m terms that come to at most 2: (m + 10) roundings of 2
    found, rounding = np.cos(lattice(horizon, courant).frequency(phase) * courant) - 1.0, np.finfo(float).eps
    expected = courant**2 * printed_sum(horizon, phase)
    np.testing.assert_allclose(found, expected, rtol=0, atol=(horizon + 10) * 2.0 * rounding)


@pytest.mark.parametrize("horizon", HORIZONS)
def test_group_velocity_is_the_slope_of_the_frequency(horizon: int) -> None:
    speeds = lattice(horizon, 0.9 * courant_limit(horizon))
    for low, high in ((0.1, 0.5), (0.5, 1.3), (1.3, 3.1)):
        rise = quad(speeds.group_velocity, low, high, epsabs=0.0, epsrel=1e-12)[0]
        # frequencies of up to π/ν are subtracted, each good to a few roundings
        assert rise == pytest.approx(float(speeds.frequency(high) - speeds.frequency(low)), rel=1e-11, abs=1e-14)


@pytest.mark.parametrize("horizon", [1, 2, 3, 6, 12])
def test_shortest_wave_is_the_first_to_grow(horizon: int) -> None:
    phase = np.linspace(0.0, np.pi, 20001)
    largest = -0.5 * printed_sum(horizon, phase)
    # at a maximum with roundings of a sum of m terms; its place is flat to the fourth order for even m
    assert largest[-1] >= largest.max() - horizon * np.finfo(float).eps
    assert courant_limit(horizon) == pytest.approx(1.0 / np.sqrt(largest.max()), rel=1e-14)
    assert np.all(np.diff(lattice(horizon, 0.0).frequency(phase)) > -1e-14)


@pytest.mark.parametrize("horizon", HORIZONS)
@pytest.mark.parametrize(("of", "share"), [("phase", 0.0), ("phase", 0.9), ("group", 0.5)])
def test_wavelengths_of_so_many_cells_and_all_longer_ones_keep_to_the_error(horizon: int, share: float, of) -> None:
    courant = share * courant_limit(horizon)
    cells = cells_per_wavelength(horizon, courant, of=of)
    speeds = lattice(horizon, courant)
    speed = speeds.phase_velocity if of == "phase" else speeds.group_velocity
    phase = 2.0 * np.pi / cells
    assert abs(float(speed(phase)) - 1.0) == pytest.approx(0.01, rel=1e-9)  # brentq's 1e-12 of a phase, twice over
    assert np.all(np.abs(speed(np.linspace(0.0, 0.999 * phase, 1000)) - 1.0) < 0.01)
    assert abs(float(speed(1.001 * phase)) - 1.0) > 0.01
    assert cells_per_wavelength(1, 1.0, of=of) == 2.0  # there is no error at all
