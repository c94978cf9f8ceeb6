"""The history-free elastic law and the step of central differences, fused into one pass over the particles.

Each particle gathers from its own row of contacts, so no two particles write to the same place: the sums are added in
the same order, and so give the same bits, for any number of threads. The constants of a contact are stored once, in a
small table for all copies of the brick; a row contains only the neighbour and the contact type (8 bytes).

A row of constants (6,) of a contact, for particle i with neighbour j, unit normal n = (c, s) from i to j or from j to i
(the law is even in n, the arms have the sign):

    [√k_n c, √k_n s, √(k_s/k_n), √k_s l_i, √k_s l_j, k_r]

so that N = √k_n n·Δu, S = √k_s (t·Δu − l_iθ_i − l_jθ_j), and the force on i is √k_n N n + √k_s S t with the moment
√k_s l_i S + k_r (θ_j − θ_i).
"""

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, DONE, FAST, LAW_ENDS, LIST_ENDS, U, largest
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.contact_measures import slack
from dembound.kernels.law import answer, generic, is_law, is_tie
from dembound.kernels.near import room
from dembound.kernels.step import move_particle, note_damping
from dembound.kernels.tables import Links, NeighbourTable, Seam, WatchedLinks


@njit(**FAST, inline="always")
def row_force(row, i, u, start, neighbour, contact_type, constants):
    """Force (x, y) and moment on particle i from a row of contacts (Z eqs 7-9; PFC2D linear parallel bond)."""
    x = u[U(0), i]
    y = u[U(1), i]
    turn = u[U(2), i]
    fx = 0.0
    fy = 0.0
    moment = 0.0
    for e in range(start[row], start[row + U(1)]):
        j = U(neighbour[e])
        k = U(contact_type[e])
        px = constants[k, U(0)]
        py = constants[k, U(1)]
        ratio = constants[k, U(2)]
        arm = constants[k, U(3)]
        turn_j = u[U(2), j]
        dx = u[U(0), j] - x
        dy = u[U(1), j] - y
        N = px * dx + py * dy
        S = ratio * (px * dy - py * dx) - arm * turn - constants[k, U(4)] * turn_j
        T = ratio * S
        fx += px * N - py * T
        fy += py * N + px * T
        moment += arm * S + constants[k, U(5)] * (turn_j - turn)
    return fx, fy, moment


@generic
def fill_forces(rows, u, force):
    """Fill force (3, slots) of the rows' disks with contact forces and moments (N, N·m) at displacements u."""


@generic
def move_rows(rows, u, v, body, u_next, fastest, arms, damped):
    """One step of the rows' disks, see `move_particle`.

    fastest (chunks,) gets surface speeds if there are arms (slots,), damped (chunks, 2) the work of local damping.
    """


@in_chunks
@njit(**FAST)
def _fill(first_chunk, last_chunk, rows, u, force):
    begin, start = rows.begin, rows.start
    neighbour, contact_type, constants = rows.neighbour, rows.contact_type, rows.constants
    n = start.size - 1 - begin
    for chunk in range(first_chunk, last_chunk):
        for p in range(begin + chunk * n // CHUNKS, begin + (chunk + 1) * n // CHUNKS):
            i = U(p)
            force[U(0), i], force[U(1), i], force[U(2), i] = row_force(
                i, i, u, start, neighbour, contact_type, constants
            )


@njit(**FAST)
def seam_forces(seam, u, v, force):
    """Add to force (k, 3) of the supported nodes the forces on their twins across the seam."""
    twin, start = seam.twin, seam.start
    neighbour, contact_type, constants = seam.neighbour, seam.contact_type, seam.constants
    for s in range(twin.size):
        if start[s + 1] > start[s]:
            fx, fy, moment = row_force(U(s), U(twin[s]), u, start, neighbour, contact_type, constants)
            force[s, 0] += fx
            force[s, 1] += fy
            force[s, 2] += moment


@in_chunks
@njit(**FAST)
def _move(first_chunk, last_chunk, rows, u, v, body, u_next, fastest, arms, damped):
    begin, start = rows.begin, rows.start
    neighbour, contact_type, constants = rows.neighbour, rows.contact_type, rows.constants
    n = start.size - 1 - begin
    watched = arms.size > 0
    for chunk in range(first_chunk, last_chunk):
        most = 0.0
        whole = 0.0
        half = 0.0
        for p in range(begin + chunk * n // CHUNKS, begin + (chunk + 1) * n // CHUNKS):
            i = U(p)
            fx, fy, moment = row_force(i, i, u, start, neighbour, contact_type, constants)
            taken, up_to = move_particle(i, fx, fy, moment, u, v, body, u_next)
            whole += taken
            half += up_to
            if watched:
                most = max(most, np.sqrt(v[U(0), i] ** 2 + v[U(1), i] ** 2) + arms[i] * abs(v[U(2), i]))
        fastest[chunk] = most
        damped[chunk, 0] = whole
        damped[chunk, 1] = half


@njit(**FAST)
def _fill_table(rows, u, force):
    _fill(rows, u, force)


@njit(**FAST)
def _move_table(rows, u, v, body, u_next, fastest, arms, damped):
    _move(rows, u, v, body, u_next, fastest, arms, damped)


answer(fill_forces, NeighbourTable, _fill_table)
answer(move_rows, NeighbourTable, _move_table)


@njit(**FAST)
def contact_forces(u, rows, force):
    """Fill force (3, slots) of the rows' disks with contact forces and moments (N, N·m) at displacements u (3, slots).

    rows : a NeighbourTable or LaneRows.
    """
    fill_forces(rows, u, force)


@njit(**FAST)
def move(links, u, u_next, v, body, nodes):
    """One step of all particles, see law.move."""
    move_rows(links.rows, u, v, body, u_next, links.fastest, links.fastest[:0], links.damped)


@njit(**FAST)
def finish(links, v, body, nodes, work):
    """Add the energy taken by local damping to the ledger."""
    if body.damp > 0.0:
        note_damping(links.damped, work)


@njit(**FAST)
def begin_watch(watched):
    """Compute the distance of all contacts from their limits anew before the first step."""
    watched.way[0] = 0.0
    watched.way[1] = 0.0


@njit(**FAST)
def check_watch(watched, u, u_next, v):
    """Whether a contact would leave the elastic law in this step, or a pair that is not listed may come into contact.

    The least distance of all pairs from their limits is computed again when surfaces have moved by half of it.
    """
    way, contacts = watched.way, watched.contacts
    if 2.0 * way[0] < way[1]:
        return DONE
    listed = room(u, contacts.begin, watched.origin, watched.skins, watched.cells)
    way[0] = 0.0
    way[1] = min(slack(u, contacts, watched.limits, watched.keeps_slip), listed)
    if way[1] >= 0.0:
        return DONE
    return LIST_ENDS if listed < 0.0 else LAW_ENDS


@njit(**FAST)
def move_watched(watched, u, u_next, v, body, nodes):
    """One step of all particles, with the largest surface speeds."""
    links = watched.links
    move_rows(links.rows, u, v, body, u_next, links.fastest, watched.arms, links.damped)


@njit(**FAST)
def finish_watched(watched, v, body, nodes, work):
    """Add the energy taken by local damping to the ledger, and update the distance surfaces have moved."""
    finish(watched.links, v, body, nodes, work)
    most = largest(watched.links.fastest)
    for s in range(nodes.size):
        i = nodes[s]
        if watched.contacts.begin <= i < watched.arms.size:
            most = max(most, np.hypot(v[0, i], v[1, i]) + watched.arms[i] * abs(v[2, i]))
    watched.way[0] += body.step * most


is_law(Links, move=move, finish=finish)
is_law(WatchedLinks, begin=begin_watch, check=check_watch, move=move_watched, finish=finish_watched)
is_tie(Seam, across=seam_forces)
