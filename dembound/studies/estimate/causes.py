"""Causes of the error of a run, each with what it adds to the motion of the monitors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

QUANTITIES = ("velocity", "displacement", "stress")
"""Quantities whose errors are estimated; stress of bars only."""


@dataclass(frozen=True)
class Recorded:
    """What a run has recorded at one monitor.

    position : (2,) m, of its particle. time : (k,) s. values : quantity -> (k, c) in SI units, of motions along x and y.
    """

    position: np.ndarray
    time: np.ndarray
    values: Mapping[str, np.ndarray]

    def component(self, quantity: str) -> int:
        """The column with the largest value, whose error is estimated."""
        return int(np.argmax(np.abs(self.values[quantity]).max(axis=0, initial=0.0)))


@dataclass(frozen=True)
class Cause:
    """One cause of errors.

    name : "sides", "grid" or "time step". words : how its errors were found. errors : monitor -> quantity -> the part of
    the recorded values (k, c) that is due to it, or, where only its size is known, a number: its RMS over that of the
    recorded values.
    """

    name: str
    words: str
    errors: Mapping[str, Mapping[str, np.ndarray | float]]

    def share(self, monitor: str, quantity: str, recorded: Recorded) -> float:
        """RMS of its error over that of the recorded values, of the component with the largest; nan if not known."""
        error = self.errors.get(monitor, {}).get(quantity, np.nan)
        if isinstance(error, float):
            return error
        column = recorded.component(quantity)
        size = float(np.linalg.norm(recorded.values[quantity][:, column]))
        return float(np.linalg.norm(error[:, column])) / size if size > 0.0 else np.nan
