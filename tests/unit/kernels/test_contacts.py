"""Pairs with a history against the same law written down plainly, and against what it must do by hand."""

from itertools import pairwise

import numpy as np
import pytest
from moving_pairs import GEOMETRIES, PAIRS, PARTICLES, STEP, UNBREAKABLE, motion, pushed, two
from plain_kernels import PlainPairs, alone, one_pair, random_pairs

from dembound.kernels.contact_measures import strain_energy
from dembound.kernels.contacts import (
    BONDED,
    INTACT,
    KEPT,
    MAY_BREAK,
    NONE,
    REACHED,
    REFERENCE,
    SHEAR,
    TENSION,
    UPDATED,
    start_from_displacements,
)
from dembound.laws.law import Limits, in_columns

WEAK = Limits(friction=0.5, tension=0.6, cohesion=0.6, tan_fa=0.6, geometry=UPDATED)


def close(found: np.ndarray, expected: np.ndarray) -> None:
    """Equal but for rounding: some 50 operations a step on values of size 1, not multiplied over 20 steps."""
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13)


@GEOMETRIES
def test_pairs_push_as_the_law_says_step_by_step(geometry: int) -> None:
    found = random_pairs(PARTICLES, PAIRS)
    expected = PlainPairs(found, WEAK._replace(geometry=geometry))
    slid = opened = 0
    for number, (u, v) in enumerate(motion(20)):
        still = (geometry == REFERENCE) | ((geometry == BONDED) & (found.state == INTACT))
        lost, before = pushed(found, expected.limits, u, v, number), expected.lost.copy()
        expected.push(u, v, STEP, number)

        close(found.force, expected.arrays.force)
        follows = (geometry == UPDATED) | ((geometry == BONDED) & (found.state != INTACT))  # others have it from u
        close(np.where(follows, found.shear, 0.0), np.where(follows, expected.arrays.shear, 0.0))
        close(found.slip, expected.arrays.slip)
        assert np.array_equal(found.state, expected.arrays.state)
        assert np.array_equal(found.cracked, expected.arrays.cracked)
        close(lost, expected.lost - before)
        # forces are opposite by the way they are listed; the couple of −F on j about i is balanced by the moments
        apart = (u[:2, found.second] - u[:2, found.first]).T
        x, y = (found.constants[:, :2] + np.where(still[:, None], 0.0, apart)).T
        close(found.force[2] + found.force[3] - (x * found.force[1] - y * found.force[0]), 0.0)
        slid += np.count_nonzero((found.slip != 0.0) & found.force[:2].any(axis=0))
        opened += np.count_nonzero((found.state != INTACT) & ~found.force[:2].any(axis=0))
    # all of it was to be seen: bonds that hold and break either way, contacts that slide, others that are open
    assert set(found.state) == {NONE, INTACT, TENSION, SHEAR}
    assert slid > 0
    assert opened > 0


@GEOMETRIES
def test_bonds_that_are_kept_never_break_and_say_that_they_would_have(geometry: int) -> None:
    weak, broken = WEAK._replace(geometry=geometry), random_pairs(PARTICLES, PAIRS)
    held, endless = random_pairs(PARTICLES, PAIRS), random_pairs(PARTICLES, PAIRS)
    kept = np.arange(PAIRS) % 2 == 0
    held.kept[kept] = KEPT
    for number, (u, v) in enumerate(motion(20)):
        for pairs, limits in ((broken, weak), (held, weak), (endless, UNBREAKABLE._replace(geometry=geometry))):
            pushed(pairs, limits, u, v, number)
        # as if they had no limit; the others as if none were kept
        assert np.array_equal(held.force, np.where(kept, endless.force, broken.force))
        assert np.array_equal(held.cracked, np.where(kept, -1, broken.cracked))
    would_have = kept & np.isin(broken.state, (TENSION, SHEAR))
    assert would_have.sum() >= 5
    assert np.array_equal(held.kept, np.where(would_have, REACHED, np.where(kept, KEPT, MAY_BREAK)))


@GEOMETRIES
def test_with_columns_of_limits_each_pair_has_those_of_its_type(geometry: int) -> None:
    columns = np.random.default_rng(4).uniform(0.2, 1.2, (PAIRS, 4))
    found = random_pairs(PARTICLES, PAIRS)
    each = [alone(found, c) for c in range(PAIRS)]
    for number, (u, v) in enumerate(motion(20)):
        pushed(found, in_columns(columns, geometry), u, v, number)
        for c, pair in enumerate(each):
            pushed(pair, Limits(*columns[c].tolist(), geometry), u, v, number)

    for name in ("force", "slip", "state", "cracked"):
        assert np.array_equal(getattr(found, name), np.concatenate([getattr(pair, name) for pair in each], axis=-1))
    assert len(set(found.cracked)) > 5


@pytest.mark.parametrize("size", [1e-12, 1e-9, 1e-3])
def test_tiny_overlaps_of_large_distances_push_to_the_last_digit(size: float) -> None:
    # a pair 0.5 m apart along (0.6, 0.8), far from where it stood; |d| of that is exact, and so is the touch
    pair = one_pair()
    pair.constants[0, :4] = [0.3, 0.4, 0.5, 0.5]
    u = np.array([[0.0, -0.6 * size], [0.0, -0.8 * size], [0.0, 0.0]])
    pushed(pair, UNBREAKABLE, u, two())
    stored, _ = strain_energy(u, pair, WEAK)

    # d − d_0 would be wrong by 1e-16/1e-12; some ten operations, each rounded
    assert np.hypot(*pair.force[:2, 0]) == pytest.approx(4.0 * size, rel=3e-15)
    assert stored == pytest.approx(0.5 * 4.0 * size**2, rel=6e-15)


def test_a_pair_that_turns_as_a_whole_keeps_its_forces() -> None:
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


def test_adopted_pairs_start_where_small_motions_brought_them() -> None:
    u = motion(1)[0][0]
    pairs = random_pairs(PARTICLES, PAIRS)
    pairs.slip[:] = 9.0
    start_from_displacements(u, pairs)

    law = PlainPairs(pairs, UNBREAKABLE._replace(geometry=REFERENCE))
    for c, (i, j) in enumerate(zip(pairs.first, pairs.second, strict=True)):
        _, _, _, stretch, shear, *_ = law.strain(c, u[:, i], u[:, j], u[:, i], u[:, j], STEP)
        closed = pairs.constants[c, 3] >= pairs.constants[c, 2] + stretch
        close(pairs.shear[c], shear)
        close(pairs.slip[c], 0.0 if closed else shear)
    assert 0 < np.count_nonzero(pairs.slip) < PAIRS
