"""The first longitudinal mode of a round elastic bar: the frequency equation of Pochhammer and Chree.

A wave exp i(kx − ωt) in a bar of radius a satisfies (Pochhammer 1876, Chree 1889; Graff 1975, eq. 8.2.36)

    (2p/a)(q² + k²) J₁(pa) J₁(qa) − (q² − k²)² J₀(pa) J₁(qa) − 4k² p q J₁(pa) J₀(qa) = 0,
    p² = ω²/c_1² − k²,   q² = ω²/c_2² − k²,

with c_1 and c_2 the speeds of P and S waves. Its first mode begins at c_0 = √(E/ρ) for long waves, with Rayleigh's
correction c/c_0 = 1 − ν²π²(a/Λ)², Λ the wavelength, and ends at the speed of Rayleigh waves for short ones.
c/c_0 depends only on a/Λ and Poisson's ratio ν (tables by Bancroft 1941).

Divided by p J₁(pa) J₁(qa), and with F(z²) = z J₀(z)/J₁(z), which is real for negative z², too, it is

    2(q² + k²) − (q² − k²)² F(p²)/p² − 4k² F(q²) = 0,    a = 1.
"""

from functools import lru_cache

import numpy as np

from dembound.exact.lamb import rayleigh_speed

LONG = 1e-3
"""a/Λ below which Rayleigh's correction is used: its error is of the order (a/Λ)⁴, 1e-12."""

SHORT = 3.0
"""Largest a/Λ of the table; beyond it the speed, within 0.5 % of that of Rayleigh waves, is taken as constant."""

POINTS = 300
"""Entries of a table of speeds, between which a spline leaves errors of 1e-7."""

BRACKETS = 400
"""Number of speeds among which the slowest root is sought."""


def phase_speed(ratio: float, poisson: float) -> float:
    """c/c_0 of the first mode at a/Λ = `ratio`.

    Raises ValueError for a negative ratio, and for a ν that is not above 0 and below ½.
    """
    if not (ratio >= 0.0 and 0.0 < poisson < 0.5):
        raise ValueError(f"a/Λ ({ratio}) must not be negative, Poisson's ratio ({poisson}) above 0 and below 0.5")
    if ratio < LONG:
        return float(1.0 - (poisson * np.pi * ratio) ** 2)
    from scipy.optimize import brentq

    speeds = np.linspace(0.9 * short_wave_speed(poisson), 1.0 - 1e-12, BRACKETS)
    values = _equation(speeds, 2.0 * np.pi * ratio, poisson)
    first = int(np.argmax(values[:-1] * values[1:] <= 0.0))  # of all modes of this wavelength the first is the slowest
    bracket = speeds[first], speeds[first + 1]
    return float(brentq(_equation, *bracket, args=(2.0 * np.pi * ratio, poisson), xtol=1e-15, rtol=1e-13))


def short_wave_speed(poisson: float) -> float:
    """Speed of Rayleigh waves over c_0, the limit for short waves."""
    p_wave, s_wave = (
        np.sqrt((1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))),
        np.sqrt(0.5 / (1.0 + poisson)),
    )
    return rayleigh_speed(float(p_wave), float(s_wave))


def wavenumber(frequency: np.ndarray, radius: float, poisson: float, speed: float) -> np.ndarray:
    """Wave numbers k (rad/m) of the first mode at angular frequencies ω ≥ 0 (k,) rad/s.

    Parameters
    ----------
    frequency : rad/s. radius : a, m. poisson : ν. speed : c_0, m/s.

    Above a/Λ = 3 the speed is that at 3.
    """
    from scipy.interpolate import CubicSpline

    reduced, speeds = _table(poisson)
    requested = np.minimum(np.asarray(frequency) * radius / (2.0 * np.pi * speed), reduced[-1])  # (a/Λ)(c/c_0)
    level = ((1, 0.0), "not-a-knot")  # c/c_0 is even in ω
    return np.asarray(frequency) / (speed * CubicSpline(reduced, speeds, bc_type=level)(requested))


@lru_cache(maxsize=4)
def _table(poisson: float) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies ωa/(2πc_0) = (a/Λ)(c/c_0) from 0, and c/c_0."""
    ratios = np.linspace(0.0, SHORT, POINTS)
    speeds = np.array([phase_speed(ratio, poisson) for ratio in ratios])
    return ratios * speeds, speeds


def _equation(speed: np.ndarray, wavenumber: float, poisson: float) -> np.ndarray:
    """The left side of the frequency equation for c/c_0 and ka, with a = 1."""
    square = wavenumber**2
    stiff = (1.0 + poisson) * (1.0 - 2.0 * poisson) / (1.0 - poisson)  # c_0²/c_1²
    p = square * (speed**2 * stiff - 1.0)
    q = square * (speed**2 * 2.0 * (1.0 + poisson) - 1.0)
    return 2.0 * (q + square) - (q - square) ** 2 * _ratio(p) / p - 4.0 * square * _ratio(q)


def _ratio(square: np.ndarray) -> np.ndarray:
    """F(z²) = z J₀(z)/J₁(z), 2 at 0, and y I₀(y)/I₁(y) for z² = −y²."""
    from scipy.special import ive, jv

    size = np.maximum(np.sqrt(np.abs(square)), 1e-8)
    return np.where(square > 0.0, size * jv(0, size) / jv(1, size), size * ive(0, size) / ive(1, size))
