"""Causes of the error of a run, each with what it adds to the motion of the monitors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from dembound.accuracy.history import History

SIDES, GRID, STEP, CONTINUUM = "sides", "grid", "time step", "continuum"
"""Names of causes."""

QUANTITIES = ("velocity", "displacement", "stress")
"""Quantities whose errors are estimated; stress of bars only."""


@dataclass(frozen=True)
class Cause:
    """One cause of errors.

    words : how its errors were found. errors : monitor -> quantity -> the part of the recorded values (k, c) that is
    due to it, or, where only its size is known, a number: its RMS over that of the recorded values. is_sample : whether
    they are a sample of a random error, of which only the RMS counts.
    """

    name: str
    words: str
    errors: Mapping[str, Mapping[str, np.ndarray | float]]
    is_sample: bool = False

    def share(self, monitor: str, quantity: str, recorded: History) -> float:
        """RMS of its error over that of the recorded values, of the component with the largest; nan if not known."""
        error = self.errors.get(monitor, {}).get(quantity, np.nan)
        if isinstance(error, float):
            return error
        column = recorded.component(quantity)
        size = float(np.linalg.norm(recorded.values[quantity][:, column]))
        return float(np.linalg.norm(error[:, column])) / size if size > 0.0 else np.nan


@dataclass(frozen=True)
class Causes:
    """Causes, and what is said about them.

    missing : what is not estimated, and why, a line each. notes : what limits them, a line each. cost : work that was
    spent, over that of the run. echo_free : whether what `SIDES` adds is known without echoes of the larger run.
    """

    found: Sequence[Cause]
    missing: Sequence[str] = ()
    notes: Sequence[str] = ()
    cost: float = 0.0
    echo_free: bool = False

    def __add__(self, other: Causes) -> Causes:
        """The causes of both, and what is said about both."""
        return Causes(
            [*self.found, *other.found],
            [*self.missing, *other.missing],
            [*self.notes, *other.notes],
            self.cost + other.cost,
            self.echo_free or other.echo_free,
        )
