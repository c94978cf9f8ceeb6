"""Pairs of faces of joints: listed, begun, and laid out in the frames in which their forces are computed."""

import numpy as np
from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.separate import apart
from dembound.kernels.joint_notes import LAID_OUT, NEEDED, PAIRS
from dembound.kernels.tables.joints import F


@njit(**FAST)
def _copy_pair(one, k, other, q):
    """Copy pair k of one list to place q of another."""
    other.first[q], other.second[q] = one.first[k], one.second[k]
    other.kn[q], other.ks[q] = one.kn[k], one.ks[k]
    other.intact[q], other.slides[q] = one.intact[k], one.slides[k]
    other.slip[q], other.length[q] = one.slip[k], one.length[k]
    other.pressure[q], other.shear[q], other.drag[q] = one.pressure[k], one.shear[k], one.drag[k]
    other.arm[q], other.arm_2[q], other.begin[q] = one.arm[k], one.arm_2[k], one.begin[k]
    other.energy[q], other.bearing[q], other.opening[q] = one.energy[k], one.bearing[k], one.opening[k]


@njit(**FAST)
def _in_series(one, other):
    """Stiffness between the faces of two disks, each of which gives by half of what its stiffness (Pa/m) says."""
    return one if one == other else 2.0 * one * other / (one + other)


@njit(**FAST)
def _begin_pair(joint, q, f, g):
    """Make pair q of the spare list one of faces f and g without overlap."""
    pairs, each = joint.spare, joint.stiffness
    pairs.first[q], pairs.second[q] = f, g
    pairs.kn[q], pairs.ks[q] = _in_series(each[0, f], each[0, g]), _in_series(each[1, f], each[1, g])
    pairs.intact[q], pairs.slides[q] = False, False
    pairs.slip[q], pairs.length[q] = 0.0, 0.0
    pairs.pressure[q], pairs.shear[q], pairs.drag[q] = 0.0, 0.0, 0.0
    pairs.arm[q], pairs.arm_2[q], pairs.begin[q] = 0.0, 0.0, 0.0
    pairs.energy[q], pairs.bearing[q], pairs.opening[q] = 0.0, 0.0, 0.0


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
                        _copy_pair(pairs, at, spare, found)
                    else:
                        _begin_pair(joint, found, f, g)
                found += 1
    joint.counts[NEEDED] = max(joint.counts[NEEDED], found)
    found = min(found, room)
    for k in range(found):
        _copy_pair(spare, k, pairs, k)
    joint.counts[PAIRS], joint.counts[LAID_OUT] = found, 0
    for f in range(joint.disk.size):
        i = U(joint.disk[f])
        joint.listed[f, 0], joint.listed[f, 1] = u[U(0), i], u[U(1), i]


@njit(**FAST)
def lay_out(joint):
    """Fill joint.frame, see `tables.joints.F`."""
    frame = joint.frame
    for k in range(joint.counts[PAIRS]):
        f, g = joint.pairs.first[k], joint.pairs.second[k]
        tx, ty = joint.along[f, 0], joint.along[f, 1]
        if tx != joint.along[g, 0] or ty != joint.along[g, 1]:
            tx, ty = tx + joint.along[g, 0], ty + joint.along[g, 1]
            size = np.sqrt(tx * tx + ty * ty)
            tx, ty = tx / size, ty / size
        frame[F.along_x, k], frame[F.along_y, k] = tx, ty
        x, y = joint.centre[g, 0] - joint.centre[f, 0], joint.centre[g, 1] - joint.centre[f, 1]
        frame[F.apart, k], frame[F.apart_up, k] = tx * x + ty * y, tx * y - ty * x
        for each in range(2):
            face = f if each == 0 else g
            for end in range(2):
                x = joint.ends[face, 2 * end] - joint.centre[face, 0]
                y = joint.ends[face, 2 * end + 1] - joint.centre[face, 1]
                row = F.end + U(4 * each + 2 * end)
                frame[row, k], frame[row + U(1), k] = tx * x + ty * y, tx * y - ty * x
            frame[F.height + U(each), k] = joint.height[face]
        frame[F.closure, k] = joint.closure[f] + joint.closure[g]
        frame[F.rest, k] = 0.5 * (joint.rest[f] + joint.rest[g])
    joint.counts[LAID_OUT] = 1
