"""A velocity that rises from zero and remains constant."""

import math
from typing import ClassVar, Literal

import numpy as np

from dembound.table import quantity
from dembound.waves.wave import HANN_FADE, Shape

ROUNDING = 1e-12
"""Share of the start by which times of steps may differ from it by rounding."""


class Constant(Shape):
    """v = M from `rise` seconds after the start on; during the rise v = M[s − sin(2πs)/2π], s = t/rise.

    rise = 0 is a step: at its time v is M/2.
    """

    stays: ClassVar[bool] = True

    type: Literal["constant"]
    rise: float = quantity(0.0, unit="s", ge=0.0)
    """length of the smooth ramp to the full velocity"""

    def _progress(self, since: np.ndarray) -> np.ndarray:
        """Position on the ramp: 0 before, 1 after."""
        if self.rise == 0.0:
            return np.where(np.abs(since) <= ROUNDING * self.start, 0.5, np.where(since > 0.0, 1.0, 0.0))
        return np.clip(since / self.rise, 0.0, 1.0)

    def _velocity_shape(self, since: np.ndarray) -> np.ndarray:
        s = self._progress(since)
        return s - np.sin(2.0 * math.pi * s) / (2.0 * math.pi)

    def _displacement_shape(self, since: np.ndarray) -> np.ndarray:
        s = self._progress(since)
        on_the_ramp = 0.5 * s**2 - (1.0 - np.cos(2.0 * math.pi * s)) / (4.0 * math.pi**2)
        return self.rise * on_the_ramp + np.maximum(since - self.rise, 0.0)

    def peak_time(self) -> float:
        """Time at which the full velocity is reached, s."""
        return self.start + self.rise

    def duration(self) -> float:
        """Infinite, as the motion does not end."""
        return math.inf

    def dominant_frequency(self) -> float:
        """1/rise, Hz; infinite for a step."""
        return 1.0 / self.rise if self.rise > 0.0 else math.inf

    def highest_frequency(self) -> float:
        """Frequency above which the *acceleration's* spectrum stays below 1 % of its largest value, Hz.

        Infinite for a step. A velocity that does not return to zero has no amplitude spectrum.
        """
        return HANN_FADE * self.dominant_frequency()
