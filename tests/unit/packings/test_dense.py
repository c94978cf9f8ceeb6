"""Random packings: stress, balance, contacts, sizes, determinism."""

from dataclasses import fields, replace

import numpy as np
import pytest

from dembound.errors import PackingError
from dembound.kernels import pack
from dembound.packings import dense
from dembound.packings.bed import Bed
from dembound.packings.brick import listed, strip_order, wrap
from dembound.packings.dense import pack_dense


def pair_forces(brick):
    """Force on j (b, 2) over E_c, from the definition: overlap along the line of centres."""
    lengths = np.linalg.norm(brick.vectors, axis=1)
    overlaps = brick.radii[brick.pairs[:, 0]] + brick.radii[brick.pairs[:, 1]] - lengths
    return np.where(overlaps > 0, overlaps / lengths, 0.0)[:, None] * brick.vectors


def test_same_seed_same_bits_another_seed_another_brick(random_brick, recipe):
    again = pack_dense(recipe)
    for field in fields(again):
        assert np.array_equal(getattr(again, field.name), getattr(random_brick, field.name)), field.name
    other = pack_dense(replace(recipe, seed=recipe.seed + 1))
    assert not np.array_equal(other.positions[:50], random_brick.positions[:50])


def test_the_brick_has_the_stress_asked_for_and_a_state_that_is_reported(dense_brick, recipe):
    forces = pair_forces(dense_brick)
    area = np.prod(dense_brick.size)
    stress = -np.einsum("ba,bc->ac", forces, dense_brick.vectors) / area
    # 5e-4 is the tolerance of the pressure search
    assert -0.5 * np.trace(stress) == pytest.approx(recipe.pressure, rel=5e-4)
    assert dense_brick.stress == pytest.approx([stress[0, 0], stress[1, 1], stress[0, 1]], rel=1e-9)
    assert dense_brick.solid_fraction == pytest.approx((np.pi * dense_brick.radii**2).sum() / area)


def test_forces_balance_in_the_box_without_loose_disks(dense_brick):
    forces = pair_forces(dense_brick)
    sums = np.zeros_like(dense_brick.positions)
    np.subtract.at(sums, dense_brick.pairs[:, 0], forces)
    np.add.at(sums, dense_brick.pairs[:, 1], forces)
    sizes = np.linalg.norm(forces, axis=1)
    free = ~dense_brick.edge_rows.any(axis=1)
    ratio = np.linalg.norm(sums[free], axis=1).mean() / sizes[sizes > 0].mean()
    # round-off: one coordinate of 10 m is known to 1e-15 m, the mean overlap is 3e-3 m, so 1e-12 at most
    assert ratio == pytest.approx(dense_brick.residual_ratio, abs=1e-11)
    assert ratio <= 1e-9
    assert np.bincount(dense_brick.pairs.ravel(), minlength=len(free))[free].min() >= 3
    assert np.all((dense_brick.positions >= 0) & (dense_brick.positions < dense_brick.size))


def test_contacts_are_those_of_brute_force_over_all_images(dense_brick, recipe):
    found = {(*pair, *image) for pair, image in zip(dense_brick.pairs, dense_brick.images, strict=True)}
    expected = set()
    for ix in (-1, 0, 1):
        for iy in (-1, 0, 1):
            moved = dense_brick.positions + np.array([ix, iy]) * dense_brick.size
            apart = np.linalg.norm(moved[None] - dense_brick.positions[:, None], axis=2)
            touching = apart <= dense_brick.radii[:, None] + dense_brick.radii + 1e-9 * recipe.radius
            expected |= {(i, j, ix, iy) for i, j in np.argwhere(touching) if i < j}
    assert len(found) == len(dense_brick.pairs)
    assert found == expected


def test_bond_gap_lists_near_contacts_too(random_brick, recipe):
    gap = 0.05 * recipe.radius
    wide = pack_dense(replace(recipe, bond_gap=gap))
    assert np.array_equal(wide.positions, random_brick.positions)
    assert wide.gaps.max() <= gap + 1e-9 * recipe.radius
    assert np.count_nonzero(wide.gaps <= 1e-9 * recipe.radius) == len(random_brick.pairs)
    assert len(wide.pairs) > len(random_brick.pairs)


@pytest.mark.parametrize("ratio", [1.0, 3.0])
def test_radii_are_uniform_with_the_mean_asked_for(recipe, ratio):
    brick = pack_dense(replace(recipe, radius_ratio=ratio, size=(10.0, 10.0)))
    assert brick.radii.mean() == pytest.approx(recipe.radius, rel=2e-3)
    assert brick.radii.max() <= ratio * brick.radii.min() * (1 + 1e-12)
    spread = np.linspace(brick.radii.min(), brick.radii.max(), len(brick.radii))
    # grown disks move up in the ranks: at most the share of loose disks, 5 % at ratio 3
    assert np.abs(np.sort(brick.radii) - spread).max() <= 0.05 * np.ptp(brick.radii) + 1e-12


def test_rows_are_straight_equal_and_touching(edged_brick, recipe):
    for row, (across, along) in enumerate([(0, 1), (1, 0)]):
        member = edged_brick.edge_rows[:, row]
        assert np.all(edged_brick.positions[member, across] == 0.0)
        inner = member & ~edged_brick.edge_rows.all(axis=1)
        assert np.ptp(edged_brick.radii[inner]) == 0.0
        assert 2 * edged_brick.radii[member].sum() == pytest.approx(edged_brick.size[along], rel=1e-14)
        within = member[edged_brick.pairs].all(axis=1)
        assert np.count_nonzero(within) == np.count_nonzero(member)  # a ring through the periodic face
        assert np.abs(edged_brick.gaps[within]).max() < 1e-13  # round-off of 10 m
    assert np.count_nonzero(edged_brick.edge_rows.all(axis=1)) == 1
    core = edged_brick.radii[~edged_brick.edge_rows.any(axis=1)]  # which is scaled alone
    assert core.mean() == pytest.approx(recipe.radius, rel=2e-3)


def test_looser_packings_have_hardly_more_contacts_than_they_need(recipe):
    """Frictionless disks at rest need four contacts each, on average."""
    pressure = 1e-5
    brick = pack_dense(replace(recipe, pressure=pressure, radius_ratio=1.66))
    assert 4.0 <= brick.coordination < 4.25
    assert brick.residual_ratio <= 1e-9
    assert -0.5 * brick.stress[:2].sum() == pytest.approx(pressure, rel=5e-4)
    assert np.bincount(brick.pairs.ravel()).min() >= 3
    assert brick.radii.mean() == pytest.approx(recipe.radius, rel=2e-3)
    assert brick.radii.max() <= 1.66 * brick.radii.min() * (1 + 1e-12)


def test_disks_that_growing_leaves_loose_are_fitted(recipe, monkeypatch):
    """As in large bricks at low pressure, where growing by steps opens as many contacts as it closes."""
    monkeypatch.setattr(Bed, "crowd", lambda *given: None)
    brick = pack_dense(replace(recipe, size=(4.0, 3.0)))
    assert brick.residual_ratio <= 1e-9
    assert np.bincount(brick.pairs.ravel()).min() >= 3


def test_failure_says_how_far_it_got(recipe, monkeypatch):
    monkeypatch.setattr(dense, "MAX_STARTS", 1)
    monkeypatch.setattr(dense, "SIZE_TOLERANCE", 0.0)
    with pytest.raises(PackingError, match=r"at least 0\.\d\d % in 1 starts"):
        pack_dense(recipe)


BOX = np.array([20.0, 20.0])


def test_three_contacts_hold_a_disk():
    angles = np.deg2rad([90.0, 210.0, 330.0])
    ring = 10.0 + 1.99 * np.column_stack([np.cos(angles), np.sin(angles)])
    bed = Bed(BOX, np.vstack([ring, [[10.0, 10.0], [2.0, 2.0]]]), np.ones(5), held=3)
    assert bed.loose().tolist() == [False, False, False, False, True]


def plain_forces(bed):
    """Forces (2, n) and mean contact force, one pair at a time in the order of the list."""
    pairs, vectors, overlaps = bed.overlaps()
    forces = np.zeros((2, len(bed.radii)))
    for (i, j), vector, overlap in zip(pairs, vectors, overlaps, strict=True):
        push = overlap / np.sqrt(vector[0] * vector[0] + vector[1] * vector[1]) * vector
        forces[:, i] -= push
        forces[:, j] += push
    return forces, overlaps.mean()


def test_kernel_forces_are_those_of_single_pairs():
    rng = np.random.default_rng(400)  # pairs of several blocks
    bed = Bed(BOX, rng.random((400, 2)) * BOX, rng.uniform(0.5, 1.0, 400), held=0)
    *_, pairs = listed(bed.positions, bed.radii, BOX, 0.3)
    forces = np.empty((2, 400))
    mean = pack.overlap_forces(bed.positions.T.copy(), pairs, forces, np.empty((3, pack.BLOCK)))
    expected, expected_mean = plain_forces(bed)
    # the same sums in the same order; only hypot and the root of squares differ, and the mean's order
    assert forces == pytest.approx(expected, rel=1e-12, abs=1e-13)
    assert mean == pytest.approx(expected_mean, rel=1e-13)
    # listed, but apart
    *_, pairs = listed(np.array([[0.0, 0.0], [3.0, 4.0]]), np.array([2.0, 2.5]), BOX, 1.0)
    forces, work = np.full((2, 2), np.nan), np.empty((3, pack.BLOCK))
    assert pack.overlap_forces(np.array([[0.0, 3.0], [0.0, 4.0]]), pairs, forces, work) == 0.0
    assert not forces.any()


WIDE = np.array([10.0, 6.0])


def test_wrap_never_returns_the_far_face():
    positions = np.array([[-1e-17, 6.0], [10.0, -0.5], [25.0, 3.0]])
    assert wrap(positions, WIDE).tolist() == [[0.0, 0.0], [0.0, 5.5], [5.0, 3.0]]


def test_strips_run_upwards_one_after_the_other():
    positions = np.array([[2.5, 0.0], [0.5, 4.0], [0.9, 1.0], [2.1, 5.0]])
    assert strip_order(positions, 1.0).tolist() == [2, 1, 0, 3]
