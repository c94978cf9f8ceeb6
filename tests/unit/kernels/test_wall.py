"""Half bonds to the wall of a grid: forces are the derivatives of one energy, and follow the law of bonds."""

from typing import NamedTuple

import numpy as np
import pytest

from dembound.kernels.tables import Repeats, WallTies
from dembound.kernels.wall import repeated_forces, tie_forces, wall_forces

PARTICLES, NODES, ELEMENTS, POINTS = 9, 30, 2, 3
TIES = 5
SUPPORTED = PARTICLES + NODES
LINES = np.random.default_rng(1).permutation(SUPPORTED)
"""Line in the support table of every particle and node."""


class Given(NamedTuple):
    """Ties one by one, (…, t), the first two of one element."""

    particle: np.ndarray
    twin: np.ndarray
    along: np.ndarray
    along_slope: np.ndarray
    up: np.ndarray
    up_slope: np.ndarray
    corrector: np.ndarray
    normal: np.ndarray
    arm: np.ndarray
    stiffness: np.ndarray


def given(**changes: np.ndarray) -> Given:
    rng = np.random.default_rng(2)
    angle = rng.uniform(0.0, 2.0 * np.pi, TIES)
    shapes = rng.normal(size=(4, POINTS, TIES))
    made = Given(
        particle=np.array([0, 3, 3, 5, 7]),
        twin=np.array([-1, 1, 1, -1, 2]),
        along=shapes[0],
        along_slope=shapes[1],
        up=shapes[2],
        up_slope=shapes[3],
        corrector=rng.normal(size=(12, TIES)),
        normal=np.stack([np.cos(angle), np.sin(angle)]),
        arm=rng.uniform(0.5, 1.0, TIES),
        stiffness=rng.uniform(0.5, 2.0, (3, TIES)),
    )
    return made._replace(**changes)


def ties(of: Given | None = None, lag: float = 0.0) -> WallTies:
    """The same in blocks of eight, one for each element."""
    of = of or given()
    place = np.array([0, 1, 8, 9, 10])

    def laid(values: np.ndarray, fill: float = 0.0) -> np.ndarray:
        wide = np.full((*values.shape[:-1], 16), fill, dtype=values.dtype)
        wide[..., place] = values
        return wide

    def in_blocks(values: np.ndarray) -> np.ndarray:
        return np.concatenate([laid(values)[:, :8].ravel(), laid(values)[:, 8:].ravel()])

    node = PARTICLES + np.random.default_rng(6).permutation(NODES)[: ELEMENTS * POINTS**2].reshape(ELEMENTS, -1)
    particle = laid(of.particle)
    return WallTies(
        points=tuple(np.linspace(-1.0, 1.0, POINTS).tolist()),
        start=np.array([0, 1, 2]),
        node=node,
        line=LINES[node],
        reach=np.tile([0, POINTS, 0, POINTS], (ELEMENTS, 1)),
        particle=particle,
        particle_line=LINES[particle],
        twin=laid(of.twin, -1),
        along=in_blocks(of.along),
        along_slope=in_blocks(of.along_slope),
        up=in_blocks(of.up),
        up_slope=in_blocks(of.up_slope),
        corrector=in_blocks(of.corrector),
        normal=laid(of.normal).ravel(),
        arm=laid(of.arm),
        stiffness=laid(of.stiffness).ravel(),
        lag=lag,
        moved=np.full(2 * POINTS**2, np.nan),
        reaction=np.full(16 * POINTS**2, np.nan),
        field=np.full(48, np.nan),
        own=np.full(24, np.nan),
    )


def motion(seed: int = 3) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(3, SUPPORTED))


def energy_of(bundle: WallTies, u: np.ndarray) -> float:
    return tie_forces(bundle, u, np.zeros_like(u), np.zeros((SUPPORTED, 3)), 0.0)


def forces(bundle: WallTies, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Forces (n, 3) by particle and node."""
    force = np.zeros((SUPPORTED, 3))
    wall_forces(bundle, u, v, force)
    return force[LINES]


def test_forces_are_the_derivatives_of_the_energy_and_add_to_what_is_there() -> None:
    of, u = given(), motion()
    bundle, twins = ties(of), of.twin[of.twin >= 0]
    already = np.random.default_rng(5).normal(size=(SUPPORTED, 3))
    both = already.copy()
    wall_forces(bundle, u, np.zeros_like(u), both)
    force = (both - already)[LINES]
    for i in range(SUPPORTED):
        for c in range(3):
            ahead, behind = u.copy(), u.copy()
            ahead[c, i] += 1.0
            behind[c, i] -= 1.0
            slope = 0.5 * (energy_of(bundle, ahead) - energy_of(bundle, behind))  # exact, as it is a square
            own = 0.0 if i in twins else slope  # nothing acts on the free field
            # differences of energies of some 1,000 J
            assert force[i, c] == pytest.approx(-own, abs=1e-11)
    assert np.abs(force[PARTICLES:, :2]).max() > 1.0
    assert not force[PARTICLES:, 2].any()


def test_a_tie_is_half_a_bond() -> None:
    """One tie at a node of the wall, against the law: n·Δu, t·Δu − lθ, and no rotation of the wall."""
    one = np.zeros((POINTS, TIES))
    one[1] = 1.0
    of, u = given(corrector=np.zeros((12, TIES)), twin=np.full(TIES, -1), along=one, up=one), motion()
    bundle = ties(of)
    expected = np.zeros((SUPPORTED, 3))
    for t in range(TIES):
        i, n, wall = of.particle[t], of.normal[:, t], bundle.node[int(t > 1), POINTS + 1]
        way = np.array([-n[1], n[0]])
        apart = u[:2, wall] - u[:2, i]
        pull = of.stiffness[0, t] * (n @ apart)
        shear = of.stiffness[1, t] * (way @ apart - of.arm[t] * u[2, i])
        force = pull * n + shear * way
        expected[i] += [*force, of.arm[t] * shear - of.stiffness[2, t] * u[2, i]]
        expected[wall, :2] -= force

    # sums of five forces of some ten
    np.testing.assert_allclose(forces(bundle, u, np.zeros_like(u)), expected, rtol=0.0, atol=1e-13)


def test_velocities_count_as_displacements_in_the_lag() -> None:
    bundle, u, v = ties(lag=0.3), motion(), motion(4)
    force = forces(bundle, u, v)

    np.testing.assert_allclose(force, forces(ties(), u + 0.3 * v, np.zeros_like(u)), rtol=0.0, atol=1e-11)
    # the dashpots take energy: their power is negative where nothing is displaced
    u[:] = 0.0
    v[:, bundle.twin[bundle.twin >= 0]] = 0.0
    assert np.sum(forces(bundle, u, v) * v.T) < 0.0


def test_repeated_forces_are_added_at_other_lines() -> None:
    force = np.arange(15.0).reshape(5, 3)
    repeats = Repeats(np.array([0, 4, 4]), np.array([1, 2, 3]))
    repeated_forces(repeats, motion(), motion(), force)

    before = np.arange(15.0).reshape(5, 3)
    expected = before.copy()
    expected[1:4] += before[[0, 4, 4]]
    assert np.array_equal(force, expected)
