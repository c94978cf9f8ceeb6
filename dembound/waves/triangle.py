"""The triangular pulse of Lu & Wang 2016, section 3."""

import math
from typing import Any, Literal

import numpy as np

from dembound.roots import root
from dembound.table import quantity
from dembound.waves.wave import FADED, Shape

FADED_AT_LATEST = 2.0 / (math.pi * FADED)
"""Frequency times length above which the spectrum of any triangle is below 1 %, as both sinc terms are at most 1."""

PER_LOBE = 64
"""Samples per lobe of the spectrum: between two of them it rises above both by at most (π/64)²/8 = 0.03 % of itself."""


class Triangle(Shape):
    """One-sided pulse: v = M t/t_r during the rise t_r, then M(1 − (t − t_r)/t_f) over the fall t_f."""

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
