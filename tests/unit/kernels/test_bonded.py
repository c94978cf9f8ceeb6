"""The step of pairs with a history against the same law and the same leapfrog written down plainly."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from plain_kernels import PlainPairs, behind, random_pairs, stepped

from dembound.kernels import bonded, follower  # noqa: F401  (they make the law and the forces that turn known)
from dembound.kernels.common import BROKE, CHUNKS, DONE, LIST_ENDS
from dembound.kernels.contacts import BONDED, INTACT, LOST, SHEAR, TENSION, UPDATED
from dembound.kernels.loop import advance
from dembound.kernels.near import room
from dembound.kernels.tables import Bonded, Cells, Contacts, Log
from dembound.laws.law import Limits

PARTICLES, PAIRS = 25, 60
STEP = 0.1
WEAK = Limits(friction=0.5, tension=0.3, cohesion=0.25, tan_fa=0.6, geometry=UPDATED)
FAR = 1e3
ONE, WRAPS = np.ones(2, dtype=np.int64), np.ones(2, dtype=bool)
EVERY = Cells(np.array([0, PARTICLES]), np.arange(PARTICLES), ONE, WRAPS, reach=np.inf)
"""One cell with all particles."""


def start() -> tuple[np.ndarray, np.ndarray]:
    """Random displacement and velocity (3, n)."""
    return tuple(np.random.default_rng(5).uniform(-0.1, 0.1, (2, 3, PARTICLES)))


def bonded_law(pairs: Contacts, limits: Limits, *, skin: float = FAR, stop: bool = False) -> Bonded:
    """The law on these pairs, which are listed where particles are at the start."""
    space = np.zeros(2), np.zeros(CHUNKS), np.zeros((CHUNKS, 2)), np.zeros((CHUNKS, LOST))
    return Bonded(pairs, limits, np.zeros((2, PARTICLES)), np.full(PARTICLES, 0.5 * skin), EVERY, stop, *space)


def run_kernel(
    pairs: Contacts, limits: Limits, model, u: np.ndarray, v: np.ndarray, *, number: int = 0, **more
) -> tuple[int, int, Log]:
    """Advance u and v in place; steps done, why it stopped, and the log of all particles."""
    body, supports, log = model.bundles()
    u_next, law = np.empty_like(u), bonded_law(pairs, limits, **more)
    done, why = advance(u, u_next, v, number, (law,), (), None, body, supports, log)
    return done, why, log


def close(found: np.ndarray, expected: np.ndarray) -> None:
    """Equal but for rounding: 20 steps of some 100 operations of 1.1e-16 each, on values of size 1."""
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13)


def law_of(pairs: Contacts, limits: Limits, number: int = 0):
    """The plain law on a copy of the pairs, and the forces it answers each step with."""
    law = PlainPairs(pairs, limits)
    numbers = iter(range(number, 10_000))
    return law, lambda u, v: law.push(u, v, STEP, next(numbers))


@pytest.mark.parametrize(("geometry", "damp", "steps"), [(UPDATED, 0.0, 19), (UPDATED, 0.3, 20), (BONDED, 0.3, 20)])
def test_steps_are_those_of_a_plain_leapfrog(geometry: int, damp: float, steps: int) -> None:
    pairs, limits = random_pairs(PARTICLES, PAIRS), WEAK._replace(geometry=geometry)
    model = stepped(PARTICLES, steps, STEP, damp=damp)
    law, forces = law_of(pairs, limits, number=100)
    u, v = start()
    states = model.leapfrog(forces, u, v)
    done, why, log = run_kernel(pairs, limits, model, u, v, number=100)

    assert (done, why) == (steps, DONE)
    close(u, states[-1][0])
    close(v, states[-1][1])
    assert np.array_equal(pairs.state, law.arrays.state)
    assert np.array_equal(pairs.cracked, law.arrays.cracked)
    close(pairs.slip, law.arrays.slip)
    close(log.work[:, :2], model.work[:, :2])
    close(log.work[:, [2, 3, 6]], [law.lost, law.lost])
    for line, (then, before, after) in zip(log.record, states, strict=False):
        close(line[:, :3].T, then)
        close(line[:, 3:].T, 0.5 * (before + after))
    close(log.top_speed, np.max([np.hypot(*after[:2]) for _, _, after in states], axis=0))
    broken = np.flatnonzero(pairs.cracked >= 0)
    first, second = (ends[broken] for ends in (pairs.first, pairs.second))
    there = np.array([states[step - 100][0] for step in pairs.cracked[broken]]).reshape(-1, 3, PARTICLES)
    row = np.arange(len(broken))
    close(pairs.place[broken], 0.5 * (there[row, :2, first] + there[row, :2, second]))
    # bonds held and broke either way, the first not in the first step
    assert {INTACT, TENSION, SHEAR} <= set(pairs.state)
    assert pairs.cracked.max() > 100
    assert law.lost.all()


def test_a_run_may_stop_after_each_step_that_breaks_bonds() -> None:
    whole, (u, v), steps = random_pairs(PARTICLES, PAIRS), start(), 30
    model = stepped(PARTICLES, steps, STEP, damp=0.3)
    assert run_kernel(whole, WEAK, model, u, v, number=100)[:2] == (steps, DONE)

    parts, (there, speed) = random_pairs(PARTICLES, PAIRS), start()
    reached, reasons = [0], []
    while reached[-1] < steps:
        rest = replace(model, push=model.push[reached[-1] :])
        done, why, _ = run_kernel(parts, WEAK, rest, there, speed, number=100 + reached[-1], stop=True)
        reached.append(reached[-1] + done)
        reasons.append(why)

    # each break ends the step of its number
    broke = np.unique(whole.cracked[whole.cracked >= 0] - 100 + 1).tolist()
    assert len(broke) > 3
    assert [step for step, why in zip(reached[1:], reasons, strict=True) if why == BROKE] == broke
    assert reasons.count(BROKE) + (broke[-1] < steps) == len(reasons)
    for one, other in ((u, there), (v, speed), *zip(whole, parts, strict=True)):
        assert np.array_equal(one, other, equal_nan=True)  # places of bonds that hold


def test_no_step_begins_with_a_list_that_is_too_old() -> None:
    pairs, model = random_pairs(PARTICLES, PAIRS), stepped(PARTICLES, 60, STEP)
    _, forces = law_of(pairs, WEAK)
    u, v = start()
    u[:2] *= 0.1
    before, states = u.copy(), model.leapfrog(forces, u, v)
    done, why, log = run_kernel(pairs, WEAK, model, u, v, skin=0.005)
    assert (done, why) == (0, LIST_ENDS)  # the pairs are not even pushed once
    assert np.array_equal(u, before)
    assert not pairs.force.any()
    assert not log.work.any()
    done, why, _ = run_kernel(pairs, WEAK, model, u, v, skin=0.3)

    law = bonded_law(pairs, WEAK, skin=0.3)
    left = np.array([room(then, 0, law.origin, law.skins, law.cells) for then, _, _ in states])
    assert why == LIST_ENDS
    assert 1 < done < 60
    assert done == np.argmax(left < 0.0)
    close(u, states[done][0])
    close(v, states[done][1])


def of_both(pushes: list) -> Callable:
    """Forces on two parts of as many particles."""
    parts = slice(0, PARTICLES), slice(PARTICLES, None)
    return lambda u, v: np.hstack([push(u[:, part], v[:, part]) for push, part in zip(pushes, parts, strict=True)])


def test_a_supported_node_that_outruns_all_others_ages_the_list() -> None:
    pairs, model = random_pairs(PARTICLES, PAIRS), stepped(2 * PARTICLES, 10, STEP, loaded=False)
    later = behind(pairs, PARTICLES)
    driven = model.nodes[-1]
    assert driven >= PARTICLES
    model.push[:] = 0.0
    model.push[:, -1, 0] = 3.0  # m/s along x, prescribed
    parts = [law_of(pairs, WEAK)[1] for _ in range(2)]
    u, v = np.zeros((2, 3, 2 * PARTICLES))
    states = model.leapfrog(of_both(parts), u, v)
    body, supports, log = model.bundles()
    laws = bonded_law(pairs, WEAK), bonded_law(later, WEAK, skin=2.0)
    done, why = advance(u, np.empty_like(u), v, 0, laws, (), None, body, supports, log)

    law = laws[1]
    left = np.array([room(then, PARTICLES, law.origin, law.skins, law.cells) for then, _, _ in states])
    others = np.delete(np.array([before for _, before, _ in states]), driven, axis=2)
    # the rest of its part is so slow that by its speed the list would stay good for all steps
    assert 2.0 * 10 * STEP * np.hypot(*others[:, :2].transpose(1, 0, 2)).max() < 2.0
    assert why == LIST_ENDS
    assert done == np.argmax(left < 0.0) > 1
    close(u, states[done][0])
    close(v, states[done][1])
