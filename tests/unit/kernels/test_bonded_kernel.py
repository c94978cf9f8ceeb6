"""The step of pairs with a history against the same law and the same leapfrog written down plainly."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.kernels import bonded, follower  # noqa: F401  (they make the law and the forces that turn known)
from dembound.kernels.approach import moved
from dembound.kernels.common import BROKE, CHUNKS, DONE, LIST_ENDS
from dembound.kernels.contacts import BONDED, INTACT, SHEAR, TENSION, UPDATED
from dembound.kernels.loop import advance
from dembound.kernels.tables import Bonded, Cells, Contacts, Followers, Limits, Log

PARTICLES, PAIRS = 25, 60
STEP = 0.1
WEAK = Limits(friction=0.5, tension=0.3, cohesion=0.25, tan_fa=0.6, geometry=UPDATED)
FAR = 1e3
NO_CELLS = Cells(*np.zeros((2, 1), dtype=np.int64), *np.ones((2, 2), dtype=np.int64), reach=0.0)


def start() -> tuple[np.ndarray, np.ndarray]:
    """Random displacement and velocity (3, n)."""
    return tuple(np.random.default_rng(5).uniform(-0.1, 0.1, (2, 3, PARTICLES)))


def bonded_law(pairs: Contacts, limits: Limits, *, skin: float = FAR, stop: bool = False) -> Bonded:
    """The law on these pairs, which are listed where particles are at the start."""
    space = np.zeros(2), np.zeros(CHUNKS), np.zeros((CHUNKS, 2)), np.zeros((CHUNKS, 4))
    return Bonded(pairs, limits, np.zeros((2, PARTICLES)), skin, NO_CELLS, stop, *space)


def run_kernel(
    pairs: Contacts,
    limits: Limits,
    model,
    u: np.ndarray,
    v: np.ndarray,
    *,
    number: int = 0,
    skin: float = FAR,
    stop: bool = False,
    followers: Followers | None = None,
) -> tuple[int, int, Log]:
    """Advance u and v in place; steps done, why it stopped, and the log of all particles."""
    body, supports, log = model.bundles()
    u_next, law = np.empty_like(u), bonded_law(pairs, limits, skin=skin, stop=stop)
    done, why = advance(u, u_next, v, number, (law,), (), followers, body, supports, log)
    return done, why, log


def close(found: np.ndarray, expected: np.ndarray) -> None:
    """Equal but for rounding: 20 steps of some 100 operations of 1.1e-16 each, on values of size 1."""
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13)


def law_of(plain, copied, pairs: Contacts, limits: Limits, number: int = 0):
    """The plain law on a copy of the pairs, and the forces it answers each step with."""
    law = plain(copied(pairs), limits)
    numbers = iter(range(number, 10_000))
    return law, lambda u, v: law.push(u, v, STEP, next(numbers))


@pytest.mark.parametrize("geometry", [UPDATED, BONDED])
@pytest.mark.parametrize(("damp", "steps"), [(0.0, 19), (0.0, 20), (0.3, 20)])
def test_steps_are_those_of_a_plain_leapfrog(
    stepped, random_pairs, plain, copied, geometry: int, damp: float, steps: int
) -> None:
    pairs, limits = random_pairs(PARTICLES, PAIRS), WEAK._replace(geometry=geometry)
    model = stepped(PARTICLES, steps, STEP, damp=damp)
    law, forces = law_of(plain, copied, pairs, limits, number=100)
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
    broken = np.flatnonzero(pairs.cracked >= 0)
    first, second = (ends[broken] for ends in (pairs.first, pairs.second))
    there = np.array([states[step - 100][0] for step in pairs.cracked[broken]]).reshape(-1, 3, PARTICLES)
    row = np.arange(len(broken))
    close(pairs.place[broken], 0.5 * (there[row, :2, first] + there[row, :2, second]))
    # bonds held and broke either way, the first not in the first step
    assert {INTACT, TENSION, SHEAR} <= set(pairs.state)
    assert pairs.cracked.max() > 100
    assert law.lost.all()


def test_a_run_may_be_cut_anywhere(stepped, random_pairs) -> None:
    results = []
    for parts in ([slice(0, 15)], [slice(0, 4), slice(4, 9), slice(9, 15)]):
        pairs, (u, v) = random_pairs(PARTICLES, PAIRS), start()
        model = stepped(PARTICLES, 15, STEP, damp=0.3)
        for part in parts:
            run_kernel(pairs, WEAK, replace(model, push=model.push[part]), u, v, number=part.start)
        results.append((u, v, pairs.cracked))

    for one, other in zip(*results, strict=True):
        assert np.array_equal(one, other)


def test_a_run_may_stop_after_each_step_that_breaks_bonds(stepped, random_pairs) -> None:
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


def test_the_work_of_what_turning_adds_has_its_own_column(stepped, random_pairs, plain, copied) -> None:
    # of three particles that nothing supports, pushed along x and with it turned by how the first two turn
    steps, nodes = 15, np.array([0, 8, 9])
    model, pairs = stepped(PARTICLES, steps, STEP, damp=0.3), random_pairs(PARTICLES, PAIRS)
    assert not np.isin(nodes, model.nodes).any()
    side, arm = nodes[:2], np.array([[-0.5, 0.5], [0.3, -0.3]])
    force = np.array([[0.3, 0.2, -0.4], [0.1, -0.2, 0.0]])
    followers = Followers(
        opposite=np.array([0]),
        start=np.array([0, 2]),
        member=side,
        twin=np.array([-1, -1]),
        arm=arm,
        node=nodes,
        side=np.array([[0, 0, 0], [-1, -1, -1]]),
        force=np.stack([force, np.zeros((2, 3))]),
        steady=model.load[:2, nodes].copy(),
        extra=np.zeros((2, 3)),
        rest=np.zeros((2, 2)),
    )

    def added(u: np.ndarray) -> np.ndarray:
        """What turning adds (3, n) at displacements (3, n): both arms turn as the line between the two does."""
        before, now = arm[:, 1] - arm[:, 0], arm[:, 1] - arm[:, 0] + u[:2, side[1]] - u[:2, side[0]]
        turn = np.arctan2(now[1], now[0]) - np.arctan2(before[1], before[0])
        total = np.zeros_like(u)
        total[0, nodes] = np.cos(turn) * force[0] - np.sin(turn) * force[1] - force[0]
        total[1, nodes] = np.sin(turn) * force[0] + np.cos(turn) * force[1] - force[1]
        return total

    law, forces = law_of(plain, copied, pairs, WEAK)
    u, v = start()
    states = model.leapfrog(lambda u, v: forces(u, v) + added(u), u, v)
    step = replace(model, load=model.load.copy())
    done, why, log = run_kernel(pairs, WEAK, step, u, v, followers=followers)

    assert (done, why) == (steps, DONE)
    close(u, states[-1][0])
    close(v, states[-1][1])
    each = [(added(then) * before, added(then) * after) for then, before, after in states[:-1]]
    halves = 0.5 * STEP * np.array([[np.sum(part) for part in parts] for parts in each])
    close(log.work[:, 5], [halves.sum(), halves.sum() - halves[-1, 1]])
    assert np.abs(halves).max() > 1e-4
    # steady loads do no work that is entered, turned or not
    close(log.work[:, [2, 3, 6]], [law.lost, law.lost])
    close(log.work[:, :2], model.work[:, :2])
    assert not log.work[:, 4].any()


def test_no_step_begins_with_a_list_that_is_too_old(stepped, random_pairs, plain, copied) -> None:
    pairs, model = random_pairs(PARTICLES, PAIRS), stepped(PARTICLES, 60, STEP)
    _, forces = law_of(plain, copied, pairs, WEAK)
    u, v = start()
    u[:2] *= 0.1
    states = model.leapfrog(forces, u, v)
    done, why, _ = run_kernel(pairs, WEAK, model, u, v, skin=0.3)

    far = np.array([moved(then, 0, np.zeros((2, PARTICLES))) for then, _, _ in states])
    assert why == LIST_ENDS
    assert 1 < done < 60
    assert done == np.argmax(2.0 * far > 0.3)
    close(u, states[done][0])
    close(v, states[done][1])


def test_a_supported_node_that_outruns_all_others_ages_the_list(stepped, random_pairs, plain, copied, behind) -> None:
    pairs, model = random_pairs(PARTICLES, PAIRS), stepped(2 * PARTICLES, 10, STEP, loaded=False)
    later = behind(copied(pairs), PARTICLES)
    driven = model.nodes[-1]
    assert driven >= PARTICLES
    model.push[:] = 0.0
    model.push[:, -1, 0] = 3.0  # m/s along x, prescribed
    parts = [law_of(plain, copied, pairs, WEAK)[1] for _ in range(2)]
    u, v = np.zeros((2, 3, 2 * PARTICLES))
    states = model.leapfrog(
        lambda u, v: np.hstack([
            push(u[:, part], v[:, part])
            for push, part in zip(parts, (slice(0, PARTICLES), slice(PARTICLES, None)), strict=True)
        ]),
        u,
        v,
    )  # fmt: skip
    body, supports, log = model.bundles()
    laws = bonded_law(pairs, WEAK), bonded_law(later, WEAK, skin=2.0)
    done, why = advance(u, np.empty_like(u), v, 0, laws, (), None, body, supports, log)

    origin = np.zeros((2, PARTICLES))
    far = np.array([moved(then, PARTICLES, origin) for then, _, _ in states])
    others = np.delete(np.array([before for _, before, _ in states]), driven, axis=2)
    # the rest of its part is so slow that by its speed the list would stay good for all steps
    assert 2.0 * 10 * STEP * np.hypot(*others[:, :2].transpose(1, 0, 2)).max() < 2.0
    assert why == LIST_ENDS
    assert done == np.argmax(2.0 * far > 2.0) == 4
    close(u, states[done][0])
    close(v, states[done][1])


def test_two_bodies_keep_a_history_each(stepped, random_pairs, plain, copied, behind) -> None:
    pairs, model = random_pairs(PARTICLES, PAIRS), stepped(2 * PARTICLES, 20, STEP, damp=0.3)
    later = behind(copied(pairs), PARTICLES)
    plain_laws = [law_of(plain, copied, pairs, WEAK) for _ in range(2)]
    parts = slice(0, PARTICLES), slice(PARTICLES, None)
    u, v = np.random.default_rng(5).uniform(-0.1, 0.1, (2, 3, 2 * PARTICLES))
    states = model.leapfrog(
        lambda u, v: np.hstack([
            push(u[:, part], v[:, part]) for (_, push), part in zip(plain_laws, parts, strict=True)
        ]),
        u,
        v,
    )  # fmt: skip
    body, supports, log = model.bundles()
    laws = bonded_law(pairs, WEAK), bonded_law(later, WEAK)
    done, why = advance(u, np.empty_like(u), v, 0, laws, (), None, body, supports, log)

    assert (done, why) == (20, DONE)
    close(u, states[-1][0])
    close(v, states[-1][1])
    for found, (law, _) in zip((pairs, later), plain_laws, strict=True):
        assert np.array_equal(found.state, law.arrays.state)
        assert np.array_equal(found.cracked, law.arrays.cracked)
        assert found.cracked.max() > 0
    assert not np.array_equal(pairs.cracked, later.cracked)
    close(log.work[0, [2, 3, 6]], sum(law.lost for law, _ in plain_laws))


def test_an_old_list_is_not_even_pushed_once(stepped, random_pairs) -> None:
    pairs, (u, v) = random_pairs(PARTICLES, PAIRS), start()
    before = u.copy()
    done, why, log = run_kernel(pairs, WEAK, stepped(PARTICLES, 5, STEP), u, v, skin=0.05)

    assert (done, why) == (0, LIST_ENDS)
    assert np.array_equal(u, before)
    assert not pairs.force.any()
    assert not log.work.any()


def test_the_record_holds_the_state_at_the_start_of_each_step(stepped, random_pairs, plain, copied) -> None:
    pairs, model = random_pairs(PARTICLES, PAIRS), stepped(PARTICLES, 9, STEP)
    _, forces = law_of(plain, copied, pairs, WEAK)
    u, v = start()
    states = model.leapfrog(forces, u, v)[:-1]
    _, _, log = run_kernel(pairs, WEAK, model, u, v)

    for row, (then, before, after) in zip(log.record, states, strict=True):
        close(row[:, :3].T, then)
        close(row[:, 3:].T, 0.5 * (before + after))
    close(log.top_speed, np.max([np.hypot(*after[:2]) for _, _, after in states], axis=0))
