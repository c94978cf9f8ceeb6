"""The passes of the Lanczos iteration against the same lines of NumPy."""

import numba
import numpy as np
import pytest

from dembound.kernels.lanczos import next_vector, work

SLOTS, EMPTY = 1000, slice(40, 57)
FREE = np.array([1.0, 0.0, 1.0])
FACTORS = -0.5, 0.75, 0.25


def vectors() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """u, before, force (3, slots), mass and inertia (slots,), with some slots that hold no disk."""
    rng = np.random.default_rng(2)
    u, before, force = rng.standard_normal((3, 3, SLOTS))
    mass, inertia = rng.uniform(0.5, 2.0, (2, SLOTS))
    for values in (u, before, mass, inertia):
        values[..., EMPTY] = 0.0
    return u, before, force, mass, inertia


def close(found: np.ndarray | float, expected: np.ndarray | float) -> None:
    """Equal but for rounding: sums of 3000 products of size 1, each with an error of 1e-16 of the sum."""
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-10)


def test_work_is_the_product_of_all_components() -> None:
    u, _, force, _, _ = vectors()

    close(work(u, force), np.sum(u * force))


def test_the_next_vector_takes_the_place_of_the_one_before() -> None:
    u, before, force, mass, inertia = vectors()
    kept = u.copy()
    pull, along, back = FACTORS
    weights = np.stack([mass, mass, inertia])
    inverse = np.divide(1.0, weights, out=np.zeros_like(weights), where=weights > 0.0)
    expected = pull * FREE[:, None] * inverse * force - along * u - back * before
    square = next_vector(u, before, force, mass, inertia, FREE, *FACTORS)

    close(before, expected)
    close(square, np.sum(weights * expected**2))
    assert not before[:, EMPTY].any()
    assert np.array_equal(u, kept)


@pytest.mark.skipif(numba.config.NUMBA_NUM_THREADS < 2, reason="needs two threads")
def test_any_number_of_threads_gives_the_same_bits() -> None:
    allowed, results = numba.get_num_threads(), []
    try:
        for threads in (1, 2):
            numba.set_num_threads(threads)
            u, before, force, mass, inertia = vectors()
            square = next_vector(u, before, force, mass, inertia, FREE, *FACTORS)
            results.append((work(u, force), square, *before.ravel()))
    finally:
        numba.set_num_threads(allowed)

    assert results[0] == results[1]
