"""Forces of history-dependent pairs, eight at once (lanes.py), in rows of copies or in no row.

The formulas are those of contacts.py. A pair whose bond breaks in this step is computed there.

Names that the functions share: law (k, began, q, kind, acts) are constants and strain from the start, the rows of the
eight pairs in both and in the limits, and whether they may have contacts beside bonds; at (c, i, j) where the pairs and
their first and second disks are; one number each where pairs are copies, or eight (lanes.py). exists : byte with the
bits of the pairs to compute. taken (24,) is advanced by the energies (J) of the eight that friction, contacts that open
and close, and dashpots take. breaking (9,) uint32 gets the number of pairs whose bond breaks, and these pairs, which
contacts.push_each computes.
"""

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, FAST, INLINED, MAKES, U, column_sum
from dembound.kernels.compiler.lane_access import (
    load,
    load_of,
    note_some,
    nth,
    store_some,
    store_some_of,
    where_equal,
)
from dembound.kernels.compiler.lanes import (
    LANES,
    at_most,
    bits,
    byte_of,
    choose,
    larger,
    magnitude,
    root,
    splat,
    with_sign,
)
from dembound.kernels.compiler.limits import factors_of
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.compiler.start_strain import began_with
from dembound.kernels.contacts import (
    BONDED,
    CLOSED,
    CLOSES,
    CLOSING,
    INTACT,
    MAY_BREAK,
    closing_work,
    push_each,
    resistance,
)
from dembound.kernels.lane_step import next_place, place_of
from dembound.kernels.lane_sums import TAKEN, add_to, begin_sums, end_sums
from dembound.kernels.pair_law import (
    acts,
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
)
from dembound.kernels.rolling import roll_eight
from dembound.pairwise import P

ALL = np.uint8(2**LANES - 1)
"""The byte of eight pairs."""

_INTACT, _MAY_BREAK, _CLOSES, _CLOSED = (np.uint8(each) for each in (INTACT, MAY_BREAK, CLOSES, CLOSED))


@njit(**INLINED)
def in_lanes(numbers):
    """A number in all lanes, or lanes themselves."""
    return splat(0.0) + numbers


@njit(**INLINED)
def apart_of(u, at):
    """Displacements of second disks relative to those of first ones."""
    _, i, j = at
    return load_of(u, U(0), j) - load_of(u, U(0), i), load_of(u, U(1), j) - load_of(u, U(1), i)


@njit(**INLINED)
def slide_of(way, arms, at, v):
    """Rate (m/s) of the shear of pairs."""
    (nx, ny), (arm_i, arm_j), (_, i, j) = way, arms, at
    dvx, dvy = apart_of(v, at)
    return nx * dvy - ny * dvx - arm_i * load_of(v, U(2), i) - arm_j * load_of(v, U(2), j)


@njit(**INLINED)
def _contact(law, at, overlap, shear, opening, sliding, step, exists, contacts, limits, taken):
    """Normal and shear force of contacts; their slip and whether they push are stored."""
    (k, _, q, kind, _), (c, _, _) = law, at
    slip = load(contacts.slip, c)
    N = normal(limits, k, q, overlap)
    S = shear_of(limits, k, q, overlap, shear, slip)
    overlapped = overlap + step * opening
    was_open = at_most(overlapped, 0.0)
    N = larger(N, 0.0)
    N = choose(was_open, CLOSING * N, N)
    had_closed = where_equal(contacts.closed, c, _CLOSES)
    closed, was, now = byte_of(had_closed), byte_of(was_open), byte_of(at_most(overlap, 0.0))
    changed = np.uint8((closed | ~(byte_of(where_equal(contacts.closed, c, _CLOSED)) ^ now) | was ^ now) & exists)
    if changed != 0:
        passed = closing_work(limits, k, q, overlapped, overlap, had_closed, N)
        add_to(taken, LANES, choose(bits(np.uint8((was ^ now | closed) & exists)), passed, 0.0))
        note_some(contacts.closed, c, np.uint8(was & ~now), np.uint8(~was & ~now), exists)
    slid = slip
    if slips_by_overlap(limits):
        earlier = shear - step * sliding
        slid = slip_after(limits, k, q, overlapped, overlap, earlier, slip)
        S = shear_of(limits, k, q, overlap, shear, slid)
    most = most_shear(limits, kind, N)
    stays = at_most(magnitude(S), most)
    if slips_by_overlap(limits) or (byte_of(stays) & exists) != exists:
        earlier = shear - step * sliding
        before = shear_of(limits, k, q, overlapped, earlier, slip)
        S = choose(stays, S, with_sign(most, S))
        slid = choose(stays, slid, slip_at(limits, k, q, overlap, shear, S))
        loss = rubbed(limits, k, q, overlapped, overlap, earlier, shear, slip, slid, before, S)
        loss = choose(bits(exists), loss, 0.0)
        store_some(contacts.slip, c, slid, exists)
        add_to(taken, 0, larger(loss, 0.0))
        add_to(taken, LANES, choose(at_most(loss, 0.0), loss, 0.0))
    return N, S


@njit(**INLINED)
def _resist(law, at, overlap, opening, sliding, step, exists, contacts, limits, taken):
    """Forces of dashpots, see `contacts.resistance`; what they take is added to taken."""
    (k, _, q, _, _), (c, _, _), drag = law, at, contacts.drag
    viscosities = load_of(contacts.viscosity, U(0), c), load_of(contacts.viscosity, U(1), c)
    push, rub = resistance(limits, k, q, overlap, viscosities, opening, sliding)
    loss = 0.5 * step * ((load_of(drag, U(1), c) + rub) * sliding - (load_of(drag, U(0), c) + push) * opening)
    add_to(taken, 2 * LANES, choose(bits(exists), loss, 0.0))
    store_some_of(drag, U(0), c, push, exists)
    store_some_of(drag, U(1), c, rub, exists)
    return push, rub


@njit(**INLINED)
def reference(law, at, way, u):
    """Arms, stretch and shear in the geometry of the start, whose normals are `way`."""
    (k, began, q, _, _), (_, i, j), (nx, ny) = law, at, way
    rest = k[q, P.rest]
    arm_i = 0.5 * rest + k[q, P.offset]
    arm_j = rest - arm_i
    dx, dy = apart_of(u, at)
    stretch = nx * dx + ny * dy + began_with(began, q, U(0))
    shear = nx * dy - ny * dx - arm_i * load_of(u, U(2), i) - arm_j * load_of(u, U(2), j) + began_with(began, q, U(1))
    return arm_i, arm_j, stretch, shear


@njit(**INLINED)
def updated(law, at, u, v, step, contacts):
    """Normals and arms that follow the motion, stretch, shear and its rate, see pair_strain.updated_strain."""
    (k, began, q, _, _), (c, _, _) = law, at
    dx, dy = apart_of(u, at)
    x = k[q, P.x] + dx
    y = k[q, P.y] + dy
    distance = root(x * x + y * y)
    stretch = ((k[q, P.x] + x) * dx + (k[q, P.y] + y) * dy) / (distance + k[q, P.rest])
    inverse = 1.0 / distance
    way = x * inverse, y * inverse
    arm_i = 0.5 * distance + k[q, P.offset]
    arms = arm_i, distance - arm_i
    sliding = slide_of(way, arms, at, v)
    shear = load(contacts.shear, c) + step * sliding
    return way[0], way[1], arms[0], arms[1], stretch + began_with(began, q, U(0)), shear, sliding


@njit(**INLINED)
def push_eight(law, at, exists, way, u, v, step, contacts, limits, taken, breaking):
    """Forces of eight pairs; way : directions from the first disks to the second at the start.

    Bonds keep the geometry of the start under BONDED. Pairs that do and those that do not take turns.
    """
    (k, began, q, kind, has_contact), (c, i, j) = law, at
    whole = where_equal(contacts.state, c, _INTACT)
    left = exists
    while left != 0:
        now = np.uint8(byte_of(whole) & left) if limits.geometry == BONDED else np.uint8(0)
        follows = now == 0
        if follows:
            now = left
            nx, ny, arm_i, arm_j, stretch, shear, sliding = updated(law, at, u, v, step, contacts)
        else:
            one, other, stretch, shear = reference(law, at, way, u)
            nx, ny, arm_i, arm_j = in_lanes(way[0]), in_lanes(way[1]), in_lanes(one), in_lanes(other)
            sliding = slide_of((nx, ny), (arm_i, arm_j), at, v)
        left = np.uint8(left & ~now)
        dvx, dvy = apart_of(v, at)
        opening = nx * dvx + ny * dvy
        pull, side, moment = splat(0.0), splat(0.0), splat(0.0)
        intact = np.uint8(byte_of(whole) & now)
        if intact != 0:
            bent = load_of(u, U(2), j) - load_of(u, U(2), i) + began_with(began, q, U(2))
            pull, side, moment = bond(limits, k, q, stretch, shear, bent)
            torn, cut = breaks(limits, k, q, kind, factors_of(limits.factor, c), pull, side, moment)
            broken = np.uint8((byte_of(torn) | byte_of(cut)) & intact)
            if broken != 0:
                held = np.uint8(broken & ~byte_of(where_equal(contacts.kept, c, _MAY_BREAK)))
                note_some(contacts.kept, c, np.uint8(0), ALL, held)  # REACHED
                broken = np.uint8(broken & ~held)
                for each in range(LANES):
                    if broken & np.uint8(1 << each):
                        breaking[0] += 1
                        breaking[breaking[0]] = nth(c, U(each))
                now, intact = np.uint8(now & ~broken), np.uint8(intact & ~broken)
            pull, side, moment = choose(whole, pull, 0.0), choose(whole, side, 0.0), choose(whole, moment, 0.0)
        overlap = (k[q, P.touch] - k[q, P.rest]) - stretch
        if has_contact:
            N, S = _contact(law, at, overlap, shear, opening, sliding, step, now, contacts, limits, taken)
            pull -= N
            side += S
            if rolls(limits):
                loose = np.uint8(now & ~intact)
                if loose != 0:
                    moment += roll_eight(limits, law, at, N, step, loose, v, contacts, taken)
        if follows:
            gone = np.uint8(byte_of(at_most(overlap, 0.0)) & ~intact & now)
            if gone != 0:  # as if the pair was met anew when it closes, see contacts.push_pair
                shear = choose(bits(gone), 0.0, shear)
                store_some(contacts.slip, c, splat(0.0), gone)
            store_some(contacts.shear, c, shear, now)
        if contacts.viscosity.shape[1] > 0:
            dashed = now if contacts.damps_bonds else np.uint8(now & ~intact)
            if dashed != 0:
                push, rub = _resist(law, at, overlap, opening, sliding, step, dashed, contacts, limits, taken)
                pull -= choose(bits(dashed), push, 0.0)
                side += choose(bits(dashed), rub, 0.0)
        force = contacts.force
        store_some_of(force, U(0), c, nx * pull - ny * side, now)
        store_some_of(force, U(1), c, ny * pull + nx * side, now)
        store_some_of(force, U(2), c, arm_i * side + moment, now)
        store_some_of(force, U(3), c, arm_j * side - moment, now)


@njit(**FAST, forceinline=True)  # called, it would call the functions above in turn: twice the time
def _push_blocks(pairs, first, last, u, v, step, number, contacts, limits, taken, breaking, lost):
    """The pairs in blocks first to last − 1; lost (5,) gets what they take."""
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
            k = pairs.constants
            law = k, pairs.began, row, U(pairs.contact_type[row]), acts(limits, k, row)
            way = pairs.way[row, U(0)], pairs.way[row, U(1)]
            push_eight(law, at, exists, way, u, v, step, contacts, limits, taken, breaking)
            if breaking[0] != 0:
                push_each(breaking[1 : 1 + breaking[0]], u, v, step, number, contacts, limits, lost)
                breaking[0] = 0
    end_sums(taken, lost)


@in_chunks
@njit(**MAKES)
def _push_rows(begin, end, u, v, step, number, pairs, contacts, limits, lost):
    n = pairs.exists.size
    taken, breaking = np.empty(TAKEN), np.zeros(1 + LANES, np.uint32)
    for chunk in range(begin, end):
        first, last = chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS
        _push_blocks(pairs, first, last, u, v, step, number, contacts, limits, taken, breaking, lost[chunk])


@njit(**FAST)
def push_rows(u, v, step, number, pairs, contacts, limits, lost):
    """Forces of the pairs in rows, see single_pairs.push."""
    _push_rows(u, v, step, number, pairs, contacts, limits, lost)
    return int(column_sum(lost, 3))
