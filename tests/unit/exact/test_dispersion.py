"""The dispersion of bars of nodes against L eq. 12 as printed, its series and its brute-force extremes."""

import numpy as np
import pytest
from scipy.integrate import quad

from dembound.exact import Lattice, cells_per_wavelength, courant_limit
from dembound.exact.dispersion import usual_shares

HORIZONS = [1, 2, 3, 4, 5, 8, 10]


def lattice(horizon: int, courant: float) -> Lattice:
    """With Δx = 1 m and c = 1 m/s, so that Δt = ν and k = θ."""
    return Lattice(horizon, spacing=1.0, time_step=courant, wave_speed=1.0)


def printed_sum(horizon: int, phase: np.ndarray) -> np.ndarray:
    """(2/m²) Σ (w_p/p)(cos pkΔx − 1), L eq. 12 with the outermost neighbour's half weight once."""
    return (
        2.0
        / horizon**2
        * sum((0.5 if p == horizon else 1.0) / p * (np.cos(p * phase) - 1.0) for p in range(1, horizon + 1))
    )


@pytest.mark.parametrize("horizon", HORIZONS)
@pytest.mark.parametrize("share", [0.1, 0.5, 0.99])
def test_frequency_solves_the_printed_equation(horizon: int, share: float) -> None:
    courant = share * courant_limit(horizon)
    phase = np.linspace(0.01, np.pi, 200)
    # each side is a sum of up to m terms that come to at most 2: (m + 10) roundings of 2
    found = np.cos(lattice(horizon, courant).frequency(phase) * courant) - 1.0
    np.testing.assert_allclose(
        found, courant**2 * printed_sum(horizon, phase), rtol=0, atol=(horizon + 10) * 2.0 * np.finfo(float).eps
    )


def test_units_are_those_of_spacing_step_and_speed() -> None:
    small = Lattice(3, spacing=0.005, time_step=1e-6, wave_speed=2763.0)
    phase = np.array([0.0, 0.3, 2.0])
    plain = lattice(3, small.courant)
    assert small.courant == pytest.approx(0.5526, rel=1e-15)
    np.testing.assert_allclose(small.frequency(phase / 0.005), plain.frequency(phase) * 2763.0 / 0.005, rtol=1e-14)
    np.testing.assert_allclose(small.group_velocity(phase / 0.005), plain.group_velocity(phase) * 2763.0, rtol=1e-14)


def test_central_differences_at_the_limit_have_no_dispersion() -> None:
    plain = lattice(1, 1.0)
    phase = np.linspace(0.01, 3.0, 100)
    # arcsin multiplies roundings by tan(θ/2) ≤ 14, the square root of 1 − s² by its square, 200
    np.testing.assert_allclose(plain.phase_velocity(phase), 1.0, rtol=1e-13)
    np.testing.assert_allclose(plain.group_velocity(phase), 1.0, rtol=1e-12)


@pytest.mark.parametrize("horizon", HORIZONS)
@pytest.mark.parametrize("courant", [0.0, 0.5, 0.9])
def test_leading_error_of_long_waves(horizon: int, courant: float) -> None:
    phase = 0.01 / horizon
    leading = -(phase**2) * ((horizon**2 + 1) / 2 - courant**2) / 24.0
    # the next term of the series is below (mθ)⁴/100, and the leading one above (mθ)²/24 times 0.19 (m = 1, ν = 0.9)
    relative = (phase * horizon) ** 2 * 24.0 / 19.0
    speeds = lattice(horizon, courant)
    assert speeds.phase_velocity(phase) - 1.0 == pytest.approx(leading, rel=relative)
    # ω = ck(1 + e k²) has the slope c(1 + 3e k²), and in the next term 5 stands for 3
    assert speeds.group_velocity(phase) - 1.0 == pytest.approx(3.0 * leading, rel=5.0 / 3.0 * relative)


@pytest.mark.parametrize("horizon", HORIZONS)
def test_nothing_cancels_in_very_long_waves(horizon: int) -> None:
    phase = np.array([0.0, 1e-12, 1e-8]) / horizon  # there L's cosines differ from 1 by rounding only
    # dispersion itself is (mθ)²/24 < 1e-17
    np.testing.assert_allclose(lattice(horizon, 0.5).frequency(phase), phase, rtol=1e-14)
    np.testing.assert_allclose(lattice(horizon, 0.5).group_velocity(phase), 1.0, rtol=1e-14)


@pytest.mark.parametrize("horizon", HORIZONS)
def test_group_velocity_is_the_slope_of_the_frequency(horizon: int) -> None:
    speeds = lattice(horizon, 0.9 * courant_limit(horizon))
    for low, high in ((0.1, 0.5), (0.5, 1.3), (1.3, 3.1)):
        rise = quad(speeds.group_velocity, low, high, epsabs=0.0, epsrel=1e-12)[0]
        # frequencies of up to π/ν are subtracted, each good to a few roundings
        assert rise == pytest.approx(float(speeds.frequency(high) - speeds.frequency(low)), rel=1e-11, abs=1e-14)


@pytest.mark.parametrize("horizon", range(1, 13))
def test_shortest_wave_is_the_first_to_grow(horizon: int) -> None:
    phase = np.linspace(0.0, np.pi, 20001)
    largest = -0.5 * printed_sum(horizon, phase)
    # at a maximum with roundings of a sum of m terms; its place is flat to the fourth order for even m
    assert largest[-1] >= largest.max() - horizon * np.finfo(float).eps
    assert courant_limit(horizon) == pytest.approx(1.0 / np.sqrt(largest.max()), rel=1e-14)
    assert np.all(np.diff(lattice(horizon, 0.0).frequency(phase)) > -1e-14)


@pytest.mark.parametrize(("horizon", "limit"), [(1, 1.000), (2, 1.414), (3, 1.964), (5, 2.953), (10, 5.289)])
def test_known_limits(horizon: int, limit: float) -> None:
    assert courant_limit(horizon) == pytest.approx(limit, abs=5e-4)  # printed to three digits


@pytest.mark.parametrize("horizon", HORIZONS)
def test_waves_that_grow_have_no_frequency(horizon: int) -> None:
    limit = courant_limit(horizon)
    at, above = lattice(horizon, limit), lattice(horizon, limit * (1.0 + 1e-9))
    assert at.stable
    # sin(ωΔt/2) is 1 within a few roundings, its angle within their square root
    assert at.frequency(np.pi) * limit == pytest.approx(np.pi, rel=1e-7)
    assert not above.stable
    for speeds in (above.frequency, above.phase_velocity, above.group_velocity):
        assert np.isnan(speeds(np.pi))
        assert np.isfinite(speeds(0.1))


@pytest.mark.parametrize("horizon", HORIZONS)
def test_no_step_is_the_limit_of_short_steps(horizon: int) -> None:
    phase = np.linspace(0.0, 3.0, 50)
    # they differ by a part s²/6 of the phase velocity and s²/2 of the group velocity, s ≤ 1e-6
    np.testing.assert_allclose(
        lattice(horizon, 0.0).phase_velocity(phase), lattice(horizon, 1e-6).phase_velocity(phase), rtol=1e-12
    )
    np.testing.assert_allclose(
        lattice(horizon, 0.0).group_velocity(phase), lattice(horizon, 1e-6).group_velocity(phase), rtol=1e-12
    )


@pytest.mark.parametrize("horizon", HORIZONS)
@pytest.mark.parametrize("share", [0.0, 0.5, 0.9])
@pytest.mark.parametrize("of", ["phase", "group"])
def test_wavelengths_of_so_many_cells_and_all_longer_ones_keep_to_the_error(horizon: int, share: float, of) -> None:
    courant = share * courant_limit(horizon)
    cells = cells_per_wavelength(horizon, courant, of=of)
    speeds = lattice(horizon, courant)
    speed = speeds.phase_velocity if of == "phase" else speeds.group_velocity
    phase = 2.0 * np.pi / cells
    assert abs(float(speed(phase)) - 1.0) == pytest.approx(0.01, rel=1e-9)  # brentq's 1e-12 of a phase, twice over
    assert np.all(np.abs(speed(np.linspace(0.0, 0.999 * phase, 1000)) - 1.0) < 0.01)
    assert abs(float(speed(1.001 * phase)) - 1.0) > 0.01


@pytest.mark.parametrize("horizon", HORIZONS)
@pytest.mark.parametrize(("of", "times"), [("phase", 1.0), ("group", 3.0)])
def test_small_errors_follow_the_leading_term(horizon: int, of, times: float) -> None:
    error, courant = 1e-6, 0.5
    expected = 2.0 * np.pi * np.sqrt(times * ((horizon**2 + 1) / 2 - courant**2) / (24.0 * error))
    # (mθ)² ≤ 48·error, so the next term, below (mθ)⁴/100, is below 24·error of the leading one; in the group velocity
    # it is five times as large, at a third of (mθ)². Half of it goes into the wavelength
    assert cells_per_wavelength(horizon, courant, error, of) == pytest.approx(expected, rel=12.0 * error)


@pytest.mark.parametrize("horizon", HORIZONS)
def test_shares_of_the_usual_bonds_make_no_difference(horizon: int) -> None:
    shares = usual_shares(horizon)
    courant = 0.9 * courant_limit(horizon)
    usual, given = lattice(horizon, courant), Lattice(horizon, 1.0, courant, 1.0, shares)
    phase = np.linspace(0.0, 3.1, 200)

    # sums of m terms of order 1; of the group velocity the closed form vanishes where the sum has its rounding
    np.testing.assert_allclose(given.frequency(phase), usual.frequency(phase), rtol=1e-13 * horizon)
    np.testing.assert_allclose(given.group_velocity(phase), usual.group_velocity(phase), atol=1e-13 * horizon)
    assert given.courant_limit == pytest.approx(courant_limit(horizon), rel=1e-12)
    assert cells_per_wavelength(horizon, courant, shares=shares) == pytest.approx(
        cells_per_wavelength(horizon, courant), rel=1e-10
    )


def test_bonds_of_two_spacings_alone_are_a_bar_of_twice_the_spacing() -> None:
    double, single = Lattice(2, 1.0, 1.5, 1.0, (0.0, 1.0)), Lattice(1, 2.0, 1.5, 1.0)
    wavenumber = np.linspace(0.0, 1.5, 50)

    # its waves of four spacings are the first to grow, not those of two
    assert double.courant_limit == pytest.approx(2.0, rel=1e-12)
    np.testing.assert_allclose(double.frequency(wavenumber), single.frequency(wavenumber), rtol=1e-14)
    np.testing.assert_allclose(double.group_velocity(wavenumber), single.group_velocity(wavenumber), rtol=1e-12)


@pytest.mark.parametrize("of", ["phase", "group"])
def test_a_bar_without_error_needs_two_cells(of) -> None:
    assert cells_per_wavelength(1, 1.0, of=of) == 2.0


def test_what_makes_no_sense_is_refused() -> None:
    for numbers in ((0, 1.0, 1.0, 1.0), (1, 0.0, 1.0, 1.0), (1, 1.0, -1.0, 1.0), (1, 1.0, 1.0, np.inf)):
        with pytest.raises(ValueError, match="must"):
            Lattice(*numbers)
    for shares in ((1.0,), (0.4, 0.5)):
        with pytest.raises(ValueError, match="shares"):
            Lattice(2, 1.0, 1.0, 1.0, shares)
    with pytest.raises(ValueError, match=r"Courant number \(1.01\) must not be above 1"):
        cells_per_wavelength(1, 1.01)
    with pytest.raises(ValueError, match="error"):
        cells_per_wavelength(1, 0.5, error=1.0)
