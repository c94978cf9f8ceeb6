"""The motion at one monitor, as a run records it, a solution gives it, or a file holds it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from dembound.results.compare import at_times, largest_component

LEAST = {"velocity": 0.01, "displacement": 0.01, "stress": 0.1}
"""By quantity, the share of the largest peak of all monitors below which that of a monitor is next to nothing.

Relative errors there are those of a small residual, and do not count. Motion fades with distance, so little is left
out. A pulse keeps its stress along a bar, which falls only where physics makes it zero: at a free end. The node there
has it half a spacing Δx inside, where a pulse with a rise of the length L and its reflection leave Δx/L of the peak,
at most 0.1 on a grid with ten spacings along the rise.
"""


@dataclass(frozen=True)
class History:
    """The motion at one monitor.

    place : (2,) m, of its particle. time : (k,) s. values : quantity -> (k, c) in SI units: displacement and velocity
    along x, y and, where it is known, of rotation; stress along a bar (k, 1).
    """

    place: np.ndarray
    time: np.ndarray
    values: Mapping[str, np.ndarray]

    @classmethod
    def of(
        cls,
        place: np.ndarray,
        time: np.ndarray,
        displacement: np.ndarray,
        velocity: np.ndarray,
        stress: np.ndarray | None = None,
    ) -> History:
        """A history from displacement (k, c) m, rad, velocity (k, c) m/s, rad/s and, of bars, stress (k,) Pa."""
        along = {} if stress is None else {"stress": stress[:, None]}
        return cls(place, time, {"displacement": displacement, "velocity": velocity, **along})

    @property
    def displacement(self) -> np.ndarray:
        """Displacement (k, c) m, rad."""
        return self.values["displacement"]

    @property
    def velocity(self) -> np.ndarray:
        """Velocity (k, c) m/s, rad/s."""
        return self.values["velocity"]

    def component(self, quantity: str) -> int:
        """The column with the largest value, for which errors are computed; see `largest_component`."""
        return largest_component(self.values[quantity])

    def at(self, times: np.ndarray) -> History:
        """The motion interpolated at times (m,) s; constant before the first and after the last sample."""
        return History(
            self.place, times, {name: at_times(self.time, each, times) for name, each in self.values.items()}
        )

    def until(self, end: float) -> History:
        """The samples up to a time (s) and at it."""
        return self._part(self.time <= end)

    def before(self, end: float) -> History:
        """The samples before a time (s)."""
        return self._part(self.time < end)

    def _part(self, kept: np.ndarray) -> History:
        """The history with the samples kept (k,) bool; itself if all are kept."""
        if kept.all():
            return self
        return History(self.place, self.time[kept], {name: each[kept] for name, each in self.values.items()})


Motions = Mapping[str, History]
"""Histories by the name of their monitor."""


def loud(motions: Motions, quantity: str) -> list[str]:
    """Monitors at which a quantity is not negligible relative to the monitor with the largest one."""
    recorded = {name: each.values[quantity] for name, each in motions.items() if quantity in each.values}
    peaks = {name: float(np.abs(values).max(initial=0.0)) for name, values in recorded.items()}
    return loud_of(peaks, LEAST[quantity])


def loud_of(peaks: Mapping[str, float], least: float) -> list[str]:
    """Monitors whose peak is at least this share of the largest peak of all monitors."""
    return [name for name, peak in peaks.items() if peak >= least * max(peaks.values())]


def earlier(motions: Motions, by: float) -> Motions:
    """Motions shifted to earlier times by `by` s (to later ones if negative); unchanged for 0."""
    if by == 0.0:
        return motions
    return {name: replace(each, time=each.time - by) for name, each in motions.items()}


def along(values: np.ndarray, column: int) -> np.ndarray:
    """Motion (k, 3) with these values (k,) in one column and zero elsewhere."""
    motion = np.zeros((len(values), 3))
    motion[:, column] = values
    return motion
