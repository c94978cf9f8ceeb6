"""What the kernels share."""

import numpy as np

U = np.uint64  # unsigned indices spare numba's test for negative ones

FASTMATH = {"contract", "nsz"}
"""Fused multiply-add only: it rounds less and does not depend on threads."""

REST = 1e-250
"""Speeds below this count as rest: they would decay into denormal numbers, which are a hundred times slower."""

CHUNKS = 128
"""Pieces of the particle or contact range handed to the threads; it has no effect on the result."""
