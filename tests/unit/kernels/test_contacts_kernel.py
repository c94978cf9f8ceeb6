"""Pairs with a history against the same law written down plainly, and against what it must do by hand."""

from itertools import pairwise

import numpy as np
import pytest

from dembound.kernels.common import CHUNKS
from dembound.kernels.contacts import (
    BONDED,
    CLOSING,
    INTACT,
    NONE,
    REFERENCE,
    SHEAR,
    TENSION,
    UPDATED,
    moved,
    note_places,
    push,
    slack,
    start_from_displacements,
    strain_energy,
    sum_forces,
)
from dembound.kernels.tables import Contacts, Limits

PARTICLES, PAIRS = 25, 60
STEP = 0.1
UNBREAKABLE = Limits(friction=0.5, tension=np.inf, cohesion=np.inf, tan_fa=0.0, geometry=UPDATED)
WEAK = Limits(friction=0.5, tension=0.6, cohesion=0.6, tan_fa=0.6, geometry=UPDATED)
GEOMETRIES = pytest.mark.parametrize("geometry", [UPDATED, BONDED, REFERENCE])


def close(found: np.ndarray, expected: np.ndarray) -> None:
    """Equal but for rounding: some 50 operations a step on values of size 1, not multiplied over 20 steps."""
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13)


def motion(steps: int, size: float = 0.3) -> list[tuple[np.ndarray, np.ndarray]]:
    """(u, v) (3, n) of a smooth random motion, v the mean velocity since the step before."""
    rng = np.random.default_rng(2)
    swing, rate, phase = rng.uniform(-size, size, (3, 3, PARTICLES))
    times = STEP * np.arange(steps + 1)
    path = [swing * np.sin(10.0 * rate * t + phase) - swing * np.sin(phase) for t in times]
    return [(after, (after - before) / STEP) for before, after in pairwise(path)]


def pushed(pairs: Contacts, limits: Limits, u: np.ndarray, v: np.ndarray, number: int = 0) -> np.ndarray:
    """One push by the kernel; what friction and cracks took."""
    lost = np.full((CHUNKS, 2), np.nan)
    push(u, v, STEP, number, pairs, limits, lost)
    return lost.sum(axis=0)


@GEOMETRIES
def test_pairs_push_as_the_law_says_step_by_step(random_pairs, plain, copied, geometry: int) -> None:
    found = random_pairs(PARTICLES, PAIRS)
    expected = plain(copied(found), WEAK._replace(geometry=geometry))
    slid = opened = 0
    for number, (u, v) in enumerate(motion(20)):
        lost, before = pushed(found, expected.limits, u, v, number), expected.lost.copy()
        expected.push(u, v, STEP, number)

        close(found.force, expected.arrays.force)
        follows = (geometry == UPDATED) | ((geometry == BONDED) & (found.state != INTACT))  # others have it from u
        close(np.where(follows, found.shear, 0.0), np.where(follows, expected.arrays.shear, 0.0))
        close(found.slip, expected.arrays.slip)
        assert np.array_equal(found.state, expected.arrays.state)
        assert np.array_equal(found.cracked, expected.arrays.cracked)
        close(lost, expected.lost - before)
        slid += np.count_nonzero((found.slip != 0.0) & found.force[:2].any(axis=0))
        opened += np.count_nonzero((found.state != INTACT) & ~found.force[:2].any(axis=0))
    # all of it was to be seen: bonds that hold and break either way, contacts that slide, others that are open
    assert set(found.state) == {NONE, INTACT, TENSION, SHEAR}
    assert slid > 0
    assert opened > 0


@GEOMETRIES
def test_forces_and_moments_of_a_pair_balance(random_pairs, geometry: int) -> None:
    pairs = random_pairs(PARTICLES, PAIRS)
    for u, v in motion(5):
        still = (geometry == REFERENCE) | ((geometry == BONDED) & (pairs.state == INTACT))
        pushed(pairs, WEAK._replace(geometry=geometry), u, v)
        apart = (u[:2, pairs.second] - u[:2, pairs.first]).T
        x, y = (pairs.constants[:, :2] + np.where(still[:, None], 0.0, apart)).T

        # forces are opposite by the way they are listed; the couple of −F on j about i is balanced by the moments
        close(pairs.force[2] + pairs.force[3] - (x * pairs.force[1] - y * pairs.force[0]), 0.0)


def test_particles_get_the_sum_of_their_pairs(random_pairs) -> None:
    pairs = random_pairs(PARTICLES, PAIRS)
    pairs.force[:] = np.random.default_rng(1).uniform(-1.0, 1.0, (4, PAIRS))
    total = np.full((3, PARTICLES), np.nan)
    sum_forces(pairs, total)

    expected = np.zeros((3, PARTICLES))
    for sign, ends, moment in ((1.0, pairs.first, 2), (-1.0, pairs.second, 3)):
        np.add.at(expected[0], ends, sign * pairs.force[0])
        np.add.at(expected[1], ends, sign * pairs.force[1])
        np.add.at(expected[2], ends, pairs.force[moment])
    close(total, expected)


def test_particles_before_those_of_the_pairs_are_left_alone(random_pairs, behind) -> None:
    pairs, others = random_pairs(PARTICLES, PAIRS), 4
    later = behind(random_pairs(PARTICLES, PAIRS), others)
    for number, (u, v) in enumerate(motion(5)):
        lost = pushed(pairs, WEAK, u, v, number)
        there, speed = (np.hstack([np.full((3, others), np.nan), values]) for values in (u, v))
        assert np.array_equal(pushed(later, WEAK, there, speed, number), lost)
        assert np.array_equal(later.force, pairs.force)
    total, expected = np.full((3, others + PARTICLES), 7.0), np.empty((3, PARTICLES))
    sum_forces(later, total)
    sum_forces(pairs, expected)

    assert np.all(total[:, :others] == 7.0)
    assert np.array_equal(total[:, others:], expected)


def test_places_of_broken_bonds_are_those_of_their_step(random_pairs) -> None:
    pairs, path = random_pairs(PARTICLES, PAIRS), motion(20)
    for number, (u, v) in enumerate(path):
        pushed(pairs, WEAK, u, v, number)
        note_places(u, number, pairs)

    for step, place, first, second in zip(pairs.cracked, pairs.place, pairs.first, pairs.second, strict=True):
        if step < 0:
            assert np.isnan(place).all()
        else:
            u, _ = path[step]
            assert np.array_equal(place, 0.5 * (u[:2, first] + u[:2, second]))
    assert len(np.unique(pairs.cracked)) > 3


def two(x: float = 0.0, y: float = 0.0, turn: float = 0.0) -> np.ndarray:
    """Motion (3, 2) of a pair of which the second disk moves."""
    return np.array([[0.0, x], [0.0, y], [0.0, turn]])


def test_a_contact_pushes_while_disks_overlap_and_never_pulls(one_pair) -> None:
    pair = one_pair()
    for x, force in ((-0.1, -0.4), (0.0, 0.0), (0.1, 0.0), (-0.2, -0.8)):
        pushed(pair, UNBREAKABLE, two(x), two())
        # k_n = 4; the first disk, on the left, is pushed to the left
        close(pair.force[:, 0], [force, 0.0, 0.0, 0.0])


def test_the_first_push_after_being_open_is_larger(one_pair) -> None:
    pair, was = one_pair(), 0.0
    factors = []
    # from just touching; then deeper, shallower, open, closed by as much, and over a further touch closed again
    for x in (-0.1, -0.2, -0.1, 0.05, -0.1, -0.15, 0.0, -0.1):
        pushed(pair, UNBREAKABLE, two(x), two((x - was) / STEP))
        factors.append(-pair.force[0, 0] / (4.0 * max(-x, 1e-3)))
        was = x

    # displacements of 0.1 m are rounded against a distance of 2 m
    np.testing.assert_allclose(factors, [CLOSING, 1.0, 1.0, 0.0, CLOSING, 1.0, 0.0, CLOSING], rtol=1e-14)
    assert CLOSING > 1.0


def test_only_contacts_with_a_gap_at_the_start_close_in_the_geometry_of_the_start(one_pair) -> None:
    limits = UNBREAKABLE._replace(geometry=REFERENCE)
    forces = []
    for overlap in (0.0, 0.02, -0.02):
        pair = one_pair(overlap=overlap)
        # it was 0.05 m further apart than at the start
        pushed(pair, limits, two(-0.1), two(-0.15 / STEP))
        forces.append(-pair.force[0, 0])

    # rounding as above
    np.testing.assert_allclose(forces, [4.0 * 0.1, 4.0 * 0.12, CLOSING * 4.0 * 0.08], rtol=1e-14)


@pytest.mark.parametrize("geometry", [UPDATED, BONDED])
def test_a_contact_that_closes_rubs_with_what_it_pushes_with(one_pair, geometry: int) -> None:
    pair = one_pair()
    # N = CLOSING · 4 · 0.1; k_s · 0.3 would be far beyond half of it
    pushed(pair, UNBREAKABLE._replace(geometry=geometry), two(-0.1, turn=0.3), two(-0.15 / STEP, turn=0.3 / STEP))

    close(abs(pair.force[1, 0]), 0.5 * CLOSING * 0.4)
    # the arm of the second disk is 0.95, and its surface moves against the first's
    close(pair.slip[0], pair.shear[0] + 0.5 * CLOSING * 0.4 / 2.0)


@GEOMETRIES
def test_a_push_returns_how_many_bonds_it_breaks(random_pairs, geometry: int) -> None:
    pairs, limits = random_pairs(PARTICLES, PAIRS), WEAK._replace(geometry=geometry)
    breaks = [
        push(u, v, STEP, number, pairs, limits, np.empty((CHUNKS, 2))) for number, (u, v) in enumerate(motion(20))
    ]

    assert breaks == [np.count_nonzero(pairs.cracked == number) for number in range(20)]
    assert max(breaks) > 1
    assert min(breaks) == 0


@pytest.mark.parametrize("size", [1e-12, 1e-9, 1e-3])
def test_tiny_overlaps_of_large_distances_push_to_the_last_digit(one_pair, size: float) -> None:
    # a pair 0.5 m apart along (0.6, 0.8), far from where it stood; |d| of that is exact, and so is the touch
    pair = one_pair()
    pair.constants[0, :4] = [0.3, 0.4, 0.5, 0.5]
    u = np.array([[0.0, -0.6 * size], [0.0, -0.8 * size], [0.0, 0.0]])
    pushed(pair, UNBREAKABLE, u, two())
    stored, _ = strain_energy(u, pair, UPDATED)

    # d − d_0 would be wrong by 1e-16/1e-12; some ten operations, each rounded
    assert np.hypot(*pair.force[:2, 0]) == pytest.approx(4.0 * size, rel=3e-15)
    assert stored == pytest.approx(0.5 * 4.0 * size**2, rel=6e-15)


def test_a_contact_slides_at_the_friction_force_and_rubs_off_its_work(one_pair) -> None:
    pair, rubbed = one_pair(overlap=0.1), 0.0
    # the second disk rolls on the spot: a spin of 1 rad/s moves its surface by 1 m/s past the first, downwards
    for number in range(1, 21):
        u, v = two(turn=number * STEP), two(turn=1.0)
        rubbed += pushed(pair, UNBREAKABLE, u, v)[0]

    # N = 4 · 0.1, F = 0.5 N = 0.2 reached after F/k_s = 0.1 m; the rest of 2 m slides
    close(pair.force[:, 0], [-0.4, -0.2, -0.2, -0.2])
    close(pair.slip, [-1.9])
    assert rubbed == pytest.approx(0.2 * 1.9, rel=1e-12)
    # turning back: first 0.2 m of springs, then sliding the other way
    for back, force in ((1.9, 0.0), (1.8, 0.2), (1.0, 0.2)):
        rubbed += pushed(pair, UNBREAKABLE, two(turn=back), two(turn=(back - u[2, 1]) / STEP))[0]
        u = two(turn=back)
        close(pair.force[:, 0], [-0.4, force, force, force])
    assert rubbed == pytest.approx(0.2 * (1.9 + 0.8), rel=1e-12)


def test_a_bond_breaks_in_tension_for_good(one_pair) -> None:
    pair = one_pair(INTACT)
    # σ = 3 x/2 + 0.5 θ · 1.5, which reaches 0.3 at θ = 0.2
    limits = UNBREAKABLE._replace(tension=0.3)
    pushed(pair, limits, two(0.1, turn=0.19), two())
    assert pair.state[0] == INTACT
    lost = pushed(pair, limits, two(0.1, turn=0.21), two(turn=0.02 / STEP), 7)

    assert (pair.state[0], pair.cracked[0]) == (TENSION, 7)
    assert not pair.force.any()
    # ½ k s⁻ s: stretched by 0.1 throughout, bent by 0.19 and then 0.21, and sheared by nothing before
    assert lost[1] == pytest.approx(0.5 * 3.0 * 0.1**2 + 0.5 * 0.5 * 0.19 * 0.21, rel=1e-12)
    assert pushed(pair, limits, two(), two())[1] == 0.0
    assert pair.state[0] == TENSION
    assert not pair.force.any()


@pytest.mark.parametrize(("x", "strength"), [(-0.2, 0.4 + 0.6 * 0.3), (0.0, 0.4), (0.1, 0.4 - 0.6 * 0.15)])
def test_a_bond_breaks_in_shear_where_cohesion_and_pressure_end(one_pair, x: float, strength: float) -> None:
    # σ = 3 x/2; τ = 1 · shear/2 against 0.4 − 0.6 σ
    limits = UNBREAKABLE._replace(cohesion=0.4, tan_fa=0.6, geometry=REFERENCE)
    states = []
    for share in (0.999, 1.001):
        pair = one_pair(INTACT)
        pushed(pair, limits, two(x, 2.0 * strength * share), two())
        states.append(pair.state[0])

    assert states == [INTACT, SHEAR]


def test_what_is_broken_still_rubs(one_pair) -> None:
    pair = one_pair(SHEAR, overlap=0.1)
    pushed(pair, UNBREAKABLE, two(turn=0.05), two(turn=0.05 / STEP))

    # k_n 0.1, k_s 0.05 along −y on the second surface, and no bond
    close(pair.force[:, 0], [-0.4, -0.1, -0.1, -0.1])


def test_a_pair_that_turns_as_a_whole_keeps_its_forces(one_pair) -> None:
    pair, turns, steps = one_pair(INTACT, overlap=0.1), 0.5 * np.pi, 200
    angles = turns * np.arange(steps + 1) / steps
    path = np.array([[[0.0, 2.0 * np.cos(a) - 2.0], [0.0, 2.0 * np.sin(a)], [a, a]] for a in angles])
    for before, after in pairwise(path):
        pushed(pair, UNBREAKABLE, after, (after - before) / STEP)

    # the chord seen along the new tangent is 2 sin δ, the arms take 2 δ: a step leaves 2 δ³/6 of false shear, which
    # k_s + k̄_s A = 3 N/m answer
    false = 3.0 * steps * 2.0 * (turns / steps) ** 3 / 6.0
    np.testing.assert_allclose(pair.force[:2, 0], [0.0, -0.4], rtol=0.0, atol=1.01 * false)
    assert abs(pair.force[2, 0]) < 1.01 * false


@pytest.mark.parametrize("geometry", [UPDATED, BONDED])
def test_small_motions_meet_the_same_forces_in_every_geometry(random_pairs, geometry: int) -> None:
    size = 1e-6
    u = size * np.random.default_rng(4).uniform(-1.0, 1.0, (3, PARTICLES))
    pairs, still = random_pairs(PARTICLES, PAIRS), random_pairs(PARTICLES, PAIRS)
    pushed(pairs, UNBREAKABLE._replace(geometry=geometry), u, u / STEP)
    pushed(still, UNBREAKABLE._replace(geometry=REFERENCE), u, u / STEP)

    # normals turn by 4e-6 at most, and push with k_n · 0.05 ≤ 0.1, arms and distances likewise; the rest is of size²
    np.testing.assert_allclose(pairs.force, still.force, rtol=0.0, atol=1e-6)
    assert np.abs(still.force[:2]).max() > 0.02


def test_adopted_pairs_start_where_small_motions_brought_them(random_pairs, plain) -> None:
    u = motion(1)[0][0]
    pairs = random_pairs(PARTICLES, PAIRS)
    pairs.slip[:] = 9.0
    start_from_displacements(u, pairs)

    law = plain(pairs, UNBREAKABLE._replace(geometry=REFERENCE))
    for c, (i, j) in enumerate(zip(pairs.first, pairs.second, strict=True)):
        _, _, _, stretch, shear, *_ = law.strain(c, u[:, i], u[:, j], u[:, i], u[:, j], STEP)
        closed = pairs.constants[c, 3] >= pairs.constants[c, 2] + stretch
        close(pairs.shear[c], shear)
        close(pairs.slip[c], 0.0 if closed else shear)
    assert 0 < np.count_nonzero(pairs.slip) < PAIRS


def test_the_largest_motion_since_the_list_was_made() -> None:
    u, origin = np.zeros((3, 500)), np.full((2, 500), 1.0)
    u[:2] = origin
    u[:2, 321] += [3.0, -4.0]
    u[2] = 100.0  # turning takes nobody nearer

    assert moved(u, 0, origin) == 5.0
    # of the particles from 320 or 322 on
    assert moved(u, 320, origin[:, 320:]) == 5.0
    assert moved(u, 322, origin[:, 322:]) == 0.0


def outside(u: np.ndarray, pairs: Contacts, limits: Limits, law) -> np.ndarray:
    """By how much each pair (b,) breaks the conditions of the elastic law, written out one by one; 0: by none."""
    excess = np.zeros(len(pairs.first))
    for c, (i, j) in enumerate(zip(pairs.first, pairs.second, strict=True)):
        _, _, _, stretch, shear, *_ = law.strain(c, u[:, i], u[:, j], u[:, i], u[:, j], STEP)
        _, _, rest, touch, _, k_n, k_s, b_n, b_s, b_m, per_area, bend = pairs.constants[c]
        overlap = touch - rest - stretch
        conditions = [-overlap, k_s * abs(shear) - limits.friction * k_n * overlap] if touch >= rest else [overlap]
        if pairs.state[c] == INTACT:
            stress, turn = b_n * stretch * per_area, u[2, j] - u[2, i]
            conditions += [
                stress + abs(b_m * turn) * bend - limits.tension,
                b_s * abs(shear) * per_area - (limits.cohesion - stress * limits.tan_fa),
            ]
        excess[c] = max(0.0, *conditions)
    return excess


LIMITS = Limits(friction=0.8, tension=0.9, cohesion=0.8, tan_fa=0.5, geometry=REFERENCE)


def test_a_motion_smaller_than_the_slack_takes_no_pair_out_of_the_elastic_law(random_pairs, plain) -> None:
    rng = np.random.default_rng(8)
    pairs = random_pairs(PARTICLES, PAIRS, gap=0.2)
    law = plain(pairs, LIMITS)
    arm = 1.1  # half of the longest distance and the largest difference of radii
    tried = 0
    for _ in range(60):
        u = 0.025 * rng.uniform(-1.0, 1.0, (3, PARTICLES))
        room = slack(u, pairs, LIMITS)
        if room <= 0.0:
            continue
        tried += 1
        way = rng.choice([-1.0, 1.0], (3, PARTICLES)) * rng.uniform(0.5, 1.0, (3, PARTICLES))
        surface = np.hypot(way[0], way[1]) + arm * np.abs(way[2])
        # every surface moves by half of it at most, so no two move by more against each other; 1e-14 for rounding
        assert not (outside(u + 0.5 * room * way / surface.max(), pairs, LIMITS, law) > 1e-14).any()
    assert tried > 20


def test_slack_is_negative_just_where_a_pair_is_outside(random_pairs, plain) -> None:
    rng = np.random.default_rng(9)
    pairs = random_pairs(PARTICLES, PAIRS, gap=0.2)
    law = plain(pairs, LIMITS)
    found = []
    for size in np.repeat([0.03, 0.08, 0.2], 20):
        u = size * rng.uniform(-1.0, 1.0, (3, PARTICLES))
        found.append(slack(u, pairs, LIMITS) < 0.0)
        assert found[-1] == (outside(u, pairs, LIMITS, law) > 0.0).any()
    assert 10 < sum(found) < 50


@pytest.mark.parametrize(
    ("motion", "room"),
    [
        (two(), 0.2 / 4.0),  # friction: 0.5·4·0.1 N left, k_s + μ k_n = 4 N/m
        (two(-0.05), 0.3 / 4.0),
        (two(0.099), 0.001 * 0.5),
        (two(0.11), -0.01),
    ],
)
def test_the_slack_of_one_contact_by_hand(one_pair, motion: np.ndarray, room: float) -> None:
    limits = UNBREAKABLE._replace(geometry=BONDED)
    assert slack(motion, one_pair(overlap=0.1), limits) == pytest.approx(room, rel=1e-12)


def test_a_pair_that_turns_leaves_small_displacements(one_pair) -> None:
    pair = one_pair(overlap=10.0)
    limits = UNBREAKABLE._replace(friction=100.0)
    distance = pair.constants[0, 2]
    assert slack(two(0.0, 0.004 * distance), pair, limits) == pytest.approx(0.006 * distance, rel=1e-9)
    assert slack(two(0.0, -0.011 * distance), pair, limits) < 0.0
    assert slack(two(0.0, -0.011 * distance), pair, limits._replace(geometry=BONDED)) > 0.0


@pytest.mark.parametrize(
    ("motion", "changes", "room"),
    [
        # σ = 3 x/2 + 0.75 |θ|, whose two parts change by 1.5 per metre of relative motion at most
        (two(0.04, turn=-0.08), {"tension": 0.3}, (0.3 - 0.06 - 0.06) / 3.0),
        (two(0.2, turn=0.2), {"tension": 0.3}, (0.3 - 0.3 - 0.15) / 3.0),
        # τ = y/2 against 0.4 − 0.6 · 3 x/2: 0.5 and 0.6 · 1.5 per metre
        (two(-0.1, -0.3), {"cohesion": 0.4, "tan_fa": 0.6}, (0.4 + 0.09 - 0.15) / 1.4),
        (two(0.3, 0.3), {"cohesion": 0.4, "tan_fa": 0.6}, (0.4 - 0.27 - 0.15) / 1.4),
    ],
)
def test_the_slack_of_one_bond_by_hand(one_pair, motion: np.ndarray, changes: dict, room: float) -> None:
    # the contact is pressed together so much that it is far from opening and sliding
    limits = UNBREAKABLE._replace(friction=100.0, geometry=BONDED, **changes)
    assert slack(motion, one_pair(INTACT, overlap=1.0), limits) == pytest.approx(room, rel=1e-12)


def test_without_pairs_there_is_all_the_slack_there_is(one_pair) -> None:
    pair = one_pair()
    nobody = Contacts(pair.begin, *(column[:0] for column in pair[1:]))
    assert slack(two(), nobody, UNBREAKABLE) == np.inf


@GEOMETRIES
def test_stored_energy_is_that_of_all_springs(random_pairs, plain, geometry: int) -> None:
    limits = UNBREAKABLE._replace(geometry=geometry)
    pairs = random_pairs(PARTICLES, PAIRS)
    for u, v in motion(5):
        pushed(pairs, limits, u, v)
    law, contact, bond = plain(pairs, limits), 0.0, 0.0
    for c, (i, j) in enumerate(zip(pairs.first, pairs.second, strict=True)):
        _, _, _, stretch, shear, *_ = law.strain(c, u[:, i], u[:, j], v[:, i], v[:, j], 0.0)
        _, _, rest, touch, _, k_n, k_s, b_n, b_s, b_m, _, _ = pairs.constants[c]
        overlap = touch - rest - stretch
        rub = k_s * (shear - (0.0 if geometry == REFERENCE else pairs.slip[c]))
        if overlap > 0.0 or (geometry == REFERENCE and touch >= rest):
            contact += 0.5 * (k_n * overlap**2 + rub**2 / k_s)
        if pairs.state[c] == INTACT:
            bond += 0.5 * (b_n * stretch**2 + b_s * shear**2 + b_m * (u[2, j] - u[2, i]) ** 2)

    # 60 terms of size 0.1
    assert strain_energy(u, pairs, geometry) == pytest.approx((contact, bond), rel=1e-13)


def test_forces_are_the_slope_of_the_stored_energy(random_pairs) -> None:
    pairs = random_pairs(PARTICLES, PAIRS)
    closed = pairs._replace(constants=pairs.constants.copy())
    closed.constants[:, 3] = closed.constants[:, 2] + 0.05
    limits, (u, v) = UNBREAKABLE._replace(geometry=REFERENCE), motion(1)[0]
    pushed(closed, limits, u, v)
    force = np.empty_like(u)
    sum_forces(closed, force)
    way = np.random.default_rng(6).uniform(-1.0, 1.0, u.shape)
    ahead, behind = (sum(strain_energy(u + side * way, closed, REFERENCE)) for side in (0.5, -0.5))

    # quadratic, so the difference quotient is exact but for rounding of energies of size 100
    assert ahead - behind == pytest.approx(-np.sum(force * way), abs=1e-12)
