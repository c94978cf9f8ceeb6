"""The loop: the step of central differences for any laws of the parts of a scene.

It is compiled separately for every combination of laws and ties, which are chosen by the types of their bundles
(law.py).
"""

import numpy as np
from numba import njit

from dembound.kernels.common import BROKE, DONE, FAST
from dembound.kernels.law import (
    across_all,
    begin_all,
    check_all,
    finish_all,
    move_all,
    note_all,
    push_all,
    turn,
    turning_work,
)
from dembound.kernels.sides import note_sides
from dembound.kernels.step import clear, move_supported, note_after, note_before, note_top_speeds


def advance(u, u_next, v, number, laws, ties, turning, body, supports, log):
    """Advance by up to supports.drive.shape[0] steps, the first being that of `number`.

    Returns the number of steps done and the reason for returning.

    u, u_next, v : (3, n) displacement now, work space for the next one, velocity half a step earlier; u contains the
    result. laws, ties : tuples of bundles, a law for every part. turning : tables.Followers, or None. The other bundles
    are explained in tables/.
    """
    for c in range(3):
        if body.free[c] == 0.0:
            u_next[c] = u[c]
    k = supports.nodes.size
    pulled, followed, moved = np.zeros((k, 3)), np.zeros((k, 3)), np.zeros((3, 3, k))
    space = pulled, followed, moved, np.zeros((log.sides.kind.size, 4))
    done, why = _advance(u, u_next, v, number, laws, ties, turning, body, supports, log, *space)
    if done % 2 == 1:
        u[:] = u_next
    return done, why


@njit(**FAST)
def _advance(u, u_next, v, number, laws, ties, turning, body, supports, log, pulled, followed, moved, sums):
    """The steps themselves, with work space; the last displacements may be in u_next."""
    steps = supports.drive.shape[0]
    nodes, work = supports.nodes, log.work
    here, there = u, u_next
    done = steps
    why = np.int64(DONE)
    begin_all(laws)
    for step in range(steps):
        why = check_all(laws, here, there, v)
        if why != DONE:
            done = step
            break
        turned = turn(turning, here, v, body.load, body.step)
        breaks = push_all(laws, here, there, v, number + step, body.step, work)
        if len(ties) > 0:
            clear(pulled)
            across_all(ties, here, v, pulled)
        note_before(step, here, v, log.probes, log.record, supports.twin, followed)
        note_all(laws, step, here, log)
        move_all(laws, here, there, v, body, nodes)
        move_supported(step, here, v, there, pulled, followed, supports, body, work, moved)
        if log.sides.every > 0:
            sides = log.sides  # the ledger is written after the last step only
            row = (number + step) // sides.every - sides.first if (number + step) % sides.every == 0 else -1
            note_sides(step, row, step == steps - 1, here, supports, pulled, followed, moved, body, sides, sums)
        note_after(step, v, log.probes, log.record, log.tracked, log.peaks)
        if log.top_speed.size > 0:
            note_top_speeds(v, log.top_speed)
        finish_all(laws, v, body, nodes, work)
        work[1, 5] = work[0, 5] + turned
        work[0, 5] += turned + turning_work(turning, v, body.step)
        log.supplied[0] = max(log.supplied[0], work[1, 0])
        here, there = there, here
        if breaks > 0:
            done = step + 1
            why = np.int64(BROKE)
            break
    return done, why
