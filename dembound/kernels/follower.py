"""Forces that depend on motion: springs to the ground beyond, and forces that rotate with their side."""

import numpy as np
from numba import njit, types

from dembound.kernels.common import FAST, MAKES, U
from dembound.kernels.compiler.separate import apart
from dembound.kernels.law import is_tie, is_turning
from dembound.kernels.tables.motion import Bearings, Followers


@njit(**FAST)
def bearing_forces(bearing, u, v, force):
    """Add to force (k, 3) of the supported nodes −K(u − u_g − rest), and store it; u : (3, n) m, v is without effect.

    u_g is the displacement of the node's twin, or the weighted mean of all nodes that have none.
    """
    node, twin, line, weight = bearing.node, bearing.twin, bearing.line, bearing.weight
    stiffness, rest, own = bearing.stiffness, bearing.rest, bearing.force
    for c in range(2):
        mean = 0.0
        for q in range(node.size):
            mean += weight[q] * u[c, U(node[q])]
        for q in range(node.size):
            beyond = u[c, U(twin[q])] if twin[q] >= 0 else mean
            f = -stiffness[q, c] * (u[c, U(node[q])] - beyond - rest[q, c])
            force[line[q], c] += f
            own[line[q], c] = f


is_tie(Bearings, across=bearing_forces)


GONE = -2
"""Value in `twin` for a member that has broken off its side."""


@njit(**FAST, inline="always")
def _moved(m, u, member, twin, rest):
    """Displacement of a member since the datum, less that of its twin if it has one."""
    i = member[m]
    x = u[0, i] - rest[0, m]
    y = u[1, i] - rest[1, m]
    if twin[m] >= 0:
        x -= u[0, twin[m]]
        y -= u[1, twin[m]]
    return x, y


@njit(**MAKES)
def side_rotation(side, u, followers):
    """Angle (rad) by which a side has rotated since the datum, relative to its twins if it has any.

    The rotation from a least-squares fit of the members' positions: tan θ = Σ a × r / Σ a · r, with a the arm of a
    member from their mean position at the datum and r the present arm.
    """
    member, twin, arm, rest = followers.member, followers.twin, followers.arm, followers.rest
    first, last = followers.start[side], followers.start[side + 1]
    mean_x = 0.0
    mean_y = 0.0
    count = 0
    for m in range(first, last):
        if twin[m] != GONE:
            x, y = _moved(m, u, member, twin, rest)
            mean_x += x
            mean_y += y
            count += 1
    mean_x /= max(count, 1)
    mean_y /= max(count, 1)
    cross = 0.0
    along = 0.0
    for m in range(first, last):
        if twin[m] == GONE:
            continue
        x, y = _moved(m, u, member, twin, rest)
        x -= mean_x
        y -= mean_y
        cross += arm[0, m] * y - arm[1, m] * x
        along += arm[0, m] * (arm[0, m] + x) + arm[1, m] * (arm[1, m] + y)
    return np.arctan2(cross, along)


@njit(**MAKES)
def side_rotations(u, followers):
    """Angles (s,) rad by which forces on each side rotate: the mean rotation of this side and the opposite one."""
    opposite = followers.opposite
    angles = np.empty(opposite.size)
    for k in range(opposite.size):
        angles[k] = side_rotation(k, u, followers)
    means = np.empty_like(angles)
    for k in range(opposite.size):
        means[k] = 0.5 * (angles[k] + angles[opposite[k]])
    return means


@apart(types.float64)
@njit(**MAKES)
def turn_forces(followers, u, v, load, step):
    """Rotate the forces with their sides at displacements u (3, n), in load (3, n).

    Returns their work (J) in half a step. The work is that of the change of force by rotation, with the velocities v
    (3, n) of half a step earlier.
    """
    node, side, force = followers.node, followers.side, followers.force
    steady, extra = followers.steady, followers.extra
    angles = side_rotations(u, followers)
    cosine = np.empty(angles.size)
    sine = np.empty(angles.size)
    for k in range(angles.size):
        angle = angles[k]
        cosine[k] = -2.0 * np.sin(0.5 * angle) ** 2  # cos θ − 1
        sine[k] = np.sin(angle)
    half = 0.0
    for q in range(node.size):
        i = U(node[q])
        fx = 0.0
        fy = 0.0
        for s in range(2):
            k = side[s, q]
            if k >= 0:
                fx += cosine[k] * force[s, 0, q] - sine[k] * force[s, 1, q]
                fy += sine[k] * force[s, 0, q] + cosine[k] * force[s, 1, q]
        load[U(0), i] = steady[0, q] + fx
        load[U(1), i] = steady[1, q] + fy
        extra[0, q] = fx
        extra[1, q] = fy
        half += fx * v[U(0), i] + fy * v[U(1), i]
    return 0.5 * step * half


@njit(**MAKES)
def extra_work(followers, v, step):
    """Work (J), in half a step at velocities v (3, n), of the change of force by rotation."""
    node, extra = followers.node, followers.extra
    half = 0.0
    for q in range(node.size):
        i = U(node[q])
        half += extra[0, q] * v[U(0), i] + extra[1, q] * v[U(1), i]
    return 0.5 * step * half


is_turning(Followers, turn=turn_forces, turning_work=extra_work)
