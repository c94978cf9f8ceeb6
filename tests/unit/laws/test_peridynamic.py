"""The peridynamic law of a bar, against elasticity and by hand."""

import numpy as np
import pytest

from dembound.laws.peridynamic import families, micromodulus

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
