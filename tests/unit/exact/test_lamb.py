"""Lamb's problem against the formulas evaluated otherwise, its Laplace transform and its static limits."""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from dembound.exact import rayleigh_speed, surface_displacement
from dembound.exact.lamb import _kernel

DENSITY, P_SPEED, DISTANCE = 2500.0, 300.0, 10.0
S_SPEEDS = [P_SPEED / math.sqrt(2.0), P_SPEED / math.sqrt(3.0), P_SPEED / 2.0, P_SPEED / 10.0]
"""Poisson's ratio 0, 1/4, 1/3 and 0.495."""

Load = Callable[[np.ndarray], np.ndarray]


def splines(t: np.ndarray) -> np.ndarray:
    """Z eq. 19 with T0 = 0.5 s, P0 = 450 kN: cubics that join with a jump in the third derivative."""
    knots = np.maximum(np.asarray(t)[..., None] / 0.5 - np.arange(5) / 4.0, 0.0)
    return 450e3 * 16.0 * (knots**3 @ np.array([1.0, -4.0, 6.0, -4.0, 1.0]))


def triangle(t: np.ndarray) -> np.ndarray:
    return np.interp(t, [0.0, 0.25, 0.5], [0.0, 450e3, 0.0])


def decaying(t: np.ndarray) -> np.ndarray:
    return (t / 0.02) ** 3 * np.exp(-t / 0.02)


def displacement(times: np.ndarray, load: Load, s_speed: float, tolerance: float = 1e-6) -> np.ndarray:
    return surface_displacement(times, DISTANCE, load, DENSITY, P_SPEED, s_speed, tolerance)


@pytest.mark.parametrize(
    ("p_over_s", "square"),
    [
        (math.sqrt(2.0), 3.0 - math.sqrt(5.0)),  # ν = 0: the cubic is (ξ − 2)(ξ² − 6ξ + 4)
        (math.sqrt(3.0), 2.0 - 2.0 / math.sqrt(3.0)),  # ν = 1/4: (ξ − 4)(ξ² − 4ξ + 8/3)
    ],
)
def test_rayleigh_speeds_in_closed_form(p_over_s: float, square: float) -> None:
    # the root is found to 1e-15, and ξ's slope to the cubic's rounding errors is below 1
    assert rayleigh_speed(200.0 * p_over_s, 200.0) == pytest.approx(200.0 * math.sqrt(square), rel=1e-14)


@pytest.mark.parametrize("poisson", [-0.4, -0.1, 0.1, 0.3, 0.4, 0.4999])
def test_rayleigh_speed_is_where_rayleighs_function_vanishes(poisson: float) -> None:
    ratio = (1.0 - 2.0 * poisson) / (2.0 - 2.0 * poisson)

    def function(speed: float) -> float:
        return (2.0 - speed**2) ** 2 - 4.0 * math.sqrt((1.0 - ratio * speed**2) * (1.0 - speed**2))

    speed = rayleigh_speed(1.0 / math.sqrt(ratio), 1.0)
    assert function(speed * (1.0 - 1e-12)) < 0.0 < function(speed * (1.0 + 1e-12))


@pytest.mark.parametrize("s_speed", S_SPEEDS)
def test_vertical_kernel_is_the_formula(s_speed: float) -> None:
    kernel = _kernel(P_SPEED, s_speed)
    for p in [*np.linspace(math.sqrt(kernel.ratio), 1.0, 7)[1:-1], 1.01, 1.5, 40.0]:
        fractions = complex_fractions(p, kernel.ratio)
        # at p = 40 the formula loses R's leading terms of 16p⁸: 4p² = 6400 times eps
        assert kernel.vertical(p) / (p - kernel.pole) == pytest.approx(fractions[1].imag, rel=1e-11)
        assert kernel.horizontal(p) == pytest.approx(fractions[0].imag, rel=1e-11, abs=1e-11)


def complex_fractions(p: float, ratio: float) -> tuple[complex, complex]:
    """The two fractions in square brackets of the module's text, p and a in units of b."""
    eta_a, eta_b = (np.conj(np.sqrt(complex(square - p**2))) for square in (ratio, 1.0))
    rayleigh = (1.0 - 2.0 * p**2) ** 2 + 4.0 * p**2 * eta_a * eta_b
    return p * (1.0 - 2.0 * p**2 - 2.0 * eta_a * eta_b) / rayleigh, eta_a / rayleigh


@pytest.mark.parametrize("s_speed", S_SPEEDS)
@pytest.mark.parametrize("time", [0.06, 0.3, 0.5, 0.6])
def test_principal_value_as_another_quadrature_finds_it(s_speed: float, time: float) -> None:
    kernel, s_arrival = _kernel(P_SPEED, s_speed), DISTANCE / s_speed
    last = time / s_arrival

    def integrand(p: float) -> float:
        return float(splines(np.array(time - p * s_arrival))) * complex_fractions(p, kernel.ratio)[1].imag

    def without_pole(p: float) -> float:
        return integrand(p) * (p - kernel.pole) if p != kernel.pole else 0.0

    joints = [(time - knot) / s_arrival for knot in (0.125, 0.25, 0.375, 0.5)]
    marks = sorted({math.sqrt(kernel.ratio), 1.0, 2.0 * kernel.pole - 1.0, last, *joints})
    total = 0.0
    for low, high in pairwise(mark for mark in marks if max(math.sqrt(kernel.ratio), joints[-1]) <= mark <= last):
        if low < kernel.pole < high:
            total += quad(without_pole, low, high, weight="cauchy", wvar=kernel.pole, limit=200)[0]
        else:
            total += quad(integrand, low, high, epsabs=0.0, limit=200)[0]
    expected = total / (math.pi * DENSITY * s_speed**2)

    # the other quadrature asks 1.5e-8 of each piece; the pieces are at most some tens of times their sum
    vertical = displacement(np.array([time]), splines, s_speed, tolerance=1e-9)[1, 0]
    assert vertical == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("s_speed", S_SPEEDS)
def test_laplace_transform_is_the_solution_in_wave_numbers(s_speed: float) -> None:
    """Signs, factors and the Rayleigh wave's share, from the problem before its inversion."""
    rate, ratio, mu = 20.0, (s_speed / P_SPEED) ** 2, DENSITY * s_speed**2
    arrivals = [DISTANCE / speed for speed in (P_SPEED, s_speed, rayleigh_speed(P_SPEED, s_speed))]
    # e^(−rate·t) has fallen below 1e-12 after 28/rate; u is smooth between the arrivals
    marks = np.concatenate([np.linspace(*ends, 20) for ends in pairwise([*arrivals, arrivals[-1] + 28.0 / rate])])
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = 0.5 * np.diff(marks)[:, None]
    times = (marks[:-1, None] + half * (1.0 + nodes)).ravel()
    u = displacement(times, decaying, s_speed, tolerance=1e-9)
    transform = u @ ((half * weights).ravel() * np.exp(-rate * times))

    def fractions(q: float) -> np.ndarray:
        """Give q (1 + 2q² − 2ν_aν_b)/R and ν_a/R, R = (1 + 2q²)² − 4q²ν_aν_b, written so that nothing cancels."""
        nu_a, nu_b = math.sqrt(ratio + q**2), math.sqrt(1.0 + q**2)
        excess = (ratio + (1.0 + ratio) * q**2) / (nu_a * nu_b + q**2)  # ν_aν_b − q²
        rayleigh = 1.0 + 4.0 * q**2 * (1.0 - excess)
        return np.array([q * (1.0 - 2.0 * excess), nu_a]) / rayleigh

    options = {"wvar": rate * DISTANCE / s_speed, "epsabs": 1e-10, "limlst": 200}
    horizontal, _ = quad(lambda q: fractions(q)[0], 0.0, math.inf, weight="sin", **options)
    vertical, _ = quad(lambda q: fractions(q)[1], 0.0, math.inf, weight="cos", **options)
    load = 6.0 * 0.02 / (1.0 + rate * 0.02) ** 4
    expected = load / (math.pi * mu) * np.array([horizontal, vertical])
    # all quadratures are asked for 1e-9 of the largest u; e^(−rate·t) weighs early errors at most e^(rate·0.3) = 400
    # times more than the later u that makes up most of the transform
    assert transform == pytest.approx(expected, rel=1e-6, abs=0.0)


@pytest.mark.parametrize("load", [splines, triangle, decaying])
@pytest.mark.parametrize("s_speed", S_SPEEDS)
def test_error_is_below_the_tolerance(load: Load, s_speed: float) -> None:
    times = np.linspace(0.0, 3.0, 101)

    u, finer = (displacement(times, load, s_speed, tolerance) for tolerance in (1e-6, 1e-7))

    assert np.abs(u - finer).max() <= 1e-6 * np.abs(finer).max()


def test_nothing_moves_before_the_p_wave_which_lifts_and_pushes_away() -> None:
    arrival = DISTANCE / P_SPEED

    horizontal, vertical = displacement(arrival * np.array([-1.0, 0.0, 0.999, 1.02]), splines, S_SPEEDS[1])

    assert not horizontal[:3].any()
    assert not vertical[:3].any()
    assert horizontal[3] > 0.0 > vertical[3]


@pytest.mark.parametrize("s_speed", S_SPEEDS)
def test_lasting_load_ends_in_the_static_solution(s_speed: float) -> None:
    """Flamant's: u_x = −(1−2ν)/4μ beside the load, u_z = −(1−ν)/(πμ) ln x + c (Timoshenko & Goodier, section 36)."""
    mu, ratio = DENSITY * s_speed**2, (s_speed / P_SPEED) ** 2
    poisson = (1.0 - 2.0 * ratio) / (2.0 - 2.0 * ratio)
    near, far = (
        surface_displacement(np.array([1e4 * DISTANCE / s_speed]), x, np.ones_like, DENSITY, P_SPEED, s_speed)[:, 0]
        for x in (DISTANCE, 2.0 * DISTANCE)
    )

    # what is left falls as (2x/c_s t)² = 4e-8; the quadrature leaves 1e-6 of two u_z below ln(1e4)/(πμ) = 3/μ each
    left = 1e-5 / mu
    assert near[0] == pytest.approx(-(1.0 - 2.0 * poisson) / (4.0 * mu), abs=left)
    assert near[1] - far[1] == pytest.approx((1.0 - poisson) / (math.pi * mu) * math.log(2.0), abs=left)


def test_what_is_not_a_half_space_is_refused() -> None:
    times = np.array([1.0])
    with pytest.raises(ValueError, match="speeds must be"):
        rayleigh_speed(100.0, 100.0)
    with pytest.raises(ValueError, match="speeds must be"):
        surface_displacement(times, 1.0, splines, 2500.0, 100.0, 0.0)
    with pytest.raises(ValueError, match="must be positive"):
        surface_displacement(times, 0.0, splines, 2500.0, 300.0, 100.0)
    with pytest.raises(ValueError, match="must be positive"):
        surface_displacement(times, 1.0, splines, -1.0, 300.0, 100.0)


def test_tolerance_that_is_not_met_is_told() -> None:
    # a jump on the way leaves an error of the order of one node's share; no number of panels allowed makes it 1e-14
    with pytest.raises(RuntimeError, match="did not converge"):
        displacement(np.array([1.0]), lambda t: 1.0 * (t < 0.5), S_SPEEDS[1], tolerance=1e-14)
