"""Lamb's problem below the surface against its Laplace transform, and towards the surface."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from dembound.exact import Solid, buried_displacement, rayleigh_speed

DENSITY, P_SPEED, DISTANCE = 2500.0, 300.0, 10.0


def decaying(t: np.ndarray) -> np.ndarray:
    return (t / 0.02) ** 3 * np.exp(-t / 0.02)


@pytest.mark.parametrize(
    ("ratio", "depth"), [pytest.param(0.5, 0.25, marks=pytest.mark.slow), (0.5, 8.0), (0.25, 3.0), (0.25, 20.0)]
)
def test_laplace_transform_is_the_solution_in_wave_numbers(ratio: float, depth: float) -> None:
    """With a head wave, and at 20 m without; ratio : (c_s/c_p)²."""
    solid, rate = Solid(DENSITY, P_SPEED, P_SPEED * math.sqrt(ratio)), 20.0
    s_speed, length = solid.s_wave_speed, math.hypot(DISTANCE, depth)
    head = DISTANCE / P_SPEED + depth * math.sqrt(s_speed**-2 - P_SPEED**-2)
    arrivals = sorted([length / P_SPEED, head, length / s_speed, DISTANCE / rayleigh_speed(P_SPEED, s_speed)])
    # e^(−rate·t) has fallen below 1e-12 after 28/rate
    marks = np.concatenate([np.linspace(*ends, 20) for ends in pairwise([*arrivals, arrivals[-1] + 28.0 / rate])])
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = 0.5 * np.diff(marks)[:, None]
    times = (marks[:-1, None] + half * (1.0 + nodes)).ravel()
    u = buried_displacement(times, DISTANCE, depth, decaying, solid, tolerance=1e-8)
    transform = u @ ((half * weights).ravel() * np.exp(-rate * times))

    def fractions(q: float) -> tuple[float, float]:
        """Along x and z, in units of 1/c_s: P and S fade as e^(−νz)."""
        nu_a, nu_b = math.sqrt(ratio + q**2), math.sqrt(1.0 + q**2)
        gamma = 1.0 + 2.0 * q**2
        p, s = (math.exp(-nu * rate * depth / s_speed) / (gamma**2 - 4.0 * q**2 * nu_a * nu_b) for nu in (nu_a, nu_b))
        return q * (gamma * p - 2.0 * nu_a * nu_b * s), nu_a * (gamma * p - 2.0 * q**2 * s)

    end = 40.0 * s_speed / (rate * depth)
    options = {"wvar": rate * DISTANCE / s_speed, "epsabs": 1e-11, "limit": 1000}
    horizontal, _ = quad(lambda q: fractions(q)[0], 0.0, end, weight="sin", **options)
    vertical, _ = quad(lambda q: fractions(q)[1], 0.0, end, weight="cos", **options)
    load = 6.0 * 0.02 / (1.0 + rate * 0.02) ** 4
    expected = load / (math.pi * DENSITY * s_speed**2) * np.array([horizontal, vertical])
    assert transform == pytest.approx(expected, rel=2e-6, abs=0.0)


def test_what_has_no_solution_is_refused() -> None:
    solid, times = Solid(DENSITY, P_SPEED, 200.0), np.array([0.2])
    for distance, depth in ((0.0, 1.0), (1.0, 0.0)):
        with pytest.raises(ValueError, match="must be positive"):
            buried_displacement(times, distance, depth, decaying, solid)
