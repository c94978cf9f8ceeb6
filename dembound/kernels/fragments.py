"""Pieces of particles connected by bonds and closed contacts."""

import numpy as np
from numba import njit

from dembound.kernels.common import FAST, MAKES, U
from dembound.kernels.contacts import INTACT


@njit(**FAST, inline="always")
def _root(parent, i):
    """The particle that represents i's piece (union-find with path halving)."""
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@njit(**MAKES)
def pieces(contacts, begin, end):
    """Piece of each of the particles begin to end, (end − begin,): number of its first particle, from begin.

    Pieces are connected by intact bonds and by contacts that were closed when forces were last computed.
    """
    first, second, state, force = contacts.first, contacts.second, contacts.state, contacts.force
    parent = np.arange(end)
    for c in range(first.size):
        i = np.int64(first[c])
        j = np.int64(second[c])
        if i < begin or i >= end or j < begin or j >= end:
            continue
        if state[c] == INTACT or force[U(0), c] != 0.0 or force[U(1), c] != 0.0:
            i = _root(parent, i)
            j = _root(parent, j)
            parent[max(i, j)] = min(i, j)
    piece = np.empty(end - begin, dtype=np.int64)
    for i in range(begin, end):
        piece[i - begin] = _root(parent, i) - begin
    return piece
