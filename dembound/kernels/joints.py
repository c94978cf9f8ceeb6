"""Joints: faces of disks on both sides of a line, with stresses where two of them lie opposite each other.

A face moves with its disk, and is as long as the part of the line in the disk's cell, so that on each side they cover
the line once and the two sides stay flat, however far they slide. A pair of overlap L has the forces Lσ and Lτ at the
middle p of the overlap. With n the normal from the second face j to the first, i, t along the line and n = ẑ × t:

    gap g = height of the face of i over that of j at p, less what both are pressed in at the start
    shear w = (u_i − u_j)·t + θ_i h_i + θ_j h_j,    σ = −k_n g,    τ = −k_s (w − slip)

Where it fails, the pair has σ ≥ 0 and |τ| ≤ μσ. A pair that begins to overlap has L = 0 and no shear, so that forces
have no steps. With dilation ψ the faces of slip s since the start ride up on each other by h = tan ψ min(|s|, its end),
and back as they slide back, σ = −k_n (g − h): Itasca's `dilation` and `zdilation`. Friction then takes τ − σ tan ψ.

Elastic bodies that slide on each other drive waves, as friction follows the pressure (Adams 1995). It therefore follows
with a delay (Prakash & Clifton 1993, Ranjith & Rice 2001), in which P waves run one diameter. And a normal dashpot acts
while a pair slides: in each step, after all forces, pair by pair, by the impulse −c L Δt × the rate after it, so that
it takes energy whatever the step is. Friction counts its stress, too.
"""

import numpy as np
from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.separate import apart
from dembound.kernels.joint_notes import NEEDED, PAIRS, STEPS, note_event, note_means
from dembound.kernels.joint_pairs import begin_pair, copy_pair
from dembound.kernels.law import is_tie
from dembound.kernels.tables.joints import JointFaces

FRICTION, CRACK, CLOSING = range(3)
"""Places in `JointFaces.lost`."""


@njit(**FAST)
def _end(joint, u, f, end):
    """Place (x, y) m of an end, 0 or 1, of face f at displacements u (3, n)."""
    i = U(joint.disk[f])
    x, y = joint.ends[f, 2 * end], joint.ends[f, 2 * end + 1]
    turn = u[U(2), i]
    return (
        x + u[U(0), i] - turn * (y - joint.centre[f, 1]),
        y + u[U(1), i] + turn * (x - joint.centre[f, 0]),
    )


@njit(**FAST)
def _height_at(place, x0, y0, x1, y1):
    """Height at a place along an axis, of the line through two points with these places and heights."""
    return y0 + (y1 - y0) * (place - x0) / (x1 - x0)


@njit(**FAST)
def _rise(joint, k):
    """By how much (m) the faces of pair k have ridden up on each other, as they have slid."""
    law, pairs = joint.law, joint.pairs
    slid = abs(pairs.slip[k] - 0.5 * (joint.rest[pairs.first[k]] + joint.rest[pairs.second[k]]))
    return law.dilation * min(slid, law.dilation_end)


@njit(**FAST)
def _stress(joint, k, gap, moved, length, place):
    """Pressure and shear stress of pair k, slip and rise of this step, whether it slides, and energy of lost strength.

    gap : m, beyond what the faces are pressed in; moved : m, shear displacement; place : x, y (m) of the overlap.
    """
    law, pairs = joint.law, joint.pairs
    kn, ks = pairs.kn[k], pairs.ks[k]
    if law.dilation > 0.0:
        gap -= _rise(joint, k)
    push, rub = -kn * gap, -ks * (moved - pairs.slip[k])
    slipped, risen, slides, cracked = 0.0, 0.0, False, 0.0
    if law.fails and pairs.intact[k]:
        torn = push < -law.tension
        if torn or abs(rub) > law.cohesion + law.friction * max(push, 0.0):
            pairs.intact[k] = False
            cracked = 0.5 * length * (push * push / kn + rub * rub / ks)
            note_event(joint, k, torn, place[0], place[1])
    if law.fails and not pairs.intact[k]:
        push = max(push, 0.0)
        bearing = pairs.bearing[k] + law.follows * (push + pairs.drag[k] - pairs.bearing[k])
        pairs.bearing[k] = bearing if push > 0.0 else 0.0
        most = law.friction * pairs.bearing[k]
        if abs(rub) > most:
            slides = push > 0.0
            rub = np.copysign(most, rub)
            slip = moved + rub / ks
            slipped = slip - pairs.slip[k]
            if law.dilation > 0.0:
                before = _rise(joint, k)
                pairs.slip[k] = slip
                risen = _rise(joint, k) - before
                push = max(kn * (risen - gap), 0.0)
            pairs.slip[k] = slip
    return push, rub, slipped, risen, slides, cracked


@njit(**FAST)
def _add(force, f, fx, fy, moment):
    """Add a force (N) and a moment (N·m) to those on face f, force (m, 3)."""
    force[f, U(0)] += fx
    force[f, U(1)] += fy
    force[f, U(2)] += moment


@njit(**FAST)
def _push_pair(joint, k, u, v):
    """Forces of pair k on the disks of its faces, added to joint.force, and what it has taken, to joint.lost."""
    pairs, lost, now = joint.pairs, joint.lost, joint.now
    f, g = U(pairs.first[k]), U(pairs.second[k])
    i, j = U(joint.disk[f]), U(joint.disk[g])
    tx, ty = joint.along[f, U(0)], joint.along[f, U(1)]
    if tx != joint.along[g, U(0)] or ty != joint.along[g, U(1)]:
        tx, ty = tx + joint.along[g, U(0)], ty + joint.along[g, U(1)]
        size = np.sqrt(tx * tx + ty * ty)
        tx, ty = tx / size, ty / size
    ax, ay = now[f, U(0)], now[f, U(1)]
    bx, by = now[f, U(2)] - ax, now[f, U(3)] - ay
    cx, cy = now[g, U(0)] - ax, now[g, U(1)] - ay
    dx, dy = now[g, U(2)] - ax, now[g, U(3)] - ay
    # along the line and from it, seen from the first end of the first face
    b, c, d = tx * bx + ty * by, tx * cx + ty * cy, tx * dx + ty * dy
    low, high = max(0.0, c), min(b, d)
    length = max(high - low, 0.0)
    if length == 0.0 and pairs.length[k] == 0.0:
        return
    height_b, height_c, height_d = tx * by - ty * bx, tx * cy - ty * cx, tx * dy - ty * dx
    middle = 0.5 * (low + high)
    moved = tx * (u[U(0), i] - u[U(0), j]) + ty * (u[U(1), i] - u[U(1), j])
    moved += u[U(2), i] * joint.height[f] + u[U(2), j] * joint.height[g]
    arm_i = middle + tx * (ax - joint.centre[f, 0] - u[U(0), i]) + ty * (ay - joint.centre[f, 1] - u[U(1), i])
    arm_j = middle + tx * (ax - joint.centre[g, 0] - u[U(0), j]) + ty * (ay - joint.centre[g, 1] - u[U(1), j])
    # rates half a step before, with the arms of the step before and of this one
    vx, vy = v[U(0), i] - v[U(0), j], v[U(1), i] - v[U(1), j]
    spin_i, spin_j = v[U(2), i], v[U(2), j]
    rise = tx * vy - ty * vx
    opening = rise + spin_i * arm_i - spin_j * arm_j
    opened = rise + spin_i * pairs.arm[k, 0] - spin_j * pairs.arm[k, 1]
    sliding = tx * vx + ty * vy + spin_i * joint.height[f] + spin_j * joint.height[g]
    before = pairs.length[k]
    if before <= 0.0:
        pairs.slip[k] = moved
    push, rub, slipped, risen, slides, cracked = 0.0, 0.0, 0.0, 0.0, False, 0.0
    if length > 0.0:
        gap = _height_at(middle, 0.0, 0.0, b, height_b) - _height_at(middle, c, height_c, d, height_d)
        pairs.opening[k] = gap
        gap -= joint.closure[f] + joint.closure[g]
        place = ax + tx * middle, ay + ty * middle
        push, rub, slipped, risen, slides, cracked = _stress(joint, k, gap, moved, length, place)
    energy = 0.5 * length * (push * push / pairs.kn[k] + rub * rub / pairs.ks[k])
    # what the forces have taken from the disks since the step before, and is not stored
    half = 0.5 * joint.law.step
    was_push, was_rub = before * pairs.pressure[k], before * pairs.shear[k]
    done = half * (was_push * opened + length * push * opening + (was_rub + length * rub) * sliding)
    taken = -done - (energy - pairs.energy[k])
    broken = max(cracked - energy, 0.0)
    rubbed = 0.0
    if slides and cracked == 0.0:
        rubbed = -0.5 * (was_rub + length * rub) * slipped
        if joint.law.dilation > 0.0:
            rubbed -= 0.5 * (was_push + length * push) * risen
    lost[U(FRICTION)] += rubbed
    lost[U(CRACK)] += broken
    lost[U(CLOSING)] += taken - rubbed - broken
    pairs.slides[k] = slides
    pairs.length[k], pairs.energy[k] = length, energy
    pairs.pressure[k], pairs.shear[k] = push, rub
    pairs.arm[k, 0], pairs.arm[k, 1] = arm_i, arm_j
    if length > 0.0:
        N, S = length * push, length * rub
        fx, fy = S * tx - N * ty, S * ty + N * tx
        _add(joint.force, f, fx, fy, N * arm_i + S * joint.height[f])
        _add(joint.force, g, -fx, -fy, S * joint.height[g] - N * arm_j)
    else:
        pairs.intact[k] = False


@apart()
@njit(**FAST)
def list_faces(joint, u):
    """List the pairs of faces that overlap, or lie apart by less than the margin, at displacements u (3, n)."""
    law, pairs, spare, split = joint.law, joint.pairs, joint.spare, joint.split
    count, room = joint.counts[PAIRS], joint.pairs.first.size
    found, at = 0, 0
    for f in range(split):
        ax, ay = _end(joint, u, f, 0)
        bx, by = _end(joint, u, f, 1)
        tx, ty = joint.along[f, 0], joint.along[f, 1]
        half = 0.5 * (tx * (bx - ax) + ty * (by - ay))
        for g in range(split, joint.disk.size):
            cx, cy = _end(joint, u, g, 0)
            dx, dy = _end(joint, u, g, 1)
            away_x, away_y = 0.5 * (cx + dx - ax - bx), 0.5 * (cy + dy - ay - by)
            other = 0.5 * (abs(tx * (dx - cx) + ty * (dy - cy)))
            near = abs(tx * away_x + ty * away_y) < half + other + law.margin and joint.part[f] == joint.part[g]
            while at < count and (pairs.first[at] < f or (pairs.first[at] == f and pairs.second[at] < g)):
                at += 1
            known = at < count and pairs.first[at] == f and pairs.second[at] == g
            if (near and abs(tx * away_y - ty * away_x) < law.reach) or (known and pairs.length[at] > 0.0):
                if found < room:
                    if known:
                        copy_pair(pairs, at, spare, found)
                    else:
                        begin_pair(joint, found, f, g)
                found += 1
    joint.counts[NEEDED] = max(joint.counts[NEEDED], found)
    found = min(found, room)
    for k in range(found):
        copy_pair(spare, k, pairs, k)
    joint.counts[PAIRS] = found
    for f in range(joint.disk.size):
        i = U(joint.disk[f])
        joint.listed[f, 0], joint.listed[f, 1] = u[U(0), i], u[U(1), i]


@njit(**FAST)
def _follow_disks(joint, u):
    """Fill joint.now, clear joint.force; whether a face has moved by half of the margin since pairs were listed."""
    least, furthest = (0.5 * joint.law.margin) ** 2, 0.0
    for face in range(joint.disk.size):
        f = U(face)
        i = U(joint.disk[f])
        ux, uy, turn = u[U(0), i], u[U(1), i], u[U(2), i]
        x, y = ux - joint.listed[f, 0], uy - joint.listed[f, 1]
        furthest = max(furthest, x * x + y * y)
        for end in range(2):
            x, y = joint.ends[f, U(2 * end)], joint.ends[f, U(2 * end + 1)]
            joint.now[f, U(2 * end)] = x + ux - turn * (y - joint.centre[f, 1])
            joint.now[f, U(2 * end + 1)] = y + uy + turn * (x - joint.centre[f, 0])
        for c in range(3):
            joint.force[f, c] = 0.0
    return furthest > least


@apart()
@njit(**FAST)
def push_faces(joint, u, v):
    """Fill joint.force at displacements u (3, n), and joint.lost with what has been taken since the step before.

    v : (3, n) velocities half a step before; zero for disks at rest.
    """
    for c in range(3):
        joint.lost[c] = 0.0
    if _follow_disks(joint, u):
        list_faces(joint, u)
    for k in range(joint.counts[PAIRS]):
        _push_pair(joint, U(k), u, v)
    note_means(joint)
    joint.counts[STEPS] += 1


@njit(**FAST)
def across(joint, u, v, force):
    """Add the forces of the faces to those on supported nodes (k, 3), see law.across."""
    push_faces(joint, u, v)
    for f in range(joint.disk.size):
        line = U(joint.line[f])
        for c in range(3):
            force[line, c] += joint.force[f, c]


@njit(**FAST)
def _resist_chatter(joint, u_next, v, step, moved, work):
    """Let dashpots resist the opening and closing of pairs that slide; no pair pulls by it."""
    pairs, kick, gives = joint.pairs, joint.kick, joint.gives
    for f in range(joint.disk.size):
        for c in range(3):
            kick[f, c] = 0.0
    for k in range(joint.counts[PAIRS]):
        if not pairs.slides[k]:
            pairs.drag[k] = 0.0
            continue
        f, g = pairs.first[k], pairs.second[k]
        tx, ty = joint.along[f, 0] + joint.along[g, 0], joint.along[f, 1] + joint.along[g, 1]
        size = np.sqrt(tx * tx + ty * ty)
        way = (-ty / size, tx / size)
        rate, yields = 0.0, 0.0
        for end in range(2):
            face, sign = (f, 1.0) if end == 0 else (g, -1.0)
            i, arm = U(joint.disk[face]), pairs.arm[k, end]
            rate += sign * (way[0] * v[U(0), i] + way[1] * v[U(1), i] + arm * v[U(2), i])
            yields += way[0] ** 2 * gives[face, 0] + way[1] ** 2 * gives[face, 1] + arm * arm * gives[face, 2]
        drag = step * joint.law.dashpot * pairs.length[k]
        impulse = max(-drag * rate / (1.0 + drag * yields), -step * pairs.length[k] * pairs.pressure[k])
        pairs.drag[k] = impulse / (step * pairs.length[k])
        for end in range(2):
            face, sign = (f, impulse) if end == 0 else (g, -impulse)
            i = U(joint.disk[face])
            for c in range(3):
                given = sign * (pairs.arm[k, end] if c == 2 else way[c])
                kick[face, c] += given
                change = given * gives[face, c]
                v[U(c), i] += change
                u_next[U(c), i] += step * change
    half, done = 0.0, 0.0
    for f in range(joint.disk.size):
        i, line = U(joint.disk[f]), U(joint.line[f])
        for c in range(3):
            half += 0.5 * kick[f, c] * moved[U(0), U(c), line]
            done += 0.5 * kick[f, c] * (moved[U(0), U(c), line] + v[U(c), i])
    work[0, 1] -= done
    work[1, 1] -= half


@njit(**FAST)
def join(joint, u_next, v, step, inertia, moved, work):
    """Take the work of the faces, which acts inside the body, out of that of the outside, and book what they took."""
    done = 0.0
    half = 0.0
    for f in range(joint.disk.size):
        line = U(joint.line[f])
        for c in range(3):
            before = 0.5 * joint.force[f, c] * moved[U(0), U(c), line]
            half += before
            done += before + 0.5 * joint.force[f, c] * moved[U(1), U(c), line]
    if joint.law.fails and joint.law.dashpot > 0.0:
        _resist_chatter(joint, u_next, v, step, moved, work)
    work[0, 0] -= step * done
    work[1, 0] -= step * half
    for row in range(2):
        work[row, 2] += joint.lost[FRICTION]
        work[row, 3] += joint.lost[CRACK]
        work[row, 6] += joint.lost[CLOSING]


is_tie(JointFaces, across=across, join=join)
