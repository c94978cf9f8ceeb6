"""The history-dependent law on rows of copies, eight disks at once (lanes.py).

Pairs that are in no row were found by search, or are between groups of different shapes (single_pairs.py); their forces
are added to those of the rows (pair_lanes.py).
"""

import numpy as np
from numba import njit

from dembound.kernels import bonded as law
from dembound.kernels.common import FAST, INLINED, U
from dembound.kernels.compiler.lanes import LANES, at_most, bits, choose, lane, larger, load, splat
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.contacts import ends_force, note_places
from dembound.kernels.lane_step import (
    blocks_of,
    first_at,
    go_on,
    kick,
    local_damping,
    next_place,
    place_of,
)
from dembound.kernels.law import is_law
from dembound.kernels.pair_lanes import push_rows
from dembound.kernels.single_pairs import push as push_others
from dembound.kernels.tables import LaneBonded


@njit(**INLINED)
def _row_forces(pairs, force, r, column, first):
    """Forces and moments on eight disks of row r by the pairs in rows; `first` is the first place of their column."""
    fx = splat(0.0)
    fy = splat(0.0)
    moment = splat(0.0)
    start = U(3) * r
    for entry in range(pairs.start[start], pairs.start[start + U(1)]):
        c = first + U(pairs.offset[U(entry)])
        fx += load(force[0], c)
        fy += load(force[1], c)
        moment += load(force[2], c)
    for entry in range(pairs.start[start + U(1)], pairs.start[start + U(2)]):
        c = first + U(pairs.offset[U(entry)])
        fx -= load(force[0], c)
        fy -= load(force[1], c)
        moment += load(force[3], c)
    for entry in range(pairs.start[start + U(2)], pairs.start[start + U(3)]):
        byte = pairs.masks[U(pairs.mask[U(entry)] + column)]
        if byte != 0:
            c, own = first + U(pairs.offset[U(entry)]), bits(byte)
            fx -= choose(own, load(force[0], c), 0.0)
            fy -= choose(own, load(force[1], c), 0.0)
            moment += choose(own, load(force[3], c), 0.0)
    return fx, fy, moment


@njit(**FAST)
def _stray_forces(stray, start, end, force, first, last, extra):
    """Forces and moments of the other pairs on the disks in blocks first to last − 1, in extra (3, slots)."""
    for k in range(first_at(stray, LANES * first), first_at(stray, LANES * last)):
        i = U(stray[k])
        extra[U(0), i], extra[U(1), i], extra[U(2), i] = ends_force(U(k), force, start, end)


@njit(**FAST)
def _move_blocks(rows, pairs, first, last, u, v, body, contacts, extra, u_next):
    """One step of the disks in blocks first to last − 1; returns the largest speed and works, see `bonded._move`."""
    if first == last:
        return 0.0, 0.0, 0.0
    across, up, about = body.free[0], body.free[1], body.free[2]
    nothing = splat(0.0)
    whole, half, speed = nothing, nothing, nothing
    force = contacts.force
    group, column, r = place_of(rows, first)
    for block in range(first, last):
        if block > first:
            group, column, r = next_place(rows, block, group, column, r)
        i, row = U(LANES * block), U(r)
        width = pairs.group_row[U(group + 1)] - pairs.group_row[U(group)]
        begin = U(LANES * (pairs.group_block[U(group)] + column * width))
        fx, fy, moment = _row_forces(pairs, force, row, column, begin)
        b = splat(body.step * rows.inverse_mass[row])
        b_turn = splat(body.step * rows.inverse_inertia[row])
        special = rows.special[U(block)]
        if special:
            b = load(body.mobility, i)
            b_turn = load(body.inverse_inertia, i)
            fx += load(extra[0], i)
            fy += load(extra[1], i)
            moment += load(extra[2], i)
        if body.load.shape[1] > 0:
            fx += load(body.load[0], i)
            fy += load(body.load[1], i)
            moment += load(body.load[2], i)
        x, y, turn = load(u[0], i), load(u[1], i), load(u[2], i)
        was_x, was_y, was_t = load(v[0], i), load(v[1], i), load(v[2], i)
        if body.damp > 0.0:
            dx = local_damping(was_x, fx, body.damp)
            dy = local_damping(was_y, fy, body.damp)
            dt = local_damping(was_t, moment, body.damp)
            now_x = kick(was_x, fx - dx, across * b)
            now_y = kick(was_y, fy - dy, up * b)
            now_t = kick(was_t, moment - dt, about * b_turn)
            held = at_most(b, 0.0)
            half += choose(held, 0.0, across * dx * was_x + up * dy * was_y + about * dt * was_t)
            whole += choose(held, 0.0, across * dx * now_x + up * dy * now_y + about * dt * now_t)
        else:
            now_x = kick(was_x, fx, across * b)
            now_y = kick(was_y, fy, up * b)
            now_t = kick(was_t, moment, about * b_turn)
        go_on(i, special, b, fx, fy, moment, x, y, turn, now_x, now_y, now_t, body.step, v, u_next)
        speed = larger(now_x * now_x + now_y * now_y, speed)
    fastest = 0.0
    taken = 0.0
    late = 0.0
    for k in range(LANES):
        fastest = max(fastest, lane(speed, U(k)))
        taken += lane(whole, U(k))
        late += lane(half, U(k))
    return np.sqrt(fastest), 0.5 * body.step * (taken + late), 0.5 * body.step * late


@in_chunks
@njit(**FAST)
def _move(begin, end, u, v, rows, pairs, contacts, stray, stray_start, stray_end, extra, body, u_next, fastest, damped):
    """One step of all disks; fastest (chunks,) gets speeds, damped (chunks, 2) the work of local damping."""
    for chunk in range(begin, end):
        first, last = blocks_of(rows, chunk)
        _stray_forces(stray, stray_start, stray_end, contacts.force, first, last, extra)
        fastest[chunk], damped[chunk, 0], damped[chunk, 1] = _move_blocks(
            rows, pairs, first, last, u, v, body, contacts, extra, u_next
        )


@njit(**FAST)
def begin(lanes):
    """Compute the displacement of particles anew before the first step."""
    law.begin(lanes.bonded)


@njit(**FAST)
def check(lanes, u, u_next, v):
    """Whether a pair that is not listed may have come into contact."""
    return law.check(lanes.bonded, u, u_next, v)


@njit(**FAST)
def push(lanes, u, u_next, v, number, step, work):
    """Compute the forces of all pairs; returns the number of bonds that broke, if the loop is to stop at breaks."""
    bonded = lanes.bonded
    breaks = push_rows(u, v, step, number, lanes.pairs, bonded.contacts, bonded.limits, bonded.lost)
    breaks += push_others(u, v, step, number, bonded.contacts, bonded.limits, lanes.also_lost)
    if breaks > 0:
        note_places(u, number, bonded.contacts)
    law.note_lost(bonded.lost, work)
    law.note_lost(lanes.also_lost, work)
    return breaks if bonded.stops else 0


@njit(**FAST)
def move(lanes, u, u_next, v, body, nodes):
    """One step of all particles, see law.move."""
    bonded = lanes.bonded
    _move(
        u, v, lanes.rows, lanes.pairs, bonded.contacts, lanes.stray, lanes.stray_start, lanes.stray_end, lanes.extra,
        body, u_next, bonded.fastest, bonded.damped,
    )  # fmt: skip


@njit(**FAST)
def finish(lanes, v, body, nodes, work):
    """Add the energy taken by local damping to the ledger, and update the distance particles have moved."""
    law.finish(lanes.bonded, v, body, nodes, work)


is_law(LaneBonded, begin=begin, check=check, push=push, move=move, finish=finish)
