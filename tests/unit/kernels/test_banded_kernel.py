"""A banded matrix is positive definite exactly where all its eigenvalues are above zero."""

import numpy as np
import pytest

from dembound.kernels.banded import is_positive_definite

COUNT = 12


def random_bands(width: int) -> tuple[np.ndarray, np.ndarray]:
    """A symmetric matrix of random entries with this many bands, its bands and the whole."""
    rng = np.random.default_rng(width)
    bands, dense = np.zeros((width, COUNT)), np.zeros((COUNT, COUNT))
    for d in range(width):
        values = rng.uniform(-1.0, 1.0, COUNT - d)
        bands[d, : COUNT - d] = values
        dense += np.diag(values, -d) + (np.diag(values, d) if d > 0 else 0.0)
    return bands, dense


@pytest.mark.parametrize("width", [1, 2, 3, 5, COUNT])
def test_the_factors_exist_above_the_least_eigenvalue(width: int) -> None:
    bands, dense = random_bands(width)
    least = float(np.linalg.eigvalsh(dense)[0])
    # eigenvalues of 12 rows of numbers up to 1 are found to some 12² roundings of 1e-16
    for shift, positive in ((-least + 1e-12, True), (-least - 1e-12, False), (-least - 1.0, False)):
        shifted = bands.copy()
        shifted[0] += shift
        assert is_positive_definite(shifted) is positive


def test_the_bands_become_the_factor() -> None:
    bands, dense = random_bands(3)
    bands[0] += 4.0
    factor = np.linalg.cholesky(dense + 4.0 * np.eye(COUNT))
    assert is_positive_definite(bands)
    # the diagonal keeps the squares of the factor's
    np.testing.assert_allclose(np.sqrt(bands[0]), np.diag(factor), rtol=1e-14)
    for d in (1, 2):
        np.testing.assert_allclose(bands[d, : COUNT - d], np.diag(factor, -d), rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("pivot", [0.0, -0.0, np.nan])
def test_a_pivot_that_is_not_above_zero_ends_it(pivot: float) -> None:
    assert not is_positive_definite(np.array([[1.0, pivot, 1.0]]))
