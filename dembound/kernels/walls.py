"""Rigid walls of line segments that disks touch: linear springs and dashpots, Coulomb's friction, no tension.

A disk is pushed by the closest point of a segment, along the line from it to the centre: a face inside the segment, a
vertex at its ends. Of all that it overlaps, faces count first, then the deeper ones; each only if its normal differs by
more than 30° from those that count already, and a vertex only if none of its own segments has a face that counts. So a
disk that rolls over a joint of two segments, or along a fine polyline, is pushed once, and in a sharp corner by both
faces. The shear spring stays with the contact whose normal is nearest to the one of the step before, so that it passes
to the next segment.

With the normal n from the wall to the centre and t = (n_y, −n_x): overlap δ = R − d, force N = k_n δ along n and −S
along t, with S = k_s s of the path s that the surface slides, at most μN; moment −RS, of the whole radius, so that its
work does not depend on changes of the overlap. What friction and dashpots take, and what closing and opening do, is
counted as for pairs of disks (kernels/contacts.py), and the work of walls that move as that of sides.
"""

import math

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, DONE, FAST, LIST_ENDS, MAKES, U, column_sum, largest
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.contacts import CLOSING
from dembound.kernels.law import is_law
from dembound.kernels.tables.contacts import Unloading, Walls

MOST = 4
"""Largest number of contacts of a disk with walls; their normals differ by more than 30°."""

NEAR = math.cos(math.radians(30.0))
"""Product of two normals above which they are of one contact."""

NX, NY, OVERLAP, PUSH, PATH, DRAG, WALL = range(7)
"""What a contact keeps: its normal, overlap (m), spring force (N), shear (m), dashpot force (N), and its wall."""

KEPT, FOUND, LOST = 7, 7, 3
"""Numbers of a contact kept; of one found: normal, overlap, place, segment, and whether it is a face; of energies."""

FRICTION, CLOSES, DASHPOT = range(3)
"""Energies (J) that a chunk counts in a step."""


@njit(**FAST)
def nearest(x, y, ends, s, across, up):
    """Point of segment s, shifted by (across, up) m, that is closest to (x, y), and whether it is inside of it."""
    ax, ay = ends[s, 0] + across, ends[s, 1] + up
    bx, by = ends[s, 2] - ends[s, 0], ends[s, 3] - ends[s, 1]
    along = ((x - ax) * bx + (y - ay) * by) / (bx * bx + by * by)
    if along <= 0.0:
        return ax, ay, False
    if along >= 1.0:  # the same bits as the first point of the next segment
        return ends[s, 2] + across, ends[s, 3] + up, False
    return ax + along * bx, ay + along * by, True


@njit(**FAST)
def _is_free(own, found, count, ends, shift):
    """Whether a contact found may count beside others that do (count of them), see this module; own, found (FOUND,)."""
    for a in range(count):
        other = found[a]
        if own[0] * other[0] + own[1] * other[1] > NEAR or (own[3] == other[3] and own[4] == other[4]):
            return False
        if own[6] == 0.0 and other[6] == 1.0:
            s = int(other[5])
            for e in (0, 2):
                if own[3] == ends[s, e] + shift[0] and own[4] == ends[s, e + 1] + shift[1]:
                    return False
    return True


@njit(**FAST)
def _find(x, y, radius, first, last, at, walls, found):
    """Contacts of a disk at (x, y) m with segments first to last − 1 of its list; fills found (MOST + 1, FOUND).

    at : row of the walls' places. Returns their number.
    """
    ends, wall, path = walls.ends, walls.wall, walls.path
    count = 0
    own = found[MOST]
    while count < MOST:
        best = found[count]
        best[2] = 0.0
        touching = 0
        for c in range(first, last):
            s = walls.segment[c]
            shift = path[at, wall[s]]
            px, py, inside = nearest(x, y, ends, s, shift[0], shift[1])
            square = (x - px) * (x - px) + (y - py) * (y - py)
            if square >= radius * radius or square == 0.0:
                continue
            touching += 1
            d = math.sqrt(square)
            overlap = radius - d
            face = 1.0 if inside else 0.0
            if overlap <= 0.0 or (best[2] > 0.0 and (face, overlap) <= (best[6], best[2])):
                continue
            own[0], own[1], own[2], own[3], own[4], own[5], own[6] = (
                (x - px) / d, (y - py) / d, overlap, px, py, s, face,
            )  # fmt: skip
            if _is_free(own, found, count, ends, shift):
                for q in range(FOUND):
                    best[q] = own[q]
        if best[2] > 0.0:
            count += 1
        if best[2] == 0.0 or touching == count:
            break
    return count


@njit(**FAST)
def _match(found, count, kept, heir):
    """For each contact kept (MOST, KEPT) of the step before its heir among those found, −1 for none."""
    for o in range(MOST):
        heir[o] = -1
        most = NEAR
        for a in range(count):
            alike = kept[o, NX] * found[a, 0] + kept[o, NY] * found[a, 1]
            if kept[o, PUSH] > 0.0 and alike > most:
                heir[o], most = a, alike
    for o in range(MOST):  # of several the one with the nearest normal
        for p in range(MOST):
            if o != p and heir[o] >= 0 and heir[o] == heir[p]:
                a = heir[o]
                one = kept[o, NX] * found[a, 0] + kept[o, NY] * found[a, 1]
                two = kept[p, NX] * found[a, 0] + kept[p, NY] * found[a, 1]
                if one >= two:
                    heir[p] = -1
                else:
                    heir[o] = -1


@njit(**FAST)
def _springs(k, w, walls):
    """Normal and shear stiffness (N/m) of contacts of disk k of the list with wall w."""
    kn = walls.given[w, 0] if walls.given[w, 0] > 0.0 else walls.spring[k]
    ks = walls.given[w, 1] if walls.given[w, 1] > 0.0 else kn / walls.kratio[k]
    return kn, ks


@njit(**FAST)
def _rub(before, now, slid, ks, lost):
    """Count what friction takes as a shear force changes (N) over a path (m); negative where its sign has changed."""
    taken = 0.5 * (before + now) * slid - 0.5 * (now * now - before * before) / ks
    lost[FRICTION if taken > 0.0 else CLOSES] += taken


@njit(**FAST)
def _opens(k, o, v, at, step, walls, lost):
    """Count the energies of a contact o of disk k of the list that has ended."""
    own = walls.kept[k, o]
    w, i = int(own[WALL]), U(walls.slot[k])
    kn, ks = _springs(k, w, walls)
    vx = v[U(0), i] * step - (walls.path[at, w, 0] - walls.path[max(at - 1, 0), w, 0])
    vy = v[U(1), i] * step - (walls.path[at, w, 1] - walls.path[max(at - 1, 0), w, 1])
    opened = own[NX] * vx + own[NY] * vy
    slid = own[NY] * vx - own[NX] * vy + walls.radius[k] * v[U(2), i] * step
    lost[CLOSES] += 0.5 * kn * own[OVERLAP] ** 2 - 0.5 * own[PUSH] * opened
    lost[DASHPOT] -= 0.5 * own[DRAG] * opened
    _rub(ks * own[PATH], 0.0, slid, ks, lost)


@njit(**FAST)
def _push_disk(k, u, v, at, step, walls, found, heir, new, lost, total):
    """Force (3, m) of disk k of the list; lost (LOST,) and total (w, 2) N, by wall, are advanced."""
    force, kept = walls.force, walls.kept[k]
    for c in range(3):
        force[c, k] = 0.0
    i = U(walls.slot[k])
    x, y = walls.place[0, k] + u[U(0), i], walls.place[1, k] + u[U(1), i]
    count = _find(x, y, walls.radius[k], walls.start[k], walls.start[k + 1], at, walls, found)
    if count == 0 and kept[0, PUSH] == 0.0:
        return
    _match(found, count, kept, heir)
    for o in range(MOST):
        if kept[o, PUSH] > 0.0 and heir[o] < 0:
            _opens(k, o, v, at, step, walls, lost)
    for a in range(count):
        nx, ny, overlap, w = found[a, 0], found[a, 1], found[a, 2], walls.wall[int(found[a, 5])]
        kn, ks = _springs(k, w, walls)
        vx = v[U(0), i] * step - (walls.path[at, w, 0] - walls.path[max(at - 1, 0), w, 0])
        vy = v[U(1), i] * step - (walls.path[at, w, 1] - walls.path[max(at - 1, 0), w, 1])
        opened = nx * vx + ny * vy
        slid = ny * vx - nx * vy + walls.radius[k] * v[U(2), i] * step
        N = kn * overlap
        before = overlap + opened
        was, path, drag, stored, first = 0.0, 0.0, 0.0, 0.0, True
        for o in range(MOST):
            if heir[o] == a:
                was, path, drag, first = kept[o, PUSH], kept[o, PATH], kept[o, DRAG], False
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
        push = max(-walls.dashpot[w] * math.sqrt(kn * walls.mass[k]) * opened / step, -N) if step > 0.0 else 0.0
        lost[DASHPOT] -= 0.5 * (drag + push) * opened
        fx, fy = (N + push) * nx - S * ny, (N + push) * ny + S * nx
        force[0, k] += fx
        force[1, k] += fy
        force[2, k] -= walls.radius[k] * S
        total[w, 0] += fx
        total[w, 1] += fy
        new[a, NX], new[a, NY], new[a, OVERLAP], new[a, PUSH] = nx, ny, overlap, N
        new[a, PATH], new[a, DRAG], new[a, WALL] = shear, push, w
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
def finish(walls, v, body, nodes, work):
    """Count the work of walls that move, and how far disks and walls have come since disks near walls were listed."""
    number = walls.step[0]
    at, later = _row(number, walls.path), _row(number + 1, walls.path)
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


@njit(**MAKES)
def near_disks(u, slot, place, radius, reach, bins, ends, shift, counts, segment):
    """Count, or list, the segments within `reach` (m) of each disk at displacements u (3, …).

    slot (n,), place (2, n) m and radius (n,) m of the disks. bins : axis, low end and width (m) of ranges, and the
    segments member[start[b]:start[b + 1]] that reach into each. ends (s, 4) m, and shift (s, 2) m of each segment.
    counts (n,) gets their numbers; segment (e,) gets them disk by disk if it has room for all, else it is empty.
    """
    axis, low, width, start, member = bins
    at = 0
    for k in range(slot.size):
        x, y = place[0, k] + u[U(0), U(slot[k])], place[1, k] + u[U(1), U(slot[k])]
        b = math.floor(((x if axis == 0 else y) - low) / width)
        counts[k] = 0
        if not 0 <= b < start.size - 1:
            continue
        for m in range(start[int(b)], start[int(b) + 1]):
            s = member[m]
            px, py, _ = nearest(x, y, ends, s, shift[s, 0], shift[s, 1])
            if math.hypot(x - px, y - py) <= radius[k] + reach:
                if segment.size > 0:
                    segment[at] = s
                at += 1
                counts[k] += 1


@njit(**FAST)
def energy_stored(walls):
    """Energy (J) in the springs of contacts with walls, at the forces of the last step."""
    total = 0.0
    for k in range(walls.slot.size):
        for a in range(MOST):
            own = walls.kept[k, a]
            if own[PUSH] > 0.0:
                kn, ks = _springs(k, int(own[WALL]), walls)
                total += 0.5 * kn * own[OVERLAP] ** 2 + 0.5 * ks * own[PATH] ** 2
    return total
