"""Forces on the body through its sides, and the mean displacement of each side.

The support table adds up the rows of all sides; here they are separated again into elements, each one dashpot,
spring, drive, prescribed motion or seam at one component of one supported node. Elements are summed one after the
other, so that the sums have the same bits for any number of threads.
"""

from typing import Any

from numba import njit

from dembound.kernels.calls import given_at, motion_at
from dembound.kernels.common import FAST, FASTMATH, U
from dembound.kernels.compiler.separate import apart

_REORDERED: Any = FAST | {"fastmath": FASTMATH | {"reassoc"}}
"""Compiler options of sums whose order of terms depends only on their number."""

PRESCRIBED, DASHPOT, FOLLOWING, SPRING, DRIVE, TIED, POWER, BORNE = range(8)
"""Kinds of elements, see `tables.Sides`."""


@njit(**FAST, inline="always")
def _dashpots(c, first, last, sides, old, new, incident):
    """Force, absorbed power and incoming power of a batch of dashpots, summed as by `_of_batch`.

    A wave of the velocity v_i = `incident` (m/s) enters. At a mean velocity v they absorb C(v − v_i)², the power of the
    outgoing wave, and C v_i² comes in.
    """
    force = 0.0
    before = 0.0
    absorbed = 0.0
    total = 0.0
    line, constant = sides.line, sides.constant
    for e in range(first, last):
        s = U(line[U(e)])
        out = 0.5 * (old[c, s] + new[c, s]) - incident
        f = constant[U(e)] * (incident - out)
        force += f
        before += f * old[c, s]
        absorbed += constant[U(e)] * out * out
        total += constant[U(e)]
    return force, total * incident * incident - absorbed, before, absorbed


@njit(**FAST, inline="always")
def _following(c, first, last, sides, old, new, followed, incident):
    """Sums of a batch of dashpots, as by `_dashpots`, on velocities relative to twins, followed (k, 3) m/s."""
    force = 0.0
    power = 0.0
    before = 0.0
    absorbed = 0.0
    line, constant, follow = sides.line, sides.constant, sides.follow
    for e in range(first, last):
        s = U(line[U(e)])
        mean = 0.5 * (old[c, s] + new[c, s])
        f = constant[U(e)] * (2.0 * incident - mean) + follow[U(e)] * followed[s, c]
        out = mean - followed[s, c] - incident
        force += f
        power += f * mean
        before += f * old[c, s]
        absorbed += constant[U(e)] * out * out
    return force, power, before, absorbed


@njit(**FAST, inline="always")
def _springs(c, first, last, sides, nodes, u):
    """Sum of forces of a batch of springs at displacements u (3, n); their energy is computed from the force."""
    force = 0.0
    for e in range(first, last):
        force -= sides.constant[U(e)] * u[c, U(nodes[U(sides.line[U(e)])])]
    return force, 0.0, 0.0, 0.0


@njit(**FAST, inline="always")
def _exerted(kind, c, first, last, sides, old, new, push, across, step):
    """Force and power of a batch of prescribed motion (the needed force, without ties), drives, seams, or bearing."""
    force = 0.0
    power = 0.0
    before = 0.0
    for e in range(first, last):
        s = U(sides.line[U(e)])
        if kind == DRIVE:
            f = sides.constant[U(e)] * sides.signals[step, U(sides.column[U(e)])]
        elif kind == PRESCRIBED:
            f = sides.constant[U(e)] * (push[c, s] - across[s, c])
        else:
            f = sides.constant[U(e)] * (sides.borne[s, c] if kind == BORNE else across[s, c] - sides.borne[s, c])
        force += f
        power += f * 0.5 * (old[c, s] + new[c, s])
        before += f * old[c, s]
    return force, power, before, 0.0


@njit(**_REORDERED)
def _mean(u, c, first, last, members, weights):
    """Sum of component c of displacements u (3, n) of members first to last − 1 of (m,) with weights (m,).

    The order of terms depends only on their number.
    """
    total = 0.0
    for m in range(first, last):
        total += weights[U(m)] * u[c, U(members[U(m)])]
    return total


@njit(**FAST, inline="always")
def _steady(c, sides, o, load):
    """Steady force (N) on side o: its offset, and shares of the load (3, n) N."""
    force = sides.offset[o, c]
    for m in range(sides.bearer_start[o], sides.bearer_start[o + 1]):
        force += sides.share[c, m] * load[c, U(sides.bearer[m])]
    return force


@njit(**FAST, inline="always")
def _of_batch(b, step, u, supports, across, followed, moved, sides):
    """Force (N) of batch b in this step, its power (W), that with velocities before the step, and absorbed power.

    The power of incident waves adds to no force; it counts as incoming once energy that leaves by forces counts as
    absorbed.
    """
    kind, c, first, last = sides.kind[b], U(sides.component[b]), sides.start[b], sides.start[b + 1]
    signal = sides.signals[step, sides.signal[b]] if sides.signal[b] >= 0 else 0.0
    old, new, push = moved[0], moved[1], moved[2]
    if kind == POWER:
        found = 0.0, 0.0, 0.0, signal
    elif kind == DASHPOT:
        found = _dashpots(c, first, last, sides, old, new, signal)
    elif kind == FOLLOWING:
        found = _following(c, first, last, sides, old, new, followed, signal)
    elif kind == SPRING:
        found = _springs(c, first, last, sides, supports.nodes, u)
    else:
        found = _exerted(kind, c, first, last, sides, old, new, push, across, step)
    return found


@njit(**FAST, inline="always")
def _note_motion(row, u, body, sides, sums):
    """Write displacements and forces of all sides in this step to a row of sides.record."""
    record = sides.record
    for o in range(record.shape[1]):
        first, last = sides.member_start[o], sides.member_start[o + 1]
        for c in range(3):
            moves = body.free[c] != 0.0
            record[row, o, c] = _mean(u, U(c), first, last, sides.member, sides.weight) if moves else 0.0
        for c in range(2):
            record[row, o, 3 + c] = _steady(c, sides, o, body.load)
    for b in range(sides.kind.size):
        if sides.component[b] < 2:
            record[row, sides.side[b], 3 + sides.component[b]] += sums[b, 0]


@njit(**FAST, inline="always")
def _note_halves(body, sides, sums):
    """Fill sides.work[1], the work up to the beginning of this step, from the work half a step earlier."""
    work = sides.work
    for o in range(work.shape[1]):
        for c in range(2):
            work[1, o, c] = work[0, o, c]
    for b in range(sides.kind.size):
        if sides.kind[b] != SPRING:
            power, before, absorbed = sums[b, 1], sums[b, 2], sums[b, 3]
            # of dashpots without a wave all is absorbed, also in half a step
            half = power + absorbed if sides.kind[b] == DASHPOT else before + absorbed
            if sides.leaves[b]:
                half = 0.0
            work[1, sides.side[b], 0] += 0.5 * body.step * half
            work[1, sides.side[b], 1] += 0.5 * body.step * (half - before)


@apart()
@njit(**FAST)
def note_sides(step, row, is_last, motion, given):
    """Add the work of all sides in this step to sides.work[0], and write their other records.

    row : of sides.record, −1 where this step has none; is_last : whether sides.work[1] is needed. motion, given :
    addresses of a calls.Motion before the step, and of calls.Given after it.
    """
    u = motion_at(motion).u
    its = given_at(given)
    body, supports, sides, sums = its.body, its.supports, its.log.sides, its.sums
    across, followed, moved = its.pulled, its.followed, its.moved
    for b in range(sides.kind.size):
        if sides.kind[b] != SPRING or row >= 0:
            force, power, before, absorbed = _of_batch(b, step, u, supports, across, followed, moved, sides)
            sums[b, 0], sums[b, 1], sums[b, 2], sums[b, 3] = force, power, before, absorbed
    if row >= 0:
        _note_motion(row, u, body, sides, sums)
    if is_last:
        _note_halves(body, sides, sums)
    for b in range(sides.kind.size):
        if sides.kind[b] != SPRING:
            power = sums[b, 1]
            absorbed = -power if sides.leaves[b] else sums[b, 3]
            sides.work[0, sides.side[b], 0] += body.step * (power + absorbed)
            sides.work[0, sides.side[b], 1] += body.step * absorbed
