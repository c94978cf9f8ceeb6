"""The history-free elastic law and the step of central differences, fused into one pass over the particles.

Each particle gathers from its own row of contacts, so no two particles write to the same place: the sums come in
the same order, hence with the same bits, for any number of threads. A contact's constants stand once in a small
palette shared by all copies of the brick; a row holds only the neighbour and the palette line (8 bytes).

A palette line (6,) of a contact seen from particle i with neighbour j, unit normal n = (c, s) from i to j or
from j to i (the law is even in n, the arms carry the sign):

    [√k_n c, √k_n s, √(k_s/k_n), √k_s l_i, √k_s l_j, k_r]

so that N = √k_n n·Δu, S = √k_s (t·Δu − l_iθ_i − l_jθ_j), and the force on i is √k_n N n + √k_s S t with the moment
√k_s l_i S + k_r (θ_j − θ_i).
"""

import numpy as np
from numba import njit, prange

from dembound.kernels.common import CHUNKS, FASTMATH, U
from dembound.kernels.contacts import moved, slack
from dembound.kernels.step import move_particle, move_supported, note_after, note_before, note_top_speeds

DONE, LAW_ENDS, LIST_ENDS, BROKE = 0, 1, 2, 3
"""Why a kernel returned: all steps are done; a contact is about to leave the elastic law; the list of pairs is old; a
bond broke in the last step."""


@njit(cache=True, fastmath=FASTMATH, error_model="numpy", inline="always")
def _row_force(row, i, u, start, neighbour, kind, palette):
    """Force (x, y) and moment on particle i from a row of contacts (Z eqs 7-9; PFC2D linear parallel bond)."""
    x = u[U(0), i]
    y = u[U(1), i]
    turn = u[U(2), i]
    fx = 0.0
    fy = 0.0
    moment = 0.0
    for e in range(start[row], start[row + U(1)]):
        j = U(neighbour[e])
        k = U(kind[e])
        px = palette[k, U(0)]
        py = palette[k, U(1)]
        ratio = palette[k, U(2)]
        arm = palette[k, U(3)]
        turn_j = u[U(2), j]
        dx = u[U(0), j] - x
        dy = u[U(1), j] - y
        N = px * dx + py * dy
        S = ratio * (px * dy - py * dx) - arm * turn - palette[k, U(4)] * turn_j
        T = ratio * S
        fx += px * N - py * T
        fy += py * N + px * T
        moment += arm * S + palette[k, U(5)] * (turn_j - turn)
    return fx, fy, moment


@njit(cache=True, parallel=True, fastmath=FASTMATH, error_model="numpy")
def contact_forces(u, rows, force):
    """Fill force (3, n) with the contact forces and moments (N, N·m) of displacements and rotations u (3, n)."""
    start, neighbour, kind, palette = rows
    n = u.shape[1]
    for chunk in prange(CHUNKS):
        for p in range(chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS):
            i = U(p)
            force[U(0), i], force[U(1), i], force[U(2), i] = _row_force(i, i, u, start, neighbour, kind, palette)


@njit(cache=True, fastmath=FASTMATH, error_model="numpy")
def seam_forces(u, rows, seam, across):
    """Fill across (k, 3) with what the nodes' twins feel across the seam."""
    for s in range(seam.twin.size):
        across[s, :] = 0.0
        if seam.start[s + 1] > seam.start[s]:
            row, i = U(s), U(seam.twin[s])
            across[s, 0], across[s, 1], across[s, 2] = _row_force(
                row, i, u, seam.start, seam.neighbour, seam.kind, rows.palette
            )


@njit(cache=True, parallel=True, fastmath=FASTMATH, error_model="numpy")
def _move(u, v, rows, body, spare, fastest, arms, damped):
    """One step of all particles, see `move_particle`.

    fastest (chunks,) gets surface speeds if there are arms, damped (chunks, 2) the work of local damping.
    """
    start, neighbour, kind, palette = rows
    n = u.shape[1]
    watched = arms.size > 0
    for chunk in prange(CHUNKS):
        most = 0.0
        whole = 0.0
        half = 0.0
        for p in range(chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS):
            i = U(p)
            fx, fy, moment = _row_force(i, i, u, start, neighbour, kind, palette)
            taken, up_to = move_particle(i, fx, fy, moment, u, v, body, spare)
            whole += taken
            half += up_to
            if watched:
                most = max(most, np.sqrt(v[U(0), i] ** 2 + v[U(1), i] ** 2) + arms[i] * abs(v[U(2), i]))
        fastest[chunk] = most
        damped[chunk, 0] = whole
        damped[chunk, 1] = half


@njit(cache=True, fastmath=FASTMATH, error_model="numpy")
def advance(u, spare, v, rows, body, supports, log, watch):
    """Advance by up to supports.drive.shape[0] steps; returns the steps done and why it stopped.

    u, spare, v : (3, n) displacement now, room for the next one, velocity half a step ago; u holds the result. The
    other bundles are explained in tables.py. A watch with arms lets no step begin in which the contact law would
    answer otherwise: it measures how far every pair is from that, and again when surfaces have travelled half of it.
    """
    steps = supports.drive.shape[0]
    nodes = supports.nodes
    across = np.empty((nodes.size, 3))
    followed = np.empty((nodes.size, 3))
    fastest = np.zeros(CHUNKS)
    damped = np.zeros((CHUNKS, 2))
    watched = watch.arms.size > 0
    travelled = 0.0
    room = 0.0
    here, there = u, spare
    done = steps
    why = DONE
    for step in range(steps):
        if watched and 2.0 * travelled >= room:
            listed = watch.skin - 2.0 * moved(here, watch.origin)
            room = min(slack(here, watch.contacts, watch.limits), listed)
            travelled = 0.0
            if room < 0.0:
                done = step
                why = LIST_ENDS if listed < 0.0 else LAW_ENDS
                break
        seam_forces(here, rows, supports.seam, across)
        note_before(step, here, v, log.probes, log.record, supports.seam.twin, followed)
        _move(here, v, rows, body, there, fastest, watch.arms, damped)
        move_supported(step, here, v, there, across, followed, supports, body, log.work)
        note_after(step, v, log.probes, log.record, log.tracked, log.peaks)
        if log.top_speed.size > 0:
            note_top_speeds(v, log.top_speed)
        if body.damp > 0.0:
            log.work[1, 1] += damped[:, 1].sum()
            log.work[0, 1] += damped[:, 0].sum()
        if watched:
            most = fastest.max()
            for s in range(nodes.size):
                most = max(most, np.hypot(v[0, nodes[s]], v[1, nodes[s]]) + watch.arms[nodes[s]] * abs(v[2, nodes[s]]))
            travelled += body.step * most
        here, there = there, here
    if done % 2 == 1:
        u[:] = here
    return done, why
