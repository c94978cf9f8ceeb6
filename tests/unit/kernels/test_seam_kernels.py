"""What free-field columns do in the kernels: forces across the seam, and dashpots that follow a twin."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from dembound.kernels import tables
from dembound.kernels.bonded import seam_ends_forces
from dembound.kernels.elastic import seam_forces
from dembound.kernels.step import move_supported, note_before

PARTICLES, TYPES = 12, 9
TWINS = np.array([-1, 3, 7, 3, 5])
"""Of five nodes; the first has none, the last one nothing across the seam."""
MANY = np.array([0, 3, 1, 2, 0])
STEP = 0.1


def ids(values: np.ndarray) -> np.ndarray:
    return values.astype(np.uint32)


@dataclass
class Contacts:
    """Contacts of the twins with random neighbours, of random types and ends."""

    start: np.ndarray
    neighbour: np.ndarray
    contact_type: np.ndarray
    end: np.ndarray


@pytest.fixture
def contacts() -> Contacts:
    rng = np.random.default_rng(4)
    start, e = np.concatenate([[0], np.cumsum(MANY)]), MANY.sum()
    neighbour, contact_type, end = (
        rng.integers(0, PARTICLES, e),
        rng.integers(0, TYPES, e),
        rng.integers(0, 2 * TYPES, e),
    )
    return Contacts(ids(start), ids(neighbour), ids(contact_type), ids(end))


def already() -> np.ndarray:
    """Forces and moments (5, 3) that another tie has brought, whole numbers, to which sums add exactly."""
    return np.arange(15.0).reshape(5, 3) - 7.0


def summed(contacts: Contacts, force: Callable[[int, int], np.ndarray]) -> np.ndarray:
    """Forces and moments (5, 3) of the nodes, contact by contact; force gets the twin and the contact's number."""
    total = np.zeros((len(TWINS), 3))
    for node, (twin, first) in enumerate(zip(TWINS, contacts.start, strict=False)):
        for e in range(first, first + MANY[node]):
            total[node] += force(twin, e)
    return total


def test_the_elastic_laws_seam_forces_are_sums_over_the_twins_contacts(contacts: Contacts) -> None:
    rng = np.random.default_rng(5)
    u, angle = rng.uniform(-1.0, 1.0, (3, PARTICLES)), rng.uniform(0.0, 2.0 * np.pi, TYPES)
    k_n, k_s, k_r, arm_i, arm_j = rng.uniform(0.5, 2.0, (5, TYPES))
    n, t = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    root_s = np.sqrt(k_s)
    constants = np.column_stack([*(np.sqrt(k_n) * n), root_s / np.sqrt(k_n), root_s * arm_i, root_s * arm_j, k_r])

    def force(i: int, e: int) -> np.ndarray:
        j, k = contacts.neighbour[e], contacts.contact_type[e]
        apart = u[:2, j] - u[:2, i]
        slip = t[:, k] @ apart - arm_i[k] * u[2, i] - arm_j[k] * u[2, j]
        moment = arm_i[k] * k_s[k] * slip + k_r[k] * (u[2, j] - u[2, i])
        return np.array([*(k_n[k] * (n[:, k] @ apart) * n[:, k] + k_s[k] * slip * t[:, k]), moment])

    across = np.zeros((len(TWINS), 3))
    seam = tables.Seam(TWINS, contacts.start, contacts.neighbour, contacts.contact_type, constants)
    seam_forces(seam, u, u, across)

    # sums of three forces of some ten
    np.testing.assert_allclose(across, summed(contacts, force), rtol=0.0, atol=1e-14)
    # they add to what is there
    both = already()
    seam_forces(seam, u, u, both)
    assert np.array_equal(both, already() + across)


def test_the_seam_forces_of_pairs_with_a_memory_are_sums_over_the_twins_ends(contacts: Contacts, random_pairs) -> None:
    pairs = random_pairs(PARTICLES, TYPES)
    pairs.force[:] = np.random.default_rng(6).uniform(-1.0, 1.0, pairs.force.shape)

    def force(_: int, e: int) -> np.ndarray:
        pair, second = divmod(int(contacts.end[e]), 2)
        fx, fy, *moments = pairs.force[:, pair]
        return np.array([-fx, -fy, moments[1]] if second else [fx, fy, moments[0]])

    across, u = np.zeros((len(TWINS), 3)), np.full((3, PARTICLES), np.nan)
    seam = tables.SeamEnds(contacts.start, contacts.end, pairs.force)
    seam_ends_forces(seam, u, u, across)

    assert np.array_equal(across, summed(contacts, force))
    # they add to what is there
    both = already()
    seam_ends_forces(seam, u, u, both)
    assert np.array_equal(both, already() + across)


class Following:
    """Three supported nodes: 2 with dashpots at rest, 5 that follows it, 6 that follows particle 0, which is free."""

    nodes = np.array([2, 5, 6])
    twin = np.array([-1, 2, 0])
    free_ones = np.array([0, 1, 3, 4])

    def __init__(self, damp: float) -> None:
        self.damp = damp
        rng = np.random.default_rng(7)
        self.u, self.before, self.after = rng.uniform(-1.0, 1.0, (3, 3, 7))
        self.inertia, self.damping, self.stiffness, self.follow = rng.uniform(0.5, 2.0, (4, 3, 3))
        self.follow[0] = 0.0
        self.force, self.across, self.drive = rng.uniform(-1.0, 1.0, (3, 3, 3))
        self.across[0] = 0.0
        self.force += self.across

    def bundles(self) -> tuple[tables.Supports, tables.Body, tables.Log]:
        """As the kernel takes it."""
        nobody = np.zeros(0, dtype=np.int64)
        mobility = 1.0 / (self.inertia / STEP + 0.5 * self.damping)
        keep = mobility * (self.inertia / STEP - 0.5 * self.damping)
        prescribed, drive = np.zeros((3, 3)), self.drive[None]
        supports = tables.Supports(
            self.nodes, self.inertia / STEP, keep, mobility, self.stiffness, prescribed, drive, self.twin, self.follow
        )
        body = tables.Body(np.zeros(7), np.zeros(7), np.ones(3), np.zeros((3, 0)), self.damp, STEP)
        log = tables.Log(
            nobody, np.zeros((1, 0, 6)), nobody, np.zeros((0, 3, 2)), np.zeros(0), np.zeros((2, 7)), np.zeros(1)
        )
        return supports, body, log

    def expected(self) -> tuple[np.ndarray, np.ndarray]:
        """Velocities (3, 7) after the step; work (2, 2) of the outside and of damping, whole and up to the middle."""
        v = self.before.copy()
        v[:, self.free_ones] = self.after[:, self.free_ones]
        work = np.zeros((2, 2))
        for s, (i, twin) in enumerate(zip(self.nodes, self.twin, strict=True)):
            for c in range(3):
                m, C, was = self.inertia[s, c], self.damping[s, c], self.before[c, i]
                outside = self.drive[s, c] - self.stiffness[s, c] * self.u[c, i]
                # of all that pushes, also across the seam, but for dashpots: it acts on the twin alike
                drag = -self.damp * abs(self.force[s, c] + outside) * np.sign(was)
                if twin >= 0:  # the dashpot's other end, at the middle of the step as its own
                    outside += self.follow[s, c] * 0.5 * (self.before[c, twin] + v[c, twin])
                total = self.force[s, c] + outside + drag
                v[c, i] = ((m / STEP - C / 2.0) * was + total) / (m / STEP + C / 2.0)
                mean = 0.5 * (was + v[c, i])
                push = outside - C * mean + self.across[s, c]
                work += STEP * np.outer([mean, 0.5 * was], [push, -drag])
        return v, work


@pytest.mark.parametrize("damp", [0.0, 0.3])
def test_a_dashpot_follows_its_twin_at_the_middle_of_the_step_supported_or_not(damp: float) -> None:
    model = Following(damp)
    supports, body, log = model.bundles()
    v, u_next, followed = model.before.copy(), np.full((3, 7), np.nan), np.empty((3, 3))
    note_before(0, model.u, v, log.probes, log.record, supports.twin, followed)
    v[:, model.free_ones] = model.after[:, model.free_ones]  # the free ones move first
    u_next[:, model.nodes] = (model.force - model.across).T  # where the contacts' forces wait
    move_supported(
        0, model.u, v, u_next, model.across, followed, supports, body, log.work, np.zeros((3, 3, len(supports.nodes)))
    )
    expected, work = model.expected()

    # some ten operations on numbers of size 1 to 10
    np.testing.assert_allclose(v, expected, rtol=0.0, atol=1e-14)
    moved = model.u + STEP * expected
    np.testing.assert_allclose(u_next[:, model.nodes], moved[:, model.nodes], rtol=0.0, atol=1e-14)
    assert np.isnan(u_next[:, model.free_ones]).all()
    # of nine components; what comes across the seam is the outside's work
    np.testing.assert_allclose(log.work[:, :2], work, rtol=0.0, atol=1e-13)
