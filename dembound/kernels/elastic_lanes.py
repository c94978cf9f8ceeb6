"""The elastic law and the step of central differences on rows of copies, eight copies at once (lanes.py).

A contact that all copies of a disk have is one entry of the row of these copies: a matrix of eight constants, and the
number of slots to the neighbours' row. With Δ = u_j − u_i the force on i is

    F_x = k_xx Δ_x + k_xy Δ_y + k_xθ θ_j + own_x θ_i
    F_y = k_xy Δ_x + k_yy Δ_y + k_yθ θ_j + own_y θ_i
    M   = k_θx Δ_x + k_θy Δ_y + k_θθ θ_j + own_θ θ_i

which is elastic.py's law multiplied out; the factor of θ_i is one constant for all contacts of a row. A contact that
only some copies have also has a mask of these. Contacts that no row shares, strays, are computed one by one before.
"""

import numpy as np
from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.lane_access import load, store
from dembound.kernels.compiler.lanes import LANES, at_most, bits, choose, lane, larger, magnitude, splat
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.elastic import fill_forces, move_rows
from dembound.kernels.held_lanes import move_pair, moving_pair
from dembound.kernels.lane_step import (
    INLINED,
    blocks_of,
    go_on,
    kick,
    local_damping,
    next_place,
    place_of,
    stray_forces,
)
from dembound.kernels.law import answer
from dembound.kernels.tables import LaneRows

_ALL = np.uint8(2**LANES - 1)


@njit(**INLINED)
def _matrix_force(k, e, j, x, y, ux, uy, ut):
    """Forces and moment of the neighbours in slots j to j + 7 on eight disks by entry e, without own rotation."""
    dx = load(ux, j) - x
    dy = load(uy, j) - y
    tj = load(ut, j)
    gx = k[e, U(0)] * dx + (k[e, U(1)] * dy + k[e, U(3)] * tj)
    gy = k[e, U(1)] * dx + (k[e, U(2)] * dy + k[e, U(4)] * tj)
    about = k[e, U(5)] * dx + (k[e, U(6)] * dy + k[e, U(7)] * tj)
    return gx, gy, about


@njit(**INLINED)
def _block_force(rows, r, column, i, x, y, turn, ux, uy, ut):
    """Forces and moments on eight disks of row r, displaced by x, y and turn, by the contacts that rows share.

    Their slots begin at i.
    """
    fx = rows.own[r, U(0)] * turn
    fy = rows.own[r, U(1)] * turn
    moment = rows.own[r, U(2)] * turn
    for entry in range(rows.start[r, U(0)], rows.start[r, U(1)]):
        gx, gy, about = _matrix_force(rows.constants, U(entry), U(i + rows.shift[U(entry)]), x, y, ux, uy, ut)
        fx += gx
        fy += gy
        moment += about
    for entry in range(rows.start[r, U(1)], rows.start[r + 1, U(0)]):
        e = U(entry)
        byte = rows.masks[U(rows.mask[e] + column)]
        if byte == 0:
            continue
        gx, gy, about = _matrix_force(rows.constants, e, U(i + rows.shift[e]), x, y, ux, uy, ut)
        gx += rows.turn[e, U(0)] * turn
        gy += rows.turn[e, U(1)] * turn
        about += rows.turn[e, U(2)] * turn
        if byte != _ALL:
            exists = bits(byte)
            gx = choose(exists, gx, 0.0)
            gy = choose(exists, gy, 0.0)
            about = choose(exists, about, 0.0)
        fx += gx
        fy += gy
        moment += about
    return fx, fy, moment


@njit(**FAST)
def _force_blocks(rows, first, last, u, force):
    """Fill force (3, slots) for blocks first to last − 1."""
    if first == last:
        return
    stray_forces(rows, first, last, u)
    ux, uy, ut = u[0], u[1], u[2]
    group, column, r = place_of(rows, first)
    for block in range(first, last):
        if block > first:
            group, column, r = next_place(rows, block, group, column, r)
        i = U(LANES * block)
        x, y, turn = load(ux, i), load(uy, i), load(ut, i)
        fx, fy, moment = _block_force(rows, r, column, LANES * block, x, y, turn, ux, uy, ut)
        if rows.special[block] and rows.stray.size > 0:
            fx += load(rows.extra[0], i)
            fy += load(rows.extra[1], i)
            moment += load(rows.extra[2], i)
        store(force[0], i, fx)
        store(force[1], i, fy)
        store(force[2], i, moment)


@njit(**INLINED)
def gathered(rows, block, r, column, u, body):
    """Forces on the disks of a block without steady loads, displacements, and factors from forces to speeds.

    Returns forces and moment, displacements, Δt over mass and over moment of inertia, and whether the block is special.
    """
    i = U(LANES * block)
    ux, uy, ut = u[0], u[1], u[2]
    x, y, turn = load(ux, i), load(uy, i), load(ut, i)
    fx, fy, moment = _block_force(rows, r, column, LANES * block, x, y, turn, ux, uy, ut)
    b = splat(body.step * rows.inverse_mass[r])
    b_turn = splat(body.step * rows.inverse_inertia[r])
    special = rows.special[block]
    if special:
        b = load(body.mobility, i)
        b_turn = load(body.inverse_inertia, i)
        if rows.stray.size > 0:
            fx += load(rows.extra[0], i)
            fy += load(rows.extra[1], i)
            moment += load(rows.extra[2], i)
    return fx, fy, moment, x, y, turn, b, b_turn, special


@njit(**FAST)
def _move_blocks(rows, first, last, u, v, body, u_next):
    """One step of the disks in blocks first to last − 1 without steady loads and local damping."""
    if first == last:
        return
    stray_forces(rows, first, last, u)
    across, up, about = body.free[0], body.free[1], body.free[2]
    group, column, r = place_of(rows, first)
    for block in range(first, last):
        if block > first:
            group, column, r = next_place(rows, block, group, column, r)
        i = U(LANES * block)
        fx, fy, moment, x, y, turn, b, b_turn, special = gathered(rows, block, r, column, u, body)
        now_x = kick(load(v[0], i), fx, across * b)
        now_y = kick(load(v[1], i), fy, up * b)
        now_t = kick(load(v[2], i), moment, about * b_turn)
        go_on(i, special, b, fx, fy, moment, x, y, turn, now_x, now_y, now_t, body.step, v, u_next)


@njit(**FAST)
def _move_loaded_blocks(rows, first, last, u, v, body, u_next, arms):
    """Move blocks under steady loads and local damping; returns surface speed and works, see elastic.move_rows."""
    if first == last:
        return 0.0, 0.0, 0.0
    stray_forces(rows, first, last, u)
    across, up, about = body.free[0], body.free[1], body.free[2]
    nothing = splat(0.0)
    whole, half, speed, spin = nothing, nothing, nothing, nothing
    group, column, r = place_of(rows, first)
    for block in range(first, last):
        if block > first:
            group, column, r = next_place(rows, block, group, column, r)
        i = U(LANES * block)
        fx, fy, moment, x, y, turn, b, b_turn, special = gathered(rows, block, r, column, u, body)
        if body.load.shape[1] > 0:
            fx += load(body.load[0], i)
            fy += load(body.load[1], i)
            moment += load(body.load[2], i)
        was_x, was_y, was_t = load(v[0], i), load(v[1], i), load(v[2], i)
        dx = local_damping(was_x, fx, body.damp)
        dy = local_damping(was_y, fy, body.damp)
        dt = local_damping(was_t, moment, body.damp)
        now_x = kick(was_x, fx - dx, across * b)
        now_y = kick(was_y, fy - dy, up * b)
        now_t = kick(was_t, moment - dt, about * b_turn)
        held = at_most(b, 0.0)
        half += choose(held, 0.0, across * dx * was_x + up * dy * was_y + about * dt * was_t)
        whole += choose(held, 0.0, across * dx * now_x + up * dy * now_y + about * dt * now_t)
        go_on(i, special, b, fx, fy, moment, x, y, turn, now_x, now_y, now_t, body.step, v, u_next)
        if arms.size > 0:
            speed = larger(now_x * now_x + now_y * now_y, speed)
            spin = larger(load(arms, i) * magnitude(now_t), spin)
    fastest = 0.0
    turning = 0.0
    taken = 0.0
    late = 0.0
    for k in range(LANES):
        fastest = max(fastest, lane(speed, U(k)))
        turning = max(turning, lane(spin, U(k)))
        taken += lane(whole, U(k))
        late += lane(half, U(k))
    return np.sqrt(fastest) + turning, 0.5 * body.step * (taken + late), 0.5 * body.step * late


@in_chunks
@njit(**FAST)
def _fill(begin, end, rows, u, force):
    for chunk in range(begin, end):
        first, last = blocks_of(rows, chunk)
        _force_blocks(rows, first, last, u, force)


@in_chunks
@njit(**FAST)
def _move(begin, end, rows, u, v, body, u_next):
    for chunk in range(begin, end):
        first, last = blocks_of(rows, chunk)
        _move_blocks(rows, first, last, u, v, body, u_next)


@in_chunks
@njit(**FAST)
def _move_and_more(begin, end, rows, u, v, body, u_next, fastest, arms, damped):
    for chunk in range(begin, end):
        first, last = blocks_of(rows, chunk)
        fastest[chunk], damped[chunk, 0], damped[chunk, 1] = _move_loaded_blocks(
            rows, first, last, u, v, body, u_next, arms
        )


@njit(**FAST)
def _fill_lanes(rows, u, force):
    _fill(rows, u, force)


@njit(**FAST)
def _move_lanes(rows, u, v, body, u_next, fastest, arms, damped):
    if body.load.shape[1] > 0 or body.damp > 0.0 or arms.size > 0:
        _move_and_more(rows, u, v, body, u_next, fastest, arms, damped)
        return
    p, q = moving_pair(body.free)
    if p != q:
        move_pair(rows, p, q, u, v, body, u_next)
    else:
        _move(rows, u, v, body, u_next)


answer(fill_forces, LaneRows, _fill_lanes)
answer(move_rows, LaneRows, _move_lanes)
