"""Laws and ties that the loop has never heard of, unlike laws in one call.

The loop is compiled anew for every combination of types, which takes seconds: there is one for all tests of this file.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import pytest
from numba import njit

from dembound.kernels import loop
from dembound.kernels.common import BROKE, DONE, FAST, TRIGGERED, U
from dembound.kernels.law import is_law, is_tie
from dembound.kernels.step import move_particle

PARTICLES = 50
HALF = PARTICLES // 2
STEP = 0.1
HERE = FAST | {"cache": False}
"""Compiled code of the classes below is not kept: nobody else can import them."""


class Wind(NamedTuple):
    """Pushes particles begin to end − 1 with the same force (3,); blown (3,) counts the steps begun, moved, ended."""

    begin: int
    end: int
    force: np.ndarray
    blown: np.ndarray


@njit(**HERE)
def blow(wind, u, u_next, v, body, nodes):
    for i in range(U(wind.begin), U(wind.end)):
        move_particle(i, wind.force[0], wind.force[1], wind.force[2], u, v, body, u_next)
    wind.blown[1] += 1


@njit(**HERE)
def settle(wind, v, body, nodes, work):
    work[0, 4] += 2.0
    wind.blown[2] += 1


is_law(Wind, move=blow, finish=settle)


class Gust(NamedTuple):
    """Wind that answers everything the loop asks: it ends before step `calm`, and breaks something in step `harm`."""

    wind: Wind
    calm: int
    harm: int
    number: np.ndarray


@njit(**HERE)
def rise(gust):
    gust.wind.blown[0] += 1


@njit(**HERE)
def wane(gust, u, u_next, v):
    return TRIGGERED if gust.number[0] >= gust.calm else DONE


@njit(**HERE)
def press(gust, u, u_next, v, number, step, work):
    gust.number[0] = number + 1
    return 3 if number == gust.harm else 0


@njit(**HERE)
def tell(gust, index, u, log):
    for q in range(log.probes.size):
        log.record[index, q, 6] = 10.0 * index + u[0, log.probes[q]]


@njit(**HERE)
def blow_gust(gust, u, u_next, v, body, nodes):
    blow(gust.wind, u, u_next, v, body, nodes)


@njit(**HERE)
def settle_gust(gust, v, body, nodes, work):
    settle(gust.wind, v, body, nodes, work)


is_law(Gust, begin=rise, check=wane, push=press, note=tell, move=blow_gust, finish=settle_gust)


class Rope(NamedTuple):
    """Pulls supported node number s with as much of a force (3,) as share (k,) of it is."""

    force: np.ndarray
    share: np.ndarray


@njit(**HERE)
def haul(rope, u, v, force):
    for s in range(rope.share.size):
        for c in range(3):
            force[s, c] += rope.share[s] * rope.force[c]


is_tie(Rope, across=haul)


@pytest.fixture(autouse=True)
def _nothing_kept() -> Iterator[None]:
    """Keeps code for these laws out of the loop's folder: whatever reads its index would have to import their types."""
    loop._advance._cache.disable()
    yield
    loop._advance._cache.enable()


NEVER = 10**9


class Blown(NamedTuple):
    """Two unlike laws, each on a half of the particles."""

    wind: Wind
    gust: Gust

    @classmethod
    def make(cls, calm: int = NEVER, harm: int = NEVER, number: int = 0) -> "Blown":
        """Laws in step `number`, of which the gust ends and breaks as it says."""
        wind, other = (
            Wind(begin, begin + HALF, np.array(force), np.zeros(3, dtype=np.int64))
            for begin, force in ((0, [0.3, -0.2, 0.1]), (HALF, [-0.1, 0.2, -0.3]))
        )
        return cls(wind, Gust(other, calm, harm, np.array([number])))

    def force(self) -> np.ndarray:
        """Forces and moments (3, n) of all particles."""
        return np.repeat([self.wind.force, self.gust.wind.force], HALF, axis=0).T


def start(count: int = PARTICLES) -> tuple[np.ndarray, np.ndarray]:
    """Random displacement and velocity (3, n)."""
    return tuple(np.random.default_rng(5).uniform(-0.1, 0.1, (2, 3, count)))


def advance(model, u: np.ndarray, v: np.ndarray, laws: Blown, ropes: tuple[Rope, ...] = (), number: int = 0):
    """Advance u and v in place; steps done, why no more, and the log of all particles, of seven columns.

    Without ropes, two pull at nothing.
    """
    body, supports, log = model.bundles()
    log = log._replace(record=np.zeros((*log.record.shape[:2], 7)))
    ropes = ropes or 2 * (Rope(np.ones(3), np.zeros(len(model.nodes))),)
    done, why = loop.advance(u, np.empty_like(u), v, number, tuple(laws), ropes, None, body, supports, log)
    return done, why, log


def close(found: np.ndarray, expected: np.ndarray) -> None:
    """Equal but for rounding: 20 steps of some 100 operations of 1.1e-16 each, on values of size 1."""
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("steps", [9, 10])
def test_laws_that_are_new_to_the_loop_move_their_own_nodes_in_one_call(stepped, steps: int) -> None:
    model, laws = stepped(PARTICLES, steps, STEP, damp=0.3), Blown.make()
    assert 0 < np.count_nonzero(model.nodes < HALF) < len(model.nodes)
    u, v = start()
    *_, (expected_u, expected_v, _) = model.leapfrog(lambda *_: laws.force(), u, v)
    done, why, log = advance(model, u, v, laws)

    assert (done, why) == (steps, DONE)
    close(u, expected_u)
    close(v, expected_v)
    # only one of them asks to be told of the beginning
    assert laws.wind.blown.tolist() == [0, steps, steps]
    assert laws.gust.wind.blown.tolist() == [1, steps, steps]
    assert log.work[0, 4] == 2.0 * 2 * steps
    close(log.work[:, 0], model.work[:, 0])  # what damping takes is a law's own to enter


def test_all_that_the_loop_asks_is_answered(stepped) -> None:
    model, laws = stepped(PARTICLES, 9, STEP), Blown.make(calm=107, harm=105, number=100)
    u, v = start()
    states = model.leapfrog(lambda *_: laws.force(), u, v)
    done, why, log = advance(model, u, v, laws, number=100)

    # step 105 is done, as something breaks in it
    assert (done, why) == (6, BROKE)
    close(u, states[6][0])
    close(v, states[6][1])
    assert np.array_equal(log.record[:6, :, 6], 10.0 * np.arange(6.0)[:, None] + log.record[:6, :, 0])
    # step 107 is not
    model.push = model.push[6:]
    done, why, _ = advance(model, u, v, laws, number=106)
    assert (done, why) == (1, TRIGGERED)
    close(u, states[7][0])
    assert advance(model, u, v, laws, number=107)[:2] == (0, TRIGGERED)
    # begun in three calls
    assert laws.gust.wind.blown.tolist() == [3, 7, 7]


def test_ties_pull_together_and_their_work_is_the_outsides(stepped) -> None:
    model, laws = stepped(PARTICLES, 9, STEP), Blown.make()
    k = len(model.nodes)
    share = np.linspace(0.0, 1.0, k)
    ropes = tuple(Rope(np.array(force), share) for force in ([0.1, 0.2, 0.0], [-0.3, 0.1, 0.2]))
    pull = np.zeros((3, PARTICLES))
    pull[:, model.nodes] = share * sum(rope.force for rope in ropes)[:, None]
    u, v = start()
    states = model.leapfrog(lambda *_: laws.force() + pull, u, v)
    _, _, log = advance(model, u, v, laws, ropes)

    close(u, states[-1][0])
    close(v, states[-1][1])
    # the model has the ropes for something inside
    work = sum(STEP * np.sum(pull * 0.5 * (before + after)) for _, before, after in states[:-1])
    close(log.work[0, 0], model.work[0, 0] + work)
