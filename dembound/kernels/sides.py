"""Forces on the body through its sides, and the mean displacement of each side.

The support table adds up the rows of all sides; here they are taken apart again into elements, each one dashpot,
spring, drive, prescribed motion or seam at one component of one supported node. Elements are summed one after the
other, so that the sums have the same bits for any number of threads.
"""

from typing import Any

from numba import njit

from dembound.kernels.common import FAST, FASTMATH, U

_REORDERED: Any = FAST | {"fastmath": FASTMATH | {"reassoc"}}
"""Compiler options of sums whose order of terms depends on their number alone."""

PRESCRIBED, DASHPOT, FOLLOWING, SPRING, DRIVE, TIED = range(6)
"""Kinds of elements, see `tables.Sides`."""


@njit(**FAST, forceinline=True)
def _needed(c, lines, constants, push, across):
    """Force (N) that prescribed motion takes, without that of ties."""
    force = 0.0
    for e in range(lines.size):
        s = U(lines[e])
        force += constants[e] * (push[c, s] - across[s, c])
    return force


@njit(**FAST, forceinline=True)
def _dashpots(c, lines, constants, old, new, incident):
    """Force (N) of dashpots through which a wave of the velocity `incident` (m/s) enters."""
    force = 0.0
    for e in range(lines.size):
        s = U(lines[e])
        force += constants[e] * (2.0 * incident - 0.5 * (old[c, s] + new[c, s]))
    return force


@njit(**FAST, forceinline=True)
def _following(c, lines, constants, follow, old, new, followed, incident):
    """Force (N) of dashpots on velocities relative to those of twins, followed (k, 3) m/s."""
    force = 0.0
    for e in range(lines.size):
        s = U(lines[e])
        force += constants[e] * (2.0 * incident - 0.5 * (old[c, s] + new[c, s])) + follow[e] * followed[s, c]
    return force


@njit(**FAST, forceinline=True)
def _springs(c, lines, constants, nodes, u):
    """Force (N) of springs at displacements u (3, n)."""
    force = 0.0
    for e in range(lines.size):
        force -= constants[e] * u[c, U(nodes[U(lines[e])])]
    return force


@njit(**FAST, forceinline=True)
def _tied(c, lines, constants, across):
    """Force (N) through seams."""
    force = 0.0
    for e in range(lines.size):
        force += constants[e] * across[U(lines[e]), c]
    return force


@njit(**FAST, forceinline=True)
def _total(values):
    """The sum of values (e,)."""
    total = 0.0
    for e in range(values.size):
        total += values[e]
    return total


@njit(**_REORDERED)
def _mean(u, members, weights):
    """Sum of displacements u (n,) of members (m,) with weights (m,), in an order that depends on m alone."""
    total = 0.0
    for m in range(members.size):
        total += weights[m] * u[U(members[m])]
    return total


@njit(**FAST, forceinline=True)
def _steady(c, sides, o, load):
    """Steady force (N) on side o: its offset, and shares of the load (3, n) N."""
    force = sides.offset[o, c]
    for m in range(sides.bearer_start[o], sides.bearer_start[o + 1]):
        force += sides.share[c, m] * load[c, U(sides.bearer[m])]
    return force


@njit(**FAST, forceinline=True)
def note_sides(step, u, supports, across, followed, moved, body, sides):
    """Write displacements and forces of all sides in this step to row `step` of sides.record.

    u : (3, n) displacements before the step; across (k, 3) N forces of ties and followed (k, 3) m/s mean velocities of
    twins in the step; moved (3, 3, k) velocities of the supported nodes before and after it, and all forces on them
    from outside.
    """
    record = sides.record
    old, new, push = moved[0], moved[1], moved[2]
    for o in range(record.shape[1]):
        first, last = U(sides.member_start[o]), U(sides.member_start[o + 1])
        members = sides.member[first:last]
        for c in range(3):
            moves = body.free[c] != 0.0
            record[step, o, c] = _mean(u[c], members, sides.weight[c, first:last]) if moves else 0.0
        for c in range(2):
            record[step, o, 3 + c] = _steady(c, sides, o, body.load)
    for b in range(sides.kind.size):
        kind, c = sides.kind[b], U(sides.component[b])
        first, last = U(sides.start[b]), U(sides.start[b + 1])
        lines, constants = sides.line[first:last], sides.constant[first:last]
        signal = sides.signals[step, sides.signal[b]] if sides.signal[b] >= 0 else 0.0
        if c == 2:
            continue
        if kind == PRESCRIBED:
            force = _needed(c, lines, constants, push, across)
        elif kind == DASHPOT:
            force = _dashpots(c, lines, constants, old, new, signal)
        elif kind == FOLLOWING:
            force = _following(c, lines, constants, sides.follow[first:last], old, new, followed, signal)
        elif kind == SPRING:
            force = _springs(c, lines, constants, supports.nodes, u)
        elif kind == DRIVE:
            force = signal * _total(constants)
        else:
            force = _tied(c, lines, constants, across)
        record[step, sides.side[b], U(3) + c] += sides.sign[b] * force
