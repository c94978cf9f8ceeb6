"""The peridynamic law in one, two and three dimensions, against elasticity and by hand."""

import numpy as np
import pytest

from dembound.laws.peridynamic import bond_forces, damage, families, micromodulus, stretch, volume_factor

EPS = np.finfo(float).eps
E, SPACING, STRAIN = 3e9, 0.5, 1e-6
POISSON = {1: 0.0, 2: 1.0 / 3.0, 3: 0.25}
"""The ratios that bonds which only pull along themselves come to, in a plate in plane stress and in space."""


def peridynamic_energy(strain: np.ndarray, horizon: int) -> float:
    """Strain energy per volume (J/m³) at a node with a whole family, under a uniform strain (d, d).

    Each bond's energy is half its force times its elongation, and half of it is this node's.
    """
    d = len(strain)
    family = families((2 * horizon + 1,) * d, horizon)
    middle = (2 * horizon + 1) ** d // 2
    mine = (family.pairs == middle).any(axis=1)
    apart = SPACING * family.offset[mine]
    volume = SPACING**d
    c_m = micromodulus(E, horizon * SPACING, d)
    moved = apart @ strain
    force = bond_forces(apart, moved, c_m, volume**2 * family.factor[mine], np.ones(len(apart), dtype=bool))
    return 0.25 * float(np.sum(force * moved)) / volume


def elastic_energy(strain: np.ndarray) -> float:
    """Strain energy per volume (J/m³) of the elastic body; in a plate λ is that of plane stress, 2μν/(1 − ν)."""
    d, nu = len(strain), POISSON[len(strain)]
    mu = 0.5 * E / (1.0 + nu)
    lame = 2.0 * mu * nu / (1.0 - (d - 1) * nu)
    return 0.5 * lame * np.trace(strain) ** 2 + mu * float(np.sum(strain**2))


@pytest.mark.parametrize("horizon", [1, 2, 3, 8])
def test_a_bar_stores_the_elastic_energy_exactly(horizon: int) -> None:
    strain = np.array([[STRAIN]])

    # Σ w_p p = m²/2; a length is rounded by ε of itself, which is ε/STRAIN of an elongation
    assert peridynamic_energy(strain, horizon) == pytest.approx(elastic_energy(strain), rel=2.0 * EPS / STRAIN)


UNIT_STRAINS = {
    "along an axis": np.diag([1.0, 0.0, 0.0]),
    "all round": np.eye(3),
    "shear": np.array([[0.0, 0.5, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.0]]),
    "oblique": np.array([[0.3, -0.7, 0.2], [-0.7, 0.1, 0.4], [0.2, 0.4, -0.5]]),
}


@pytest.mark.parametrize("strain", UNIT_STRAINS.values(), ids=UNIT_STRAINS.keys())
@pytest.mark.parametrize(("dimension", "horizons"), [(2, (2, 4, 8, 16)), (3, (2, 4, 6))])
def test_a_plate_and_a_body_store_less_by_what_lies_just_beyond_the_horizon(
    dimension: int, horizons: tuple[int, ...], strain: np.ndarray
) -> None:
    strain = STRAIN * strain[:dimension, :dimension]
    for horizon in horizons:
        missing = 1.0 - peridynamic_energy(strain, horizon) / elastic_energy(strain)
        # the factor falls to ½ over the last Δx/2 and leaves out as much beyond: a shell of Δx/8, of an energy that
        # goes with the distance to the power d + 1. That nodes stand in rows may double it, no more
        assert 0.0 < missing < 2.0 * (dimension + 1) / (8.0 * horizon)


def test_stiffness_of_the_bonds() -> None:
    assert micromodulus(E, 0.5, 1, section=0.1) == pytest.approx(2.0 * E / (0.1 * 0.25), rel=4 * EPS)
    assert micromodulus(E, 0.5, 2) == pytest.approx(9.0 * E / (np.pi * 0.125), rel=4 * EPS)
    assert micromodulus(E, 0.5, 3) == pytest.approx(12.0 * E / (np.pi * 0.0625), rel=4 * EPS)


def test_volume_is_whole_then_falls_to_a_half_at_the_horizon() -> None:
    factor = volume_factor(np.array([0.5, 2.5, 2.75, 3.0, 3.01]), 1.0, 3.0)

    assert factor.tolist() == [1.0, 1.0, 0.75, 0.5, 0.0]


@pytest.mark.parametrize("spacing", [0.1, 1.0 / 3.0, 1e-3, 7e-4])
def test_the_outermost_node_is_not_lost_to_rounding(spacing: float) -> None:
    for horizon in range(1, 40):
        delta = sum([spacing] * horizon)  # not the same float as horizon · spacing
        (factor,) = volume_factor(np.array([horizon * spacing]), spacing, delta)
        # the difference of two lengths of up to 40 Δx, one a sum of as many
        assert factor == pytest.approx(0.5, abs=horizon**2 * EPS)


@pytest.mark.parametrize(
    ("dimension", "horizon", "size"),
    # whole points in a circle (1, 5, 13, 29, 49, 81 …) and a ball (1, 7, 33, 123 …), less the node itself; the circle
    # of 5 has (3, 4) on it
    [(1, 1, 2), (1, 3, 6), (2, 1, 4), (2, 2, 12), (2, 3, 28), (2, 5, 80), (3, 1, 6), (3, 2, 32), (3, 3, 122)],
)
def test_size_of_a_whole_family(dimension: int, horizon: int, size: int) -> None:
    side = 2 * horizon + 1
    family = families((side,) * dimension, horizon)
    ends = np.bincount(family.pairs.ravel(), minlength=side**dimension)

    assert ends[side**dimension // 2] == size
    assert ends.max() == size
    # in a corner only the steps along all axes are left
    steps = np.array(np.meshgrid(*[np.arange(horizon + 1)] * dimension)).reshape(dimension, -1)
    assert ends[0] == np.count_nonzero(np.sum(steps**2, axis=0) <= horizon**2) - 1


@pytest.mark.parametrize(("shape", "horizon"), [((9,), 3), ((5, 7), 2), ((2, 6), 4), ((3, 4, 2), 3), ((1, 3), 2)])
def test_every_pair_within_the_horizon_is_listed_once(shape: tuple[int, ...], horizon: int) -> None:
    family = families(shape, horizon)
    places = np.indices(shape).reshape(len(shape), -1).T
    apart = places[None] - places[:, None]
    near = np.sum(apart**2, axis=2) <= horizon**2

    assert sorted(map(tuple, np.sort(family.pairs, axis=1))) == list(zip(*np.nonzero(np.triu(near, 1)), strict=True))
    assert np.array_equal(family.offset, apart[tuple(family.pairs.T)])
    length = np.sqrt(np.sum(family.offset**2, axis=1))
    assert np.array_equal(family.factor, volume_factor(length, 1.0, float(horizon)))
    assert family.factor.min() > 0.0


def turned(angle: float) -> np.ndarray:
    """A rotation in space, about no axis of the grid."""
    axis = np.array([1.0, 2.0, 2.0]) / 3.0
    cross = np.cross(np.eye(3), axis)
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


@pytest.fixture
def bonds() -> tuple[np.ndarray, np.ndarray]:
    """Some bonds in space, and how far their ends move apart: (b, 3) m each, by as much as their length."""
    rng = np.random.default_rng(5)
    return rng.uniform(0.5, 1.0, (20, 3)), rng.uniform(-0.4, 0.4, (20, 3))


def test_stretch_is_elongation_over_length() -> None:
    apart, moved = np.array([[3.0, 4.0], [2.0, 0.0], [0.0, 1.0]]), np.array([[3.0, 4.0], [-0.5, 0.0], [1.0, 0.0]])

    np.testing.assert_allclose(stretch(apart, moved), [1.0, -0.25, np.sqrt(2.0) - 1.0], rtol=4 * EPS)


@pytest.mark.parametrize("angle", [0.1, 2.0])
def test_turning_stretches_nothing_and_turns_forces(bonds, angle: float) -> None:
    apart, moved = bonds
    turn, count = turned(angle), len(apart)
    intact = np.ones(count, dtype=bool)
    rigid = apart @ turn.T - apart
    before = bond_forces(apart, moved, 2.0, np.ones(count), intact)
    after = bond_forces(apart, (apart + moved) @ turn.T - apart, 2.0, np.ones(count), intact)

    # sums of three products of numbers up to 1.5, over lengths above 0.8, taken a few times
    np.testing.assert_allclose(stretch(apart, rigid), 0.0, atol=20 * EPS)
    np.testing.assert_allclose(after, before @ turn.T, atol=40 * EPS)
    assert np.abs(before).max() > 0.1


def test_forces_pull_along_the_bond_and_its_ends_feel_opposite_ones(bonds) -> None:
    apart, moved = bonds
    volumes, intact = np.linspace(1.0, 2.0, len(apart)), np.arange(len(apart)) % 4 > 0
    force = bond_forces(apart, moved, 3.0, volumes, intact)
    now = apart + moved

    assert np.array_equal(bond_forces(-apart, -moved, 3.0, volumes, intact), -force)
    assert not force[~intact].any()
    # stretched bonds pull the first node towards the second one
    along = np.sum(force * now, axis=1) / np.linalg.norm(now, axis=1)
    np.testing.assert_allclose(along[intact], (3.0 * stretch(apart, moved) * volumes)[intact], rtol=20 * EPS)
    np.testing.assert_allclose(np.cross(force, now), 0.0, atol=20 * EPS)


def test_damage_is_the_volume_lost() -> None:
    pairs = np.array([[0, 1], [1, 2], [0, 2]])
    weight = np.array([[2.0, 1.0], [3.0, 2.0], [3.0, 0.5]])
    intact = np.array([True, False, True])

    # node 1 keeps 1 of 4, node 2 keeps 0.5 of 2.5; node 3 has nothing to lose
    np.testing.assert_allclose(damage(pairs, weight, intact, 4), [0.0, 0.75, 0.8, 0.0], rtol=4 * EPS)
    assert not damage(pairs, weight, np.ones(3, dtype=bool), 4).any()
