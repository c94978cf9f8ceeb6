"""Rigid walls of line segments that disks touch: linear springs and dashpots, Coulomb's friction, no tension.

Which contacts of a disk count is found in wall_contacts.py. With the normal n from the wall to the centre and t = (n_y,
−n_x): overlap δ = R − d, force N = k_n δ along n and −S along t, with S = k_s s of the path s that the surface slides,
at most μN; moment −RS, of the whole radius, so that its work does not depend on changes of the overlap. Rolling
resistance is that of pairs (laws/linearpbond.py) with R̄ = R: moment −k_s R² θ of the rotation θ that has not slid, at
most rr_fric R N. What friction and dashpots take, and what closing and opening do, is counted as for pairs of disks
(kernels/contacts.py), and the work of walls that move as that of sides.
"""

import math

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, DONE, FAST, LIST_ENDS, MAKES, U, column_sum, largest
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.contacts import CLOSING
from dembound.kernels.law import is_law
from dembound.kernels.tables.contacts import Unloading, Walls
from dembound.kernels.wall_contacts import (
    DRAG,
    FOUND,
    KEPT,
    MOST,
    NX,
    NY,
    OVERLAP,
    PATH,
    PUSH,
    ROLLED,
    WALL,
    find,
    match,
)

LOST = 3
"""Number of energies that a chunk counts in a step."""

FRICTION, CLOSES, DASHPOT = range(3)
"""These energies, J."""


@njit(**FAST)
def _springs(k, w, walls):
    """Normal, shear (N/m) and rolling stiffness (N·m) of contacts of disk k of the list with wall w."""
    kn = walls.given[w, 0] if walls.given[w, 0] > 0.0 else walls.spring[k]
    ks = walls.given[w, 1] if walls.given[w, 1] > 0.0 else kn / walls.kratio[k]
    return kn, ks, ks * walls.radius[k] ** 2


@njit(**FAST)
def _rub(before, now, slid, ks, lost):
    """Count what friction takes as a shear force changes (N) over a path (m); negative where its sign has changed.

    Or a moment (N·m) over a rotation, with its stiffness ks.
    """
    taken = 0.5 * (before + now) * slid - 0.5 * (now * now - before * before) / ks
    lost[FRICTION if taken > 0.0 else CLOSES] += taken


@njit(**FAST)
def _opens(k, o, v, at, step, walls, lost):
    """Count the energies of a contact o of disk k of the list that has ended."""
    own = walls.kept[k, o]
    w, i = int(own[WALL]), U(walls.slot[k])
    kn, ks, kr = _springs(k, w, walls)
    vx = v[U(0), i] * step - (walls.path[at, w, 0] - walls.path[max(at - 1, 0), w, 0])
    vy = v[U(1), i] * step - (walls.path[at, w, 1] - walls.path[max(at - 1, 0), w, 1])
    turned = v[U(2), i] * step
    opened = own[NX] * vx + own[NY] * vy
    slid = own[NY] * vx - own[NX] * vy + walls.radius[k] * v[U(2), i] * step
    lost[CLOSES] += 0.5 * kn * own[OVERLAP] ** 2 - 0.5 * own[PUSH] * opened
    lost[DASHPOT] -= 0.5 * own[DRAG] * opened
    _rub(ks * own[PATH], 0.0, slid, ks, lost)
    _rub(kr * own[ROLLED], 0.0, turned, kr, lost)


@njit(**FAST)
def _push_disk(k, u, v, at, step, walls, found, heir, new, lost, total):
    """Force (3, m) of disk k of the list; lost (LOST,) and total (w, 2) N, by wall, are advanced."""
    force, kept = walls.force, walls.kept[k]
    for c in range(3):
        force[c, k] = 0.0
    i = U(walls.slot[k])
    x, y = walls.place[0, k] + u[U(0), i], walls.place[1, k] + u[U(1), i]
    turned = v[U(2), i] * step
    count = find(x, y, walls.radius[k], walls.start[k], walls.start[k + 1], at, walls, found)
    if count == 0 and kept[0, PUSH] == 0.0:
        return
    match(found, count, kept, heir)
    for o in range(MOST):
        if kept[o, PUSH] > 0.0 and heir[o] < 0:
            _opens(k, o, v, at, step, walls, lost)
    for a in range(count):
        nx, ny, overlap, w = found[a, 0], found[a, 1], found[a, 2], walls.wall[int(found[a, 5])]
        kn, ks, kr = _springs(k, w, walls)
        vx = v[U(0), i] * step - (walls.path[at, w, 0] - walls.path[max(at - 1, 0), w, 0])
        vy = v[U(1), i] * step - (walls.path[at, w, 1] - walls.path[max(at - 1, 0), w, 1])
        opened = nx * vx + ny * vy
        slid = ny * vx - nx * vy + walls.radius[k] * v[U(2), i] * step
        N = kn * overlap
        before = overlap + opened
        was, path, drag, rolled, stored, first = 0.0, 0.0, 0.0, 0.0, 0.0, True
        for o in range(MOST):
            if heir[o] == a:
                was, path, drag, first = kept[o, PUSH], kept[o, PATH], kept[o, DRAG], False
                rolled = kept[o, ROLLED]
                stored = 0.5 * kn * kept[o, OVERLAP] ** 2
                if was > kn * kept[o, OVERLAP] * (0.5 + 0.5 * CLOSING):  # after a first push
                    lost[CLOSES] += 0.5 * (was + N) * (overlap - before) - (0.5 * kn * overlap**2 - stored)
        if first:
            N *= CLOSING
            lost[CLOSES] += 0.5 * N * (overlap - before) - 0.5 * kn * overlap**2
        shear = path + slid
        S = ks * shear
        most = walls.friction[w] * N
        if abs(S) > most:
            S = math.copysign(most, S)
            shear = S / ks
            _rub(ks * path, S, slid, ks, lost)
        angle = rolled + turned
        M = kr * angle
        most = walls.rolling[w] * walls.radius[k] * N
        if abs(M) > most:
            M = math.copysign(most, M)
            angle = M / kr
            _rub(kr * rolled, M, turned, kr, lost)
        push = max(-walls.dashpot[w] * math.sqrt(kn * walls.mass[k]) * opened / step, -N) if step > 0.0 else 0.0
        lost[DASHPOT] -= 0.5 * (drag + push) * opened
        fx, fy = (N + push) * nx - S * ny, (N + push) * ny + S * nx
        force[0, k] += fx
        force[1, k] += fy
        force[2, k] -= walls.radius[k] * S
        force[2, k] -= M
        total[w, 0] += fx
        total[w, 1] += fy
        new[a, NX], new[a, NY], new[a, OVERLAP], new[a, PUSH] = nx, ny, overlap, N
        new[a, PATH], new[a, DRAG], new[a, WALL], new[a, ROLLED] = shear, push, w, angle
    for a in range(MOST):
        for q in range(KEPT):
            kept[a, q] = new[a, q] if a < count else 0.0


@in_chunks
@njit(**MAKES)
def _push(first_chunk, last_chunk, u, v, at, step, walls):
    found, new, heir = np.empty((MOST + 1, FOUND)), np.empty((MOST, KEPT)), np.empty(MOST, np.int64)
    for chunk in range(first_chunk, last_chunk):
        lost, total = walls.lost[chunk], walls.total[chunk]
        for q in range(LOST):
            lost[q] = 0.0
        for w in range(total.shape[0]):
            total[w, 0] = total[w, 1] = 0.0
        for k in range(walls.bound[chunk], walls.bound[chunk + 1]):
            _push_disk(k, u, v, at, step, walls, found, heir, new, lost, total)


@njit(**FAST)
def _row(number, path):
    """The row of the places of walls in a step; after all of them the last one, which repeats the one before."""
    return min(number, path.shape[0] - 1)


@njit(**FAST)
def check(walls, u, u_next, v):
    """Whether a disk that is not listed may have reached a wall."""
    return LIST_ENDS if walls.way[0] >= walls.way[1] else DONE


@njit(**FAST)
def push(walls, u, u_next, v, number, step, work):
    """Compute the forces of walls on disks in step `number`, and what they take; see law.push."""
    at = _row(number, walls.path)
    _push(u, v, at, step, walls)
    walls.step[0] = number
    row = walls.record[number % walls.record.shape[0]]
    for w in range(walls.path.shape[1]):
        fx = 0.0
        fy = 0.0
        for chunk in range(CHUNKS):
            fx += walls.total[chunk, w, 0]
            fy += walls.total[chunk, w, 1]
        row[w, 0], row[w, 1], row[w, 2], row[w, 3] = walls.path[at, w, 0], walls.path[at, w, 1], -fx, -fy
    for column, lost in ((1, DASHPOT), (2, FRICTION), (6, CLOSES)):
        work[0, column] += column_sum(walls.lost, lost)
        if column > 1:
            work[1, column] = work[0, column]  # of damping by the kernels that follow
    return 0


@njit(**FAST)
def move(walls, u, u_next, v, body, nodes):
    """Add the forces of walls to steady loads, with which the disks then move."""
    for k in range(walls.slot.size):
        i = U(walls.slot[k])
        for c in range(3):
            walls.load[c, k] = body.load[U(c), i]
            body.load[U(c), i] += walls.force[c, k]


@njit(**FAST)
def take_off(unloading, u, u_next, v, body, nodes):
    """Restore the steady loads, once all disks have moved."""
    for k in range(unloading.slot.size):
        for c in range(3):
            body.load[U(c), U(unloading.slot[k])] = unloading.load[c, k]


@njit(**FAST)
def _follow(walls, v, step, later):
    """Move walls that follow disks by their mean velocity (m/s), to the row `later` of places."""
    last = walls.path.shape[0] - 1
    for w in range(walls.path.shape[1]):
        if walls.follow[w] < walls.follow[w + 1] and later < last:
            for c in range(2):
                mean = 0.0
                for e in range(walls.follow[w], walls.follow[w + 1]):
                    mean += walls.share[e] * v[U(c), U(walls.leader[e])]
                walls.path[later, w, c] = walls.path[last, w, c] = walls.path[later - 1, w, c] + step * mean


@njit(**FAST)
def finish(walls, v, body, nodes, work):
    """Count the work of walls that move, and how far disks and walls have come since disks near walls were listed."""
    number = walls.step[0]
    at, later = _row(number, walls.path), _row(number + 1, walls.path)
    _follow(walls, v, body.step, number + 1)
    row = walls.record[number % walls.record.shape[0]]
    farthest = 0.0
    whole = 0.0
    half = 0.0
    for w in range(walls.path.shape[1]):
        for c in range(2):
            came = walls.path[at, w, c] - walls.path[max(at - 1, 0), w, c]
            goes = walls.path[later, w, c] - walls.path[at, w, c]
            half -= 0.5 * row[w, 2 + c] * came
            whole -= 0.5 * row[w, 2 + c] * (came + goes)
        away = np.hypot(walls.path[later, w, 0] - walls.path[at, w, 0], walls.path[later, w, 1] - walls.path[at, w, 1])
        farthest = max(farthest, away)
    walls.moved[1] = walls.moved[0] + half
    walls.moved[0] += whole
    work[1, 0] += half
    work[0, 0] += whole
    most = largest(walls.fastest)
    for s in range(nodes.size):
        most = max(most, np.hypot(v[0, nodes[s]], v[1, nodes[s]]))
    walls.way[0] += body.step * most + farthest


is_law(Walls, check=check, push=push, move=move, finish=finish)
is_law(Unloading, move=take_off, finish=None)


@njit(**FAST)
def energy_stored(walls):
    """Energy (J) in the springs of contacts with walls, at the forces of the last step."""
    total = 0.0
    for k in range(walls.slot.size):
        for a in range(MOST):
            own = walls.kept[k, a]
            if own[PUSH] > 0.0:
                kn, ks, kr = _springs(k, int(own[WALL]), walls)
                total += 0.5 * (kn * own[OVERLAP] ** 2 + ks * own[PATH] ** 2 + kr * own[ROLLED] ** 2)
    return total
