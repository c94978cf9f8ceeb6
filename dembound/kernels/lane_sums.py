"""Energies that pairs take, summed lane by lane."""

from numba import njit

from dembound.kernels.common import INLINED, U
from dembound.kernels.compiler.lane_access import load, store
from dembound.kernels.compiler.lanes import LANES

TAKEN = 3 * LANES
"""Numbers in `taken`, see pair_lanes.py."""


@njit(**INLINED)
def add_to(sums, first, values):
    """Add eight numbers to those in an array (n,) from index `first` on."""
    store(sums, U(first), load(sums, U(first)) + values)


@njit(**INLINED)
def begin_sums(taken, lost):
    """Set the sums of a chunk to zero."""
    for k in range(TAKEN):
        taken[U(k)] = 0.0
    for k in range(lost.size):
        lost[U(k)] = 0.0


@njit(**INLINED)
def end_sums(taken, lost):
    """Add the energies of the lanes to those of the chunk, see `single_pairs.push`."""
    for k in range(LANES):
        lost[0] += taken[U(k)]
        lost[2] += taken[U(LANES + k)]
        lost[4] += taken[U(2 * LANES + k)]
