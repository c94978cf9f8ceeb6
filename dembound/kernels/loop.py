"""The loop: the step of central differences for any laws of the parts of a scene.

It calls the kernels of laws and ties by their addresses (calls.py), so that it is compiled once.
"""

import numpy as np
from numba import njit

from dembound.kernels.calls import (
    ACROSS,
    BEGIN,
    CHECK,
    FINISH,
    JOIN,
    MOVE,
    NOTE,
    PUSH,
    TURN,
    TURNING_WORK,
    Given,
    Motion,
    call_all,
    count_all,
    entered,
    given_at,
    measure_all,
    motion_at,
)
from dembound.kernels.common import BROKE, DONE, FAST
from dembound.kernels.sides import note_sides
from dembound.kernels.step import clear, move_supported, note_after, note_before, note_top_speeds


def advance(u, u_next, v, number, laws, ties, turning, body, supports, log, kept=None):
    """Advance by up to supports.drive.shape[0] steps, the first being that of `number`.

    Returns the number of steps done and the reason for returning.

    u, u_next, v : (3, n) displacement now, work space for the next one, velocity half a step earlier; u contains the
    result. laws, ties : tuples of bundles, a law for every part. turning : tables.Followers, or None. The other bundles
    are explained in tables/. kept : table entries of an earlier call, of which only changed ones are made anew.
    """
    for c in range(3):
        if body.free[c] == 0.0:
            u_next[c] = u[c]
    turnings = () if turning is None else (turning,)
    motions, given = (Motion(u, u_next, v), Motion(u_next, u, v)), Given.by(body, supports, log)
    kept = {} if kept is None else kept
    done, why = _advance(number, *entered(laws, ties, turnings, motions, given, kept))
    if done % 2 == 1:
        u[:] = u_next
    return done, why


@njit(**FAST)
def _advance(number, laws, ties, turning, motions, given):
    """The steps themselves; the last displacements may be in u_next. For the arguments see `calls.entered`."""
    first, its = motion_at(motions[0]), given_at(given)
    here, there, v = first.u, first.u_next, first.v
    body, supports, log, pulled, followed, moved = (
        its.body, its.supports, its.log, its.pulled, its.followed, its.moved,
    )  # fmt: skip
    steps = supports.drive.shape[0]
    work = log.work
    done = steps
    why = np.int64(DONE)
    call_all(laws, BEGIN, motions[0], 0, number, given)
    for step in range(steps):
        motion = motions[step % 2]
        why = count_all(laws, CHECK, motion, step, number + step, given)
        if why != DONE:
            done = step
            break
        turned = measure_all(turning, TURN, motion, step, number + step, given)
        breaks = count_all(laws, PUSH, motion, step, number + step, given)
        if len(ties) > 0:
            clear(pulled)
            call_all(ties, ACROSS, motion, step, number + step, given)
        note_before(step, here, v, log.probes, log.record, supports.twin, followed)
        call_all(laws, NOTE, motion, step, number + step, given)
        call_all(laws, MOVE, motion, step, number + step, given)
        move_supported(step, here, v, there, pulled, followed, supports, body, work, moved)
        call_all(ties, JOIN, motion, step, number + step, given)
        if log.sides.every > 0:
            sides = log.sides  # the ledger is written after the last step only
            row = (number + step) // sides.every - sides.first if (number + step) % sides.every == 0 else -1
            note_sides(step, row, step == steps - 1, motion, given)
        note_after(step, v, log.probes, log.record, log.tracked, log.peaks)
        if log.top_speed.size > 0:
            note_top_speeds(v, log.top_speed)
        call_all(laws, FINISH, motion, step, number + step, given)
        work[1, 5] = work[0, 5] + turned
        work[0, 5] += turned + measure_all(turning, TURNING_WORK, motion, step, number + step, given)
        log.supplied[0] = max(log.supplied[0], work[1, 0])
        here, there = there, here
        if breaks > 0:
            done = step + 1
            why = np.int64(BROKE)
            break
    return done, why
