"""Damping of linear ground, as memories of forces and a drag on masses: what all its kinds have in common."""

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np


class Attenuation(ABC):
    """Damping of one material.

    Attributes
    ----------
    band : lowest and highest frequency, Hz, for which it is fitted. frequency : f₀, Hz, at which the given wave speeds
    hold.
    """

    band: tuple[float, float]
    frequency: float

    @property
    @abstractmethod
    def count(self) -> int:
        """Number of memories of each force."""

    @abstractmethod
    def per_step(self, time_step: float) -> np.ndarray:
        """Factors e and g (2, K) of the memories for steps of this length (s), see dembound/damping/quality.py."""

    @abstractmethod
    def relative_modulus(self, frequency: np.ndarray | float) -> np.ndarray:
        """M(ω)/M₀ (...) at frequencies (...) Hz, which may be complex, for e^{iωt}; M₀ is ρc² of the given speed."""

    def relative_density(self, frequency: np.ndarray | float) -> np.ndarray:
        """ρ(ω)/ρ (...) at frequencies (...) Hz other than 0, which may be complex; by default 1."""
        return np.ones(np.shape(frequency), dtype=complex)

    @property
    def unrelaxed(self) -> float:
        """Stiffness of the springs with which ground is stepped over that of the given wave speeds; by default 1."""
        return 1.0

    @property
    def drag(self) -> float:
        """Force against the motion over mass and velocity, 1/s; by default none."""
        return 0.0

    @property
    def lag(self) -> float:
        """Time (s) β by which forces on fast motion grow, F = f + β df/dt, which shortens the step; by default none."""
        return 0.0

    def quality(self, frequency: np.ndarray | float) -> np.ndarray:
        """Q (...) at frequencies (...) Hz."""
        modulus, density = self.relative_modulus(frequency), self.relative_density(frequency)
        return np.asarray(1.0 / (modulus.imag / modulus.real - density.imag / density.real))

    @property
    def range(self) -> tuple[float, float]:
        """Least and largest Q over the band."""
        found = self.quality(np.geomspace(*self.band, 201))
        return float(found.min()), float(found.max())


def factors_of(layers: Sequence[Attenuation | None], time_step: float) -> np.ndarray:
    """Factors e and g (layers, 2, K) of the memories of layers of ground; of undamped ones zero."""
    count = max((each.count for each in layers if each is not None), default=0)
    factors = np.zeros((len(layers), 2, count))
    for row, each in zip(factors, layers, strict=True):
        if each is not None:
            row[:, : each.count] = each.per_step(time_step)
    return factors
