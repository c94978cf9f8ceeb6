"""The step of central differences under the contact law with a memory: pairs push first, then particles move."""

import numpy as np
from numba import njit, prange

from dembound.kernels.common import CHUNKS, FASTMATH, U
from dembound.kernels.contacts import ends_force, moved, push, seam_ends_forces
from dembound.kernels.elastic import BROKE, DONE, LIST_ENDS
from dembound.kernels.follower import extra_work, turn_forces
from dembound.kernels.step import move_particle, move_supported, note_after, note_before, note_top_speeds


@njit(cache=True, parallel=True, fastmath=FASTMATH, error_model="numpy")
def _move(u, v, contacts, body, spare, fastest, damped):
    """One step of all particles, see `move_particle`.

    fastest (chunks,) gets their speeds, damped (chunks, 2) the work of local damping.
    """
    force, start, end = contacts.force, contacts.start, contacts.end
    n = u.shape[1]
    for chunk in prange(CHUNKS):
        most = 0.0
        whole = 0.0
        half = 0.0
        for p in range(chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS):
            i = U(p)
            fx, fy, moment = ends_force(i, force, start, end)
            taken, up_to = move_particle(i, fx, fy, moment, u, v, body, spare)
            whole += taken
            half += up_to
            most = max(most, v[U(0), i] ** 2 + v[U(1), i] ** 2)
        fastest[chunk] = np.sqrt(most)
        damped[chunk, 0] = whole
        damped[chunk, 1] = half


@njit(cache=True, fastmath=FASTMATH, error_model="numpy")
def advance(u, spare, v, number, contacts, limits, origin, skin, body, supports, followers, stop, log):
    """Advance by up to supports.drive.shape[0] steps, the first being that of `number`; returns steps done and why.

    As elastic.advance; origin (2, n) are the displacements at which all pairs with gaps up to skin (m) were listed.
    stop : return after a step in which a bond broke, so that balancing forces can end on debris.
    """
    steps = supports.drive.shape[0]
    nodes = supports.nodes
    across = np.empty((nodes.size, 3))
    followed = np.empty((nodes.size, 3))
    fastest = np.zeros(CHUNKS)
    damped = np.zeros((CHUNKS, 2))
    lost = np.zeros((CHUNKS, 2))
    travelled = 0.0
    room = 0.0
    here, there = u, spare
    done = steps
    why = DONE
    for step in range(steps):
        if 2.0 * travelled >= room:
            room = skin - 2.0 * moved(here, origin)
            travelled = 0.0
            if room < 0.0:
                done = step
                why = LIST_ENDS
                break
        turned = turn_forces(here, v, followers, body.load, body.step)
        breaks = push(here, v, body.step, number + step, contacts, limits, lost)
        seam_ends_forces(contacts, supports.seam, across)
        note_before(step, here, v, log.probes, log.record, supports.seam.twin, followed)
        _move(here, v, contacts, body, there, fastest, damped)
        move_supported(step, here, v, there, across, followed, supports, body, log.work)
        note_after(step, v, log.probes, log.record, log.tracked, log.peaks)
        if log.top_speed.size > 0:
            note_top_speeds(v, log.top_speed)
        log.work[1, 1] += damped[:, 1].sum()
        log.work[0, 1] += damped[:, 0].sum()
        for way in range(2):
            log.work[0, 2 + way] += lost[:, way].sum()
            log.work[1, 2 + way] = log.work[0, 2 + way]
        log.work[1, 5] = log.work[0, 5] + turned
        log.work[0, 5] += turned + extra_work(v, followers, body.step)
        most = fastest.max()
        for s in range(nodes.size):
            most = max(most, np.hypot(v[0, nodes[s]], v[1, nodes[s]]))
        travelled += body.step * most
        here, there = there, here
        if stop and breaks > 0:
            done = step + 1
            why = BROKE
            break
    if done % 2 == 1:
        u[:] = here
    return done, why
