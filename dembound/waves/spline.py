"""The smooth pulse of Zhou et al. 2018, equation 19: a cubic B-spline."""

from typing import Literal

import numpy as np

from dembound.roots import root
from dembound.waves.wave import FADED, Pulse

AREA = 3.0 / 8.0
"""Integral of the spline of unit height and unit length."""

FADE = 4.0 * root(lambda x: float(np.sinc(x)) - FADED**0.25, 0.0, 1.0)
"""Frequency times length at which the spectrum sinc⁴(fT/4), sinc x = sin πx/πx, has faded: 2.952.

All side lobes are below: the first is 0.217⁴ = 0.22 % of the crest.
"""


class CubicSpline(Pulse):
    """v = M·16[G(τ) − 4G(τ−¼) + 6G(τ−½) − 4G(τ−¾) + G(τ−1)], τ = t/T, G(x) = x³ for x > 0, else 0 (Z eq. 19).

    One-sided on 0 ≤ t ≤ T with continuous velocity, acceleration and its rate.

    Notes
    -----
    The pulse is even about its crest, so both halves are taken from the first two terms: there the five do not cancel.
    """

    type: Literal["cubic_spline"]

    def _velocity_shape(self, since: np.ndarray) -> np.ndarray:
        tau = np.clip(since / self.period, 0.0, 1.0)
        return _rise(np.minimum(tau, 1.0 - tau), 3)

    def _displacement_shape(self, since: np.ndarray) -> np.ndarray:
        tau = np.clip(since / self.period, 0.0, 1.0)
        near = 0.25 * _rise(np.minimum(tau, 1.0 - tau), 4)
        return self.period * np.where(tau <= 0.5, near, AREA - near)

    def highest_frequency(self) -> float:
        """Frequency above which the amplitude spectrum stays below 1 % of its largest value, Hz: 2.95/T."""
        return FADE / self.period


def _rise(s: np.ndarray, power: int) -> np.ndarray:
    """16[sⁿ − 4(s−¼)ⁿ], the second term from s = ¼ on, n = power; s within 0…½."""
    return 16.0 * (s**power - 4.0 * np.maximum(s - 0.25, 0.0) ** power)
