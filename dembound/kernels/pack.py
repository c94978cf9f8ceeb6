"""Minimise the overlap energy of frictionless disks (FIRE: Bitzek et al. 2006, Guénolé et al. 2020).

Every contact is a spring of unit stiffness under compression only, every disk has unit mass; the contact modulus
multiplies all forces by the same factor and is not needed.

All sums are taken in the order of the list of pairs or of the disks, without fused multiply-add: the bits of a brick
depend neither on the processor's instructions nor on the number of pairs treated at once.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from dembound.kernels.common import EXACT, EXACT_MAKES, U

FIRST_STEP = 0.1
# A disk with z contacts has ω² ≤ 2z. The most crowded disk (radius ratio 3) has about 12 neighbours, so the
# central difference limit is 2/√24 = 0.41.
LONGEST_STEP = 0.35
GROW, SHRINK, MIX, MIX_DECAY, PATIENCE = 1.1, 0.5, 0.25, 0.99, 20  # FIRE 2.0's published constants

BLOCK = 256  # pairs treated at once: their work stays in the first cache


class Pairs(NamedTuple):
    """Pairs of disks that can come into contact, sorted by first, then by second disk.

    Attributes
    ----------
    first, second : (b,) uint32.
    shift_x, shift_y : (b,) m, whole boxes from the second disk to its image beside the first.
    reach : (b,) m, sum of the two radii.
    """

    first: np.ndarray
    second: np.ndarray
    shift_x: np.ndarray
    shift_y: np.ndarray
    reach: np.ndarray


@njit(**EXACT)
def vectors(x, y, pairs, begin, dx, dy):
    """Vectors dx, dy (k,) m from first to second disk of the pairs from `begin` on."""
    for k in range(dx.size):
        b, c = U(begin + k), U(k)
        i, j = U(pairs.first[b]), U(pairs.second[b])
        dx[c] = x[j] + pairs.shift_x[b] - x[i]
        dy[c] = y[j] + pairs.shift_y[b] - y[i]


@njit(**EXACT)
def push_apart(dx, dy, reach, overlap):
    """Turn vectors (k,) of pairs into forces on the second disks, and fill the overlaps, 0.0 of disks that are apart.

    Returns the number of pairs that touch. There is no jump in the loop, so that it is done for several pairs at once.
    """
    touching = 0
    for k in range(dx.size):
        c = U(k)
        d2 = dx[c] * dx[c] + dy[c] * dy[c]
        apart = (d2 >= reach[c] * reach[c]) | (d2 == 0.0)
        d = 1.0 if apart else math.sqrt(d2)
        overlap[c] = 0.0 if apart else reach[c] - d
        factor = overlap[c] / d
        dx[c], dy[c] = factor * dx[c], factor * dy[c]
        touching += not apart
    return touching


@njit(**EXACT)
def add_forces(fx, fy, pairs, begin, px, py, overlap, total):
    """Add the forces px, py (k,) of the pairs from `begin` on to those on the disks.

    Returns the total plus the overlaps (k,): in this loop that addition takes no time.
    """
    for k in range(px.size):
        b, c = U(begin + k), U(k)
        i, j = U(pairs.first[b]), U(pairs.second[b])
        total += overlap[c]
        fx[i] -= px[c]
        fy[i] -= py[c]
        fx[j] += px[c]
        fy[j] += py[c]
    return total


@njit(**EXACT)
def overlap_forces(places, pairs, forces, work):
    """Fill the contact forces on all disks and return the mean contact force.

    places (2, n) m, forces (2, n) and work (3, BLOCK) overwritten. Returns the mean overlap of the pairs that overlap
    (0.0 when none does).
    """
    forces[:] = 0.0
    total = 0.0
    touching = 0
    for begin in range(0, pairs.first.size, BLOCK):
        end = min(begin + BLOCK, pairs.first.size)
        dx, dy, overlap = work[0, : end - begin], work[1, : end - begin], work[2, : end - begin]
        vectors(places[0], places[1], pairs, begin, dx, dy)
        touching += push_apart(dx, dy, pairs.reach[begin:end], overlap)
        total = add_forces(forces[0], forces[1], pairs, begin, dx, dy, overlap, total)
    return total / max(touching, 1)


@njit(**EXACT)
def sums(velocities, forces, held, dt):
    """Sums over the free disks, in one pass: |F|, F·v, |F|² and |v + dt·F|²."""
    unbalanced, power, ff, vv = 0.0, 0.0, 0.0, 0.0
    for i in range(held, forces.shape[1]):
        c = U(i)
        fx, fy = forces[0, c], forces[1, c]
        vx, vy = velocities[0, c], velocities[1, c]
        unbalanced += math.sqrt(fx * fx + fy * fy)  # hypot is five times slower
        power += fx * vx
        power += fy * vy
        ff += fx * fx
        ff += fy * fy
        vx += dt * fx
        vy += dt * fy
        vv += vx * vx
        vv += vy * vy
    return unbalanced, power, ff, vv


@njit(**EXACT)
def accelerate(velocities, forces, held, dt, mix, turn):
    """Add dt·F to the velocities (n,) of the free disks, and mix them towards the force: (1 − mix)·v + turn·F."""
    keep = 1.0 - mix
    for i in range(held, forces.size):
        c = U(i)
        velocities[c] = keep * (velocities[c] + dt * forces[c]) + turn * forces[c]


@njit(**EXACT)
def drift(places, velocities, held, dt):
    """Move the free disks by dt·v along one axis; places and velocities (n,)."""
    for i in range(held, places.size):
        c = U(i)
        places[c] += dt * velocities[c]


@njit(**EXACT | {"fastmath": {"nnan", "nsz"}})  # or the maximum would be taken disk by disk
def farthest(places, origin):
    """The largest distance of a disk from its origin; both (2, n)."""
    largest = 0.0
    for i in range(places.shape[1]):
        c = U(i)
        dx = places[0, c] - origin[0, c]
        dy = places[1, c] - origin[1, c]
        largest = max(largest, dx * dx + dy * dy)
    return math.sqrt(largest)


@njit(**EXACT)
def downhill(pace):
    """Step and mix after one more step downhill, see `relax`."""
    if pace[2] + 1.0 > PATIENCE:
        return min(pace[0] * GROW, LONGEST_STEP), pace[1] * MIX_DECAY
    return pace[0], pace[1]


@njit(**EXACT_MAKES)
def relax(places, velocities, held, pairs, origin, leash, tolerance, faint, max_steps, pace):
    """Run FIRE until the forces balance, a disk has moved by `leash` from `origin`, or `max_steps` are done.

    places, velocities (2, n) change in place; the first `held` disks do not move; pairs lists every pair that can come
    into contact before a disk has moved by `leash` from origin (2, n). pace = [dt, mix, downhill steps] keeps FIRE's
    state between calls: several calls of fewer steps give the same result as one. Returns (mean unbalanced force / mean
    contact force, steps done, whether only `max_steps` ended them); balance is reached when the ratio is at most
    `tolerance`. Contact forces below `faint` count as `faint`: disks with free space lose their last contacts only
    slowly, so that waiting for them would take too long.
    """
    forces, work = np.zeros_like(places), np.empty((3, BLOCK))
    free = max(places.shape[1] - held, 1)
    ratio = 0.0
    for step in range(max_steps):
        mean = overlap_forces(places, pairs, forces, work)
        dt, mix = downhill(pace)
        unbalanced, power, ff, vv = sums(velocities, forces, held, dt)
        ratio = unbalanced / free / max(mean, faint)
        if ratio <= tolerance:
            return ratio, step, False
        if power > 0.0:
            pace[0], pace[1], pace[2] = dt, mix, pace[2] + 1.0
        else:  # uphill: go back half a step, stop, and start again with a smaller step
            for axis in range(2):
                drift(places[axis], velocities[axis], held, -0.5 * pace[0])
            velocities[:] = 0.0
            pace[0], pace[1], pace[2] = max(pace[0] * SHRINK, 0.1 * FIRST_STEP), MIX, 0.0
            _, _, _, vv = sums(velocities, forces, held, pace[0])
        turn = pace[1] * math.sqrt(vv / ff) if ff > 0.0 else 0.0
        for axis in range(2):
            accelerate(velocities[axis], forces[axis], held, pace[0], pace[1], turn)
            drift(places[axis], velocities[axis], held, pace[0])
        if farthest(places, origin) > leash:
            return ratio, step + 1, False
    return ratio, max_steps, True
