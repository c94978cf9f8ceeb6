"""History-dependent contacts: PFC2D's linear contact (no tension, Coulomb friction) with a parallel bond that breaks.

A pair's motion is three numbers: the distance of the centres, the tangential displacement `shear` of the two surfaces
(counted along the path, as the tangent turns with the pair) and the relative rotation. The bond resists all three from
its unloaded state; the contact resists overlap and the part of `shear` that has not slid. No other history is needed:
in two dimensions a shear force has one component, which rotates with the pair automatically.

The constants of pairs are those of pairwise.py and of the law, whose functions (pair_law.py) are called. Under a
stress at rest a pair has a stretch, shear and rotation from the start (compiler/start_strain.py).
Force (4,) of a pair: x and y on i (the opposite on j), moment on i, moment on j.
"""

import numpy as np
from numba import njit

from dembound.kernels.common import FAST, INLINED, U
from dembound.kernels.compiler.lanes import at_most, choose, larger
from dembound.kernels.compiler.limits import factor_of
from dembound.kernels.compiler.separate import apart
from dembound.kernels.compiler.start_strain import began_with
from dembound.kernels.pair_law import (
    bond,
    breaks,
    most_shear,
    normal,
    rolls,
    rubbed,
    shear_of,
    slip_after,
    slip_at,
    slips_by_overlap,
    stored_between,
    viscosity,
)
from dembound.kernels.pair_strain import pair, reference_strain, slide, updated_strain, updated_stretch
from dembound.kernels.rolling import roll_pair
from dembound.pairwise import P

NONE, INTACT, TENSION, SHEAR = 0, 1, 2, 3
"""States of a pair: without bond, bonded, bond broken in tension, bond broken in shear."""

MAY_BREAK, KEPT, REACHED = 0, 1, 2
"""Whether a bond may break, never breaks, or never breaks and has reached its strength."""

UPDATED, BONDED, REFERENCE, SLID = 0, 1, 2, 3
"""Geometries of normals and arms.

UPDATED: they follow the motion. BONDED, for ``geometry = "reference"``: intact bonds keep the initial geometry.
REFERENCE: all pairs keep it, and contacts that are closed at the start neither open nor slide. SLID, only for energies:
REFERENCE for contacts that slid earlier."""

OPEN, CLOSES, CLOSED = 0, 1, 2
"""Whether a contact pushed in the last step: it did not, for the first time, or it did before, too.

Pairs that are open before and after a step, and without bond, are left out: nothing of them may change.
"""

LOST = 5
"""Numbers that a chunk of pairs counts in a step, see single_pairs.push."""

CLOSING = 1.05
"""Factor of a contact's first push after it was open.

With central differences a contact that opens, with an overlap a in one step and a gap b in the next, gains ½k·ab too
much energy; one that closes loses ½k·ab too much. The two balance only on average. With long steps noise gains energy,
by a factor e within 0.3 s (0.9 of the limit, square lattice of 0.5 m disks, 2000 m/s). With this factor closing loses
more than opening gains, on average by 0.05·sin³φ/φ of the contact's energy per period, with the phase φ = 2
arcsin(½ωΔt) per step: 2e-6 for waves of 1000 steps a period. A chain of contacts and bonds needs some 0.03 instead of
0.05 for all φ below 2π/3 (stability.OPENING).
"""


@njit(**FAST, inline="always")
def closing_work(limits, constants, k, before, now, had_closed, push):
    """Energy (J) taken by a contact's normal force in a step beyond the stored energy; negative if released.

    before, now : overlap (m) before and after the step, negative for a gap, numbers or lanes; had_closed : whether the
    force of the step before was a first push (`CLOSING`); push : the force now, N. Forces at whole steps do the work
    ½(N⁻ + N)(now − before), while the energy of the overlaps, if positive, is stored. They differ where a contact opens
    or closes, and after a first push.
    """
    closed, closes = larger(before, 0.0), larger(now, 0.0)
    was = normal(limits, constants, k, closed)
    was = choose(had_closed, CLOSING * was, was)
    return 0.5 * ((was + push) * (now - before)) - stored_between(limits, constants, k, closed, closes)


@njit(**INLINED)
def resistance(limits, constants, k, overlap, viscosities, opening, sliding):
    """Forces (N) of the dashpots of contacts, with which they push and rub; numbers or lanes.

    They resist the rate of the overlap, but no contact pulls by it, and the rate of the shear, whether or not the
    contact slides: mode 1 of PFC's linear model. viscosities : N·s/m of both; opening, sliding : rates (m/s) half a
    step before the displacements (`disks.stability`).
    """
    share = viscosity(limits, constants, k, overlap)
    push = larger(0.0 - share * viscosities[0] * opening, 0.0 - normal(limits, constants, k, overlap))
    is_open = at_most(overlap, 0.0)
    return choose(is_open, 0.0, push), choose(is_open, 0.0, share * viscosities[1] * sliding)


@njit(**FAST, forceinline=True)  # by LLVM: numba's own inlining would drop writes to arrays that nothing reads
def _resist(c, k, overlap, opening, sliding, step, contacts, limits, lost):
    """Forces of the dashpots of pair c, see `resistance`; lost (5,) is advanced by what they take."""
    viscous, drag = contacts.viscosity, contacts.drag
    viscosities = viscous[U(0), c], viscous[U(1), c]
    push, rub = resistance(limits, contacts.constants, k, overlap, viscosities, opening, sliding)
    lost[4] += 0.5 * step * ((drag[U(1), c] + rub) * sliding - (drag[U(0), c] + push) * opening)
    drag[U(0), c], drag[U(1), c] = push, rub
    return push, rub


@njit(**FAST, forceinline=True)
def push_pair(c, u, v, step, number, contacts, limits, lost):
    """Force of pair c alone; lost (5,) is advanced, see `single_pairs.push`."""
    first, second, contact_type = contacts.first, contacts.second, contacts.contact_type
    constants, began, state, force = contacts.constants, contacts.began, contacts.state, contacts.force
    all_shear, all_slip, closed, cracked = contacts.shear, contacts.slip, contacts.closed, contacts.cracked
    geometry = limits.geometry
    i, j, k, dx, dy = pair(c, u, first, second, contact_type, constants)
    intact = state[c] == INTACT
    keeps_geometry = geometry == REFERENCE or (geometry == BONDED and intact)
    if keeps_geometry:
        nx, ny, distance, stretch, shear = reference_strain(i, j, k, dx, dy, u, constants, began)
        was = shear - step * slide(i, j, k, nx, ny, distance, v, constants)
    else:
        was = all_shear[c]
        nx, ny, distance, stretch, shear = updated_strain(i, j, k, dx, dy, was, v, step, constants, began)
        all_shear[c] = shear
    overlap = constants[k, P.touch] - constants[k, P.rest] - stretch
    arm_i = 0.5 * distance + constants[k, P.offset]
    arm_j = distance - arm_i
    slip = all_slip[c]
    N = normal(limits, constants, k, overlap)
    S = shear_of(limits, constants, k, overlap, shear, slip)
    opening = nx * (v[U(0), j] - v[U(0), i]) + ny * (v[U(1), j] - v[U(1), i])
    if geometry != REFERENCE or constants[k, P.touch] < constants[k, P.rest]:
        N = max(N, 0.0)
        overlapped = overlap + step * opening  # one step earlier
        if overlapped <= 0.0:
            N *= CLOSING
        if closed[c] == CLOSES or (overlapped <= 0.0) != (overlap <= 0.0):
            lost[2] += closing_work(limits, constants, k, overlapped, overlap, closed[c] == CLOSES, N)
        closed[c] = OPEN if overlap <= 0.0 else (CLOSES if overlapped <= 0.0 else CLOSED)
        slid = slip
        if slips_by_overlap(limits):
            slid = slip_after(limits, constants, k, overlapped, overlap, was, slip)
            S = shear_of(limits, constants, k, overlap, shear, slid)
        most = most_shear(limits, k, N)
        slides = abs(S) > most
        if slides or slips_by_overlap(limits):
            before = shear_of(limits, constants, k, overlapped, was, slip)
            if slides:
                S = np.copysign(most, S)
                slid = slip_at(limits, constants, k, overlap, shear, S)
            taken = rubbed(limits, constants, k, overlapped, overlap, was, shear, slip, slid, before, S)
            all_slip[c] = slid
            lost[0 if taken > 0.0 else 2] += taken  # below zero the force has changed its sign within the step
        if overlap <= 0.0 and not keeps_geometry and not intact:
            all_shear[c] = 0.0  # as if the pair was met anew when it closes, so that bits do not depend on the list
            all_slip[c] = 0.0
    pull = -N
    moment = 0.0
    if intact:
        turn = u[U(2), j] - u[U(2), i] + began_with(began, k, U(2))
        Fn, Fs, M = bond(limits, constants, k, stretch, shear, turn)
        torn, cut = breaks(limits, constants, k, k, factor_of(limits.factor, c), Fn, Fs, M)
        if (torn or cut) and contacts.kept[c] != MAY_BREAK:
            torn = cut = False
            contacts.kept[c] = REACHED
        if not torn and not cut:
            pull += Fn
            S += Fs
            moment = M
        else:
            state[c] = TENSION if torn else SHEAR
            cracked[c] = number
            all_shear[c] = shear
            closed[c] = CLOSED  # so that the next step looks at it
            turning = v[U(2), j] - v[U(2), i]
            broken = 0.5 * (Fn * (stretch - step * opening) + Fs * was + M * (turn - step * turning))
            if geometry == BONDED:  # the contact changes to the updated geometry
                _, _, _, longer = updated_stretch(k, dx, dy, constants, began)
                later = max(overlap + stretch - longer, 0.0)
                broken += stored_between(limits, constants, k, later, max(overlap, 0.0))
            lost[1 if broken > 0.0 else 2] += broken
            lost[3] += 1.0
    elif rolls(limits) and geometry != REFERENCE:
        moment = roll_pair(limits, c, k, N, step * (v[U(2), j] - v[U(2), i]), contacts, lost)
    if contacts.viscosity.shape[1] > 0 and (contacts.damps_bonds or not intact):
        sliding = slide(i, j, k, nx, ny, distance, v, constants)
        push, rub = _resist(c, k, overlap, opening, sliding, step, contacts, limits, lost)
        pull -= push
        S += rub
    force[U(0), c] = pull * nx - S * ny
    force[U(1), c] = pull * ny + S * nx
    force[U(2), c] = arm_i * S + moment
    force[U(3), c] = arm_j * S - moment


@apart()
@njit(**FAST)
def push_each(pairs, u, v, step, number, contacts, limits, lost):
    """Forces of some pairs (k,) uint32, one by one; lost (5,) is advanced, see `single_pairs.push`."""
    for k in range(pairs.size):
        push_pair(U(pairs[k]), u, v, step, number, contacts, limits, lost)


@apart()
@njit(**FAST)
def note_places(u, number, contacts):
    """Record the positions, at displacements u (3, n), of the bonds that broke in step `number`."""
    first, second, cracked, place = contacts.first, contacts.second, contacts.cracked, contacts.place
    for c in range(cracked.size):
        if cracked[c] == number:
            for axis in range(2):
                place[c, axis] = 0.5 * (u[axis, first[c]] + u[axis, second[c]])


@njit(**FAST, inline="always")
def ends_force(row, force, start, end):
    """Force (x, y) and moment on the particle of a row of contact ends, summed in order."""
    fx = 0.0
    fy = 0.0
    moment = 0.0
    for e in range(start[row], start[row + U(1)]):
        c = U(end[e]) >> U(1)
        side = U(end[e]) & U(1)
        sign = 1.0 - 2.0 * np.float64(side)
        fx += sign * force[U(0), c]
        fy += sign * force[U(1), c]
        moment += force[U(2) + side, c]
    return fx, fy, moment


@njit(**FAST)
def sum_forces(contacts, total):
    """Fill total (3, n) of the contacts' particles with the sums of their last forces and moments."""
    first, second, force = contacts.first, contacts.second, contacts.force
    total[:] = 0.0
    for p in range(first.size):
        c = U(p)
        i, j = U(first[c]), U(second[c])
        total[U(0), i] += force[U(0), c]
        total[U(1), i] += force[U(1), c]
        total[U(2), i] += force[U(2), c]
        total[U(0), j] -= force[U(0), c]
        total[U(1), j] -= force[U(1), c]
        total[U(2), j] += force[U(3), c]


@njit(**FAST)
def start_from_displacements(u, contacts, keeps_slip=False):
    """Set the pairs' tangential displacements to those of small displacements u (3, n), without slip.

    keeps_slip : contacts that are closed at the start keep their slip.
    """
    first, second, contact_type, constants = contacts.first, contacts.second, contacts.contact_type, contacts.constants
    began, shear, slip = contacts.began, contacts.shear, contacts.slip
    for p in range(first.size):
        c = U(p)
        i, j, k, dx, dy = pair(c, u, first, second, contact_type, constants)
        _, _, _, stretch, sheared = reference_strain(i, j, k, dx, dy, u, constants, began)
        shear[c] = sheared
        if keeps_slip and constants[k, P.touch] >= constants[k, P.rest]:
            continue
        slip[c] = sheared if constants[k, P.touch] - constants[k, P.rest] < stretch else 0.0
