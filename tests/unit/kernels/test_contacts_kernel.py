"""Pairs with a history against the same law written down plainly, and against what it must do by hand."""

from itertools import pairwise

import numpy as np
import pytest
from moving_pairs import GEOMETRIES, PAIRS, PARTICLES, STEP, UNBREAKABLE, motion, pushed, two

from dembound.kernels.common import CHUNKS
from dembound.kernels.contact_measures import strain_energy
from dembound.kernels.contacts import (
    BONDED,
    CLOSING,
    INTACT,
    NONE,
    REFERENCE,
    SHEAR,
    TENSION,
    UPDATED,
    note_places,
    push,
    start_from_displacements,
    sum_forces,
)
from dembound.kernels.tables import Limits

WEAK = Limits(friction=0.5, tension=0.6, cohesion=0.6, tan_fa=0.6, geometry=UPDATED)


def close(found: np.ndarray, expected: np.ndarray) -> None:
    """Equal but for rounding: some 50 operations a step on values of size 1, not multiplied over 20 steps."""
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13)


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
        push(u, v, STEP, number, pairs, limits, np.empty((CHUNKS, 4)), 0) for number, (u, v) in enumerate(motion(20))
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
def test_smaffordable_motions_meet_the_same_forces_in_every_geometry(random_pairs, geometry: int) -> None:
    size = 1e-6
    u = size * np.random.default_rng(4).uniform(-1.0, 1.0, (3, PARTICLES))
    pairs, still = random_pairs(PARTICLES, PAIRS), random_pairs(PARTICLES, PAIRS)
    pushed(pairs, UNBREAKABLE._replace(geometry=geometry), u, u / STEP)
    pushed(still, UNBREAKABLE._replace(geometry=REFERENCE), u, u / STEP)

    # normals turn by 4e-6 at most, and push with k_n · 0.05 ≤ 0.1, arms and distances likewise; the rest is of size²
    np.testing.assert_allclose(pairs.force, still.force, rtol=0.0, atol=1e-6)
    assert np.abs(still.force[:2]).max() > 0.02


def test_adopted_pairs_start_where_smaffordable_motions_brought_them(random_pairs, plain) -> None:
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
