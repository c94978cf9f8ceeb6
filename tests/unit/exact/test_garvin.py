"""A buried line explosion: Laplace transform, equations, free surface, full space, reciprocity and rest."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from dembound.exact import Solid, buried_explosion, cavity_moment, cavity_motion, rayleigh_speed

DEPTH, PERIOD, MOMENT = 10.0, 0.03, 1e9
SOLIDS = [Solid(2500.0, 1000.0, 1000.0 * share) for share in (math.sqrt(0.5), 0.6, 0.3)]
"""Poisson's ratio 0, 0.22 and 0.45."""


def rate(t: np.ndarray) -> np.ndarray:
    """The moment rises to MOMENT within PERIOD; smooth up to the rate's fifth derivative."""
    return MOMENT * 3.2 / PERIOD * np.where(t < PERIOD, np.sin(math.pi * np.clip(t / PERIOD, 0.0, 1.0)) ** 6, 0.0)


def moved(times: np.ndarray, x: float, z: float, solid: Solid, depth: float = DEPTH) -> np.ndarray:
    return buried_explosion(times, x, z, depth, rate, solid, 1e-7)


@pytest.mark.parametrize(("solid", "x"), [(SOLIDS[0], 4.0), (SOLIDS[1], 40.0), (SOLIDS[2], 4.0)])
def test_laplace_transform_is_the_solution_in_wave_numbers(solid: Solid, x: float) -> None:
    """Signs, factors and the Rayleigh wave, from the problem before its inversion."""
    s = 60.0
    a, b = 1.0 / solid.p_wave_speed, 1.0 / solid.s_wave_speed
    arrivals = [a * math.hypot(x, DEPTH), b * x + DEPTH * a, x / rayleigh_speed(1 / a, 1 / b) + 2.0 * PERIOD]
    marks = np.concatenate([np.linspace(*ends, 15) for ends in pairwise(sorted([*arrivals, arrivals[-1] + 0.35]))])
    nodes, weights = np.polynomial.legendre.leggauss(16)
    half = 0.5 * np.diff(marks)[:, None]
    times = (marks[:-1, None] + half * (1.0 + nodes)).ravel()
    transform = moved(times, x, 0.0, solid) @ ((half * weights).ravel() * np.exp(-s * times))
    # beyond the last mark the motion is at rest but for (b h/t)² = 1 %: the rest of the integral of a constant
    rest = moved(marks[-1:], x, 0.0, solid)[:, 0] * math.exp(-s * marks[-1]) / s

    def fractions(q: float) -> np.ndarray:
        """4qη_b b²/R and 2Γb²/R at p = iq, with e^{−sη_a h}."""
        eta_a, eta_b, gamma = math.sqrt(a**2 + q**2), math.sqrt(b**2 + q**2), b**2 + 2.0 * q**2
        rayleigh = gamma**2 - 4.0 * q**2 * eta_a * eta_b
        return 2.0 * b**2 / rayleigh * math.exp(-s * eta_a * DEPTH) * np.array([2.0 * q * eta_b, -gamma])

    last = 60.0 / (s * DEPTH)  # e^(−60)
    along, _ = quad(lambda q: fractions(q)[0], 0.0, last, weight="sin", wvar=s * x, limit=500, epsabs=0.0)
    down, _ = quad(lambda q: fractions(q)[1], 0.0, last, weight="cos", wvar=s * x, limit=500, epsabs=0.0)
    t = np.linspace(0.0, PERIOD, 2001)
    source = np.trapezoid(rate(t) * np.exp(-s * t), t)
    expected = source / (2.0 * math.pi * solid.uniaxial) * np.array([along, down])
    # the last mark weighs e^(−60·0.35) = 8e-10 of the pulse's end; the quadratures are asked for 1e-7 of the largest
    np.testing.assert_allclose(transform + rest, expected, rtol=0.0, atol=1e-5 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("solid", "x", "z"),
    [pytest.param(SOLIDS[0], 7.0, 4.0, marks=pytest.mark.slow), (SOLIDS[1], 0.0, 3.0), (SOLIDS[2], 12.0, 25.0)],
)
def test_interior_obeys_newtons_law(solid: Solid, x: float, z: float) -> None:
    """It tends to the motion of the surface, by which both reflected waves are known."""
    h, step = 0.05, 0.25e-3
    times = (np.linspace(0.004, 0.15, 25)[:, None] + step * np.arange(-1, 2)).ravel()
    steps = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)]
    u = np.stack([moved(times, x + h * i, z + h * j, solid) for i, j in steps])
    xx, zz, xz = u[1] - 2.0 * u[0] + u[2], u[3] - 2.0 * u[0] + u[4], 0.25 * (u[5] - u[6] - u[7] + u[8])
    force = solid.shear * (xx + zz) + (solid.lame + solid.shear) * np.stack([xx[0] + xz[1], xz[0] + zz[1]])
    second = (u[0][:, 2::3] - 2.0 * u[0][:, 1::3] + u[0][:, ::3]) / step**2
    size = np.abs(second).max() * solid.density
    # differences err by (2π·0.25e-3·3/0.03)²/12 = 2e-3 in time; in space, near the source or the surface, by some
    # (h/3 m)² = 3e-4; the quadrature's 1e-7 of u becomes 1e-7/(h k)² = 1e-4
    np.testing.assert_allclose(force[:, 1::3] / h**2, solid.density * second, rtol=0.0, atol=5e-3 * size)
    top, below = (moved(times[1::3], x, depth, solid) for depth in (0.0, 1e-6))
    np.testing.assert_allclose(below, top, rtol=0.0, atol=1e-5 * np.abs(top).max())


def test_before_echoes_it_is_the_cavity_with_the_same_moment() -> None:
    """A pressure in a hole and its moment, through Cagniard's integral, against the cavity's transform."""
    solid, radius, deep, distance = SOLIDS[1], 5.0, 400.0, 30.0
    advance = radius / solid.p_wave_speed

    def pressure(t: np.ndarray) -> np.ndarray:
        return 1e6 * np.where(t < PERIOD, np.sin(math.pi * np.clip(t / PERIOD, 0.0, 1.0)) ** 6, 0.0)

    times = np.linspace(0.0, 0.12, 61)
    source = np.linspace(-advance, 0.12, 2001)
    moment = cavity_moment(source, pressure, radius, solid)
    motion = cavity_motion(times, distance, pressure, radius, solid)
    direction = np.array([0.6, -0.8])
    place = distance * direction + [0.0, deep]
    for derivative, history in ((1, motion.displacement), (2, motion.velocity)):

        def signal(t: np.ndarray, values: np.ndarray = moment[derivative]) -> np.ndarray:
            return np.interp(t, source + advance, values)

        found = buried_explosion(times + advance, *place, deep, signal, solid, 1e-5)
        # linear interpolation over 60 µs of a pulse of 10 ms errs by (2π·60e-6/0.01)²/8 = 2e-4
        np.testing.assert_allclose(found, direction[:, None] * history, rtol=0.0, atol=5e-4 * np.abs(history).max())


def test_what_is_no_buried_source_is_refused() -> None:
    times = np.array([0.1])
    with pytest.raises(ValueError, match="depths must be"):
        moved(times, 1.0, 0.0, SOLIDS[0], depth=0.0)
    with pytest.raises(ValueError, match="depths must be"):
        moved(times, 1.0, -1.0, SOLIDS[0])
    with pytest.raises(ValueError, match="at the source"):
        moved(times, 0.0, DEPTH, SOLIDS[0])
    with pytest.raises(RuntimeError, match="did not converge"):
        buried_explosion(np.array([0.5]), 3.0, 0.0, DEPTH, lambda t: 1.0 * (t < 0.1), SOLIDS[0], 1e-14)
