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


@njit(**MAKES)
def broken_off(contacts, slot, torn, kept):
    """Whether each disk (m,) is in a piece that has broken off, and whether it has just lost its last bond.

    A piece has broken off if it has no disk that is kept (m,), or where none is, is not the largest, and one of its
    bonds has ever broken. slot : (m,) of each disk. torn : (m,) bool, disks of which a bond has broken before, to which
    those are added whose bonds have broken since cracks were last recorded.
    """
    begin, end = slot.min(), slot.max() + 1
    piece = pieces(contacts, begin, end)
    fresh, bonds = np.zeros(end - begin, np.bool_), np.zeros(end - begin, np.int64)
    for p in range(contacts.first.size):
        c = U(p)
        i, j = np.int64(contacts.first[c]) - begin, np.int64(contacts.second[c]) - begin
        if contacts.cracked[c] >= 0:
            fresh[i] = fresh[j] = True
        if contacts.state[c] == INTACT:
            bonds[i] += 1
            bonds[j] += 1
    held, has_torn, size = np.zeros(end - begin, np.bool_), np.zeros(end - begin, np.bool_), np.zeros(end - begin)
    for p in range(slot.size):
        own = piece[slot[p] - begin]
        torn[p] |= fresh[slot[p] - begin]
        held[own] |= kept[p]
        has_torn[own] |= torn[p]
        size[own] += 1.0
    if not held.any():
        held[np.argmax(size)] = True
    debris, alone = np.zeros(slot.size, np.bool_), np.zeros(slot.size, np.bool_)
    for p in range(slot.size):
        own = piece[slot[p] - begin]
        debris[p] = has_torn[own] and not held[own]
        alone[p] = fresh[slot[p] - begin] and bonds[slot[p] - begin] == 0
    return debris, alone
