"""Forces of history-dependent pairs that are in no row: of those that push or are bonded, eight at once (lanes.py)."""

import numpy as np
from numba import njit

from dembound.kernels.common import FAST, INLINED, MAKES, U, column_sum
from dembound.kernels.compiler.lane_access import load
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.compiler.start_strain import began_with
from dembound.kernels.contacts import INTACT, OPEN, push_each
from dembound.kernels.lane_sums import TAKEN, begin_sums, end_sums
from dembound.kernels.pair_lanes import ALL, push_eight
from dembound.kernels.pair_strain import pair
from dembound.pairwise import P

TILE = 128
"""Pairs among which those that act are chosen at once."""

MARGIN = 1.0 + 1e-9  # of the squared distance: a pair that is left out is open whatever its rounding


@njit(**INLINED)
def _acts(c, u, contacts):
    """Whether a pair is bonded, pushed in the last step, or has an overlap."""
    constants = contacts.constants
    _, _, k, dx, dy = pair(c, u, contacts.first, contacts.second, contacts.contact_type, constants)
    x, y = constants[k, P.x] + dx, constants[k, P.y] + dy
    reach = constants[k, P.touch] - began_with(contacts.began, k, U(0))
    near = x * x + y * y <= reach * reach * MARGIN
    return near | (contacts.state[c] == INTACT) | (contacts.closed[c] != OPEN)


@njit(**FAST, forceinline=True)  # see pair_lanes._push_blocks
def _push_chunk(chunk, acting, u, v, step, number, contacts, limits, taken, breaking, lost):
    """The pairs of a chunk; acting (TILE + 2 LANES,) uint32 is work space."""
    begin_sums(taken, lost)
    first, last = contacts.bound[chunk], contacts.bound[chunk + 1]
    if first == last:
        return
    waiting = 0
    while first < last:
        stop = min(first + TILE, last)
        for p in range(first, stop):
            acting[U(waiting)] = p
            waiting += int(_acts(U(p), u, contacts))
        first = stop
        if stop == last:
            for k in range(LANES):  # the last eight are filled up
                acting[U(waiting + k)] = acting[U(max(waiting - 1, 0))]
        done = 0
        while waiting - done >= LANES or (stop == last and waiting > done):
            exists = ALL if waiting - done >= LANES else np.uint8((1 << (waiting - done)) - 1)
            c = load(acting, U(done))
            q, k = load(contacts.contact_type, c), contacts.constants
            law, at = (k, contacts.began, q, q, True), (c, load(contacts.first, c), load(contacts.second, c))
            way = k[q, P.x] / k[q, P.rest], k[q, P.y] / k[q, P.rest]
            push_eight(law, at, exists, way, u, v, step, contacts, limits, taken, breaking)
            if breaking[0] != 0:
                push_each(breaking[1 : 1 + breaking[0]], u, v, step, number, contacts, limits, lost)
                breaking[0] = 0
            done += LANES
        waiting = max(waiting - done, 0)
        for k in range(waiting):
            acting[U(k)] = acting[U(done + k)]
    end_sums(taken, lost)


@in_chunks
@njit(**MAKES)
def _push(first_chunk, last_chunk, u, v, step, number, contacts, limits, lost):
    taken, acting = np.empty(TAKEN), np.empty(TILE + 2 * LANES, np.uint32)
    breaking = np.zeros(1 + LANES, np.uint32)
    for chunk in range(first_chunk, last_chunk):
        _push_chunk(chunk, acting, u, v, step, number, contacts, limits, taken, breaking, lost[chunk])


@njit(**FAST)
def push(u, v, step, number, contacts, limits, lost):
    """Fill contacts.force for displacements u (3, n) reached with velocities v (3, n) after a step (s).

    Contacts and bonds at their limits slide and break; number is that of the step. lost (chunks, 5) receives the energy
    (J) taken in this step by friction, by cracks and by contacts that open and close, the number of bonds that broke,
    and the energy taken by dashpots. In pairs whose force changes its sign in the step friction and cracks take no
    energy; the energy that they then add is subtracted from that by opening and closing. Pairs in rows of copies are
    left out; the geometry must not be REFERENCE. Returns the number of bonds that broke.
    """
    _push(u, v, step, number, contacts, limits, lost)
    return int(column_sum(lost, 3))
