"""Time functions of the drives of the support table and of waves that enter through a side."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

Signal = Callable[[np.ndarray], np.ndarray]
"""A time function: times (k,) in s -> values (k,)."""


class Signals(Protocol):
    """Signals whose values are computed together."""

    @property
    def count(self) -> int:
        """Number q of the signals."""

    def __call__(self, times: np.ndarray, half_step: float) -> np.ndarray:
        """Values (k, q) at times (k,) s of steps; velocities for ties are taken half a step (s) earlier."""


@dataclass(frozen=True)
class OneOf:
    """One of several signals."""

    signals: Signals
    number: int

    def __call__(self, times: np.ndarray, half_step: float = 0.0) -> np.ndarray:
        """Values (k,) of the signal at times (k,) s of steps, with half their length, s."""
        return self.signals(times, half_step)[:, self.number]


class Incident(Protocol):
    """A wave that may enter through a side."""

    def velocity(self, t: np.ndarray) -> np.ndarray:
        """Particle velocity, m/s, at the times t, s; same shape as t."""

    def displacement(self, t: np.ndarray) -> np.ndarray:
        """Particle displacement, m, at the times t, s; same shape as t."""


Waves = Mapping[str, Incident]
"""The waves of a case by name."""
