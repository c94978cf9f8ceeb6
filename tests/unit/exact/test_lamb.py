"""Lamb's problem, at and below the surface, and a buried explosion: Laplace transforms, equations, full space."""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from dembound.exact import (
    Solid,
    buried_displacement,
    buried_explosion,
    cavity_moment,
    cavity_motion,
    rayleigh_speed,
    surface_displacement,
)

DENSITY, P_SPEED, DISTANCE = 2500.0, 300.0, 10.0
S_SPEEDS = [P_SPEED / math.sqrt(2.0), P_SPEED / math.sqrt(3.0), P_SPEED / 2.0, P_SPEED / 10.0]
"""Poisson's ratio 0, 1/4, 1/3 and 0.495."""

Load = Callable[[np.ndarray], np.ndarray]


def decaying(t: np.ndarray) -> np.ndarray:
    return (t / 0.02) ** 3 * np.exp(-t / 0.02)


def quadrature(marks: list[float], order: int) -> tuple[np.ndarray, np.ndarray]:
    """Times and weights of Gauss's quadrature in as many panels between two marks, less one."""
    ends = np.concatenate([np.linspace(*each, order) for each in pairwise(marks)])
    nodes, weights = np.polynomial.legendre.leggauss(order)
    half = 0.5 * np.diff(ends)[:, None]
    return (ends[:-1, None] + half * (1.0 + nodes)).ravel(), (half * weights).ravel()


def in_wave_numbers(fractions: Callable, end: float, **options: float) -> np.ndarray:
    """Integrals over wave numbers of motion along the surface, by a sine, and across it, by a cosine."""
    along = quad(lambda q: fractions(q)[0], 0.0, end, weight="sin", **options)[0]
    return np.array([along, quad(lambda q: fractions(q)[1], 0.0, end, weight="cos", **options)[0]])


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
    times, weights = quadrature([*arrivals, arrivals[-1] + 28.0 / rate], 20)
    transform = displacement(times, decaying, s_speed, tolerance=1e-9) @ (weights * np.exp(-rate * times))

    def fractions(q: float) -> np.ndarray:
        """Give q (1 + 2q² − 2ν_aν_b)/R and ν_a/R, R = (1 + 2q²)² − 4q²ν_aν_b, written so that nothing cancels."""
        nu_a, nu_b = math.sqrt(ratio + q**2), math.sqrt(1.0 + q**2)
        excess = (ratio + (1.0 + ratio) * q**2) / (nu_a * nu_b + q**2)  # ν_aν_b − q²
        rayleigh = 1.0 + 4.0 * q**2 * (1.0 - excess)
        return np.array([q * (1.0 - 2.0 * excess), nu_a]) / rayleigh

    load = 6.0 * 0.02 / (1.0 + rate * 0.02) ** 4
    both = in_wave_numbers(fractions, math.inf, wvar=rate * DISTANCE / s_speed, epsabs=1e-10, limlst=200)
    expected = load / (math.pi * mu) * both
    # all quadratures are asked for 1e-9 of the largest u; e^(−rate·t) weighs early errors at most e^(rate·0.3) = 400
    # times more than the later u that makes up most of the transform
    assert transform == pytest.approx(expected, rel=1e-6, abs=0.0)


def test_a_source_that_jumps_does_not_converge() -> None:
    with pytest.raises(RuntimeError, match="did not converge"):
        buried_explosion(np.array([0.5]), 3.0, 0.0, DEPTH, lambda t: 1.0 * (t < 0.1), SOLIDS[0], 1e-14)


@pytest.mark.parametrize(
    ("ratio", "depth"), [pytest.param(0.5, 0.25, marks=pytest.mark.slow), (0.5, 8.0), (0.25, 3.0), (0.25, 20.0)]
)
def test_below_the_surface_too(ratio: float, depth: float) -> None:
    """With a head wave, and at 20 m without; ratio : (c_s/c_p)²."""
    solid, rate = Solid(DENSITY, P_SPEED, P_SPEED * math.sqrt(ratio)), 20.0
    s_speed, length = solid.s_wave_speed, math.hypot(DISTANCE, depth)
    head = DISTANCE / P_SPEED + depth * math.sqrt(s_speed**-2 - P_SPEED**-2)
    arrivals = sorted([length / P_SPEED, head, length / s_speed, DISTANCE / rayleigh_speed(P_SPEED, s_speed)])
    # e^(−rate·t) has fallen below 1e-12 after 28/rate
    times, weights = quadrature([*arrivals, arrivals[-1] + 28.0 / rate], 20)
    u = buried_displacement(times, DISTANCE, depth, decaying, solid, tolerance=1e-8)
    transform = u @ (weights * np.exp(-rate * times))

    def fractions(q: float) -> tuple[float, float]:
        """Along x and z, in units of 1/c_s: P and S fade as e^(−νz)."""
        nu_a, nu_b = math.sqrt(ratio + q**2), math.sqrt(1.0 + q**2)
        gamma = 1.0 + 2.0 * q**2
        p, s = (math.exp(-nu * rate * depth / s_speed) / (gamma**2 - 4.0 * q**2 * nu_a * nu_b) for nu in (nu_a, nu_b))
        return q * (gamma * p - 2.0 * nu_a * nu_b * s), nu_a * (gamma * p - 2.0 * q**2 * s)

    end, wave = 40.0 * s_speed / (rate * depth), rate * DISTANCE / s_speed
    load = 6.0 * 0.02 / (1.0 + rate * 0.02) ** 4
    both = in_wave_numbers(fractions, end, wvar=wave, epsabs=1e-11, limit=1000)
    expected = load / (math.pi * DENSITY * s_speed**2) * both
    assert transform == pytest.approx(expected, rel=2e-6, abs=0.0)


DEPTH, PERIOD, MOMENT = 10.0, 0.03, 1e9
SOLIDS = [Solid(2500.0, 1000.0, 1000.0 * share) for share in (math.sqrt(0.5), 0.6, 0.3)]
"""Poisson's ratio 0, 0.22 and 0.45."""


def rate(t: np.ndarray) -> np.ndarray:
    """The moment rises to MOMENT within PERIOD; smooth up to the rate's fifth derivative."""
    return MOMENT * 3.2 / PERIOD * np.where(t < PERIOD, np.sin(math.pi * np.clip(t / PERIOD, 0.0, 1.0)) ** 6, 0.0)


def moved(times: np.ndarray, x: float, z: float, solid: Solid, depth: float = DEPTH) -> np.ndarray:
    return buried_explosion(times, x, z, depth, rate, solid, 1e-7)


@pytest.mark.parametrize(("solid", "x"), [(SOLIDS[0], 4.0), (SOLIDS[1], 40.0), (SOLIDS[2], 4.0)])
def test_the_transform_of_an_explosion_is_the_solution_in_wave_numbers(solid: Solid, x: float) -> None:
    """Signs, factors and the Rayleigh wave, from the problem before its inversion."""
    s = 60.0
    a, b = 1.0 / solid.p_wave_speed, 1.0 / solid.s_wave_speed
    arrivals = [a * math.hypot(x, DEPTH), b * x + DEPTH * a, x / rayleigh_speed(1 / a, 1 / b) + 2.0 * PERIOD]
    end = arrivals[-1] + 0.35
    times, weights = quadrature(sorted([*arrivals, end]), 16)
    transform = moved(times, x, 0.0, solid) @ (weights * np.exp(-s * times))
    # beyond the last mark the motion is at rest but for (b h/t)² = 1 %: the rest of the integral of a constant
    rest = moved(np.array([end]), x, 0.0, solid)[:, 0] * math.exp(-s * end) / s

    def fractions(q: float) -> np.ndarray:
        """4qη_b b²/R and 2Γb²/R at p = iq, with e^{−sη_a h}."""
        eta_a, eta_b, gamma = math.sqrt(a**2 + q**2), math.sqrt(b**2 + q**2), b**2 + 2.0 * q**2
        rayleigh = gamma**2 - 4.0 * q**2 * eta_a * eta_b
        return 2.0 * b**2 / rayleigh * math.exp(-s * eta_a * DEPTH) * np.array([2.0 * q * eta_b, -gamma])

    both = in_wave_numbers(fractions, 60.0 / (s * DEPTH), wvar=s * x, limit=500, epsabs=0.0)  # e^(−60)
    t = np.linspace(0.0, PERIOD, 2001)
    source = np.trapezoid(rate(t) * np.exp(-s * t), t)
    expected = source / (2.0 * math.pi * solid.uniaxial) * both
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
