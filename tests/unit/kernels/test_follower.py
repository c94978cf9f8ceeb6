"""Forces that turn with their sides, against rotations that are fitted and applied plainly."""

from collections.abc import Callable

import numpy as np
import pytest
from disk_systems import fitted, turn

from dembound.kernels.follower import extra_work, side_rotation, side_rotations, turn_forces
from dembound.kernels.tables import Followers

PARTICLES = 24
SIDES = {0: np.array([7, 8, 9, 10, 11]), 1: np.array([12, 13, 14, 15]), 2: np.array([11, 16, 12])}
"""Two that are opposite and one without an opposite side; particles 11 and 12 stand at corners."""
OPPOSITE = np.array([1, 0, 2])
NODE = np.array([7, 9, 11, 12, 15, 16, 20])
SIDE = np.array([[0, 0, 0, 1, 1, 2, 2], [-1, -1, 2, 2, -1, -1, -1]])
"""Sides of the particles with forces; the last one belongs to a side without being its member."""
STEP = 0.1


DATUM = np.random.default_rng(2).integers(-1024, 1024, (3, PARTICLES)) / 1024.0
"""Displacements of all particles that rotations count from, whole 1024ths."""


@pytest.fixture
def followers() -> Callable[..., tuple[Followers, np.ndarray]]:
    """Makes followers at random places, and these places (2, n) at the datum; twinned: members have twins 0 to 4."""

    def make(*, twinned: bool = False) -> tuple[Followers, np.ndarray]:
        rng = np.random.default_rng(1)
        # whole 1024ths, of which sums and differences are exact
        places = rng.integers(-1024, 1024, (2, PARTICLES)) / 1024.0
        members = np.concatenate(list(SIDES.values()))
        arms = [places[:, nodes] - places[:, nodes].mean(axis=1, keepdims=True) for nodes in SIDES.values()]
        force = rng.uniform(-1.0, 1.0, (2, 2, len(NODE)))
        force[1, :, SIDE[1] < 0] = 0.0
        twins = members % 5 if twinned else np.full(len(members), -1)
        table = Followers(
            opposite=OPPOSITE,
            start=np.cumsum([0, *(len(nodes) for nodes in SIDES.values())]),
            member=members,
            twin=twins,
            arm=np.ascontiguousarray(np.concatenate(arms, axis=1)),
            node=NODE,
            side=SIDE,
            force=force,
            steady=rng.uniform(-1.0, 1.0, (2, len(NODE))),
            extra=np.full((2, len(NODE)), np.nan),
            rest=np.ascontiguousarray(DATUM[:2, members] - (DATUM[:2, twins] if twinned else 0.0)),
        )
        return table, places

    return make


def shaken(seed: int = 7) -> np.ndarray:
    """Random motions (3, n), whole 1024ths."""
    return np.random.default_rng(seed).integers(-200, 200, (3, PARTICLES)) / 1024.0


def turned(places: np.ndarray, angle: float) -> np.ndarray:
    """Displacements (3, n) of a turn about a point outside."""
    centre = np.array([[3.0], [-2.0]])
    return np.vstack([(turn(angle) - np.eye(2)) @ (places - centre), np.zeros(PARTICLES)])


@pytest.mark.parametrize(("angle", "twinned"), [(1e-7, False), (2.0, False), (-0.3, True), (-2.5, True)])
def test_a_side_that_turns_as_one_has_turned_by_just_that(followers, angle: float, twinned: bool) -> None:
    table, places = followers(twinned=twinned)
    u = DATUM + turned(places, angle)
    if twinned:  # all members have moved, beside the turn, by as much as their twins
        u[:, :5] = DATUM[:, :5] + shaken()[:, :5]
        for i, twin in zip(table.member, table.twin, strict=True):
            u[:, i] = (DATUM + turned(places, angle))[:, i] + (u - DATUM)[:, twin]
    for side in SIDES:
        # some ten sums of numbers up to 10, over arms of size 1
        assert side_rotation(side, u, table) == pytest.approx(angle, rel=0.0, abs=1e-14)


def test_the_load_is_what_was_steady_with_its_forces_turned(followers) -> None:
    table, places = followers()
    u, v = DATUM + 3.0 * shaken(), shaken(3)
    load = np.full((3, PARTICLES), 7.0)
    half = turn_forces(table, u, v, load, STEP)
    assert extra_work(table, v, STEP) == pytest.approx(half, rel=0.0, abs=1e-15)
    angles = np.array([fitted(places[:, nodes], (u - DATUM)[:2, nodes]) for nodes in SIDES.values()])
    angles[:2] = angles[:2].mean()

    expected, work = np.full((3, PARTICLES), 7.0), 0.0
    for q, node in enumerate(NODE):
        without = table.steady[:, q] - table.force[:, :, q].sum(axis=0)
        now = sum(turn(angles[k]) @ table.force[s, :, q] for s, k in enumerate(SIDE[:, q]) if k >= 0)
        expected[:2, node] = without + now
        added = now - table.force[:, :, q].sum(axis=0)
        work += 0.5 * STEP * added @ v[:2, node]
        # angles as above; forces of size 1
        np.testing.assert_allclose(table.extra[:, q], added, rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(load, expected, rtol=0.0, atol=1e-14)
    assert half == pytest.approx(work, rel=0.0, abs=1e-15)
    assert abs(half) > 1e-3
    # the corners' two sides have not turned alike
    assert abs(angles[0] - angles[2]) > 0.1
    assert side_rotations(u, table) == pytest.approx(angles, rel=0.0, abs=1e-14)
    # where nothing has moved but all alike, nothing changes
    load[:2, NODE] = np.nan
    assert turn_forces(table, DATUM + np.array([[0.375], [-1.25], [0.5]]), v, load, STEP) == 0.0
    assert np.array_equal(load[:2, NODE], table.steady)
    assert not table.extra.any()
