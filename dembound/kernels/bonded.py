"""The history-dependent law in the loop: first the forces of pairs, then the motion of particles under their sums."""

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, DONE, FAST, LIST_ENDS, U, column_sum, largest
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.contacts import ends_force, note_places
from dembound.kernels.law import is_law, is_tie
from dembound.kernels.near import room
from dembound.kernels.single_pairs import push as push_pairs
from dembound.kernels.step import move_particle, note_damping
from dembound.kernels.tables import Bonded, SeamEnds


@njit(**FAST)
def begin(bonded):
    """Compute the displacement of particles anew before the first step."""
    bonded.way[0] = 0.0
    bonded.way[1] = 0.0


@njit(**FAST)
def check(bonded, u, u_next, v):
    """Whether a pair that is not listed may have come into contact."""
    way = bonded.way
    if 2.0 * way[0] < way[1]:
        return DONE
    way[0] = 0.0
    way[1] = room(u, bonded.contacts.begin, bonded.origin, bonded.skins, bonded.cells)
    return LIST_ENDS if way[1] < 0.0 else DONE


@njit(**FAST)
def note_lost(lost, work):
    """Add to work (2, 7) the energy that pairs have taken up to the whole step, see single_pairs.push."""
    work[0, 1] += column_sum(lost, 4)
    work[0, 2] += column_sum(lost, 0)
    work[0, 3] += column_sum(lost, 1)
    work[0, 6] += column_sum(lost, 2)
    work[1, 2] = work[0, 2]
    work[1, 3] = work[0, 3]
    work[1, 6] = work[0, 6]


@njit(**FAST)
def push(bonded, u, u_next, v, number, step, work):
    """Compute the forces of all pairs; returns the number of bonds that broke, if the loop is to stop at breaks."""
    breaks = push_pairs(u, v, step, number, bonded.contacts, bonded.limits, bonded.lost)
    if breaks > 0:
        note_places(u, number, bonded.contacts)
    note_lost(bonded.lost, work)
    return breaks if bonded.stops else 0


@in_chunks
@njit(**FAST)
def _move(first_chunk, last_chunk, u, v, contacts, body, u_next, fastest, damped):
    """One step of the contacts' particles, see `move_particle`.

    fastest (chunks,) gets their speeds, damped (chunks, 2) the work of local damping.
    """
    force, start, end = contacts.force, contacts.start, contacts.end
    begin = contacts.begin
    n = start.size - 1 - begin
    for chunk in range(first_chunk, last_chunk):
        most = 0.0
        whole = 0.0
        half = 0.0
        for p in range(begin + chunk * n // CHUNKS, begin + (chunk + 1) * n // CHUNKS):
            i = U(p)
            fx, fy, moment = ends_force(i, force, start, end)
            taken, up_to = move_particle(i, fx, fy, moment, u, v, body, u_next)
            whole += taken
            half += up_to
            most = max(most, v[U(0), i] ** 2 + v[U(1), i] ** 2)
        fastest[chunk] = np.sqrt(most)
        damped[chunk, 0] = whole
        damped[chunk, 1] = half


@njit(**FAST)
def move(bonded, u, u_next, v, body, nodes):
    """One step of all particles, see law.move."""
    _move(u, v, bonded.contacts, body, u_next, bonded.fastest, bonded.damped)


@njit(**FAST)
def finish(bonded, v, body, nodes, work):
    """Add the energy taken by local damping to the ledger, and update the distance particles have moved."""
    note_damping(bonded.damped, work)
    most = largest(bonded.fastest)
    begin = bonded.contacts.begin
    for s in range(nodes.size):
        i = nodes[s]
        if begin <= i < begin + bonded.origin.shape[1]:
            most = max(most, np.hypot(v[0, i], v[1, i]))
    bonded.way[0] += body.step * most


@njit(**FAST)
def seam_ends_forces(seam, u, v, force):
    """Add to force (k, 3) of the supported nodes the last forces on their twins across the seam."""
    for s in range(seam.start.size - 1):
        fx, fy, moment = ends_force(U(s), seam.force, seam.start, seam.end)
        force[s, 0] += fx
        force[s, 1] += fy
        force[s, 2] += moment


is_law(Bonded, begin=begin, check=check, push=push, move=move, finish=finish)
is_tie(SeamEnds, across=seam_ends_forces)
