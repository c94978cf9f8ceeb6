"""Sums whose bits do not depend on how many of them are computed at once, unlike those of matrix products."""

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
