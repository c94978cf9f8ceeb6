"""The stability limit from bands, against eigenvalues of dense matrices."""

import numpy as np
import pytest

from dembound.bar.body import is_stable, largest_stable_step

ROUNDING = 1e-13
"""Rounding of the largest of 20 eigenvalues: either way of finding it rounds some 20 sums of 20 terms."""


def chain(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Random bonds of 20 nodes, most of them there: bands, dense stiffness matrix and masses."""
    rng = np.random.default_rng(seed)
    n, reach = 20, 1 + seed % 4
    bands, dense = np.zeros((reach + 1, n)), np.zeros((n, n))
    for d in range(1, reach + 1):
        for i in range(n - d):
            k = rng.uniform(0.0, 1e9) * (rng.uniform() < 0.8)
            dense[np.ix_((i, i + d), (i, i + d))] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
            bands[d, i] = -k
    bands[0] = np.diag(dense)
    return bands, dense, rng.uniform(1.0, 10.0, n)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("held", [[], [0, 19], [3, 4, 11]], ids=str)
def test_the_limit_is_that_of_the_largest_eigenvalue(seed: int, held: list[int]) -> None:
    bands, dense, mass = chain(seed)
    nodes, before = np.array(held, dtype=np.int64), (bands.copy(), mass.copy())
    free = np.setdiff1d(np.arange(len(mass)), nodes)
    root = np.sqrt(mass[free])
    limit = 2.0 / np.sqrt(np.linalg.eigvalsh(dense[np.ix_(free, free)] / np.outer(root, root))[-1])

    assert largest_stable_step(bands, mass, nodes) == pytest.approx(limit, rel=ROUNDING)
    assert is_stable(limit * (1.0 - 2.0 * ROUNDING), bands, mass, nodes)
    assert not is_stable(limit * (1.0 + 2.0 * ROUNDING), bands, mass, nodes)
    assert np.array_equal(bands, before[0])
    assert np.array_equal(mass, before[1])
