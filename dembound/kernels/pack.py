"""Minimise the overlap energy of frictionless disks (FIRE: Bitzek et al. 2006, Guénolé et al. 2020).

Every contact is a spring of unit stiffness under compression only, every disk has unit mass; the contact modulus
multiplies all forces by the same factor and is not needed.
"""

import math

import numpy as np
from numba import njit

FIRST_STEP = 0.1
# A disk with z contacts has ω² ≤ 2z. The most crowded disk (radius ratio 3) has about 12 neighbours, so the
# central difference limit is 2/√24 = 0.41.
LONGEST_STEP = 0.35
GROW, SHRINK, MIX, MIX_DECAY, PATIENCE = 1.1, 0.5, 0.25, 0.99, 20  # FIRE 2.0's published constants


@njit(cache=True)
def overlap_forces(positions, radii, pairs, shifts, forces):
    """Fill the contact forces on all disks and return the mean contact force.

    positions (n, 2), radii (n,), pairs (b, 2), shifts (b, 2) = images·box, forces (n, 2) overwritten.
    Returns the mean overlap of the pairs that overlap (0.0 when none does).
    """
    forces[:] = 0.0
    total = 0.0
    touching = 0
    for b in range(pairs.shape[0]):
        i = pairs[b, 0]
        j = pairs[b, 1]
        dx = positions[j, 0] + shifts[b, 0] - positions[i, 0]
        dy = positions[j, 1] + shifts[b, 1] - positions[i, 1]
        reach = radii[i] + radii[j]
        d2 = dx * dx + dy * dy
        if d2 >= reach * reach or d2 == 0.0:
            continue
        d = math.sqrt(d2)
        overlap = reach - d
        total += overlap
        touching += 1
        fx = overlap / d * dx
        fy = overlap / d * dy
        forces[i, 0] -= fx
        forces[i, 1] -= fy
        forces[j, 0] += fx
        forces[j, 1] += fy
    return total / max(touching, 1)


@njit(cache=True)
def residual(forces, held):
    """Mean size of the unbalanced force over the disks that may move (those from index `held` on)."""
    total = 0.0
    for i in range(held, forces.shape[0]):
        total += math.sqrt(forces[i, 0] ** 2 + forces[i, 1] ** 2)  # hypot is five times slower
    return total / max(forces.shape[0] - held, 1)


@njit(cache=True)
def push(velocities, forces, held, dt, mix):
    """Add dt·F to the velocities of all free disks, and mix them towards the direction of the force (in place)."""
    vv = 0.0
    ff = 0.0
    for i in range(held, forces.shape[0]):
        for a in range(2):
            velocities[i, a] += dt * forces[i, a]
            vv += velocities[i, a] ** 2
            ff += forces[i, a] ** 2
    turn = mix * math.sqrt(vv / ff) if ff > 0.0 else 0.0
    for i in range(held, forces.shape[0]):
        for a in range(2):
            velocities[i, a] = (1.0 - mix) * velocities[i, a] + turn * forces[i, a]


@njit(cache=True)
def drift(positions, velocities, held, dt, origin):
    """Move the free disks by dt·v and return the largest distance from `origin` (n, 2)."""
    largest = 0.0
    for i in range(held, positions.shape[0]):
        positions[i, 0] += dt * velocities[i, 0]
        positions[i, 1] += dt * velocities[i, 1]
        dx = positions[i, 0] - origin[i, 0]
        dy = positions[i, 1] - origin[i, 1]
        largest = max(largest, dx * dx + dy * dy)
    return math.sqrt(largest)


@njit(cache=True)
def relax(positions, velocities, radii, held, pairs, shifts, leash, tolerance, faint, max_steps, pace):
    """Run FIRE until the forces balance, a disk has moved by `leash`, or `max_steps` are done.

    positions, velocities (n, 2) change in place; the first `held` disks do not move; pairs (b, 2) and shifts (b, 2)
    list every pair that can come into contact before a disk has moved by `leash`. pace = [dt, mix, downhill steps]
    keeps FIRE's state between calls. Returns (mean unbalanced force / mean contact force, steps done); balance is
    reached when the ratio is at most `tolerance`. Contact forces below `faint` count as `faint`: disks with free space
    lose their last contacts only slowly, so that waiting for them would take too long.
    """
    forces = np.zeros_like(positions)
    origin = positions.copy()
    ratio = 0.0
    for step in range(max_steps):
        mean = overlap_forces(positions, radii, pairs, shifts, forces)
        ratio = residual(forces, held) / max(mean, faint)
        if ratio <= tolerance:
            return ratio, step
        power = np.sum(forces[held:] * velocities[held:])
        if power > 0.0:
            pace[2] += 1.0
            if pace[2] > PATIENCE:
                pace[0] = min(pace[0] * GROW, LONGEST_STEP)
                pace[1] *= MIX_DECAY
        else:  # uphill: go back half a step, stop, and start again with a smaller step
            drift(positions, velocities, held, -0.5 * pace[0], origin)
            velocities[:] = 0.0
            pace[0] = max(pace[0] * SHRINK, 0.1 * FIRST_STEP)
            pace[1] = MIX
            pace[2] = 0.0
        push(velocities, forces, held, pace[0], pace[1])
        if drift(positions, velocities, held, pace[0], origin) > leash:
            return ratio, step + 1
    return ratio, max_steps
