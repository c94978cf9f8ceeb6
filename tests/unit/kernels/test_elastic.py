"""The compiled step against a plain implementation."""

from dataclasses import dataclass

import numpy as np
import pytest
from plain_kernels import behind, random_pairs, stepped

from dembound.kernels import near, tables
from dembound.kernels.common import CHUNKS, DONE, LAW_ENDS, LIST_ENDS
from dembound.kernels.contact_measures import slack
from dembound.kernels.contacts import BONDED
from dembound.kernels.elastic import contact_forces
from dembound.kernels.loop import advance
from dembound.laws.law import Limits

PARTICLES, CONTACTS = 30, 70
TIME_STEP = 0.02
DAMP = 0.3
FREE = np.array([1.0, 1.0, 1.0])


@dataclass
class Bodies:
    """Random contacts between random particles; nothing but the contacts' own constants decides their forces."""

    pairs: np.ndarray
    normal: np.ndarray
    k_n: np.ndarray
    k_s: np.ndarray
    k_r: np.ndarray
    arm_i: np.ndarray
    arm_j: np.ndarray

    def forces(self, u: np.ndarray, v: np.ndarray | None = None) -> np.ndarray:
        """Forces and moments (3, n) of motions u (3, n), contact by contact; velocities do not matter."""
        total = np.zeros_like(u)
        for b, (i, j) in enumerate(self.pairs):
            n = self.normal[b]
            t = np.array([-n[1], n[0]])
            apart = u[:2, j] - u[:2, i]
            slip = t @ apart - self.arm_i[b] * u[2, i] - self.arm_j[b] * u[2, j]
            force = self.k_n[b] * (n @ apart) * n + self.k_s[b] * slip * t
            bending = self.k_r[b] * (u[2, j] - u[2, i])
            total[:2, i] += force
            total[:2, j] -= force
            total[2, i] += self.arm_i[b] * self.k_s[b] * slip + bending
            total[2, j] += self.arm_j[b] * self.k_s[b] * slip - bending
        return total

    def rows(self, begin: int = 0) -> tables.NeighbourTable:
        """The contacts as the kernels take them; begin : number of the first particle."""
        constants, owner, neighbour = [], [], []
        for b, (i, j) in enumerate(self.pairs):
            root_n, root_s = np.sqrt(self.k_n[b]), np.sqrt(self.k_s[b])
            common = [root_n * self.normal[b, 0], root_n * self.normal[b, 1], root_s / root_n]
            constants.append([*common, root_s * self.arm_i[b], root_s * self.arm_j[b], self.k_r[b]])
            constants.append([*common, -root_s * self.arm_j[b], -root_s * self.arm_i[b], self.k_r[b]])
            owner += [i, j]
            neighbour += [j, i]
        order = np.argsort(owner, kind="stable")
        start = np.concatenate([np.zeros(begin + 1), np.cumsum(np.bincount(owner, minlength=PARTICLES))])
        index = np.uint32
        neighbour = (begin + np.array(neighbour)[order]).astype(index)
        return tables.NeighbourTable(begin, start.astype(index), neighbour, order.astype(index), np.array(constants))

    def links(self, begin: int = 0) -> tables.Links:
        """The law on them."""
        return tables.Links(self.rows(begin), np.zeros(CHUNKS), np.zeros((CHUNKS, 2)))


@pytest.fixture(scope="module")
def bodies() -> Bodies:
    rng = np.random.default_rng(7)
    pairs = np.array([rng.choice(PARTICLES, 2, replace=False) for _ in range(CONTACTS)])
    angle = rng.uniform(0.0, 2.0 * np.pi, CONTACTS)
    k_n, k_s, k_r, arm_i, arm_j = rng.uniform(0.5, 2.0, (5, CONTACTS))
    normal = np.column_stack([np.cos(angle), np.sin(angle)])
    return Bodies(pairs, normal, k_n, k_s, k_r, arm_i, arm_j)


def start(free: np.ndarray = FREE) -> tuple[np.ndarray, np.ndarray]:
    """Random displacement and velocity (3, n), at rest in held components."""
    rng = np.random.default_rng(5)
    return tuple(rng.uniform(-1.0, 1.0, (2, 3, PARTICLES)) * free[:, None])


def run_kernel(bodies: Bodies, model, u: np.ndarray, v: np.ndarray, laws: tuple = ()) -> tuple[int, int, tables.Log]:
    """Advance u and v in place with the kernel, under the plain elastic law if there are no others.

    Returns steps done, why it stopped, and the log of all particles.
    """
    body, supports, log = model.bundles()
    laws = laws or (bodies.links(),)
    done, why = advance(u, np.empty_like(u), v, 0, laws, (), None, body, supports, log)
    return done, why, log


def close(found: np.ndarray, expected: np.ndarray) -> None:
    """Equal but for rounding.

    A force sums some ten contacts of size 1; a stable step passes errors on undiminished but does not multiply
    them: 10 steps of 100 operations of 1.1e-16 each, on values of size 1.
    """
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13)


def test_row_forces_are_those_of_the_contacts_and_leave_the_particles_before_alone(bodies: Bodies) -> None:
    others, (u, _) = 4, start()
    there = np.hstack([np.full((3, others), np.nan), u])
    found = np.full_like(there, 7.0)
    contact_forces(there, bodies.rows(begin=others), found)

    assert np.all(found[:, :others] == 7.0)
    close(found[:, others:], bodies.forces(u))


@pytest.mark.parametrize(
    ("steps", "damp", "loaded", "held"),
    [(1, 0.0, False, False), (2, DAMP, True, False), (9, DAMP, True, False), (10, 0.0, True, True)],
)
def test_steps_and_their_log_are_those_of_a_plain_leapfrog(bodies: Bodies, steps, damp, loaded, held) -> None:
    free = np.array([1.0, 0.0, 1.0]) if held else FREE
    model = stepped(PARTICLES, steps, TIME_STEP, damp=damp, loaded=loaded, free=free)
    u, v = start(free)
    *states, (expected_u, expected_v, _) = model.leapfrog(bodies.forces, u, v)
    done, why, log = run_kernel(bodies, model, u, v)

    assert (done, why) == (steps, DONE)
    close(u, expected_u)
    close(v, expected_v)
    assert not held or not (u[1].any() or v[1].any())
    # the work of supports and damping, whole and up to the middle of the last step
    assert model.work[0, 0] != model.work[1, 0]
    assert model.work[:, 1].any() == (damp > 0.0)
    close(log.work, model.work)
    # the record holds the state at the start of each step
    for row, (then, before, after) in zip(log.record, states, strict=True):
        close(row[:, :3].T, then)
        close(row[:, 3:].T, 0.5 * (before + after))
    speeds = np.array([after.T for _, _, after in states])
    close(log.peaks[..., 0], np.minimum(speeds.min(axis=0), 0.0))
    close(log.peaks[..., 1], np.maximum(speeds.max(axis=0), 0.0))
    close(log.top_speed, np.hypot(speeds[..., 0], speeds[..., 1]).max(axis=0))


ONE, WRAPS = np.ones(2, dtype=np.int64), np.ones(2, dtype=bool)
EVERY = tables.Cells(np.array([0, PARTICLES]), np.arange(PARTICLES), ONE, WRAPS, reach=np.inf)
"""One cell with all particles."""


def watched(bodies: Bodies, **changes: object) -> tables.WatchedLinks:
    """The law on watch over random pairs of strong bonds that start within it."""
    pairs = random_pairs(PARTICLES, CONTACTS, gap=0.3)
    limits = Limits(friction=5.0, tension=1e3, cohesion=1e3, tan_fa=0.0, geometry=BONDED)
    arms = np.full(PARTICLES, 1.1)  # half of the longest distance, and the largest difference of radii
    links, origin, skins = bodies.links(), np.zeros((2, PARTICLES)), np.full(PARTICLES, 1e3)
    return tables.WatchedLinks(links, pairs, limits, origin, skins, EVERY, arms, np.zeros(2))._replace(**changes)


def calm() -> tuple[np.ndarray, np.ndarray]:
    """Undeformed, at a fifth of the usual speed."""
    _, v = start()
    return np.zeros_like(v), 0.2 * v


@pytest.mark.parametrize(("skin", "reason"), [(1e3, LAW_ENDS), (0.05, LIST_ENDS)])
def test_no_step_begins_outside_the_elastic_law_or_with_a_list_that_is_too_old(
    bodies: Bodies, skin: float, reason: int
) -> None:
    watch, model = watched(bodies, skins=np.full(PARTICLES, 0.5 * skin)), stepped(PARTICLES, 150, TIME_STEP)
    u, v = calm()
    states = model.leapfrog(bodies.forces, u, v)
    done, why, _ = run_kernel(bodies, model, u, v, (watch,))

    room = np.array([slack(then, watch.contacts, watch.limits, False) for then, _, _ in states])
    left = np.array([near.room(then, 0, watch.origin, watch.skins, watch.cells) for then, _, _ in states])
    assert why == reason
    assert 2 < done < 150
    assert done == np.argmax((room < 0.0) | (left < 0.0))
    close(u, states[done][0])
    close(v, states[done][1])


def test_a_supported_node_that_begins_to_spin_ends_the_law_at_once(bodies: Bodies) -> None:
    model = stepped(2 * PARTICLES, 5, TIME_STEP, loaded=False)
    assert model.nodes[-1] >= PARTICLES
    model.push[:] = 0.0
    model.push[:, -1, 2] = 60.0  # rad/s, prescribed
    weak = Limits(friction=5.0, tension=0.5, cohesion=1e3, tan_fa=0.0, geometry=BONDED)  # breaks soon by bending
    watch, parts = watched(bodies, limits=weak), (slice(0, PARTICLES), slice(PARTICLES, None))
    arms, pairs = np.concatenate([np.zeros(PARTICLES), watch.arms]), behind(watch.contacts, PARTICLES)
    later = watch._replace(links=bodies.links(begin=PARTICLES), contacts=pairs, arms=arms)
    u, v = np.zeros((2, 3, 2 * PARTICLES))
    states = model.leapfrog(lambda u, _: np.hstack([bodies.forces(u[:, part]) for part in parts]), u, v)
    done, why, _ = run_kernel(bodies, model, u, v, (bodies.links(), later))

    room = np.array([slack(then, later.contacts, later.limits, False) for then, _, _ in states])
    assert why == LAW_ENDS
    # it spins from the first step on, before anything else moves: its speed of before that step says nothing
    assert done == np.argmax(room < 0.0) == 1
    close(u, states[done][0])
    close(v, states[done][1])
