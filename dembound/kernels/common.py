"""What the kernels share."""

from typing import Any

import numpy as np
from numba import njit

U = np.uint64  # unsigned indices spare numba's test for negative ones

FASTMATH = {"contract", "nsz"}
"""Fused multiply-add only: it rounds less and does not depend on threads."""

FAST: dict[str, Any] = {"cache": True, "fastmath": FASTMATH, "error_model": "numpy", "_nrt": False}
"""How what runs at every step is compiled: without counting references to arrays, which the caller holds.

Counting costs two calls whenever an array is taken out of a bundle or handed to a function: as much, in all, as moving
a thousand nodes of a bar. Such functions cannot make arrays.
"""

MAKES = FAST | {"_nrt": True}
"""How functions are compiled that make arrays."""

PARALLEL = MAKES | {"parallel": True}
"""How loops over particles and contacts are compiled."""

REST = 1e-250
"""Speeds below this count as rest: they would decay into denormal numbers, which are a hundred times slower."""

DONE, LIST_ENDS, LAW_ENDS, TRIGGERED, BROKE = 0, 1, 2, 3, 4
"""Why the loop returned: all steps are done; a list of pairs is old; a contact is about to leave the elastic law; a
spring of a bar has triggered its method; a bond broke in the last step."""

CHUNKS = 128
"""Pieces of the particle or contact range handed to the threads; it has no effect on the result."""


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
