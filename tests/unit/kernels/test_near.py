"""Near pairs by the grid of cells are those that a trial of all pairs and images finds."""

import numpy as np
import pytest

from dembound.kernels import near


def by_trial(positions, radii, gap, periods):
    """Rows i, j, image x, image y of near pairs, in order; axes of period 0.0 are not periodic."""
    found = []
    steps = [(-1, 0, 1) if period else (0,) for period in periods]
    for a, b in ((a, b) for a in steps[0] for b in steps[1]):
        vectors = positions[None] + periods * (a, b) - positions[:, None]
        close = np.hypot(*vectors.transpose(2, 0, 1)) - radii[:, None] - radii <= gap
        found += [(i, j, a, b) for i, j in np.argwhere(close) if i < j or (i == j and (a, b) > (0, 0))]
    return np.array(sorted(found), dtype=np.int64).reshape(-1, 4)


def by_grid(positions, radii, gap, periods):
    return np.hstack(near.near_pairs(positions, radii, gap, periods))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("axes", [(1, 1), (1, 0), (0, 0)], ids=["periodic", "periodic along x", "open"])
def test_pairs_are_those_of_a_trial_in_the_same_order(axes, seed):
    rng = np.random.default_rng(seed)
    count, ratio, gap = rng.integers(2, 400), rng.uniform(1.0, 4.0), rng.uniform(0.0, 0.5) * (seed % 3 > 0)
    radii = rng.uniform(1.0, ratio, count)
    box = rng.uniform(1.0, 4.0, 2) * (4.0 * radii.max() + 2.0 * gap)
    positions, periods = rng.random((count, 2)) * box, box * axes
    assert by_grid(positions, radii, gap, periods).tolist() == by_trial(positions, radii, gap, periods).tolist()


@pytest.mark.parametrize("seed", range(8))
def test_disks_may_lie_outside_and_touch_their_own_images(seed):
    rng = np.random.default_rng(100 + seed)
    count = rng.integers(1, 60)
    periods = rng.uniform(0.9, 5.0, 2) * rng.integers(0, 2, 2)
    positions = rng.random((count, 2)) * np.where(periods > 0.0, periods, 6.0) + rng.normal(0.0, 0.2, (count, 2))
    positions += rng.normal(0.0, 100.0, 2)
    radii = rng.uniform(0.1, 0.45, count)
    assert by_grid(positions, radii, 0.05, periods).tolist() == by_trial(positions, radii, 0.05, periods).tolist()


def test_crowded_disks_all_find_each_other_and_none_has_no_pairs():
    positions = np.full((50, 2), 3.0)  # more pairs than there is room for at first
    found = by_grid(positions, np.ones(50), 0.0, np.zeros(2))
    assert found[:, :2].tolist() == [[i, j] for i in range(50) for j in range(i + 1, 50)]
    assert by_grid(np.empty((0, 2)), np.empty(0), 0.1, np.zeros(2)).shape == (0, 4)
