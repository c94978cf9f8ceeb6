"""The peridynamic law of a bar, against elasticity and by hand."""

import numpy as np
import pytest

from dembound.laws.peridynamic import damage, families, micromodulus

EPS = np.finfo(float).eps
E, SPACING, SECTION = 3e9, 0.5, 0.1


@pytest.mark.parametrize("horizon", [1, 3])
def test_bonds_store_the_elastic_energy(horizon: int) -> None:
    """Under a uniform strain ε a node with a whole family has ½Eε² per volume: half the energy of each of its bonds."""
    strain, volume = 1e-3, SECTION * SPACING
    family = families(2 * horizon + 1, horizon)
    mine = (family.pairs == horizon).any(axis=1)
    elongation = strain * SPACING * family.apart[mine]
    force = micromodulus(E, horizon * SPACING, SECTION) * strain * volume**2 * family.factor[mine]

    energy = 0.5 * np.sum(0.5 * force * elongation) / volume
    assert energy == pytest.approx(0.5 * E * strain**2, rel=16 * EPS)


@pytest.mark.parametrize(("count", "horizon"), [(9, 3), (4, 6)])
def test_every_pair_within_the_horizon_is_listed_once(count: int, horizon: int) -> None:
    family = families(count, horizon)
    expected = [(i, i + p) for p in range(1, horizon + 1) for i in range(count - p)]

    assert list(map(tuple, family.pairs.tolist())) == expected
    assert np.array_equal(family.apart, family.pairs[:, 1] - family.pairs[:, 0])
    assert np.array_equal(family.factor, np.where(family.apart == horizon, 0.5, 1.0))


def test_damage_is_the_volume_lost() -> None:
    pairs = np.array([[0, 1], [1, 2], [0, 2]])
    weight = np.array([[2.0, 1.0], [3.0, 2.0], [3.0, 0.5]])
    intact = np.array([True, False, True])

    # node 1 keeps 1 of 4, node 2 keeps 0.5 of 2.5; node 3 has nothing to lose
    np.testing.assert_allclose(damage(pairs, weight, intact, 4), [0.0, 0.75, 0.8, 0.0], rtol=4 * EPS)
    assert not damage(pairs, weight, np.ones(3, dtype=bool), 4).any()
