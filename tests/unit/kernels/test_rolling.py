"""Contacts that resist rolling, by hand, and eight at once as one by one."""

import numpy as np
import pytest
from moving_pairs import PARTICLES, STEP, motion, pushed, two
from plain_kernels import copied, one_pair, random_pairs

from dembound.kernels.contact_measures import strain_energy
from dembound.kernels.contacts import BONDED, INTACT, LOST, NONE, UPDATED, push_each
from dembound.kernels.tables import Contacts
from dembound.laws.law import RollingLimits

ROLLS = RollingLimits(friction=0.5, tension=np.inf, cohesion=np.inf, tan_fa=0.0, rolling=0.4, geometry=UPDATED)
OVERLAP = 0.1
RADIUS = 0.25 * (2.0 + OVERLAP)  # R̄ of equal disks
STIFF, MOST = 2.0 * RADIUS**2, 0.4 * RADIUS * 4.0 * OVERLAP  # k_s R̄² and rr_fric R̄ N


def rolling(pairs: Contacts) -> Contacts:
    """Pairs with the array of what has not slid."""
    return pairs._replace(rolled=np.zeros(len(pairs.first)))


def moment(pairs: Contacts) -> float:
    """Moment of the one pair, along x, on its first disk, without that of its shear force."""
    return float(pairs.force[2, 0] - 0.5 * 2.0 * pairs.force[1, 0])


def test_the_moment_of_two_disks_grows_to_its_largest_and_what_it_takes_is_friction() -> None:
    """Both disks turn against each other, so that their surfaces do not slide."""
    pair, before = rolling(one_pair(overlap=OVERLAP)), 0.0
    taken, turns, moments = [], [0.1, 0.15, 0.5, 0.4, 0.1, 0.0], []
    for turn in turns:
        u, v = (np.array([[0.0] * 2, [0.0] * 2, [-0.5 * each, 0.5 * each]]) for each in (turn, (turn - before) / STEP))
        taken.append(pushed(pair, ROLLS, u, v)[0])
        moments.append(moment(pair))
        before = turn
    at_most = MOST / STIFF
    # the spring reaches its largest moment at 0.152; back from 0.5 it has slid by 0.348 and reaches the opposite one
    slid = 0.5 - at_most
    expected = [0.1 * STIFF, 0.15 * STIFF, MOST, (0.4 - slid) * STIFF, (0.1 - slid) * STIFF, -MOST]
    expected[4] = max(expected[4], -MOST)
    np.testing.assert_allclose(moments, expected, rtol=1e-12)
    np.testing.assert_allclose(pair.rolled[0], -at_most, rtol=1e-12)
    losses = [0.0, 0.0, 0.5 * (0.15 * STIFF + MOST) * (0.5 - at_most)]
    np.testing.assert_allclose(taken[:3], losses, rtol=1e-12, atol=1e-15)
    stored = 0.5 * 4.0 * OVERLAP**2 + 0.5 * STIFF * at_most**2
    assert strain_energy(u, pair, ROLLS)[0] == pytest.approx(stored, rel=1e-12)


def test_nothing_is_left_of_it_once_the_contact_opens_and_bonds_turn_it_off() -> None:
    pair = rolling(one_pair(overlap=OVERLAP))
    pushed(pair, ROLLS, two(turn=0.1), two(turn=0.1 / STEP))
    assert pair.rolled[0] == 0.1
    pushed(pair, ROLLS, two(x=0.2, turn=0.1), two(x=0.2 / STEP))
    assert pair.rolled[0] == 0.0
    assert not pair.force.any()
    pushed(pair, ROLLS, two(turn=0.15), two(x=-0.2 / STEP, turn=0.05 / STEP))
    assert pair.rolled[0] == 0.15 - 0.1 or abs(pair.rolled[0] - 0.05) < 1e-15

    bonded = rolling(one_pair(INTACT, OVERLAP))
    pushed(bonded, ROLLS, two(turn=0.1), two(turn=0.1 / STEP))
    assert bonded.rolled[0] == 0.0
    pushed(bonded, weak := ROLLS._replace(tension=1e-3), two(turn=0.2), two(turn=0.1 / STEP))
    assert bonded.state[0] > INTACT
    assert bonded.rolled[0] == 0.0
    pushed(bonded, weak, two(turn=0.3), two(turn=0.1 / STEP))  # from the break on
    assert abs(bonded.rolled[0] - 0.1) < 1e-15


def test_eight_at_once_are_one_by_one_and_energies_balance() -> None:
    """Work of the forces, of whole steps, is what is stored and what is taken."""
    limits = ROLLS._replace(tension=0.6, cohesion=0.6, geometry=BONDED)
    many = rolling(random_pairs(PARTICLES, 60))
    single = copied(many)
    lost = np.zeros(LOST)
    for number, (u, v) in enumerate(motion(20)):
        pushed(many, limits, u, v, number)
        push_each(np.arange(60, dtype=np.uint32), u, v, STEP, number, single, limits, lost)
        np.testing.assert_allclose(many.force, single.force, rtol=0.0, atol=1e-13)
        np.testing.assert_allclose(many.rolled, single.rolled, rtol=0.0, atol=1e-13)
    assert many.rolled[many.state != INTACT].any()
    assert not many.rolled[many.state == INTACT].any()
    assert (many.state != NONE).any()
