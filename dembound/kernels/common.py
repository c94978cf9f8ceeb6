"""Constants and functions that all kernels use, and sums whose bits do not depend on the number of lanes."""

from typing import Any

import numpy as np
from numba import njit

U = np.uint64  # unsigned indices avoid numba's test for negative ones

FASTMATH = {"contract", "nsz"}
"""Fast-math option: fused multiply-add only, which rounds less and does not depend on threads."""

FAST: dict[str, Any] = {
    "cache": True, "fastmath": FASTMATH, "error_model": "numpy", "_nrt": False, "no_cfunc_wrapper": True,
}  # fmt: skip
"""Compiler options of functions that run at every step: no reference counts for arrays, which the caller keeps.

Counting takes two calls whenever an array is read from a bundle or passed to a function, in all as much time as moving
a thousand nodes of a bar. Such functions cannot create arrays. The code by which C could call each function, which
takes long to compile, is left out.
"""

INLINED: dict[str, Any] = FAST | {"inline": "always"}
"""Options of small functions, which become part of the loops that call them."""

MAKES = FAST | {"_nrt": True}
"""Compiler options of functions that create arrays."""

EXACT = FAST | {"fastmath": False}
"""Compiler options of functions whose results must be the same to the last bit on all processors."""

EXACT_MAKES = EXACT | {"_nrt": True}
"""`EXACT` for functions that create arrays."""

REST = 1e-250
"""Speed (m/s) below which speeds are set to zero: they would decay into denormal numbers, which are a hundred times
slower.
"""

DONE, LIST_ENDS, LAW_ENDS, TRIGGERED, BROKE = 0, 1, 2, 3, 4
"""Reasons why the loop returned.

All steps are done; a list of pairs is out of date; a contact is about to leave the elastic law; a spring of a bar has
triggered its method; a bond broke in the last step.
"""

CHUNKS = 128
"""Number of chunks of the particle or contact range for the threads; it has no effect on the result."""


@njit(**FAST)
def column_sum(values, column):
    """Sum of a column of values (k, m), in order."""
    total = 0.0
    for i in range(values.shape[0]):
        total += values[i, column]
    return total


@njit(**FAST)
def largest(values):
    """Largest of values (k,)."""
    most = values[0]
    for i in range(1, values.size):
        most = max(most, values[i])
    return most


@njit(**FAST)
def weighted_sums(values, factors, sums):
    """Fill sums (k, r) with Σ_q values (k, q)·factors (q, r), one term after the other."""
    for t in range(values.shape[0]):
        for r in range(factors.shape[1]):
            sums[U(t), U(r)] = 0.0
        for q in range(factors.shape[0]):
            value = values[U(t), U(q)]
            for r in range(factors.shape[1]):
                sums[U(t), U(r)] += value * factors[U(q), U(r)]


@njit(**FAST)
def add_weighted_sums(values, factors, column, sums, row):
    """Add Σ_q values (k, q)·factors (q, r) to columns (r,) of sums (k, n), each once; row (r,) is overwritten."""
    for t in range(values.shape[0]):
        for r in range(factors.shape[1]):
            row[U(r)] = 0.0
        for q in range(factors.shape[0]):
            value = values[U(t), U(q)]
            for r in range(factors.shape[1]):
                row[U(r)] += value * factors[U(q), U(r)]
        for r in range(factors.shape[1]):
            sums[U(t), U(column[r])] += row[U(r)]


@njit(**FAST)
def add_driven(signals, number, factor, column, sums):
    """Add signals (k, q), of these numbers (d,) and times factors (d,), to columns (d,) of sums (k, n), in order."""
    for t in range(signals.shape[0]):
        for d in range(number.size):
            sums[U(t), U(column[d])] += signals[U(t), U(number[d])] * factor[d]
