"""Dashpots of contacts under the history-dependent law, which act beside it while a contact is closed.

The forces of pairs are computed by the law first, and those of dashpots are added to them. A dashpot resists the rate
of the overlap, but no contact pulls by it, and the rate of the shear, whether or not the contact slides: mode 1 of
PFC's linear model. Velocities are those half a step before the displacements (`disks.stability`).
"""

from numba import njit

from dembound.kernels.common import CHUNKS, FAST, U
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.contacts import BONDED, INTACT, REFERENCE
from dembound.kernels.law import begin as begin_law
from dembound.kernels.law import check as check_law
from dembound.kernels.law import finish as finish_law
from dembound.kernels.law import is_law
from dembound.kernels.law import move as move_law
from dembound.kernels.law import push as push_law
from dembound.kernels.pair_law import normal
from dembound.kernels.pair_law import viscosity as viscosity_of
from dembound.kernels.pair_strain import pair, reference_strain, slide, updated_stretch
from dembound.kernels.tables import Dashed
from dembound.pairwise import P


@in_chunks
@njit(**FAST)
def _drag(first_chunk, last_chunk, u, v, step, contacts, limits, viscosity, drag, taken):
    """Add the forces of dashpots to those of closed contacts; taken (chunks,) gets the energy (J) of the last step.

    It is the work of forces at whole steps, half of it before and half after each.
    """
    first, second, contact_type = contacts.first, contacts.second, contacts.contact_type
    constants, began, state, force = contacts.constants, contacts.began, contacts.state, contacts.force
    b, geometry = first.size, limits.geometry
    for chunk in range(first_chunk, last_chunk):
        lost = 0.0
        for p in range(chunk * b // CHUNKS, (chunk + 1) * b // CHUNKS):
            c = U(p)
            if viscosity[c, U(0)] == 0.0 and viscosity[c, U(1)] == 0.0:
                continue
            i, j, k, dx, dy = pair(c, u, first, second, contact_type, constants)
            if geometry == REFERENCE or (geometry == BONDED and state[c] == INTACT):
                nx, ny, distance, stretch, _ = reference_strain(i, j, k, dx, dy, u, constants, began)
            else:
                nx, ny, distance, stretch = updated_stretch(k, dx, dy, constants, began)
            overlap = constants[k, P.touch] - constants[k, P.rest] - stretch
            if overlap <= 0.0 and drag[c, U(0)] == 0.0 and drag[c, U(1)] == 0.0:
                continue
            closing = nx * (v[U(0), i] - v[U(0), j]) + ny * (v[U(1), i] - v[U(1), j])
            sliding = slide(i, j, k, nx, ny, distance, v, constants)
            push = 0.0
            rub = 0.0
            if overlap > 0.0:
                share = viscosity_of(limits, constants, k, overlap)
                push = max(share * viscosity[c, U(0)] * closing, -normal(limits, constants, k, overlap))
                rub = share * viscosity[c, U(1)] * sliding
            lost += 0.5 * step * ((drag[c, U(0)] + push) * closing + (drag[c, U(1)] + rub) * sliding)
            drag[c, U(0)] = push
            drag[c, U(1)] = rub
            arm_i = 0.5 * distance + constants[k, P.offset]
            force[U(0), c] -= push * nx + rub * ny
            force[U(1), c] -= push * ny - rub * nx
            force[U(2), c] += arm_i * rub
            force[U(3), c] += (distance - arm_i) * rub
        taken[chunk] = lost


@njit(**FAST)
def begin(dashed):
    """See law.begin."""
    begin_law(dashed.law)


@njit(**FAST)
def check(dashed, u, u_next, v):
    """See law.check."""
    return check_law(dashed.law, u, u_next, v)


@njit(**FAST)
def push(dashed, u, u_next, v, number, step, work):
    """Compute the forces of the law and of dashpots, which add what they take to the energy taken by damping."""
    breaks = push_law(dashed.law, u, u_next, v, number, step, work)
    _drag(u, v, step, dashed.contacts, dashed.limits, dashed.viscosity, dashed.drag, dashed.taken)
    for chunk in range(dashed.taken.size):
        work[0, 1] += dashed.taken[chunk]
    return breaks


@njit(**FAST)
def move(dashed, u, u_next, v, body, nodes):
    """See law.move."""
    move_law(dashed.law, u, u_next, v, body, nodes)


@njit(**FAST)
def finish(dashed, v, body, nodes, work):
    """See law.finish."""
    finish_law(dashed.law, v, body, nodes, work)


is_law(Dashed, begin=begin, check=check, push=push, move=move, finish=finish)
