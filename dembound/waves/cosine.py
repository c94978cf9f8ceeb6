"""The cosine pulse of Zhou et al. 2018, equation 12."""

import math
from typing import Literal

import numpy as np

from dembound.waves.wave import HANN_FADE, Pulse


class Cosine(Pulse):
    """One-sided pulse: v = M/2 · (1 − cos 2πt/T) for 0 ≤ t ≤ T (Z eq. 12)."""

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
