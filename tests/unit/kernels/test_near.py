"""Near pairs by the grid of cells, and the motion after which others may meet."""

import numpy as np
import pytest

from dembound.disks.contacts.pair_list import CELL, cells_of
from dembound.kernels import near
from dembound.kernels.contacts import INTACT, NONE
from dembound.kernels.listing import NEW, keys_of, merged
from dembound.kernels.near import room


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


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("axes", [(1, 1), (1, 0), (0, 0)], ids=["periodic", "periodic along x", "open"])
def test_pairs_are_those_of_a_trial_in_the_same_order(axes, seed):
    rng = np.random.default_rng(seed)
    count, ratio, gap = rng.integers(2, 400), rng.uniform(1.0, 4.0), rng.uniform(0.0, 0.5) * (seed % 3 > 0)
    radii = rng.uniform(1.0, ratio, count)
    box = rng.uniform(1.0, 4.0, 2) * (4.0 * radii.max() + 2.0 * gap)
    positions, periods = rng.random((count, 2)) * box, box * axes
    assert by_grid(positions, radii, gap, periods).tolist() == by_trial(positions, radii, gap, periods).tolist()


def test_crowded_disks_all_find_each_other_and_none_has_no_pairs():
    positions = np.full((50, 2), 3.0)  # more pairs than there is room for at first
    found = by_grid(positions, np.ones(50), 0.0, np.zeros(2))
    assert found[:, :2].tolist() == [[i, j] for i in range(50) for j in range(i + 1, 50)]
    assert by_grid(np.empty((0, 2)), np.empty(0), 0.1, np.zeros(2)).shape == (0, 4)


COUNT, SIZE, RADIUS = 800, (30.0, 10.0), 0.25


def positions() -> np.ndarray:
    return np.random.default_rng(3).uniform(0.0, SIZE, (COUNT, 2))


def wave(places: np.ndarray, length: float) -> np.ndarray:
    """Displacements (3, n) of 0.3 m by a wave of this length along x, and a tenth of it along y."""
    u = np.zeros((3, len(places)))
    u[0] = 0.3 * np.sin(2.0 * np.pi * places[:, 0] / length)
    u[1] = 0.1 * u[0]
    u[2] = 50.0  # rotations do not count
    return u


def apart(places: np.ndarray, periods) -> np.ndarray:
    """Distances (n, n) along x and y of disks, the nearest way round."""
    gap = places[:, None] - places[None]
    for axis, period in enumerate(periods):
        if period is not None:
            gap[..., axis] -= period * np.rint(gap[..., axis] / period)
    return np.hypot(*np.moveaxis(gap, 2, 0))


@pytest.mark.parametrize(
    ("periods", "length"), [((None, None), 20.0), ((SIZE[0], None), 3.0), ((None, SIZE[1]), 20.0), (SIZE, 3.0)]
)
def test_no_two_disks_that_may_meet_have_come_nearer_than_that(periods, length) -> None:
    places, number = positions(), np.random.default_rng(5).permutation(COUNT)
    cells = cells_of(places, np.full(COUNT, RADIUS), number, periods)
    origin, u = np.full((2, COUNT), 7.0), np.zeros((3, 10 + COUNT))
    u[:, 10 + number] = wave(places, length)
    u[:2, 10:] += 7.0
    skins = np.full(COUNT, 0.5)
    skins[::7] = 0.7
    found = room(u, 10, origin, skins[np.argsort(number)], cells)

    moved = wave(places, length)[:2]
    relative = np.hypot(*(moved[:, :, None] - moved[:, None]))
    left = skins[:, None] + skins - relative
    near = apart(places, periods) < CELL * 2.0 * RADIUS  # in the same cell or in two that touch
    assert found <= left[near].min()
    # no bound is worse than by the extent of the motion in cells, whose ends are up to three cells apart
    assert found >= left[apart(places, periods) < 3.0 * CELL * 2.0 * RADIUS].min() - 0.5 * relative.max()
    # any two that meet were near, or one has moved further than cells can tell
    assert np.hypot(*moved).max() < cells.reach
    assert not (relative > apart(places, periods) - 2.0 * RADIUS)[~near].any()


def test_disks_that_all_move_along_keep_their_room_and_a_fast_one_takes_that_of_its_own_skin() -> None:
    cells, origin = cells_of(positions(), np.full(COUNT, RADIUS), np.arange(COUNT), (None, None)), np.zeros((2, COUNT))
    u, skins = np.zeros((3, COUNT)), np.full(COUNT, 0.1)
    u[0] = 0.5 * cells.reach
    assert room(u, 0, origin, skins, cells) == pytest.approx(0.2, rel=1e-12)
    u[1, 234] = -0.3
    assert room(u, 0, origin, skins, cells) == pytest.approx(0.2 - 0.3, rel=1e-12)
    skins[234] = 0.4
    assert room(u, 0, origin, skins, cells) == pytest.approx(0.2, rel=1e-12)
    u[1, 234] = -0.5
    assert room(u, 0, origin, skins, cells) == pytest.approx(0.5 - 0.5, abs=1e-12)
    u[0] = 1.1 * cells.reach  # so far that disks of any cells may meet
    assert room(u, 0, origin, skins, cells) < 0.0


def test_a_pair_has_one_key_whichever_disk_is_the_first() -> None:
    rng = np.random.default_rng(2)
    (first, second), images = rng.integers(0, 30, (2, 400)), rng.integers(-1, 2, (400, 2)).astype(np.int8)
    keys = keys_of(first, second, images, 30)
    assert np.array_equal(keys, keys_of(second, first, -images, 30))

    pairs, periods = near.pairs_of(keys, 30)
    there = np.hstack([np.column_stack([first, second]), images])
    back = np.hstack([np.column_stack([second, first]), -images])
    turned = (np.hstack([pairs, periods]) != there).any(axis=1)
    assert np.array_equal(np.hstack([pairs, periods])[turned], back[turned])
    assert 0.3 < turned.mean() < 0.7
    assert (pairs[:, 0] <= pairs[:, 1]).all()


@pytest.mark.parametrize("axes", [(1, 1), (0, 0)], ids=["periodic", "open"])
def test_disks_that_reach_far_find_all_and_none_of_no_reach(axes) -> None:
    rng, count = np.random.default_rng(5), 300
    positions, reach, box = rng.random((count, 2)) * 20.0, rng.uniform(0.3, 0.5, count), np.array([20.0, 20.0])
    reach[::37], reach[5] = 2.4, -np.inf
    names = np.arange(count) * 2 + 3
    found = near.pairs_of(near.near_keys(positions, reach, box * axes, names, 0.5), names[-1] + 1)
    expected = by_trial(positions, reach, 0.0, box * axes)
    expected[:, :2] = names[expected[:, :2]]
    assert np.hstack(found).tolist() == expected.tolist()
    assert len(expected) > 300


def test_a_list_keeps_bonds_and_held_pairs_and_takes_near_ones_that_are_not_elsewhere() -> None:
    listed, state = np.array([2, 5, 7, 11, 13]), np.array([NONE, INTACT, NONE, NONE, NONE], np.uint8)
    near_ones, held, elsewhere = np.array([1, 3, 7, 8, 17]), np.array([6, 11]), np.array([3, 9])
    keys, source = merged(near_ones, listed, state, held, elsewhere)
    assert keys.tolist() == [1, 5, 7, 8, 11, 17]
    assert source.tolist() == [NEW, 1, 2, NEW, 3, NEW]
