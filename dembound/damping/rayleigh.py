"""Rayleigh damping: a drag α on masses, and stresses that grow with β times the rate of strain.

With e^{iωt} the modulus is M₀(1 + iωβ) and the density ρ(1 − iα/ω), so that a motion of the frequency ω has the damping
ratio ξ = α/(2ω) + βω/2 = 1/(2Q). Forces F = f + β(f − f')/Δt, with f' those one step earlier, are those of two memories
with e = 0, g = β/Δt and e = −1, g = −2β/Δt (quality.py), of which the second one stays empty.
"""

import math
from dataclasses import dataclass

import numpy as np

from dembound.damping.attenuation import Attenuation


@dataclass(frozen=True)
class Rayleigh(Attenuation):
    """Rayleigh damping of one material.

    Attributes
    ----------
    alpha : α, 1/s. beta : β, s. band : the two frequencies, Hz, at which the damping ratio is the given one.
    """

    alpha: float
    beta: float
    band: tuple[float, float]

    @classmethod
    def fitted(cls, quality: float, band: tuple[float, float]) -> "Rayleigh":
        """Rayleigh damping with a quality factor at the two frequencies (Hz) of a band."""
        (low, high), ratio = band, 0.5 / quality
        return cls(4.0 * math.pi * ratio * low * high / (low + high), ratio / (math.pi * (low + high)), band)

    @property
    def frequency(self) -> float:  # type: ignore[override]  # an attribute of others
        """The middle of the band, Hz; wave speeds hold at all frequencies."""
        return math.sqrt(self.band[0] * self.band[1])

    @property
    def count(self) -> int:
        """Number of memories of each force."""
        return 2

    @property
    def drag(self) -> float:
        """α, 1/s."""
        return self.alpha

    @property
    def lag(self) -> float:
        """β, s."""
        return self.beta

    def per_step(self, time_step: float) -> np.ndarray:
        """Factors e and g (2, 2) of the memories for steps of this length (s)."""
        rate = self.beta / time_step
        return np.array([[0.0, -1.0], [rate, -2.0 * rate]])

    def relative_modulus(self, frequency: np.ndarray | float) -> np.ndarray:
        """1 + iωβ (...) at frequencies (...) Hz."""
        return np.asarray(1.0 + 2j * math.pi * self.beta * np.asarray(frequency))

    def relative_density(self, frequency: np.ndarray | float) -> np.ndarray:
        """1 − iα/ω (...) at frequencies (...) Hz."""
        return np.asarray(1.0 - 1j * self.alpha / (2.0 * math.pi * np.asarray(frequency)))
