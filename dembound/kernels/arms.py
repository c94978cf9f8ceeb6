"""Relaxation arms of intact bonds, by which ground that can break is damped, see disks/stepping/arms.py.

Beside the springs k_R that a pair has at rest, an intact bond has K arms with the springs w k_U of all of the pair,
k_R = k_U(1 − Σw): F = k_R d + Σ w k_U a, for its stretch, its shear and its rotation d alike. An arm lags behind,
a ← e a + ½(1 + e)Δd, with e = exp(−Δt/τ) and Δd by the velocities of the step. It takes ½w k_U(a + ½Δd)²(1 − e²) ≥ 0 in
a step, and stores ½w k_U a². Weights here are w/(1 − Σw), those of k_R. Contacts have no arms: they are αk_R, and open
and slide as without damping. A bond breaks by its own forces: the share 1 − α of all springs and arms in tension and in
shear, with what its contact cannot hold of the share α of the arms, as it is open or slides, and all of the moment. So
a pair breaks under the same force at any rate. The arms of a bond are gone with it.

The law itself steps contacts and bonds of the springs k_R, which never break there; after it arms are added, to eight
pairs at once (lanes.py), and bonds break, one by one. Names that functions share are those of pair_lanes.py.
"""

import numpy as np
from numba import njit

from dembound.kernels.bonded import note_lost
from dembound.kernels.common import CHUNKS, FAST, INLINED, MAKES, U, column_sum
from dembound.kernels.compiler.lane_access import load, load_of, nth, store_some_of, where_equal
from dembound.kernels.compiler.lanes import LANES, at_most, bits, byte_of, choose, larger, splat
from dembound.kernels.compiler.limits import factor_of, factors_of
from dembound.kernels.compiler.separate import apart, in_chunks
from dembound.kernels.compiler.start_strain import began_with
from dembound.kernels.contacts import BONDED, CLOSED, INTACT, MAY_BREAK, REACHED, SHEAR, TENSION
from dembound.kernels.lane_step import next_place, place_of
from dembound.kernels.lane_sums import TAKEN, add_to, begin_sums, end_sums
from dembound.kernels.law import answer, generic
from dembound.kernels.pair_lanes import (
    ALL,
    apart_of,
    in_lanes,
    reference,
    slide_of,
    updated,
)
from dembound.kernels.pair_law import (
    bond,
    breaks,
    most_shear,
    normal,
    shear_of,
    stored_between,
)
from dembound.kernels.pair_strain import pair, reference_strain, slide, updated_stretch
from dembound.kernels.tables import Bonded, LaneBonded
from dembound.pairwise import P

FADED = 1e-216
"""Lag (m) that is added and subtracted again, so that those much smaller become zero, see damped.FADED."""

_INTACT = np.uint8(INTACT)


@njit(**INLINED)
def springs_of(limits, constants, k):
    """Stiffnesses of a bond against stretch, shear and rotation, and of its contact, numbers or lanes.

    Those of contacts that were open at the start are 0: arms have no share of them.
    """
    of_bond = bond(limits, constants, k, 1.0, 1.0, 1.0)
    closed = choose(at_most(constants[k, P.rest], constants[k, P.touch]), 1.0, 0.0)
    along = 0.0 - closed * normal(limits, constants, k, 0.0 - 1.0)
    return of_bond, (along, closed * shear_of(limits, constants, k, 0.0, 1.0, 0.0))


@njit(**INLINED)
def energy_of(springs, stretch, shear, turn):
    """Energy (J) of the springs of all of a pair under a strain, numbers or lanes."""
    (n, s, t), (contact_n, contact_s) = springs
    return 0.5 * ((n + contact_n) * stretch * stretch + (s + contact_s) * shear * shear + t * turn * turn)


@njit(**INLINED)
def _not_held(limits, kind, push, shared, pull, side):
    """What a contact cannot hold of its share `pull` and `side` of the forces of arms, so that its bond does.

    push, shared : N, of the contact without arms. It cannot pull and slides, with its share as without it; then the
    bond holds all of the pair's force. Numbers or lanes.
    """
    with_arms = larger(push - pull, 0.0)
    most, whole = most_shear(limits, kind, with_arms), shared + side
    held = 0.0 - larger(0.0 - larger(whole, 0.0 - most), 0.0 - most)
    return (pull - push) + with_arms, whole - held


@njit(**FAST, forceinline=True)
def _break_pair(c, u, v, step, number, contacts, limits, arms, lost):
    """Break the bond of pair c, whose lags are those of this step, or add the forces of its arms if it may not."""
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
    springs, count, row = springs_of(limits, constants, k), arms.decay.shape[1], k % U(arms.decay.shape[0])
    pulled, sheared, bent, stored = 0.0, 0.0, 0.0, 0.0
    for each in range(count):
        a, b, g = lag[U(each), c], lag[U(count + each), c], lag[U(2 * count + each), c]
        weight = arms.weight[row, U(each)]
        stored += weight * energy_of(springs, a, b, g)
        pulled += weight * a
        sheared += weight * b
        bent += weight * g
    turn = u[U(2), j] - u[U(2), i] + began_with(began, k, U(2))
    overlap = constants[k, P.touch] - constants[k, P.rest] - stretch
    (bond_n, bond_s, bond_t), (contact_n, contact_s) = springs
    Fn, Fs, M = bond_n * stretch, bond_s * shear, bond_t * turn
    push, shared = 0.0, 0.0
    if overlap > 0.0:
        push = normal(limits, constants, k, overlap)
        shared = shear_of(limits, constants, k, overlap, shear, contacts.slip[c])
    pull, side = contact_n * pulled, contact_s * sheared
    more, across = _not_held(limits, k, push, shared, pull, side)
    An, As, Am = bond_n * pulled, bond_s * sheared, bond_t * bent
    factor = factor_of(limits.factor, c)
    torn, cut = breaks(limits, constants, k, k, factor, Fn + (An + more), Fs + (As + across), M + Am)
    An += pull
    As += side
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
        An, As, Am = 0.0 - Fn, 0.0 - Fs, 0.0 - M
    if (torn or cut) and overlap <= 0.0:  # its contact is open
        for each in range(4):
            force[U(each), c] = 0.0
    else:
        force[U(0), c] += An * nx - As * ny
        force[U(1), c] += An * ny + As * nx
        force[U(2), c] += arm_i * As + Am
        force[U(3), c] += arm_j * As - Am


@apart()
@njit(**FAST)
def break_each(pairs, u, v, step, number, contacts, limits, arms, lost):
    """Break the bonds of some pairs (k,) uint32, one by one, see `_break_pair`; lost (5,) is advanced."""
    for k in range(pairs.size):
        _break_pair(U(pairs[k]), u, v, step, number, contacts, limits, arms, lost)


@njit(**INLINED)
def _relax_eight(law, at, exists, way, u, v, step, contacts, limits, arms, taken, breaking):
    """Add the forces of arms of eight pairs; breaking (9,) uint32 gets those whose bonds may break."""
    (k, began, q, kind, _), (c, i, j) = law, at
    intact = np.uint8(byte_of(where_equal(contacts.state, c, _INTACT)) & exists)
    if intact == 0:
        return
    if limits.geometry == BONDED:
        one, other, stretch, shear = reference(law, at, way, u)
        nx, ny, arm_i, arm_j = in_lanes(way[0]), in_lanes(way[1]), in_lanes(one), in_lanes(other)
        sliding = slide_of((nx, ny), (arm_i, arm_j), at, v)
    else:  # the shear is already that of this step
        nx, ny, arm_i, arm_j, stretch, shear, sliding = updated(law, at, u, v, 0.0, contacts)
    dvx, dvy = apart_of(v, at)
    opened, slid = step * (nx * dvx + ny * dvy), step * sliding
    turned = step * (load_of(v, U(2), j) - load_of(v, U(2), i))
    turn = load_of(u, U(2), j) - load_of(u, U(2), i) + began_with(began, q, U(2))
    overlap = (k[q, P.touch] - k[q, P.rest]) - stretch
    push, is_open = larger(normal(limits, k, q, overlap), 0.0), at_most(overlap, 0.0)
    shared = choose(is_open, 0.0, shear_of(limits, k, q, overlap, shear, load(contacts.slip, c)))
    springs, lag, count = springs_of(limits, k, q), contacts.lag, arms.decay.shape[1]
    alike = arms.decay.shape[0] == 1
    pulled, sheared, bent, loss = splat(0.0), splat(0.0), splat(0.0), splat(0.0)
    for each in range(count):
        m, s, t = U(each), U(count + each), U(2 * count + each)
        if alike:
            e, weight = splat(arms.decay[U(0), m]), splat(arms.weight[U(0), m])
        else:
            e, weight = in_lanes(arms.decay[kind, m]), in_lanes(arms.weight[kind, m])
        a, b, g = load_of(lag, m, c), load_of(lag, s, c), load_of(lag, t, c)
        middle = energy_of(springs, a + 0.5 * opened, b + 0.5 * slid, g + 0.5 * turned)
        loss += weight * (1.0 - e * e) * middle
        half = 0.5 * (1.0 + e)
        a = (e * a + (half * opened + FADED)) - FADED
        b = (e * b + (half * slid + FADED)) - FADED
        g = (e * g + (half * turned + FADED)) - FADED
        store_some_of(lag, m, c, a, intact)
        store_some_of(lag, s, c, b, intact)
        store_some_of(lag, t, c, g, intact)
        pulled += weight * a
        sheared += weight * b
        bent += weight * g
    add_to(taken, 2 * LANES, choose(bits(intact), loss, 0.0))
    (bond_n, bond_s, bond_t), (contact_n, contact_s) = springs
    pull, side = contact_n * pulled, contact_s * sheared
    more, across = _not_held(limits, kind, push, shared, pull, side)
    An, As, Am = bond_n * pulled, bond_s * sheared, bond_t * bent
    factor = factors_of(limits.factor, c)
    tension, across = bond_n * stretch + (An + more), bond_s * shear + (As + across)
    torn, cut = breaks(limits, k, q, kind, factor, tension, across, bond_t * turn + Am)
    broken = np.uint8((byte_of(torn) | byte_of(cut)) & intact)
    if broken != 0:
        for each in range(LANES):
            if broken & np.uint8(1 << each):
                breaking[0] += 1
                breaking[breaking[0]] = nth(c, U(each))
        intact = np.uint8(intact & ~broken)
    An += pull
    As += side
    force = contacts.force
    store_some_of(force, U(0), c, load_of(force, U(0), c) + (An * nx - As * ny), intact)
    store_some_of(force, U(1), c, load_of(force, U(1), c) + (An * ny + As * nx), intact)
    store_some_of(force, U(2), c, load_of(force, U(2), c) + (arm_i * As + Am), intact)
    store_some_of(force, U(3), c, load_of(force, U(3), c) + (arm_j * As - Am), intact)


@njit(**FAST, forceinline=True)  # see pair_lanes._push_blocks
def _relax_singles(first, last, u, v, step, number, contacts, limits, arms, taken, breaking, lost):
    """The bonds of pairs first to last − 1, which are in no row."""
    begin_sums(taken, lost)
    for begin in range(first, last, LANES):
        exists = ALL if last - begin >= LANES else np.uint8((1 << (last - begin)) - 1)
        c, k = U(begin), contacts.constants
        q = load(contacts.contact_type, c)
        law, at = (k, contacts.began, q, q, True), (c, load(contacts.first, c), load(contacts.second, c))
        way = k[q, P.x] / k[q, P.rest], k[q, P.y] / k[q, P.rest]
        _relax_eight(law, at, exists, way, u, v, step, contacts, limits, arms, taken, breaking)
        if breaking[0] != 0:
            break_each(breaking[1 : 1 + breaking[0]], u, v, step, number, contacts, limits, arms, lost)
            breaking[0] = 0
    end_sums(taken, lost)


@in_chunks
@njit(**MAKES)
def _relax_all_singles(begin, end, u, v, step, number, contacts, limits, arms, lost):
    taken, breaking = np.empty(TAKEN), np.zeros(1 + LANES, np.uint32)
    for chunk in range(begin, end):
        first, last = contacts.bound[chunk], contacts.bound[chunk + 1]
        _relax_singles(first, last, u, v, step, number, contacts, limits, arms, taken, breaking, lost[chunk])


@njit(**FAST, forceinline=True)
def _relax_blocks(pairs, first, last, u, v, step, number, contacts, limits, arms, taken, breaking, lost):
    """The bonds in blocks first to last − 1 of the rows of copies."""
    begin_sums(taken, lost)
    if first == last:
        return
    group, column, q = place_of(pairs, first)
    for block in range(first, last):
        if block > first:
            group, column, q = next_place(pairs, block, group, column, q)
        row, exists = U(q), pairs.exists[U(block)]
        if exists != 0:
            disks = pairs.disk_block[U(group)] + column * pairs.disk_rows[U(group)] + pairs.step[row, U(0)]
            i = U(LANES * disks)
            at = U(LANES * block), i, i + U(pairs.step[row, U(1)])
            law = pairs.constants, pairs.began, row, U(pairs.contact_type[row]), True
            way = pairs.way[row, U(0)], pairs.way[row, U(1)]
            _relax_eight(law, at, exists, way, u, v, step, contacts, limits, arms, taken, breaking)
            if breaking[0] != 0:
                break_each(breaking[1 : 1 + breaking[0]], u, v, step, number, contacts, limits, arms, lost)
                breaking[0] = 0
    end_sums(taken, lost)


@in_chunks
@njit(**MAKES)
def _relax_rows(begin, end, u, v, step, number, pairs, contacts, limits, arms, lost):
    n = pairs.exists.size
    taken, breaking = np.empty(TAKEN), np.zeros(1 + LANES, np.uint32)
    for chunk in range(begin, end):
        first, last = chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS
        _relax_blocks(pairs, first, last, u, v, step, number, contacts, limits, arms, taken, breaking, lost[chunk])


@generic
def relax(law, u, v, step, number, limits, arms, work):
    """Add the forces of arms to those of the law's pairs; returns the number of bonds that broke."""


@njit(**FAST)
def _relax(law, u, v, step, number, limits, arms, work):
    contacts = law.contacts
    _relax_all_singles(u, v, step, number, contacts, limits, arms, arms.lost)
    note_lost(arms.lost, work)
    return int(column_sum(arms.lost, 3))


@njit(**FAST)
def _relax_with_rows(law, u, v, step, number, limits, arms, work):
    breaks = _relax(law.bonded, u, v, step, number, limits, arms, work)
    _relax_rows(u, v, step, number, law.pairs, law.bonded.contacts, limits, arms, arms.lost)
    note_lost(arms.lost, work)
    return breaks + int(column_sum(arms.lost, 3))


answer(relax, Bonded, _relax)
answer(relax, LaneBonded, _relax_with_rows)
