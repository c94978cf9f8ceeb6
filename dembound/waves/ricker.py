"""The Ricker wavelet."""

import math
from typing import Literal

import numpy as np

from dembound.roots import root
from dembound.table import quantity
from dembound.waves.wave import FADED, Shape

DELAY = 1.5
"""Periods from the start to the crest, and from the crest to the end.

The wavelet is nowhere exactly zero and is not cut off: it is 1e-8 of its amplitude at the start, less before."""

FADE = root(lambda x: x**2 * math.exp(1.0 - x**2) - FADED, 1.0, 10.0)
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
        return FADE * self.frequency
