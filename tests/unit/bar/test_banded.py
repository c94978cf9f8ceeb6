"""The stability limit from bands, against eigenvalues of dense matrices."""

import numpy as np
import pytest

from dembound.bar.banded import is_stable, largest_stable_step

NOBODY = np.zeros(0, dtype=np.int64)
ROUNDING = 1e-13
"""Of the largest of 20 eigenvalues: either way of finding it rounds some 20 sums of 20 terms."""


@pytest.fixture(params=range(8))
def chain(request) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Random bonds of 20 nodes, most of them there: bands, dense stiffness matrix and masses."""
    rng = np.random.default_rng(request.param)
    n, reach = 20, 1 + request.param % 4
    bands, dense = np.zeros((reach + 1, n)), np.zeros((n, n))
    for d in range(1, reach + 1):
        for i in range(n - d):
            k = rng.uniform(0.0, 1e9) * (rng.uniform() < 0.8)
            dense[np.ix_((i, i + d), (i, i + d))] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
            bands[d, i] = -k
    bands[0] = np.diag(dense)
    return bands, dense, rng.uniform(1.0, 10.0, n)


def dense_limit(dense: np.ndarray, mass: np.ndarray, held: np.ndarray) -> float:
    """2/ω_max (s) of what is not held."""
    free = np.setdiff1d(np.arange(len(mass)), held)
    root = np.sqrt(mass[free])
    return 2.0 / np.sqrt(np.linalg.eigvalsh(dense[np.ix_(free, free)] / np.outer(root, root))[-1])


@pytest.mark.parametrize("held", [[], [0], [0, 19], [3, 4, 11]], ids=str)
def test_the_limit_is_that_of_the_largest_eigenvalue(chain, held: list[int]) -> None:
    bands, dense, mass = chain
    nodes = np.array(held, dtype=np.int64)
    limit = dense_limit(dense, mass, nodes)

    assert largest_stable_step(bands, mass, nodes) == pytest.approx(limit, rel=ROUNDING)
    assert is_stable(limit * (1.0 - 2.0 * ROUNDING), bands, mass, nodes)
    assert not is_stable(limit * (1.0 + 2.0 * ROUNDING), bands, mass, nodes)


def test_nothing_is_changed(chain) -> None:
    bands, _, mass = chain
    before = bands.copy(), mass.copy()
    largest_stable_step(bands, mass, np.array([2]))
    is_stable(1e-5, bands, mass, np.array([2]))

    assert np.array_equal(bands, before[0])
    assert np.array_equal(mass, before[1])


def test_two_nodes_on_a_spring() -> None:
    bands = np.array([[9.0, 9.0], [-9.0, 0.0]])

    # ω² = k(1/m + 1/m'), and k/m' where one is held
    assert largest_stable_step(bands, np.array([1.0, 0.5]), NOBODY) == pytest.approx(2.0 / np.sqrt(27.0), rel=ROUNDING)
    assert largest_stable_step(bands, np.array([1.0, 0.5]), np.array([0])) == pytest.approx(
        2.0 / np.sqrt(18.0), rel=ROUNDING
    )


@pytest.mark.parametrize(("stiffness", "held"), [(0.0, []), (9.0, [0, 1])], ids=["no spring", "all held"])
def test_any_step_serves_where_nothing_vibrates(stiffness: float, held: list[int]) -> None:
    bands = stiffness * np.array([[1.0, 1.0], [-1.0, 0.0]])
    nodes = np.array(held, dtype=np.int64)

    assert largest_stable_step(bands, np.ones(2), nodes) == np.inf
    assert is_stable(1e9, bands, np.ones(2), nodes)
