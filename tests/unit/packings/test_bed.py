"""Beds of few disks whose rest can be worked out by hand."""

import numpy as np
import pytest

from dembound.errors import PackingError
from dembound.kernels import pack
from dembound.packings import bed as module
from dembound.packings.bed import Bed
from dembound.packings.brick import listed

BOX = np.array([20.0, 20.0])


def test_three_contacts_hold_a_disk():
    angles = np.deg2rad([90.0, 210.0, 330.0])
    ring = 10.0 + 1.99 * np.column_stack([np.cos(angles), np.sin(angles)])
    bed = Bed(BOX, np.vstack([ring, [[10.0, 10.0], [2.0, 2.0]]]), np.ones(5), held=3)
    assert bed.loose().tolist() == [False, False, False, False, True]


def test_running_out_of_steps_is_an_error(monkeypatch):
    monkeypatch.setattr(module, "MAX_STEPS", 2)
    bed = Bed(BOX, np.array([[5.0, 5.0], [6.0, 5.0]]), np.ones(2), held=0)
    with pytest.raises(PackingError, match="did not come to rest"):
        bed.relax(1e-9, faint=1e-3)


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
