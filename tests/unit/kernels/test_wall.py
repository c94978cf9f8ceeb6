"""Half bonds to the wall of a grid: forces are the derivatives of one energy, and follow the law of bonds."""

import numpy as np
import pytest

from dembound.kernels.tables import WallTies
from dembound.kernels.wall import tie_forces, wall_forces

PARTICLES, NODES, ELEMENTS, POINTS = 9, 30, 2, 3
TIES = 5
SUPPORTED = PARTICLES + NODES
LINES = np.random.default_rng(1).permutation(SUPPORTED)
"""Line in the support table of every particle and node."""


def ties(seed: int = 2, **changes: object) -> WallTies:
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0.0, 2.0 * np.pi, TIES)
    particle = np.array([0, 3, 3, 5, 7])
    node = PARTICLES + rng.permutation(NODES)[: ELEMENTS * POINTS**2].reshape(ELEMENTS, POINTS, POINTS)
    along, along_slope, up, up_slope = rng.normal(size=(4, POINTS, TIES))
    made = WallTies(
        start=np.array([0, 2, TIES]),
        node=node,
        line=LINES[node],
        particle=particle,
        particle_line=LINES[particle],
        twin=np.array([-1, 1, 1, -1, 2]),
        along=along,
        along_slope=along_slope,
        up=up,
        up_slope=up_slope,
        corrector=rng.normal(size=(3, 4, TIES)),
        normal=np.stack([np.cos(angle), np.sin(angle)]),
        arm=rng.uniform(0.5, 1.0, TIES),
        stiffness=rng.uniform(0.5, 2.0, (3, TIES)),
        lag=0.0,
        field=np.full((6, TIES), np.nan),
        row=np.full((2, TIES), np.nan),
    )
    return made._replace(**changes)


def motion(seed: int = 3) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(3, SUPPORTED))


def energy_of(bundle: WallTies, u: np.ndarray) -> float:
    return tie_forces(bundle, u, np.zeros_like(u), np.zeros((SUPPORTED, 3)), 0.0)


def forces(bundle: WallTies, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Forces (n, 3) by particle and node."""
    force = np.zeros((SUPPORTED, 3))
    wall_forces(bundle, u, v, force)
    return force[LINES]


@pytest.mark.parametrize("relative", [False, True])
def test_forces_are_the_derivatives_of_the_energy(relative) -> None:
    bundle, u = ties(), motion()
    if not relative:
        bundle = bundle._replace(twin=np.full(TIES, -1))
    twins = bundle.twin[bundle.twin >= 0]
    force = forces(bundle, u, np.zeros_like(u))
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
    bundle, u = ties(corrector=np.zeros((3, 4, TIES)), twin=np.full(TIES, -1)), motion()
    one = np.zeros((POINTS, TIES))
    one[1] = 1.0
    bundle = bundle._replace(along=one, up=one, start=np.array([0, TIES, TIES]))
    expected = np.zeros((SUPPORTED, 3))
    wall = bundle.node[0, 1, 1]
    for t in range(TIES):
        i, n = bundle.particle[t], bundle.normal[:, t]
        way = np.array([-n[1], n[0]])
        apart = u[:2, wall] - u[:2, i]
        pull = bundle.stiffness[0, t] * (n @ apart)
        shear = bundle.stiffness[1, t] * (way @ apart - bundle.arm[t] * u[2, i])
        force = pull * n + shear * way
        expected[i] += [*force, bundle.arm[t] * shear - bundle.stiffness[2, t] * u[2, i]]
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


def test_forces_add_to_what_is_there() -> None:
    bundle, u = ties(), motion()
    already = np.random.default_rng(5).normal(size=(SUPPORTED, 3))
    both = already.copy()
    wall_forces(bundle, u, u, both)
    alone = np.zeros((SUPPORTED, 3))
    wall_forces(bundle, u, u, alone)
    np.testing.assert_allclose(both, already + alone, rtol=0.0, atol=1e-13)
