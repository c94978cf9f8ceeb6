"""The compiled step against the same equations written down plainly."""

from dataclasses import dataclass

import numba
import numpy as np
import pytest

from dembound.kernels.elastic import advance, contact_forces

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
    mass: np.ndarray
    inertia: np.ndarray

    def forces(self, u: np.ndarray) -> np.ndarray:
        """Forces and moments (3, n) of motions u (3, n), contact by contact."""
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

    def rows(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """The contacts as the kernels take them: start, neighbour, kind, palette."""
        lines, owner, neighbour = [], [], []
        for b, (i, j) in enumerate(self.pairs):
            root_n, root_s = np.sqrt(self.k_n[b]), np.sqrt(self.k_s[b])
            common = [root_n * self.normal[b, 0], root_n * self.normal[b, 1], root_s / root_n]
            lines.append([*common, root_s * self.arm_i[b], root_s * self.arm_j[b], self.k_r[b]])
            lines.append([*common, -root_s * self.arm_j[b], -root_s * self.arm_i[b], self.k_r[b]])
            owner += [i, j]
            neighbour += [j, i]
        order = np.argsort(owner, kind="stable")
        start = np.concatenate([[0], np.cumsum(np.bincount(owner, minlength=PARTICLES))])
        index = np.uint32
        return start.astype(index), np.array(neighbour)[order].astype(index), order.astype(index), np.array(lines)


@pytest.fixture(scope="module")
def bodies() -> Bodies:
    rng = np.random.default_rng(7)
    pairs = np.array([rng.choice(PARTICLES, 2, replace=False) for _ in range(CONTACTS)])
    angle = rng.uniform(0.0, 2.0 * np.pi, CONTACTS)
    k_n, k_s, k_r, arm_i, arm_j = rng.uniform(0.5, 2.0, (5, CONTACTS))
    mass, inertia = rng.uniform(0.5, 2.0, (2, PARTICLES))
    normal = np.column_stack([np.cos(angle), np.sin(angle)])
    return Bodies(pairs, normal, k_n, k_s, k_r, arm_i, arm_j, mass, inertia)


@dataclass
class Table:
    """Supports of k nodes in physical terms, (k, 3) each; `prescribed` components take `push` as their velocity."""

    nodes: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    preload: np.ndarray
    prescribed: np.ndarray
    push: np.ndarray

    def coefficients(self, bodies: Bodies) -> tuple[np.ndarray, ...]:
        """keep, mobility, stiffness, preload, prescribed and drive as the kernel takes them."""
        inertia = np.column_stack([bodies.mass, bodies.mass, bodies.inertia])[self.nodes] / TIME_STEP
        mobility = np.where(self.prescribed, 0.0, 1.0 / (inertia + 0.5 * self.damping))
        keep = mobility * (inertia - 0.5 * self.damping)
        return keep, mobility, self.stiffness, self.preload, self.prescribed.astype(float), self.push


def supports(steps: int, damped: bool = True) -> Table:
    """Five supported nodes with dashpots, springs, preloads and drives; the last is prescribed in x and rotation."""
    rng = np.random.default_rng(3)
    shape = (5, 3)
    prescribed = np.zeros(shape, dtype=bool)
    prescribed[4, [0, 2]] = True
    damping, stiffness, preload = rng.uniform(0.0, 2.0, (3, *shape))
    push = rng.uniform(-1.0, 1.0, (steps, *shape))
    return Table(np.array([2, 3, 11, 17, 29]), damping * damped, stiffness, preload, prescribed, push)


def leapfrog(bodies: Bodies, table: Table, u: np.ndarray, v: np.ndarray, free: np.ndarray, damp: float) -> list:
    """Central differences, one particle and component at a time; (u, v before, v after) of every step."""
    inertia = np.stack([bodies.mass, bodies.mass, bodies.inertia])
    line = {node: k for k, node in enumerate(table.nodes)}
    states = []
    for push in table.push:
        force, after = bodies.forces(u), v.copy()
        for c in range(3):
            for i in range(PARTICLES):
                F, C, drive, prescribed = force[c, i], 0.0, 0.0, False
                if i in line:
                    k = line[i]
                    C, drive, prescribed = table.damping[k, c], push[k, c], table.prescribed[k, c]
                    F += table.preload[k, c] - table.stiffness[k, c] * u[c, i] + drive
                # Cundall's damping acts on the whole unbalanced force, applied ones included
                F -= damp * abs(F) * np.sign(v[c, i])
                m = inertia[c, i]
                # m (v⁺ − v)/Δt = F − C (v⁺ + v)/2
                moved = ((m / TIME_STEP - C / 2.0) * v[c, i] + F) / (m / TIME_STEP + C / 2.0)
                after[c, i] = drive if prescribed else moved * free[c]
        states.append((u, v, after))
        u, v = u + TIME_STEP * after, after
    return [*states, (u, v, v)]


def start(free: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Random displacement and velocity (3, n), at rest in held components."""
    rng = np.random.default_rng(5)
    return tuple(rng.uniform(-1.0, 1.0, (2, 3, PARTICLES)) * free[:, None])


def run_kernel(
    bodies: Bodies, table: Table, u: np.ndarray, v: np.ndarray, free: np.ndarray, damp: float
) -> tuple[np.ndarray, np.ndarray]:
    """Advance u and v in place with the kernel; the record (steps, n, 6) and the peaks (n, 3, 2) of all particles."""
    keep, mobility, stiffness, preload, prescribed, push = table.coefficients(bodies)
    held = np.ones_like(keep) * free
    everyone = np.arange(PARTICLES)
    record, peaks = np.empty((len(push), PARTICLES, 6)), np.zeros((PARTICLES, 3, 2))
    advance(
        u, np.empty_like(u), v, *bodies.rows(),
        TIME_STEP / bodies.mass, TIME_STEP / bodies.inertia, free, damp, TIME_STEP,
        table.nodes, keep * held, mobility * held, stiffness, preload, prescribed, push * held,
        everyone, record, everyone, peaks,
    )  # fmt: skip
    return record, peaks


def close(found: np.ndarray, expected: np.ndarray) -> None:
    """Equal but for rounding.

    A force sums some ten contacts of size 1; a stable step passes errors on undiminished but does not multiply
    them: 10 steps of 100 operations of 1.1e-16 each, on values of size 1.
    """
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13)


def test_row_forces_are_those_of_the_contacts(bodies: Bodies) -> None:
    u, _ = start(FREE)
    found = np.empty_like(u)
    contact_forces(u, *bodies.rows(), found)

    close(found, bodies.forces(u))


def test_a_rigid_turn_needs_no_force_where_arms_fit_the_places() -> None:
    # two disks 3 apart along an oblique normal, turned by ω about the origin; arms 1 and 2
    n = np.array([0.6, 0.8])
    pair = Bodies(np.array([[0, 1]]), n[None], *np.array([[5.0], [3.0], [2.0], [1.0], [2.0]]), np.ones(30), np.ones(30))
    places, turn = np.zeros((PARTICLES, 2)), 1e-3
    places[1] = 3.0 * n
    u = np.stack([-turn * places[:, 1], turn * places[:, 0], np.full(PARTICLES, turn)])
    found = np.empty_like(u)
    contact_forces(u, *pair.rows(), found)

    # terms of size k·ω·3 cancel: 15 · 1e-3 · 1.1e-16 · some operations
    np.testing.assert_allclose(found, 0.0, atol=1e-16)


@pytest.mark.parametrize("steps", [1, 2, 9, 10])
@pytest.mark.parametrize("damp", [0.0, DAMP])
def test_steps_are_those_of_a_plain_leapfrog(bodies: Bodies, steps: int, damp: float) -> None:
    table = supports(steps)
    u, v = start(FREE)
    *_, (expected_u, expected_v, _) = leapfrog(bodies, table, u.copy(), v.copy(), FREE, damp)
    run_kernel(bodies, table, u, v, FREE, damp)

    close(u, expected_u)
    close(v, expected_v)


def test_a_held_component_stays_where_it_is(bodies: Bodies) -> None:
    free, table = np.array([1.0, 0.0, 1.0]), supports(9)
    u, v = start(free)
    *_, (expected_u, expected_v, _) = leapfrog(bodies, table, u.copy(), v.copy(), free, 0.0)
    run_kernel(bodies, table, u, v, free, 0.0)

    assert not u[1].any()
    assert not v[1].any()
    close(u, expected_u)
    close(v, expected_v)


def test_without_supports_momentum_is_kept(bodies: Bodies) -> None:
    table = supports(10)
    nothing = Table(table.nodes[:0], *(np.zeros((0, 3)) for _ in range(4)), push=np.zeros((10, 0, 3)))
    u, v = start(FREE)
    before = (v[:2] * bodies.mass).sum(axis=1)
    run_kernel(bodies, nothing, u, v, FREE, 0.0)

    # 30 momenta of size 1 over 10 steps, errors of 1.1e-16 each time
    np.testing.assert_allclose((v[:2] * bodies.mass).sum(axis=1), before, atol=1e-13)


def test_the_record_holds_the_state_at_the_start_of_each_step(bodies: Bodies) -> None:
    table = supports(9)
    u, v = start(FREE)
    states = leapfrog(bodies, table, u.copy(), v.copy(), FREE, 0.0)[:-1]
    record, peaks = run_kernel(bodies, table, u, v, FREE, 0.0)

    for row, (then, before, after) in zip(record, states, strict=True):
        close(row[:, :3].T, then)
        close(row[:, 3:].T, 0.5 * (before + after))
    speeds = np.array([after.T for _, _, after in states])
    close(peaks[..., 0], np.minimum(speeds.min(axis=0), 0.0))
    close(peaks[..., 1], np.maximum(speeds.max(axis=0), 0.0))


def test_a_run_may_be_cut_anywhere(bodies: Bodies) -> None:
    whole, cut = start(FREE), start(FREE)
    run_kernel(bodies, supports(9), *whole, FREE, DAMP)
    for part in (slice(0, 4), slice(4, 9)):
        table = supports(9)
        table.push = table.push[part]
        run_kernel(bodies, table, *cut, FREE, DAMP)

    assert np.array_equal(whole, cut)


def test_motion_that_dies_out_comes_to_rest(bodies: Bodies) -> None:
    # far below 1e-250 a dashpot would leave denormal numbers; they count as rest
    table = supports(1)
    nothing = Table(table.nodes[:0], *(np.zeros((0, 3)) for _ in range(4)), push=np.zeros((1, 0, 3)))
    u, v = np.zeros((3, PARTICLES)), np.full((3, PARTICLES), 1e-260)
    run_kernel(bodies, nothing, u, v, FREE, 0.0)

    assert not v.any()
    assert not u.any()


@pytest.mark.skipif(numba.config.NUMBA_NUM_THREADS < 2, reason="needs two threads")
def test_any_number_of_threads_gives_the_same_bits(bodies: Bodies) -> None:
    before, results = numba.get_num_threads(), []
    try:
        for threads in (1, 2):
            numba.set_num_threads(threads)
            u, v = start(FREE)
            run_kernel(bodies, supports(9), u, v, FREE, DAMP)
            results.append((u, v))
    finally:
        numba.set_num_threads(before)

    assert np.array_equal(*results)
