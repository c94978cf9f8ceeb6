"""Lamb's problem against the formulas evaluated otherwise, its Laplace transform and its static limits."""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from dembound.exact import rayleigh_speed, surface_displacement

DENSITY, P_SPEED, DISTANCE = 2500.0, 300.0, 10.0
S_SPEEDS = [P_SPEED / math.sqrt(2.0), P_SPEED / math.sqrt(3.0), P_SPEED / 2.0, P_SPEED / 10.0]
"""Poisson's ratio 0, 1/4, 1/3 and 0.495."""

Load = Callable[[np.ndarray], np.ndarray]


def splines(t: np.ndarray) -> np.ndarray:
    """Z eq. 19 with T0 = 0.5 s, P0 = 450 kN: cubics that join with a jump in the third derivative."""
    knots = np.maximum(np.asarray(t)[..., None] / 0.5 - np.arange(5) / 4.0, 0.0)
    return 450e3 * 16.0 * (knots**3 @ np.array([1.0, -4.0, 6.0, -4.0, 1.0]))


def decaying(t: np.ndarray) -> np.ndarray:
    return (t / 0.02) ** 3 * np.exp(-t / 0.02)


def displacement(times: np.ndarray, load: Load, s_speed: float, tolerance: float = 1e-6) -> np.ndarray:
    return surface_displacement(times, DISTANCE, load, DENSITY, P_SPEED, s_speed, tolerance)


@pytest.mark.parametrize("poisson", [-0.4, -0.1, 0.1, 0.3, 0.4, 0.4999])
def test_rayleigh_speed_is_where_rayleighs_function_vanishes(poisson: float) -> None:
    ratio = (1.0 - 2.0 * poisson) / (2.0 - 2.0 * poisson)

    def function(speed: float) -> float:
        return (2.0 - speed**2) ** 2 - 4.0 * math.sqrt((1.0 - ratio * speed**2) * (1.0 - speed**2))

    speed = rayleigh_speed(1.0 / math.sqrt(ratio), 1.0)
    assert function(speed * (1.0 - 1e-12)) < 0.0 < function(speed * (1.0 + 1e-12))


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


def test_what_is_not_a_half_space_is_refused() -> None:
    with pytest.raises(ValueError, match="speeds must be"):
        rayleigh_speed(100.0, 100.0)
    for distance, density, s_speed, said in (
        (1.0, 2500.0, 0.0, "speeds must be"),
        (0.0, 2500.0, 100.0, "must be positive"),
        (1.0, -1.0, 100.0, "must be positive"),
    ):
        with pytest.raises(ValueError, match=said):
            surface_displacement(np.array([1.0]), distance, splines, density, 300.0, s_speed)
