"""The forces that balance a settled body: on which sides they turn, how they end on debris, and their work."""

import numpy as np
import pytest
from disk_systems import BODY, fitted

from dembound.boundaries import OPPOSITE
from dembound.disks.scene import DiskScene, build
from dembound.disks.stepping.balance import Balance, mean_rotations
from dembound.disks.stepping.part import DiskPart
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.contacts import TENSION
from dembound.kernels.follower import extra_work, turn_forces

LATTICE = {"pattern": "A", "size": [2.5, 2.0], "radius": 0.25}
STEP = 0.1


@pytest.fixture
def scene(bar, in_order):
    """Makes five disks by four that nothing holds, or other packings under other boundaries."""

    def make(packing: dict = LATTICE, ground: dict | None = None, **boundary: dict) -> DiskScene:
        law = {"material.law": "linearpbond"}
        return in_order(build(bar({**BODY, **law, "packing": packing, "boundary": boundary, **(ground or {})})))

    return make


def shaken(body: DiskScene, seed: int, size: float = 1.0) -> np.ndarray:
    """Random numbers (3, n), of motions or forces."""
    return size * np.random.default_rng(seed).uniform(-1.0, 1.0, (3, body.count))


def balance_of(body: DiskScene, across: np.ndarray | None = None) -> tuple[Balance, np.ndarray]:
    """Random forces, which also act on other particles than those of the sides, and the other steady forces."""
    steady = shaken(body, 2)
    across = np.zeros((3, body.count)) if across is None else across
    return Balance(body, shaken(body, 1), steady, shaken(body, 3, 0.1), across), steady


def at(body: DiskScene, x: float, y: float) -> int:
    """The particle there."""
    found = np.flatnonzero(np.isclose(body.positions, [x, y]).all(axis=1))
    assert len(found) == 1
    return int(found[0])


def test_sides_turn_by_their_mean_with_the_opposite_one(scene) -> None:
    body = scene()
    moved = shaken(body, 4, 0.2)
    own = {side: fitted(edge.positions.T, moved[:2, edge.nodes]) for side, edge in body.edges.items()}
    expected = {side: 0.5 * (own[side] + own[other]) for side, other in OPPOSITE.items()}
    found = mean_rotations(body, moved)

    assert list(found) == list(body.edges)
    # some ten sums of numbers of size 1
    assert found == pytest.approx(expected, rel=0.0, abs=1e-14)
    assert abs(own["left"] - own["right"]) > 0.02
    assert abs(found["left"] - found["top"]) > 0.05


def resultants(body: DiskScene, force: np.ndarray) -> np.ndarray:
    """Force along x and y and torque about the origin of forces and moments (3, n) at the datum."""
    x, y = body.positions.T + shaken(body, 3, 0.1)[:2]
    return np.array([force[0].sum(), force[1].sum(), np.sum(x * force[1] - y * force[0]) + force[2].sum()])


def parts_of(body: DiskScene) -> tuple[DiskPart, ...]:
    """The parts of a body as built."""
    return DiskSystem(body, STEP).parts


def isolate(parts: tuple[DiskPart, ...], particles: list[int]) -> None:
    """Break all bonds of some particles, and none other."""
    for part in parts:
        pairs = part.pairs
        broken = np.isin(pairs.first, particles) | np.isin(pairs.second, particles)
        pairs.state[broken], pairs.cracked[broken] = TENSION, 1


def test_forces_end_on_what_has_broken_away_and_there_alone(scene) -> None:
    body = scene()
    parts, (balance, steady) = parts_of(body), balance_of(body)
    before, u, v = balance.force.copy(), shaken(body, 4), shaken(body, 5)
    load = steady + balance.force
    turn_forces(balance.followers, u, v, load, STEP)
    turned = load.copy()
    balance.end_on_debris(parts, u, v, STEP, load, None)
    assert np.array_equal(balance.force, before)
    assert np.array_equal(load, turned)

    # a corner, one in the middle of a side and one inside, which no side turns
    debris = [at(body, 0.25, 0.25), at(body, 2.25, 0.75), at(body, 1.25, 0.75)]
    isolate(parts, debris)
    balance.end_on_debris(parts, u, v, STEP, load, None)
    rest = np.setdiff1d(np.arange(body.count), debris)
    assert np.array_equal(balance.force[:, debris], np.zeros((3, 3)))
    borne = (balance.force - before)[:, rest]
    np.testing.assert_allclose(load[:, rest], turned[:, rest] + borne, rtol=0.0, atol=1e-15)
    # what has ended the other disks of the sides bear, and they alone: the resultant stays
    sides = np.isin(rest, balance.followers.node)
    assert not borne[:, ~sides].any()
    assert borne[:2, sides].all()
    np.testing.assert_allclose(*(resultants(body, each)[:2] for each in (balance.force, before)), rtol=0.0, atol=1e-13)
    # what is taken off has been added: three sums of size 1
    np.testing.assert_allclose(load[:, debris], steady[:, debris], rtol=0.0, atol=1e-15)
    assert not balance.followers.extra[:, np.isin(balance.followers.node, debris)].any()

    # and they stay ended however the sides turn
    turn_forces(balance.followers, 2.0 * u, v, load, STEP)
    np.testing.assert_allclose(load[:, debris], steady[:, debris], rtol=0.0, atol=1e-15)
    assert np.abs(load - turned)[:2, balance.followers.node].max() > 0.1


def test_the_work_goes_on_from_where_forces_end(scene) -> None:
    body = scene()
    rng, parts, (balance, steady) = np.random.default_rng(6), parts_of(body), balance_of(body)
    debris = {3: [at(body, 0.25, 0.25)], 8: [at(body, 1.75, 1.75), at(body, 1.25, 1.25)]}
    u, v, load = balance.datum.copy(), np.zeros((3, body.count)), steady + balance.force
    whole = turning = 0.0
    worst = []
    for number in range(14):
        half = turn_forces(balance.followers, u, v, load, STEP)
        force, after = load - steady, rng.uniform(-1.0, 1.0, v.shape)
        # of all that balances, turned or not: F·(v⁻ + v⁺)/2·Δt, half of that up to the whole step
        until_now = whole + 0.5 * STEP * np.sum(force * v)
        worst.append(abs(until_now - (balance.work(u) + turning + half)))
        whole += 0.5 * STEP * np.sum(force * (v + after))
        turning += half + extra_work(balance.followers, after, STEP)
        u, v = u + STEP * after, after
        if number in debris:
            isolate(parts, debris[number])
            balance.end_on_debris(parts, u, v, STEP, load, None)

    # fourteen sums of sixty terms of size 0.1
    assert max(worst) < 1e-13
    assert np.count_nonzero(balance.force[0] == 0.0) == 3
    assert abs(whole) > 0.1
