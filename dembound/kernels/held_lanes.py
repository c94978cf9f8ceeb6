"""The elastic law on rows of copies, eight at once, where one of the three components of motion is held.

The law is that of elastic_lanes.py without the rows and columns of the held component, so its results are the same.
With p a translation and q the other component that moves, and w = q_j, less q_i if q is a translation too:

    F_p = k_pp (p_j − p_i) + k_pq w + own_p θ_i
    F_q = k_qp (p_j − p_i) + k_qq w + own_q θ_i
"""

import numpy as np
from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.lane_access import load, store
from dembound.kernels.compiler.lanes import LANES, at_most, bits, choose, splat
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.lane_step import INLINED, blocks_of, kick, next_place, place_of, stray_forces

_ALL = np.uint8(2**LANES - 1)


@njit(**FAST)
def moving_pair(free):
    """The two components that move, where free (3,) has a single 0; else (0, 0)."""
    held = 0
    count = 0
    for c in range(3):
        if free[c] == 0.0:
            held = c
            count += 1
    if count != 1:
        return 0, 0
    return 1 if held == 0 else 0, 1 if held == 2 else 2


@njit(**INLINED)
def _columns(p, q):
    """Columns of k_pp, k_pq, k_qp and k_qq among the constants of elastic_lanes.py."""
    if q == 1:
        return U(0), U(1), U(1), U(2)
    return U(2 * p), U(3 + p), U(5 + p), U(7)


@njit(**INLINED)
def _pair_force(rows, r, column, i, p, q, columns, x, w, turn, ux, uw):
    """Both components of the force on eight disks of row r in slots from i on, by the contacts that rows share.

    x, w, turn : displacement p, value subtracted from the neighbour's q, and rotation; zero where it is held.
    """
    pp, pq, qp, qq = columns
    k = rows.constants
    fp = rows.own[r, p] * turn
    fq = rows.own[r, q] * turn
    for entry in range(rows.start[r, U(0)], rows.start[r, U(1)]):
        e = U(entry)
        j = i + U(rows.shift[e])
        dx, dw = load(ux, j) - x, load(uw, j) - w
        fp += k[e, pp] * dx + k[e, pq] * dw
        fq += k[e, qp] * dx + k[e, qq] * dw
    for entry in range(rows.start[r, U(1)], rows.start[r + U(1), U(0)]):
        e = U(entry)
        byte = rows.masks[U(rows.mask[e] + column)]
        if byte == 0:
            continue
        j = i + U(rows.shift[e])
        dx, dw = load(ux, j) - x, load(uw, j) - w
        gp = k[e, pp] * dx + k[e, pq] * dw + rows.turn[e, p] * turn
        gq = k[e, qp] * dx + k[e, qq] * dw + rows.turn[e, q] * turn
        if byte != _ALL:
            exists = bits(byte)
            gp = choose(exists, gp, 0.0)
            gq = choose(exists, gq, 0.0)
        fp += gp
        fq += gq
    return fp, fq


@njit(**FAST)
def _move_blocks(rows, first, last, p, q, u, v, body, u_next):
    """One step of components p and q of the disks in blocks first to last − 1."""
    if first == last:
        return
    columns = _columns(p, q)
    turns = q == 2
    p, q = U(p), U(q)
    ux, uw = u[p], u[q]
    group, column, r = place_of(rows, first)
    for block in range(first, last):
        if block > first:
            group, column, r = next_place(rows, block, group, column, r)
        i, row = U(LANES * block), U(r)
        x, y = load(ux, i), load(uw, i)
        less, turn = y, splat(0.0)
        if turns:
            less, turn = turn, less
        fp, fq = _pair_force(rows, row, column, i, p, q, columns, x, less, turn, ux, uw)
        b = splat(body.step * rows.inverse_mass[row])
        b_q = splat(body.step * rows.inverse_inertia[row]) if turns else b
        special = rows.special[U(block)]
        if special:
            b = load(body.mobility, i)
            b_q = load(body.inverse_inertia, i) if turns else b
            if rows.stray.size > 0:
                fp += load(rows.extra[p], i)
                fq += load(rows.extra[q], i)
        now_p = kick(load(v[p], i), fp, b)
        now_q = kick(load(v[q], i), fq, b_q)
        store(v[p], i, now_p)
        store(v[q], i, now_q)
        x += body.step * now_p
        y += body.step * now_q
        if special:
            held = at_most(b, 0.0)
            x = choose(held, fp, x)
            y = choose(held, fq, y)
        store(u_next[p], i, x)
        store(u_next[q], i, y)


@in_chunks
@njit(**FAST)
def move_pair(begin, end, rows, p, q, u, v, body, u_next):
    """One step of components p and q of all disks, without steady loads and local damping."""
    for chunk in range(begin, end):
        first, last = blocks_of(rows, chunk)
        stray_forces(rows, first, last, u)
        _move_blocks(rows, first, last, p, q, u, v, body, u_next)
