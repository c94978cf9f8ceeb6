"""The elastic law and the step of central differences on rows of copies, eight copies at once (lanes.py).

A contact that all copies of a disk have is one entry of the row of these copies: a matrix of eight constants, and the
number of slots to the neighbours' row. With Δ = u_j − u_i the force on i is

    F_x = k_xx Δ_x + k_xy Δ_y + k_xθ θ_j + own_x θ_i
    F_y = k_xy Δ_x + k_yy Δ_y + k_yθ θ_j + own_y θ_i
    M   = k_θx Δ_x + k_θy Δ_y + k_θθ θ_j + own_θ θ_i

which is elastic.py's law multiplied out; what θ_i adds is one constant for all contacts of a row. A contact that not
all copies have also has a mask of those that do. Contacts that no row shares, strays, are computed one by one before.
"""

import numpy as np
from numba import njit, prange

from dembound.kernels.common import CHUNKS, FAST, PARALLEL, REST, U
from dembound.kernels.elastic import fill_forces, move_rows, row_force
from dembound.kernels.lanes import LANES, at_most, bits, choose, lane, load, magnitude, splat, store, with_sign
from dembound.kernels.law import answer
from dembound.kernels.tables import LaneRows

_INLINED = FAST | {"inline": "always"}


@njit(**_INLINED)
def _block_force(rows, r, block, x, y, turn, ux, uy, ut):
    """Forces and moments on the eight disks of a block of row r, displaced by x, y and turn, by what rows share."""
    fx = rows.own[r, U(0)] * turn
    fy = rows.own[r, U(1)] * turn
    moment = rows.own[r, U(2)] * turn
    at = block - rows.first[r]
    for entry in range(rows.start[r], rows.start[r + 1]):
        e = U(entry)
        j = U(LANES * block + rows.shift[e])
        mask = rows.mask[e]
        k = rows.constants
        if mask < 0:
            dx = load(ux, j) - x
            dy = load(uy, j) - y
            tj = load(ut, j)
            fx = k[e, U(0)] * dx + (k[e, U(1)] * dy + (k[e, U(3)] * tj + fx))
            fy = k[e, U(1)] * dx + (k[e, U(2)] * dy + (k[e, U(4)] * tj + fy))
            moment = k[e, U(5)] * dx + (k[e, U(6)] * dy + (k[e, U(7)] * tj + moment))
        else:
            byte = rows.masks[U(mask + at)]
            if byte != 0:
                exists = bits(byte)
                own = rows.turn
                dx = load(ux, j) - x
                dy = load(uy, j) - y
                tj = load(ut, j)
                gx = k[e, U(0)] * dx + (k[e, U(1)] * dy + (k[e, U(3)] * tj + (own[e, U(0)] * turn + fx)))
                gy = k[e, U(1)] * dx + (k[e, U(2)] * dy + (k[e, U(4)] * tj + (own[e, U(1)] * turn + fy)))
                about = k[e, U(5)] * dx + (k[e, U(6)] * dy + (k[e, U(7)] * tj + (own[e, U(2)] * turn + moment)))
                fx = choose(exists, gx, fx)
                fy = choose(exists, gy, fy)
                moment = choose(exists, about, moment)
    return fx, fy, moment


@njit(**_INLINED)
def _kick(v, f, b):
    """Half-step velocity after a force f, see step.kick."""
    w = v + b * f
    return choose(at_most(magnitude(w), REST), 0.0, w)


@njit(**_INLINED)
def _local_damping(v, f, damp):
    """The force of local damping (Cundall: −damp·|F|·sign(v)), turned round."""
    return choose(at_most(magnitude(v), 0.0), 0.0, with_sign(damp * magnitude(f), v))


@njit(**_INLINED)
def _larger(a, b):
    """The larger of two numbers in each lane."""
    return choose(at_most(a, b), b, a)


@njit(**FAST)
def _first_at(numbers, least):
    """Index of the first of ascending numbers that is not below the least."""
    low = 0
    high = numbers.size
    while low < high:
        middle = (low + high) // 2
        if numbers[middle] < least:
            low = middle + 1
        else:
            high = middle
    return low


@njit(**FAST)
def _stray_forces(rows, first, last, u):
    """Forces and moments of strays on the disks in blocks first to last − 1, in rows.extra."""
    extra = rows.extra
    for k in range(_first_at(rows.stray, LANES * first), _first_at(rows.stray, LANES * last)):
        i = U(rows.stray[k])
        fx, fy, moment = row_force(
            U(k), i, u, rows.stray_start, rows.stray_neighbour, rows.stray_type, rows.stray_constants
        )
        extra[U(0), i] = fx
        extra[U(1), i] = fy
        extra[U(2), i] = moment


@njit(**FAST)
def _force_blocks(rows, first, last, u, force):
    """Fill force (3, slots) for blocks first to last − 1."""
    _stray_forces(rows, first, last, u)
    ux, uy, ut = u[0], u[1], u[2]
    r = _first_at(rows.first, first + 1) - 1
    for block in range(first, last):
        while block >= rows.first[r + 1]:
            r += 1
        i = U(LANES * block)
        fx, fy, moment = _block_force(rows, r, block, load(ux, i), load(uy, i), load(ut, i), ux, uy, ut)
        if rows.special[block] and rows.stray.size > 0:
            fx += load(rows.extra[0], i)
            fy += load(rows.extra[1], i)
            moment += load(rows.extra[2], i)
        store(force[0], i, fx)
        store(force[1], i, fy)
        store(force[2], i, moment)


@njit(**FAST)
def _move_blocks(rows, first, last, u, v, body, u_next, arms, result):
    """One step of the disks in blocks first to last − 1; result (3,) gets surface speed and works."""
    _stray_forces(rows, first, last, u)
    ux, uy, ut = u[0], u[1], u[2]
    vx, vy, vt = v[0], v[1], v[2]
    across, up, about = body.free[0], body.free[1], body.free[2]
    damp, step = body.damp, body.step
    nothing = splat(0.0)
    whole = nothing
    half = nothing
    speed = nothing
    spin = nothing
    r = _first_at(rows.first, first + 1) - 1
    mobility = splat(step / rows.mass[r])
    inverse_inertia = splat(step / rows.inertia[r])
    for block in range(first, last):
        if block >= rows.first[r + 1]:
            r += 1
            mobility = splat(step / rows.mass[r])
            inverse_inertia = splat(step / rows.inertia[r])
        i = U(LANES * block)
        x = load(ux, i)
        y = load(uy, i)
        turn = load(ut, i)
        fx, fy, moment = _block_force(rows, r, block, x, y, turn, ux, uy, ut)
        special = rows.special[block]
        b = mobility
        b_turn = inverse_inertia
        if special:
            b = load(body.mobility, i)
            b_turn = load(body.inverse_inertia, i)
            if rows.stray.size > 0:
                fx += load(rows.extra[0], i)
                fy += load(rows.extra[1], i)
                moment += load(rows.extra[2], i)
        if body.load.shape[1] > 0:
            fx += load(body.load[0], i)
            fy += load(body.load[1], i)
            moment += load(body.load[2], i)
        was_x = load(vx, i)
        was_y = load(vy, i)
        was_t = load(vt, i)
        if damp > 0.0:
            dx = _local_damping(was_x, fx, damp)
            dy = _local_damping(was_y, fy, damp)
            dt = _local_damping(was_t, moment, damp)
            now_x = _kick(was_x, fx - dx, across * b)
            now_y = _kick(was_y, fy - dy, up * b)
            now_t = _kick(was_t, moment - dt, about * b_turn)
            held = at_most(b, 0.0)
            half += choose(held, 0.0, across * dx * was_x + up * dy * was_y + about * dt * was_t)
            whole += choose(held, 0.0, across * dx * now_x + up * dy * now_y + about * dt * now_t)
        else:
            now_x = _kick(was_x, fx, across * b)
            now_y = _kick(was_y, fy, up * b)
            now_t = _kick(was_t, moment, about * b_turn)
        store(vx, i, now_x)
        store(vy, i, now_y)
        store(vt, i, now_t)
        x += step * now_x
        y += step * now_y
        turn += step * now_t
        if special:
            held = at_most(b, 0.0)
            x = choose(held, fx, x)
            y = choose(held, fy, y)
            turn = choose(held, moment, turn)
        store(u_next[0], i, x)
        store(u_next[1], i, y)
        store(u_next[2], i, turn)
        if arms.size > 0:
            speed = _larger(now_x * now_x + now_y * now_y, speed)
            spin = _larger(load(arms, i) * magnitude(now_t), spin)
    fastest = 0.0
    turning = 0.0
    taken = 0.0
    late = 0.0
    for k in range(LANES):
        fastest = max(fastest, lane(speed, U(k)))
        turning = max(turning, lane(spin, U(k)))
        taken += lane(whole, U(k))
        late += lane(half, U(k))
    result[0] = np.sqrt(fastest) + turning
    result[1] = 0.5 * step * (taken + late)
    result[2] = 0.5 * step * late


@njit(**PARALLEL)
def _fill(rows, u, force):
    begin, end = rows.first[0], rows.first[rows.first.size - 1]
    n = end - begin
    for chunk in prange(CHUNKS):
        _force_blocks(rows, begin + chunk * n // CHUNKS, begin + (chunk + 1) * n // CHUNKS, u, force)


@njit(**PARALLEL)
def _move(rows, u, v, body, u_next, fastest, arms, damped):
    begin, end = rows.first[0], rows.first[rows.first.size - 1]
    n = end - begin
    result = np.zeros((CHUNKS, 3))  # made anew: nothing is shared between threads
    for chunk in prange(CHUNKS):
        first, last = begin + chunk * n // CHUNKS, begin + (chunk + 1) * n // CHUNKS
        if first < last:
            _move_blocks(rows, first, last, u, v, body, u_next, arms, result[chunk])
        fastest[chunk] = result[chunk, 0]
        damped[chunk, 0] = result[chunk, 1]
        damped[chunk, 1] = result[chunk, 2]


@njit(**FAST)
def _fill_lanes(rows, u, force):
    _fill(rows, u, force)


@njit(**FAST)
def _move_lanes(rows, u, v, body, u_next, fastest, arms, damped):
    _move(rows, u, v, body, u_next, fastest, arms, damped)


answer(fill_forces, LaneRows, _fill_lanes)
answer(move_rows, LaneRows, _move_lanes)
