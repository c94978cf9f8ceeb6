"""Pulses by formulas: those of Zhou et al. 2018, equations 12 and 19, the triangle, and the Ricker wavelet."""

import math
from typing import Any, Literal

import numpy as np

from dembound.roots import root
from dembound.table import quantity
from dembound.waves.wave import FADED, HANN_FADE, Pulse, Shape


class Cosine(Pulse):
    """One smooth one-sided pulse: v = M/2 · (1 − cos 2πt/T) for 0 ≤ t ≤ T (Z eq. 12)."""

    type: Literal["cosine"]

    def _velocity_shape(self, since: np.ndarray) -> np.ndarray:
        phase = 2.0 * math.pi * np.clip(since / self.period, 0.0, 1.0)
        return 0.5 * (1.0 - np.cos(phase))

    def _displacement_shape(self, since: np.ndarray) -> np.ndarray:
        phase = 2.0 * math.pi * np.clip(since / self.period, 0.0, 1.0)
        return self.period / (4.0 * math.pi) * (phase - np.sin(phase))

    def highest_frequency(self) -> float:
        """Frequency above which the amplitude spectrum stays below 1 % of its largest value, Hz: 3.27/T."""
        return HANN_FADE / self.period


AREA = 3.0 / 8.0
"""Integral of the spline of unit height and unit length."""

SPLINE_FADE = 4.0 * root(lambda x: float(np.sinc(x)) - FADED**0.25, 0.0, 1.0)
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
        return SPLINE_FADE / self.period


def _rise(s: np.ndarray, power: int) -> np.ndarray:
    """16[sⁿ − 4(s−¼)ⁿ], the second term from s = ¼ on, n = power; s within 0…½."""
    return 16.0 * (s**power - 4.0 * np.maximum(s - 0.25, 0.0) ** power)


FADED_AT_LATEST = 2.0 / (math.pi * FADED)
"""Frequency times length above which the spectrum of any triangle is below 1 %, as both sinc terms are at most 1."""

PER_LOBE = 64
"""Samples per lobe of the spectrum: between two of them it rises above both by at most (π/64)²/8 = 0.03 % of itself."""


class Triangle(Shape):
    """One one-sided pulse: v = M t/t_r during the rise t_r, then M(1 − (t − t_r)/t_f) over the fall t_f."""

    type: Literal["triangle"]
    rise: float = quantity(unit="s", means="period", gt=0.0)
    """time from the start to the crest"""
    fall: float = quantity(unit="s", means="period", gt=0.0)
    """time from the crest to the end"""

    def _legs(self, since: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Part of the rise that has passed, and part of the fall that remains."""
        return np.clip(since / self.rise, 0.0, 1.0), np.clip(1.0 - (since - self.rise) / self.fall, 0.0, 1.0)

    def _velocity_shape(self, since: np.ndarray) -> np.ndarray:
        return np.minimum(*self._legs(since))

    def _displacement_shape(self, since: np.ndarray) -> np.ndarray:
        done, to_come = self._legs(since)
        return 0.5 * (self.rise * done**2 + self.fall * (1.0 - to_come**2))

    def _length(self) -> float:
        return self.rise + self.fall

    def peak_time(self) -> float:
        """Time of the crest, s."""
        return self.start + self.rise

    def duration(self) -> float:
        """Time from which the wave is over, s: rise and fall after the start."""
        return self.start + self._length()

    def dominant_frequency(self) -> float:
        """One over the pulse's length, Hz; the spectrum of a one-sided pulse is largest at zero."""
        return 1.0 / self._length()

    def highest_frequency(self) -> float:
        """Frequency above which the amplitude spectrum stays below 1 % of its largest value, Hz.

        Its product with the pulse's length is 5.36 when rise and fall are equal, and up to 31.9 when one of them is
        sudden.
        """
        share = self.rise / self._length()
        products = np.arange(1, math.ceil(FADED_AT_LATEST * PER_LOBE) + 2) / PER_LOBE
        last = int(np.flatnonzero(_spectrum(products, share) >= FADED)[-1])
        faded = root(lambda x: _spectrum(x, share) - FADED, products[last], products[last + 1])
        return faded / self._length()


def _spectrum(products: Any, share: float) -> Any:
    """Amplitude spectrum over that at zero of a triangle whose rise is this share q of its length T, at x = fT > 0.

    The pulse's rate is a box of area M over the rise less one over the fall, whose middles are T/2 apart; hence
    |sinc qx − e^(−iπx) sinc (1−q)x|/(πx), sinc x = sin πx/πx.
    """
    boxes = np.sinc(share * products) - np.exp(-1j * math.pi * products) * np.sinc((1.0 - share) * products)
    return np.abs(boxes) / (math.pi * products)


DELAY = 1.5
"""Periods from the start to the crest, and from the crest to the end.

The wavelet is nowhere exactly zero and is not cut off: it is 1e-8 of its amplitude at the start, less before."""

RICKER_FADE = root(lambda x: x**2 * math.exp(1.0 - x**2) - FADED, 1.0, 10.0)
"""Frequency over crest frequency, x, above which the spectrum x² exp(1 − x²) is below 1 %: 2.764."""


class Ricker(Shape):
    """v = M(1 − 2a)e^(−a), a = [πf(t − t₀)]²: a crest M at t₀ = `start` + 1.5/f between troughs of 0.446 M."""

    type: Literal["ricker"]
    frequency: float = quantity(unit="Hz", gt=0.0)
    """frequency of the spectrum's crest"""

    def _velocity_shape(self, since: np.ndarray) -> np.ndarray:
        a = np.square(math.pi * (self.frequency * since - DELAY))
        return (1.0 - 2.0 * a) * np.exp(-a)

    def _displacement_shape(self, since: np.ndarray) -> np.ndarray:
        a = np.square(math.pi * (self.frequency * since - DELAY))
        return (since - DELAY / self.frequency) * np.exp(-a)

    def peak_time(self) -> float:
        """Time of the crest, one and a half periods after the start, s."""
        return self.start + DELAY / self.frequency

    def duration(self) -> float:
        """Time after which |velocity| stays below 1e-8 of the amplitude, s: three periods from the start."""
        return self.start + 2.0 * DELAY / self.frequency

    def dominant_frequency(self) -> float:
        """Frequency at which the amplitude spectrum is largest, Hz."""
        return self.frequency

    def highest_frequency(self) -> float:
        """Frequency above which the amplitude spectrum stays below 1 % of its largest value, Hz: 2.76 f."""
        return RICKER_FADE * self.frequency
