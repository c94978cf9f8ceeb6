"""The history-dependent law on bonds with relaxation arms in the loop, and the energy of arms."""

import numpy as np
from numba import njit

from dembound.kernels.arms import energy_of, relax, springs_of
from dembound.kernels.common import CHUNKS, FAST, MAKES, U, column_sum
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.contacts import INTACT, note_places
from dembound.kernels.law import begin as begin_law
from dembound.kernels.law import check as check_law
from dembound.kernels.law import finish as finish_law
from dembound.kernels.law import is_law
from dembound.kernels.law import move as move_law
from dembound.kernels.law import push as push_law
from dembound.kernels.tables import Relaxing


@njit(**MAKES)
def arms_energy(contacts, limits, arms):
    """Energy (J) stored in the arms of all intact bonds."""
    stored = np.empty((CHUNKS, 1))
    _arms_energies(contacts, limits, arms, stored)
    return column_sum(stored, 0)


@in_chunks
@njit(**FAST)
def _arms_energies(begin, end, contacts, limits, arms, stored):
    """Fill stored (chunks, 1) with the energy in the arms of each chunk of pairs."""
    bound, lag, constants = contacts.bound, contacts.lag, contacts.constants
    in_rows, arm_count = bound[0], arms.decay.shape[1]
    for chunk in range(begin, end):
        energy = 0.0
        first_in_rows = chunk * in_rows // CHUNKS
        count = (chunk + 1) * in_rows // CHUNKS - first_in_rows
        for p in range(count + bound[chunk + 1] - bound[chunk]):
            c = U(first_in_rows + p) if p < count else U(bound[chunk] + p - count)
            if contacts.state[c] == INTACT:
                k = U(contacts.contact_type[c])
                springs, row = springs_of(limits, constants, k), k % U(arms.decay.shape[0])
                for each in range(arm_count):
                    a, b, g = lag[U(each), c], lag[U(arm_count + each), c], lag[U(2 * arm_count + each), c]
                    energy += arms.weight[row, U(each)] * energy_of(springs, a, b, g)
        stored[chunk, 0] = energy


@njit(**FAST)
def begin(relaxing):
    """See law.begin."""
    begin_law(relaxing.law)


@njit(**FAST)
def check(relaxing, u, u_next, v):
    """See law.check."""
    return check_law(relaxing.law, u, u_next, v)


@njit(**FAST)
def push(relaxing, u, u_next, v, number, step, work):
    """Compute the forces of all pairs; returns the number of bonds that broke, if the loop is to stop at breaks."""
    push_law(relaxing.law, u, u_next, v, number, step, work)
    breaks = relax(relaxing.law, u, v, step, number, relaxing.limits, relaxing.arms, work)
    if breaks > 0:
        note_places(u, number, relaxing.bonded.contacts)
    return breaks if relaxing.stops else 0


@njit(**FAST)
def move(relaxing, u, u_next, v, body, nodes):
    """See law.move."""
    move_law(relaxing.law, u, u_next, v, body, nodes)


@njit(**FAST)
def finish(relaxing, v, body, nodes, work):
    """See law.finish."""
    finish_law(relaxing.law, v, body, nodes, work)


is_law(Relaxing, begin=begin, check=check, push=push, move=move, finish=finish)
