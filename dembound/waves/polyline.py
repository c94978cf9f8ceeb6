"""A history of straight lines between points, and its integral."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np


@dataclass(frozen=True, eq=False)
class Polyline:
    """Values (k,) at increasing times (k,), s, joined by straight lines and zero outside."""

    times: np.ndarray
    values: np.ndarray

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Polyline)
            and np.array_equal(self.times, other.times)
            and np.array_equal(self.values, other.values)
        )

    __hash__ = None  # type: ignore[assignment]

    def at(self, t: np.ndarray) -> np.ndarray:
        """Values at the times t, s; same shape as t."""
        return np.interp(t, self.times, self.values, left=0.0, right=0.0)

    def integral(self, t: np.ndarray) -> np.ndarray:
        """Exact integral from −∞ to the times t, s; same shape as t, unit of the values times s."""
        times, values = self.times, self.values
        inside = np.clip(t, times[0], times[-1])
        left = np.clip(np.searchsorted(times, inside, side="right") - 1, 0, len(times) - 2)
        mean = 0.5 * (values[left] + np.interp(inside, times, values))
        whole: np.ndarray = self._integral_at_points[left] + mean * (inside - times[left])
        return whole

    @cached_property
    def _integral_at_points(self) -> np.ndarray:
        areas = 0.5 * (self.values[1:] + self.values[:-1]) * np.diff(self.times)
        return np.concatenate([[0.0], np.cumsum(areas)])
