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

from dembound.kernels.common import FAST, INLINED, U
from dembound.kernels.compiler.lane_access import (
    load,
    load_of,
    note_some,
    store_of,
    store_some,
    where_equal,
)
from dembound.kernels.compiler.lanes import (
    LANES,
    at_most,
    bits,
    byte_of,
    choose,
    lane,
    larger,
    magnitude,
    splat,
    with_sign,
)
from dembound.kernels.compiler.separate import apart
from dembound.kernels.joint_notes import LAID_OUT, PAIRS, STEPS, note_event, note_means
from dembound.kernels.joint_pairs import lay_out, list_faces
from dembound.kernels.law import is_tie
from dembound.kernels.tables.joints import F, JointFaces

FRICTION, CRACK, CLOSING = range(3)
"""Places in `JointFaces.lost`."""


@njit(**INLINED)
def _smaller(values, others):
    return choose(at_most(values, others), values, others)


@njit(**INLINED)
def _rise(joint, slid):
    """By how much (m) faces have ridden up on each other that have slid so far (m) since the start."""
    return joint.law.dilation * _smaller(magnitude(slid), joint.law.dilation_end)


@njit(**INLINED)
def _height_at(place, x0, y0, x1, y1):
    """Height at a place along an axis, of the line through two points with these places and heights."""
    return y0 + (y1 - y0) * (place - x0) / (x1 - x0)


@njit(**INLINED)
def _overlap(frame, k, along, up, turn_i, turn_j):
    """Length (m) and gap of the overlap of eight pairs, its arms, and how far its begin is from that of the first face.

    along, up : m, displacement of the first disk from the second in the frame of the pair; turn_i, turn_j : rad.
    """
    ax, ay = load_of(frame, F.end, k), load_of(frame, F.end + U(1), k)
    bx, by = load_of(frame, F.end + U(2), k), load_of(frame, F.end + U(3), k)
    cx, cy = load_of(frame, F.end + U(4), k), load_of(frame, F.end + U(5), k)
    dx, dy = load_of(frame, F.end + U(6), k), load_of(frame, F.end + U(7), k)
    # all from the centre of the first disk, which the ends turn with
    to_x, to_y = load_of(frame, F.apart, k) - along, load_of(frame, F.apart_up, k) - up
    ax, ay = ax - turn_i * ay, ay + turn_i * ax
    bx, by = bx - turn_i * by, by + turn_i * bx
    cx, cy = to_x + (cx - turn_j * cy), to_y + (cy + turn_j * cx)
    dx, dy = to_x + (dx - turn_j * dy), to_y + (dy + turn_j * dx)
    low, high = larger(ax, cx), _smaller(bx, dx)
    middle = 0.5 * (low + high)
    gap = _height_at(middle, ax, ay, bx, by) - _height_at(middle, cx, cy, dx, dy)
    return larger(high - low, 0.0), gap, middle, middle - to_x, low - ax


@njit(**INLINED)
def _stress(joint, k, gap, moved, slip, length, on, u):
    """Pressure and shear stress of eight pairs, slip and rise of this step, slip so far, cracks, and which pairs slide.

    gap : m, beyond what the faces are pressed in; moved : m, shear displacement; slip : m, so far; on : byte of pairs
    that overlap. Cracks are the energies (J) of lost strength.
    """
    law, pairs = joint.law, joint.pairs
    kn, ks, rest = load(pairs.kn, k), load(pairs.ks, k), load_of(joint.frame, F.rest, k)
    if law.dilation > 0.0:
        gap -= _rise(joint, slip - rest)
    push, rub = 0.0 - kn * gap, ks * (slip - moved)
    slipped, risen, cracked, slides = splat(0.0), splat(0.0), splat(0.0), np.uint8(0)
    if law.fails:
        intact = np.uint8(byte_of(where_equal(pairs.intact, k, np.uint8(1))) & on)
        if intact != 0:
            torn = np.uint8(~byte_of(at_most(splat(-law.tension), push)))
            cut = np.uint8(~byte_of(at_most(magnitude(rub), law.cohesion + law.friction * larger(push, 0.0))))
            broken = np.uint8((torn | cut) & intact)
            if broken != 0:
                cracked = choose(bits(broken), 0.5 * length * (push * push / kn + rub * rub / ks), 0.0)
                intact = np.uint8(intact & ~broken)
                for each in range(LANES):
                    if broken & np.uint8(1 << each):
                        note_event(joint, k + U(each), torn & np.uint8(1 << each), u)
        note_some(pairs.intact, k, intact, np.uint8(0), np.uint8(255))
        loose = np.uint8(on & ~intact)
        if loose != 0:
            push = choose(bits(loose), larger(push, 0.0), push)
            bearing = load(pairs.bearing, k)
            bearing += law.follows * (push + load(pairs.drag, k) - bearing)
            bearing = choose(at_most(push, 0.0), 0.0, bearing)
            store_some(pairs.bearing, k, bearing, loose)
            most = law.friction * bearing
            slid = np.uint8(loose & ~byte_of(at_most(magnitude(rub), most)))
            if slid != 0:
                slides = np.uint8(slid & ~byte_of(at_most(push, 0.0)))
                rub = choose(bits(slid), with_sign(most, rub), rub)
                slipped = choose(bits(slid), moved + rub / ks - slip, 0.0)
                if law.dilation > 0.0:
                    risen = _rise(joint, slip + slipped - rest) - _rise(joint, slip - rest)
                    push = choose(bits(slid), larger(kn * (risen - gap), 0.0), push)
                slip += slipped
    return push, rub, slipped, risen, slip, cracked, slides


@njit(**INLINED)
def _push_eight(joint, k, exists, u, taken):
    """Forces of eight pairs from k on, in joint.pushes; taken with the energies (J) they took added, see `lost`.

    exists : byte of those there are. Their motion is in joint.motion. Returns taken, and the byte of those that act.
    """
    pairs, frame, motion = joint.pairs, joint.frame, joint.motion
    tx, ty = load_of(frame, F.along_x, k), load_of(frame, F.along_y, k)
    x, y, vx, vy = (
        load_of(motion, U(0), U(0)),
        load_of(motion, U(1), U(0)),
        load_of(motion, U(2), U(0)),
        load_of(motion, U(3), U(0)),
    )
    turn_i, turn_j = load_of(motion, U(4), U(0)), load_of(motion, U(5), U(0))
    spin_i, spin_j = load_of(motion, U(6), U(0)), load_of(motion, U(7), U(0))
    along, up = tx * x + ty * y, tx * y - ty * x
    length, gap, arm_i, arm_j, begin = _overlap(frame, k, along, up, turn_i, turn_j)
    before = load(pairs.length, k)
    overlaps = np.uint8(exists & ~byte_of(at_most(length, 0.0)))
    acts = np.uint8(exists & (overlaps | ~byte_of(at_most(before, 0.0))))
    if acts == 0:
        return taken, acts
    height_i, height_j = load_of(frame, F.height, k), load_of(frame, F.height + U(1), k)
    moved = along + turn_i * height_i + turn_j * height_j
    # rates half a step before, with the arms of the step before and of this one
    rise, sliding = tx * vy - ty * vx, tx * vx + ty * vy + spin_i * height_i + spin_j * height_j
    opening = rise + spin_i * arm_i - spin_j * arm_j
    opened = rise + spin_i * load(pairs.arm, k) - spin_j * load(pairs.arm_2, k)
    store_some(pairs.arm, k, arm_i, acts)
    store_some(pairs.arm_2, k, arm_j, acts)
    store_some(pairs.begin, k, begin, acts)
    store_some(pairs.opening, k, gap, overlaps)
    gap -= load_of(frame, F.closure, k)
    slip = choose(at_most(before, 0.0), moved, load(pairs.slip, k))  # pairs that begin to overlap have no shear
    push, rub, slipped, risen, slip, cracked, slides = _stress(joint, k, gap, moved, slip, length, overlaps, u)
    on = bits(overlaps)
    push, rub = choose(on, push, 0.0), choose(on, rub, 0.0)
    energy = 0.5 * length * (push * push / load(pairs.kn, k) + rub * rub / load(pairs.ks, k))
    # what the forces have taken from the disks since the step before, and is not stored
    was_push, was_rub = before * load(pairs.pressure, k), before * load(pairs.shear, k)
    N, S = length * push, length * rub
    done = 0.5 * joint.law.step * (was_push * opened + N * opening + (was_rub + S) * sliding)
    passed = load(pairs.energy, k) - energy - done
    broken = larger(cracked - energy, 0.0)
    rubbed = -0.5 * (was_rub + S) * slipped
    if joint.law.dilation > 0.0:
        rubbed -= 0.5 * (was_push + N) * risen
    rubbed = choose(bits(slides), choose(at_most(cracked, 0.0), rubbed, 0.0), 0.0)
    closing = choose(bits(acts), passed - rubbed - broken, 0.0)
    store_some(pairs.slip, k, slip, acts)
    store_some(pairs.length, k, length, acts)
    store_some(pairs.energy, k, energy, acts)
    store_some(pairs.pressure, k, push, acts)
    store_some(pairs.shear, k, rub, acts)
    note_some(pairs.slides, k, slides, np.uint8(0), acts)
    pushes = joint.pushes
    store_of(pushes, U(0), U(0), choose(on, S * tx - N * ty, 0.0))
    store_of(pushes, U(1), U(0), choose(on, S * ty + N * tx, 0.0))
    store_of(pushes, U(2), U(0), choose(on, N * arm_i + S * height_i, 0.0))
    store_of(pushes, U(3), U(0), choose(on, S * height_j - N * arm_j, 0.0))
    return (taken[0] + rubbed, taken[1] + choose(bits(acts), broken, 0.0), taken[2] + closing), acts


@njit(**FAST)
def _follow_disks(joint, u):
    """Clear joint.force; whether a face has moved by half of the margin since pairs were listed."""
    least, furthest = (0.5 * joint.law.margin) ** 2, 0.0
    for face in range(joint.disk.size):
        f = U(face)
        i = U(joint.disk[f])
        x, y = u[U(0), i] - joint.listed[f, U(0)], u[U(1), i] - joint.listed[f, U(1)]
        furthest = max(furthest, x * x + y * y)
        for c in range(3):
            joint.force[f, U(c)] = 0.0
    return furthest > least


@njit(**FAST)
def _gather(joint, first, last, u, v):
    """Fill joint.motion with the motion of the disks of pairs first to last − 1, at most eight."""
    motion = joint.motion
    for k in range(first, last):
        i, j, p = U(joint.disk[joint.pairs.first[k]]), U(joint.disk[joint.pairs.second[k]]), U(k - first)
        motion[U(0), p], motion[U(1), p] = u[U(0), i] - u[U(0), j], u[U(1), i] - u[U(1), j]
        motion[U(2), p], motion[U(3), p] = v[U(0), i] - v[U(0), j], v[U(1), i] - v[U(1), j]
        motion[U(4), p], motion[U(5), p] = u[U(2), i], u[U(2), j]
        motion[U(6), p], motion[U(7), p] = v[U(2), i], v[U(2), j]


@njit(**FAST)
def _add_pushes(joint, first, last):
    """Add the forces of pairs first to last − 1, in joint.pushes, to those of their faces."""
    force, pushes = joint.force, joint.pushes
    for k in range(first, last):
        f, g, p = U(joint.pairs.first[k]), U(joint.pairs.second[k]), U(k - first)
        fx, fy = pushes[U(0), p], pushes[U(1), p]
        force[f, U(0)] += fx
        force[f, U(1)] += fy
        force[f, U(2)] += pushes[U(2), p]
        force[g, U(0)] -= fx
        force[g, U(1)] -= fy
        force[g, U(2)] += pushes[U(3), p]


@apart()
@njit(**FAST)
def push_faces(joint, u, v):
    """Fill joint.force at displacements u (3, n), and joint.lost with what has been taken since the step before.

    v : (3, n) velocities half a step before; zero for disks at rest.
    """
    if _follow_disks(joint, u):
        list_faces(joint, u)
    if joint.counts[LAID_OUT] == 0:
        lay_out(joint)
    taken, count = (splat(0.0), splat(0.0), splat(0.0)), joint.counts[PAIRS]
    for first in range(0, count, LANES):
        last = min(first + LANES, count)
        _gather(joint, first, last, u, v)
        taken, acts = _push_eight(joint, U(first), np.uint8((1 << (last - first)) - 1), u, taken)
        if acts != 0:
            _add_pushes(joint, first, last)
    for c in range(3):
        joint.lost[c] = 0.0
    for k in range(LANES):
        joint.lost[FRICTION] += lane(taken[0], U(k))
        joint.lost[CRACK] += lane(taken[1], U(k))
        joint.lost[CLOSING] += lane(taken[2], U(k))
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
    slide = False
    for k in range(joint.counts[PAIRS]):
        if not pairs.slides[k]:
            pairs.drag[k] = 0.0
            continue
        if not slide:
            slide = True
            for f in range(joint.disk.size):
                for c in range(3):
                    kick[f, c] = 0.0
        f, g = pairs.first[k], pairs.second[k]
        way = -joint.frame[F.along_y, k], joint.frame[F.along_x, k]
        rate, yields = 0.0, 0.0
        for end in range(2):
            face, sign = (f, 1.0) if end == 0 else (g, -1.0)
            i, arm = U(joint.disk[face]), pairs.arm[k] if end == 0 else pairs.arm_2[k]
            rate += sign * (way[0] * v[U(0), i] + way[1] * v[U(1), i] + arm * v[U(2), i])
            yields += way[0] ** 2 * gives[face, 0] + way[1] ** 2 * gives[face, 1] + arm * arm * gives[face, 2]
        drag = step * joint.law.dashpot * pairs.length[k]
        impulse = max(-drag * rate / (1.0 + drag * yields), -step * pairs.length[k] * pairs.pressure[k])
        pairs.drag[k] = impulse / (step * pairs.length[k])
        for end in range(2):
            face, sign = (f, impulse) if end == 0 else (g, -impulse)
            i, arm = U(joint.disk[face]), pairs.arm[k] if end == 0 else pairs.arm_2[k]
            for c in range(3):
                given = sign * (arm if c == 2 else way[c])
                kick[face, c] += given
                change = given * gives[face, c]
                v[U(c), i] += change
                u_next[U(c), i] += step * change
    if not slide:
        return
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
