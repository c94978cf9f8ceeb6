"""Springs and bonds of a bar as methods lay them: what they carry, when they give way, and what that leaves."""

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.exact.bar import usual_shares
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Rod

EPS = np.finfo(float).eps
COUNT, STRETCH = 41, 1e-3
ROD = Rod.uniform(COUNT, spacing=0.25, section=0.5, modulus=2e9, critical_stretch=STRETCH)
WHOLE = 2e9 * 0.5 / 0.25
"""Stiffness EA/Δx of a spring, N/m."""
LIMIT = 0.25 * STRETCH
"""Elongation at which a spring breaks, m."""


def zoned(horizon: int, *zones: tuple[int, int], **words) -> Bonds:
    bonds = Bonds(ROD, horizon, **words)
    for first, last in zones:
        bonds.add_zone(first, last)
    return bonds


def stress(bonds: Bonds) -> np.ndarray:
    """Share (n − 1,) of EAε that springs and bonds carry across each plane under uniform strain, bond by bond."""
    carried = bonds.spring * 0.25
    for row, first in zip(*np.nonzero(bonds.bond), strict=True):
        carried[first : first + row + 1] += bonds.bond[row, first] * 0.25 * (row + 1)
    return carried / (2e9 * 0.5)


def pulled(*planes: int, elongation: float = LIMIT) -> np.ndarray:
    """Displacements (n,) m that stretch these planes alone."""
    u = np.zeros(COUNT)
    for k in planes:
        u[k + 1 :] += elongation
    return u


@pytest.mark.parametrize("horizon", [1, 3])
def test_bonds_are_those_of_the_law(horizon: int) -> None:
    rows = ROD.bond_rows(horizon)

    assert rows.shape == (horizon, COUNT)
    for p in range(1, horizon + 1):
        # c_m V² w/(pΔx) with c_m = 2E/(A m²Δx²): 2w/(m²p) of a spring, half of that at each end
        w = 0.5 if p == horizon else 1.0
        stiffness = WHOLE * 2.0 * w / (horizon**2 * p)
        halves = np.ones(COUNT - p)
        halves[[0, -1]] = 0.5
        np.testing.assert_allclose(rows[p - 1, : COUNT - p], stiffness * halves, rtol=8 * EPS)
        assert not rows[p - 1, COUNT - p :].any()


@pytest.mark.parametrize("horizon", [1, 4])
def test_another_micromodulus_leaves_youngs_modulus(horizon: int) -> None:
    influence = 1.0 - np.arange(1, horizon + 1) / (horizon + 1.0)  # of a cone
    bonds = zoned(horizon, (0, COUNT), complement=False, influence=influence)

    np.testing.assert_allclose(stress(bonds)[horizon:-horizon], 1.0, rtol=32 * EPS)
    usual = ROD.bond_rows(horizon)[:, 20]
    np.testing.assert_allclose(bonds.bond[:, 20] / usual, influence * bonds.bond[0, 20] / usual[0] / influence[0])


def test_bonds_without_a_stiffness_are_none() -> None:
    cone = zoned(4, (0, COUNT), complement=False, influence=np.array([0.75, 0.5, 0.25, 0.0]))
    whole = zoned(3, (0, COUNT), complement=False)
    for bonds in (cone, whole):  # cut between nodes 19 and 20
        for row in range(3):
            crossing = slice(20 - row - 1, 20)
            bonds.bond[row, crossing], bonds.bond_broken[row, crossing] = 0.0, 5

    # half of the family beside a cut is on its other side, whatever the stiffness of its bonds; of the cone's, bonds of
    # four spacings are none, and of the other those of three reach to the horizon, where they count half
    assert cone.damage()[20] == pytest.approx(0.5, rel=8 * EPS)
    assert whole.damage()[20] == pytest.approx(0.5, rel=8 * EPS)
    for influence in ([0.0], [1.0, -0.1]):
        with pytest.raises(CaseError, match=r"method: gives no bond a stiffness above 0"):
            ROD.bond_rows(len(influence), np.array(influence))


@pytest.mark.parametrize("horizon", [3])
def test_shares_of_the_stress_are_those_of_the_middle(horizon: int) -> None:
    everywhere, at_the_end = zoned(horizon, (0, COUNT)), zoned(horizon, (0, horizon + 3))

    np.testing.assert_allclose(everywhere.shares(ROD.ranges[0]), usual_shares(horizon), rtol=32 * EPS)
    assert sum(everywhere.shares(ROD.ranges[0])) == pytest.approx(1.0, rel=32 * EPS)
    assert at_the_end.shares(ROD.ranges[0]) == Bonds(ROD, 0).shares(ROD.ranges[0]) == (1.0,)


def test_without_a_horizon_there_are_springs_alone_that_ask_at_their_share_of_the_critical_stretch() -> None:
    bonds = Bonds(ROD, 0, trigger_ratio=0.8)
    assert bonds.bond.shape == (0, COUNT)
    assert np.array_equal(bonds.spring, np.full(40, WHOLE))
    assert bonds.triggers.all()
    assert bonds.alive == 40
    nearly, reached = pulled(7, elongation=0.8 * LIMIT * (1 - 1e-9)), pulled(7, 30, elongation=0.8 * LIMIT)
    assert bonds.triggered(nearly).tolist() == []
    assert bonds.triggered(reached).tolist() == [7, 30]
    assert bonds.triggered(-reached).tolist() == []
    bonds.stop_triggering()
    assert bonds.triggered(reached).size == 0
    assert np.array_equal(bonds.spring_limit, np.full(40, LIMIT))
    # the kernel has to look at each of them: no node is plain any more
    plain, mixed = ranges(bonds, supported=[])
    assert plain.size == 0
    assert mixed.tolist() == [[0, COUNT, 1]]


ZONES = [[(10, 20), (25, 35)], [(0, 20)], [(0, 41)], [(18, 20)], [(15, 32), (10, 20)]]


@pytest.mark.parametrize("zones", ZONES, ids=str)
@pytest.mark.parametrize("horizon", [1, 3, 5])
def test_springs_carry_what_bonds_leave(horizon: int, zones: list[tuple[int, int]]) -> None:
    bonds = zoned(horizon, *zones)

    # 2m terms of at most 1
    np.testing.assert_allclose(stress(bonds), 1.0, atol=4 * horizon * EPS)
    # deep in a zone bonds carry it all, and no spring is left that rounding has made; outside springs do
    outside = np.ones(40, dtype=bool)
    for first, last in bonds.zones:
        outside[first : last - 1] = False
        assert not bonds.spring[first + horizon : last - horizon - 1].any()
    assert np.all(bonds.spring[outside] == WHOLE)
    assert bonds.spring.min() >= 0.0
    # bonds join the nodes of a zone alone
    inside = {(i, p) for a, b in bonds.zones for p in range(1, horizon + 1) for i in range(a, b - p)}
    assert {(i, row + 1) for row, i in zip(*np.nonzero(bonds.bond), strict=True)} == inside
    assert np.array_equal(bonds.laid, bonds.bond > 0.0)
    assert bonds.alive == len(inside) + np.count_nonzero(bonds.spring)


@pytest.mark.parametrize("horizon", [2, 5])
def test_without_complement_a_plane_has_springs_or_bonds(horizon: int) -> None:
    bonds = zoned(horizon, (10, 30), complement=False)
    spanned = stress(bonds) - bonds.spring / WHOLE > 0.0

    assert np.array_equal(bonds.spring == 0.0, spanned)
    assert np.flatnonzero(spanned).tolist() == list(range(10, 29))
    assert stress(bonds).min() < 0.9


@pytest.mark.parametrize(
    ("asked", "zones"),
    [
        ([(30, 60)], [(30, 41)]),
        ([(3, 12)], [(0, 12)]),  # three nodes would be left, less than a family
        ([(4, 12)], [(4, 12)]),
        ([(10, 20), (21, 30)], [(10, 20), (21, 30)]),
        ([(20, 30), (5, 9), (8, 21)], [(5, 30)]),
    ],
    ids=str,
)
def test_zones_end_with_the_bar_and_grow_together(asked: list, zones: list) -> None:
    assert zoned(3, *asked).zones == zones


def test_springs_ask_until_bonds_cover_their_plane_as_far_as_they_can() -> None:
    bonds = zoned(3, (10, 30), trigger_ratio=0.5)
    # bonds of three across plane k need the nodes k − 2 to k + 3
    covered = np.zeros(40, dtype=bool)
    covered[12:27] = True

    assert np.array_equal(bonds.triggers, ~covered)
    assert np.array_equal(bonds.spring_limit, np.where(covered, LIMIT, 0.5 * LIMIT))
    # all over, no spring is left to a method: at soft ends they break as bonds do
    everywhere = zoned(3, (0, COUNT), trigger_ratio=0.5)
    assert not everywhere.triggers.any()
    assert np.flatnonzero(everywhere.spring).tolist() == [0, 1, 2, 37, 38, 39]
    assert everywhere.triggered(pulled(0)).size == 0


def broken_at(bonds: Bonds, plane: int, step: int) -> Bonds:
    """The bonds with all that cross a plane broken in a step."""
    if bonds.spring[plane] > 0.0:
        bonds.spring[plane] = 0.0
        bonds.spring_broken[plane] = step
    for row in range(bonds.horizon):
        for i in range(max(0, plane - row), min(plane, COUNT - 2 - row) + 1):
            if bonds.bond[row, i] > 0.0:
                bonds.bond[row, i] = 0.0
                bonds.bond_broken[row, i] = step
    return bonds


def test_what_is_broken_stays_broken_when_a_zone_grows() -> None:
    bonds = broken_at(zoned(3, (10, 30)), 20, step=5)
    bonds.add_zone(5, 35)

    carried = stress(bonds)
    assert carried[20] == 0.0
    assert bonds.bond_broken[2, 18] == 5
    everywhere = zoned(3, (0, COUNT))
    everywhere.spring[0], everywhere.spring_broken[0] = 0.0, 3
    everywhere.add_zone(0, COUNT)
    assert everywhere.spring[0] == 0.0 < everywhere.spring[1]
    # bonds of up to three across that plane are missing on two planes on each side of it, too
    np.testing.assert_allclose(np.delete(carried, range(18, 23)), 1.0, atol=12 * EPS)
    assert carried[18:23].max() < 0.99


def lost_beside(horizon: int, away: int) -> float:
    """Share of its family that an interior node loses when all beyond `away` nodes on one side breaks off."""
    weights = np.array((horizon - 1) * [1.0] + [0.5])
    return float(weights[away:].sum() / (2.0 * weights.sum()))


@pytest.mark.parametrize(("horizon", "zones"), [(1, [(10, 31)]), (3, [(0, COUNT)]), (3, [(10, 31)]), (5, [])], ids=str)
def test_damage_beside_a_crack_is_the_same_whatever_was_there(horizon: int, zones: list[tuple[int, int]]) -> None:
    bonds = broken_at(zoned(horizon, *zones), 20, step=4)
    damage = np.zeros(COUNT)
    reach = horizon if zones else 1
    for away in range(reach):
        damage[[20 - away, 21 + away]] = lost_beside(horizon, away)

    # with three spacings the node beside it loses 2.5 of 5: a half. 0.3 is reached by the next, 1.5 of 5
    np.testing.assert_allclose(bonds.damage(), damage, atol=4 * EPS)
    assert not zoned(horizon, *zones).damage().any()


def test_damage_of_finite_differences() -> None:
    bonds = broken_at(broken_at(broken_at(Bonds(ROD, 0), 20, step=4), 0, step=6), 1, step=7)
    damage = bonds.damage()

    # the first node has lost all it had, the next both the half volume there and the whole one
    assert damage[[0, 1, 2, 3, 20, 21]].tolist() == pytest.approx([1.0, 1.0, 0.5, 0.0, 0.5, 0.5], abs=4 * EPS)
    assert bonds.damage(6)[[0, 1, 2]].tolist() == pytest.approx([1.0, 1.0 / 3.0, 0.0], abs=4 * EPS)


def ranges(bonds: Bonds, supported: list[int]) -> tuple[np.ndarray, np.ndarray]:
    arrays = bonds.arrays(np.array(supported, dtype=np.int64), 1.0)
    return arrays.plain, arrays.mixed
