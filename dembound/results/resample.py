"""Histories at times other than their samples: cubic splines between jumps, straight lines across them."""

from __future__ import annotations

import numpy as np

ABRUPT = 4.0
"""Change between two samples, over the larger of the changes before and after, above which motion jumps.

In a sine with n samples a period this ratio is at most 1/cos(2π/n): 3.2 with 5 samples, 1.05 with 20.
"""

JUMP = 0.01
"""Change between two samples, over the largest value, up to which it is not a jump: splines ring by a quarter of it."""

FEWEST = 4
"""Number of samples of the shortest smooth piece that is interpolated by a cubic spline."""


def at_times(time: np.ndarray, values: np.ndarray, requested: np.ndarray) -> np.ndarray:
    """Values (m,) or (m, c) of a history at requested times (m,) s; constant before its first and after its last.

    time (k,) s, ascending, and values (k,) or (k, c) of the history. The error in a sine with 20 samples a period is
    0.002 %, with straight lines 0.9 %. A spline through a jump would overshoot for some samples on both sides.
    """
    if np.array_equal(time, requested):
        return values
    inside = np.clip(requested, time[0], time[-1])
    columns = [_column(time, column, inside) for column in np.atleast_2d(values.T)]
    return np.array(columns).T.reshape(-1, *values.shape[1:])


def _column(time: np.ndarray, values: np.ndarray, requested: np.ndarray) -> np.ndarray:
    """Values of one column at other times; requested : between the first and the last sample."""
    from scipy.interpolate import CubicSpline

    jumps = _jumps(values)
    found = np.interp(requested, time, values)
    ends = np.flatnonzero(np.diff(np.concatenate([[True], jumps, [True]]).astype(int)))
    for first, last in zip(ends[::2], ends[1::2], strict=True):  # without a jump between them
        if last - first + 1 >= FEWEST:
            own = (requested >= time[first]) & (requested <= time[last])
            found[own] = CubicSpline(time[first : last + 1], values[first : last + 1])(requested[own])
    return found


def _jumps(values: np.ndarray) -> np.ndarray:
    """Whether a motion (k,) jumps between two samples, for each of the intervals (k − 1,)."""
    change = np.abs(np.diff(values))
    if len(change) < FEWEST - 1:
        return np.zeros(len(change), dtype=bool)
    around = np.concatenate([[change[2]], change, [change[-3]]])
    beside = np.maximum(around[:-2], around[2:])
    return np.asarray(change > np.maximum(ABRUPT * beside, JUMP * np.abs(values).max()))
