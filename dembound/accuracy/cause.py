"""Causes of the error of a run, each with what it adds to the motion of the monitors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

SIDES, GRID, STEP, CONTINUUM = "sides", "grid", "time step", "continuum"
"""Names of causes."""

QUANTITIES = ("velocity", "displacement", "stress")
"""Quantities whose errors are estimated; stress of bars only."""


QUIET = 0.01
"""Monitors whose peak in the reference is below this share of the largest one are left out.

Relative errors there are those of a small residual motion.
"""


@dataclass(frozen=True)
class Recorded:
    """What a run has recorded at one monitor.

    position : (2,) m, of its particle. time : (k,) s. values : quantity -> (k, c) in SI units, of motions along x, y.
    """

    position: np.ndarray
    time: np.ndarray
    values: Mapping[str, np.ndarray]

    def component(self, quantity: str) -> int:
        """The column with the largest value, whose error is estimated."""
        return int(np.argmax(np.abs(self.values[quantity]).max(axis=0, initial=0.0)))


def quiet(recorded: Mapping[str, Recorded], quantity: str, share: float) -> set[str]:
    """Monitors that record a quantity, but whose largest value is below this share of the loudest one's."""
    values = {name: each.values[quantity] for name, each in recorded.items() if quantity in each.values}
    peaks = {name: float(np.abs(each).max(initial=0.0)) for name, each in values.items()}
    loudest = max(peaks.values(), default=0.0)
    return {name for name, peak in peaks.items() if peak < share * loudest}


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

    def share(self, monitor: str, quantity: str, recorded: Recorded) -> float:
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
        """Both."""
        return Causes(
            [*self.found, *other.found],
            [*self.missing, *other.missing],
            [*self.notes, *other.notes],
            self.cost + other.cost,
            self.echo_free or other.echo_free,
        )
