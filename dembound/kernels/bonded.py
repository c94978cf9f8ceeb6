"""The step of central differences under the contact law with a memory: pairs push first, then particles move."""

import numpy as np
from numba import njit, prange

from dembound.kernels.common import CHUNKS, FASTMATH, U
from dembound.kernels.contacts import ends_force, moved, push, seam_ends_forces
from dembound.kernels.elastic import DONE, LIST_ENDS
from dembound.kernels.step import damping_work, kick, move_supported, note_after, note_before


@njit(cache=True, fastmath=FASTMATH, error_model="numpy")
def _node_forces(contacts, supports, load, force, across):
    """Fill force (k, 3) with contact, seam and steady forces on the nodes, across (k, 3) with those of the seam."""
    seam_ends_forces(contacts, supports.seam, across)
    for s in range(supports.nodes.size):
        i = U(supports.nodes[s])
        force[s, 0], force[s, 1], force[s, 2] = ends_force(i, contacts.force, contacts.start, contacts.end)
        for c in range(3):
            force[s, c] += across[s, c]
            force[s, c] += load[c, i]


@njit(cache=True, parallel=True, fastmath=FASTMATH, error_model="numpy")
def _move(u, v, contacts, body, spare, fastest, damped):
    """One step of all particles; fastest (chunks,) gets their speeds, damped (chunks, 2) the work of local damping."""
    mobility, inverse_inertia, free, load, damp, step = body
    force, start, end = contacts.force, contacts.start, contacts.end
    n = u.shape[1]
    for chunk in prange(CHUNKS):
        most = 0.0
        whole = 0.0
        half = 0.0
        for p in range(chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS):
            i = U(p)
            fx, fy, moment = ends_force(i, force, start, end)
            fx += load[U(0), i]
            fy += load[U(1), i]
            moment += load[U(2), i]
            vx = kick(v[U(0), i], fx, free[0] * mobility[i], damp)
            vy = kick(v[U(1), i], fy, free[1] * mobility[i], damp)
            spin = kick(v[U(2), i], moment, free[2] * inverse_inertia[i], damp)
            if damp > 0.0:
                for w, c, f, b in (
                    (vx, 0, fx, free[0] * mobility[i]),
                    (vy, 1, fy, free[1] * mobility[i]),
                    (spin, 2, moment, free[2] * inverse_inertia[i]),
                ):
                    taken, up_to = damping_work(v[U(c), i], w, f, b, damp, step)
                    whole += taken
                    half += up_to
            most = max(most, vx * vx + vy * vy)
            v[U(0), i] = vx
            v[U(1), i] = vy
            v[U(2), i] = spin
            spare[U(0), i] = u[U(0), i] + step * vx
            spare[U(1), i] = u[U(1), i] + step * vy
            spare[U(2), i] = u[U(2), i] + step * spin
        fastest[chunk] = np.sqrt(most)
        damped[chunk, 0] = whole
        damped[chunk, 1] = half


@njit(cache=True, fastmath=FASTMATH, error_model="numpy")
def advance(u, spare, v, number, contacts, limits, origin, skin, body, supports, log):
    """Advance by up to supports.drive.shape[0] steps, the first being that of `number`; returns steps done and why.

    As elastic.advance; origin (2, n) are the displacements at which all pairs with gaps up to skin (m) were listed.
    """
    steps = supports.drive.shape[0]
    nodes = supports.nodes
    at_nodes = np.empty((nodes.size, 3))
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
        push(here, v, body.step, number + step, contacts, limits, lost)
        _node_forces(contacts, supports, body.load, at_nodes, across)
        note_before(step, here, v, supports.seam, followed, log)
        _move(here, v, contacts, body, there, fastest, damped)
        move_supported(step, here, v, there, at_nodes, across, followed, supports, body, log.work)
        note_after(step, v, log)
        log.work[1, 1] += damped[:, 1].sum()
        log.work[0, 1] += damped[:, 0].sum()
        for way in range(2):
            log.work[0, 2 + way] += lost[:, way].sum()
            log.work[1, 2 + way] = log.work[0, 2 + way]
        most = fastest.max()
        for s in range(nodes.size):
            most = max(most, np.hypot(v[0, nodes[s]], v[1, nodes[s]]))
        travelled += body.step * most
        here, there = there, here
    if done % 2 == 1:
        u[:] = here
    return done, why
