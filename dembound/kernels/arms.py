"""Relaxation arms of intact bonds, by which ground that can break is damped, see disks/stepping/arms.py.

Beside the springs k_R that a pair has at rest, an intact bond has K arms with the springs w k_U of all of the pair,
k_R = k_U(1 − Σw): F = k_R d + Σ w k_U a, for its stretch, its shear and its rotation d alike. An arm lags behind,
a ← e a + ½(1 + e)Δd, with e = exp(−Δt/τ) and Δd by the velocities of the step. It takes ½w k_U(a + ½Δd)²(1 − e²) ≥ 0 in
a step, and stores ½w k_U a². Weights here are w/(1 − Σw), those of k_R. Contacts have no arms: they are αk_R, and open
and slide as without damping. A bond breaks by its own forces, the share 1 − α of all springs and arms in tension and in
shear, and all of the moment; its arms are gone with it, and the forces of what it held are those of its contact.

The law itself steps contacts and bonds of the springs k_R, which never break there; after it arms are added, pair by
pair, and bonds break.
"""

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, FAST, MAKES, U, column_sum
from dembound.kernels.compiler.limits import factor_of
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.compiler.start_strain import began_with
from dembound.kernels.bonded import note_lost
from dembound.kernels.contacts import (
    BONDED,
    CLOSED,
    INTACT,
    MAY_BREAK,
    REACHED,
    SHEAR,
    TENSION,
    note_places,
)
from dembound.kernels.law import begin as begin_law
from dembound.kernels.law import check as check_law
from dembound.kernels.law import finish as finish_law
from dembound.kernels.law import is_law
from dembound.kernels.law import move as move_law
from dembound.kernels.law import push as push_law
from dembound.kernels.pair_law import (
    bond,
    bond_energy,
    breaks,
    contact_energy,
    most_shear,
    normal,
    shear_of,
    stored_between,
)
from dembound.kernels.pair_strain import pair, reference_strain, slide, updated_stretch
from dembound.kernels.tables import Relaxing
from dembound.pairwise import P

FADED = 1e-216
"""Lag (m) that is added and subtracted again, so that those much smaller become zero, see damped.FADED."""


@njit(**FAST, inline="always")
def _springs_energy(limits, constants, k, stretch, shear, turn):
    """Energy (J) of the bond and of the contact, if it was closed at the start, of a pair under a strain."""
    energy = bond_energy(limits, constants, k, stretch, shear, turn)
    if constants[k, P.touch] >= constants[k, P.rest]:
        energy += contact_energy(limits, constants, k, stretch, shear)
    return energy


@njit(**FAST, inline="always")
def _not_held(limits, constants, k, overlap, shear, slip, pull, side):
    """What a contact cannot hold of its share of the forces of arms, `pull` and `side`, so that its bond does."""
    push, held = 0.0, 0.0
    if overlap > 0.0:
        push = normal(limits, constants, k, overlap)
        held = shear_of(limits, constants, k, overlap, shear, slip)
    with_arms = max(push - pull, 0.0)
    most = most_shear(limits, k, with_arms)
    return (pull - push) + with_arms, (held + side) - min(max(held + side, 0.0 - most), most)


@njit(**FAST, forceinline=True)
def _relax_pair(c, u, v, step, number, contacts, limits, arms, lost):
    """Add the forces of the arms of pair c, whose bond is intact, to those of its springs, unless it breaks."""
    constants, began, lag, force = contacts.constants, contacts.began, contacts.lag, contacts.force
    i, j, k, dx, dy = pair(c, u, contacts.first, contacts.second, contacts.contact_type, constants)
    if limits.geometry == BONDED:
        nx, ny, distance, stretch, shear = reference_strain(i, j, k, dx, dy, u, constants, began)
    else:
        nx, ny, distance, stretch = updated_stretch(k, dx, dy, constants, began)
        shear = contacts.shear[c]
    opened = step * (nx * (v[U(0), j] - v[U(0), i]) + ny * (v[U(1), j] - v[U(1), i]))
    slid = step * slide(i, j, k, nx, ny, distance, v, constants)
    turned = step * (v[U(2), j] - v[U(2), i])
    count = arms.decay.shape[1]
    pulled, sheared, bent = 0.0, 0.0, 0.0
    taken, stored = 0.0, 0.0
    for each in range(count):
        m, s, t = U(each), U(count + each), U(2 * count + each)
        e, weight = arms.decay[k, m], arms.weight[k, m]
        a, b, g = lag[m, c], lag[s, c], lag[t, c]
        middle = _springs_energy(limits, constants, k, a + 0.5 * opened, b + 0.5 * slid, g + 0.5 * turned)
        taken += weight * (1.0 - e * e) * middle
        half = 0.5 * (1.0 + e)
        a = (e * a + (half * opened + FADED)) - FADED
        b = (e * b + (half * slid + FADED)) - FADED
        g = (e * g + (half * turned + FADED)) - FADED
        lag[m, c], lag[s, c], lag[t, c] = a, b, g
        stored += weight * _springs_energy(limits, constants, k, a, b, g)
        pulled += weight * a
        sheared += weight * b
        bent += weight * g
    lost[4] += taken
    turn = u[U(2), j] - u[U(2), i] + began_with(began, k, U(2))
    Fn, Fs, M = bond(limits, constants, k, stretch, shear, turn)
    An, As, Am = bond(limits, constants, k, pulled, sheared, bent)
    Cn, Cs = 0.0, 0.0
    if constants[k, P.touch] >= constants[k, P.rest]:
        Cn = 0.0 - normal(limits, constants, k, 0.0 - pulled)
        Cs = shear_of(limits, constants, k, 0.0, sheared, 0.0)
    overlap = constants[k, P.touch] - constants[k, P.rest] - stretch
    slip = contacts.slip[c]
    more_pull, more_shear = _not_held(limits, constants, k, overlap, shear, slip, Cn, Cs)
    factor = factor_of(limits.factor, c)
    torn, cut = breaks(limits, constants, k, k, factor, Fn + (An + more_pull), Fs + (As + more_shear), M + Am)
    An += Cn
    As += Cs
    if (torn or cut) and contacts.kept[c] != MAY_BREAK:
        torn = cut = False
        contacts.kept[c] = REACHED
    arm_i = 0.5 * distance + constants[k, P.offset]
    arm_j = distance - arm_i
    if torn or cut:
        contacts.state[c] = TENSION if torn else SHEAR
        contacts.cracked[c] = number
        contacts.shear[c] = shear
        contacts.closed[c] = CLOSED  # so that the next step looks at it
        broken = stored + 0.5 * (Fn * (stretch - opened) + Fs * (shear - slid) + M * (turn - turned))
        broken -= 0.5 * (An * opened + As * slid + Am * turned)
        if limits.geometry == BONDED:  # the contact changes to the updated geometry
            _, _, _, longer = updated_stretch(k, dx, dy, constants, began)
            later = max(overlap + stretch - longer, 0.0)
            broken += stored_between(limits, constants, k, later, max(overlap, 0.0))
        lost[1 if broken > 0.0 else 2] += broken
        lost[3] += 1.0
        for each in range(3 * count):
            lag[U(each), c] = 0.0
        if overlap <= 0.0:  # its contact is open
            for each in range(4):
                force[U(each), c] = 0.0
            return
        An, As, Am = 0.0 - Fn, 0.0 - Fs, 0.0 - M
    force[U(0), c] += An * nx - As * ny
    force[U(1), c] += An * ny + As * nx
    force[U(2), c] += arm_i * As + Am
    force[U(3), c] += arm_j * As - Am


@in_chunks
@njit(**FAST)
def _relax(begin, end, u, v, step, number, contacts, limits, arms):
    """Arms of all intact bonds; arms.lost (chunks, 5) receives what they take, see `single_pairs.push`."""
    state, bound, lost = contacts.state, contacts.bound, arms.lost
    in_rows = bound[0]
    for chunk in range(begin, end):
        lost[chunk] = 0.0
        first_in_rows = chunk * in_rows // CHUNKS
        count = (chunk + 1) * in_rows // CHUNKS - first_in_rows
        for p in range(count + bound[chunk + 1] - bound[chunk]):
            c = U(first_in_rows + p) if p < count else U(bound[chunk] + p - count)
            if state[c] == INTACT:
                _relax_pair(c, u, v, step, number, contacts, limits, arms, lost[chunk])


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
                for each in range(arm_count):
                    a, b, g = lag[U(each), c], lag[U(arm_count + each), c], lag[U(2 * arm_count + each), c]
                    energy += arms.weight[k, U(each)] * _springs_energy(limits, constants, k, a, b, g)
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
    contacts, arms = relaxing.bonded.contacts, relaxing.arms
    _relax(u, v, step, number, contacts, relaxing.limits, arms)
    breaks = int(column_sum(arms.lost, 3))
    if breaks > 0:
        note_places(u, number, contacts)
    note_lost(arms.lost, work)
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
