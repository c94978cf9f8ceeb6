"""Cholesky's factors of a symmetric banded matrix."""

import numpy as np
from numba import njit

from dembound.kernels.common import FAST


@njit(**FAST)
def is_positive_definite(bands):
    """Whether a symmetric matrix is positive definite; its bands (b, n) are overwritten.

    Row d of the bands contains the entries [i + d, i]. Column by column, as LAPACK's dpbtf2: a matrix is positive
    definite if and only if all pivots are above zero.
    """
    width, count = bands.shape
    for i in range(count):
        if not bands[0, i] > 0.0:
            return False
        scale = 1.0 / np.sqrt(bands[0, i])
        end = min(width, count - i)
        for d in range(1, end):
            bands[d, i] *= scale
        for d in range(1, end):
            for e in range(d, end):
                bands[e - d, i + d] -= bands[d, i] * bands[e, i]
    return True
