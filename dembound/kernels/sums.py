"""Sums whose bits do not depend on how many are computed at once, unlike matrix products."""

from numba import njit

from dembound.kernels.common import FAST, U


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
