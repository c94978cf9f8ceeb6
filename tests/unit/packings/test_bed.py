"""Beds of few disks whose rest can be worked out by hand."""

import numpy as np
import pytest

from dembound.errors import PackingError
from dembound.kernels import pack
from dembound.packings import bed as module
from dembound.packings.bed import Bed
from dembound.packings.contacts import listed

BOX = np.array([20.0, 20.0])


def test_two_overlapping_disks_push_each_other_apart():
    bed = Bed(BOX, np.array([[19.9, 5.0], [0.9, 5.0]]), np.array([1.0, 1.0]), held=0)  # through the face
    bed.relax(1e-9, faint=1e-3)
    gap = np.linalg.norm(bed.positions[1] + [20.0, 0.0] - bed.positions[0]) - 2.0
    # balance is reached when the last overlap is below 1e-9 of the faint force
    assert gap >= -1e-12


def test_held_disks_stay():
    held = np.array([[5.0, 5.0], [7.0, 5.0]])
    bed = Bed(BOX, np.vstack([held, [[6.2, 5.1]]]), np.ones(3), held=2)
    bed.relax(1e-9, faint=1e-3)
    assert np.array_equal(bed.positions[:2], held)
    assert np.linalg.norm(bed.positions[2] - held, axis=1).min() >= 2.0 - 1e-11


def test_square_lattice_reaches_its_pressure():
    centres = np.stack(np.meshgrid(np.arange(10.0), np.arange(10.0)), axis=-1).reshape(-1, 2) * 2.0 + 1.0
    bed = Bed(BOX, centres, np.full(100, 1.001), held=0)
    bed.compress(0.01, 1e-9)
    # per cell of side d = 2: σ = overlap·d/d², so overlap = 0.02; the search stops within 5e-4
    assert 2 * bed.radii - 2.0 == pytest.approx(np.full(100, 0.02), rel=5e-4)


def test_three_contacts_hold_a_disk():
    angles = np.deg2rad([90.0, 210.0, 330.0])
    ring = 10.0 + 1.99 * np.column_stack([np.cos(angles), np.sin(angles)])
    bed = Bed(BOX, np.vstack([ring, [[10.0, 10.0], [2.0, 2.0]]]), np.ones(5), held=3)
    assert bed.loose().tolist() == [False, False, False, False, True]


def test_crowding_grows_loose_disks_up_to_the_largest():
    bed = Bed(BOX, np.array([[2.0, 2.0], [8.0, 8.0], [15.0, 15.0]]), np.array([0.5, 0.995, 1.0]), held=0)
    bed.crowd(np.array([True, True, False]))
    assert bed.radii.tolist() == [0.51, 1.0, 1.0]
    bed.crowd(np.array([False, True, False]))  # as large as allowed and still loose
    assert bed.radii.tolist() == [0.51, 1.0]
    assert bed.positions.tolist() == [[2.0, 2.0], [15.0, 15.0]]


def test_running_out_of_steps_is_an_error(monkeypatch):
    monkeypatch.setattr(module, "MAX_STEPS", 2)
    bed = Bed(BOX, np.array([[5.0, 5.0], [6.0, 5.0]]), np.ones(2), held=0)
    with pytest.raises(PackingError, match="did not come to rest"):
        bed.relax(1e-9, faint=1e-3)


def test_kernel_force_is_the_overlap_along_the_line_of_centres():
    positions, forces, work = np.array([[0.0, 0.0], [3.0, 4.0]]), np.full((2, 2), np.nan), np.empty((3, pack.BLOCK))
    *_, pairs = listed(positions, np.array([3.0, 2.5]), BOX, 0.0)
    assert pack.overlap_forces(positions.T.copy(), pairs, forces, work) == 0.5
    assert forces == pytest.approx(np.array([[-0.3, 0.3], [-0.4, 0.4]]))
    *_, pairs = listed(positions, np.array([2.0, 2.5]), BOX, 1.0)  # listed, but apart
    assert pack.overlap_forces(positions.T.copy(), pairs, forces, work) == 0.0
    assert not forces.any()


def plain_forces(bed):
    """Forces (2, n) and mean contact force, one pair at a time in the order of the list."""
    pairs, vectors, overlaps = bed.overlaps()
    forces = np.zeros((2, len(bed.radii)))
    for (i, j), vector, overlap in zip(pairs, vectors, overlaps, strict=True):
        push = overlap / np.sqrt(vector[0] * vector[0] + vector[1] * vector[1]) * vector
        forces[:, i] -= push
        forces[:, j] += push
    return forces, overlaps.mean()


@pytest.mark.parametrize("count", [20, 400])  # pairs of less than a block, and of several
def test_kernel_forces_are_those_of_single_pairs(count):
    rng = np.random.default_rng(count)
    bed = Bed(BOX, rng.random((count, 2)) * BOX, rng.uniform(0.5, 1.0, count), held=0)
    *_, pairs = listed(bed.positions, bed.radii, BOX, 0.3)
    forces = np.empty((2, count))
    mean = pack.overlap_forces(bed.positions.T.copy(), pairs, forces, np.empty((3, pack.BLOCK)))
    expected, expected_mean = plain_forces(bed)
    # the same sums in the same order; only hypot and the root of squares differ, and the mean's order
    assert forces == pytest.approx(expected, rel=1e-12, abs=1e-13)
    assert mean == pytest.approx(expected_mean, rel=1e-13)


def test_looking_for_requests_to_end_changes_no_bit(monkeypatch) -> None:
    def relaxed() -> Bed:
        rng = np.random.default_rng(3)
        made = Bed(np.array([6.0, 6.0]), 6.0 * rng.random((60, 2)), np.full(60, 0.42), 0)
        made.relax(1e-6, faint=1e-3)
        return made

    whole = relaxed()
    monkeypatch.setattr(module, "AT_ONCE", 3 * 400)  # a few steps at once
    np.testing.assert_array_equal(relaxed().positions, whole.positions)
