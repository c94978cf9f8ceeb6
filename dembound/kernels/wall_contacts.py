"""Which contacts of a disk with rigid walls count, and which of them go on from the step before.

A disk is pushed by the closest point of a segment, along the line from it to the centre: a face inside the segment, a
vertex at its ends. Of all that it overlaps, faces count first, then the deeper ones; each only if its normal differs by
more than 30° from those that count already, and a vertex only if none of its own segments has a face that counts. So a
disk that rolls over a joint of two segments, or along a fine polyline, is pushed once, and in a sharp corner by both
faces. The springs along the wall stay with the contact whose normal is nearest to the one of the step before, so that
they pass to the next segment.
"""

import math

from numba import njit

from dembound.kernels.common import FAST, MAKES, U

MOST = 4
"""Largest number of contacts of a disk with walls; their normals differ by more than 30°."""

NEAR = math.cos(math.radians(30.0))
"""Product of two normals above which they are of one contact."""

NX, NY, OVERLAP, PUSH, PATH, DRAG, WALL, ROLLED = range(8)
"""What a contact keeps: normal, overlap (m), spring force (N), shear (m), dashpot force (N), wall, rotation (rad)."""

KEPT, FOUND = 8, 7
"""Numbers of a contact kept; of one found: normal, overlap, place, segment, and whether it is a face."""


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
def find(x, y, radius, first, last, at, walls, found):
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
def match(found, count, kept, heir):
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
