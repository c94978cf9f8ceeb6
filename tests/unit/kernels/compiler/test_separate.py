"""Kernels compiled apart: called and not copied, compiled when they are first called, shared out among threads."""

import numba
import numpy as np
import pytest
from numba import njit, types

from dembound.kernels.common import CHUNKS, EXACT
from dembound.kernels.compiler.separate import apart, in_chunks

OWN = EXACT | {"cache": False}


@apart(types.float64)
@njit(**OWN)
def _weighted(values, weights, least):
    """The least, or the sum of values (n,) times weights (n,) if that is larger."""
    total = 0.0
    for i in range(values.size):
        total += values[i] * weights[i]
    return max(total, least)


@njit(**OWN)
def _doubled(values, weights, least):
    return 2.0 * _weighted(values, weights, least)


def test_it_computes_the_same_called_by_compiled_code_and_from_python_and_is_not_in_that_of_its_caller() -> None:
    for kind in (np.float64, np.int64):
        values, weights = np.array([1, 2, 4], dtype=kind), np.array([0.5, 0.25, 2.0])
        assert _weighted(values, weights, 8.0) == 9.0
        assert _doubled(values, weights, 8.0) == 18.0
        assert _doubled(values, weights, 10.0) == 20.0
    for code in _doubled.inspect_llvm().values():
        assert not [line for line in code.splitlines() if line.startswith("define") and "_weighted" in line]


@in_chunks
@njit(**OWN)
def _number(first, last, factor, chunks, threads):
    """Count in chunks (chunks,) how often each is computed, times a factor; and where its thread begins in threads."""
    for chunk in range(first, last):
        chunks[chunk] += factor * (1 + chunk)
        threads[chunk] = first


@njit(**OWN)
def _numbered(factor, chunks, threads):
    _number(factor, chunks, threads)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_each_chunk_is_computed_once_by_any_number_of_threads(count) -> None:
    if count > numba.config.NUMBA_NUM_THREADS:
        pytest.skip(f"needs {count} threads")
    chunks, threads = np.zeros(CHUNKS), np.full(CHUNKS, -1)
    before = numba.get_num_threads()
    numba.set_num_threads(count)
    try:
        for _ in range(2):
            _numbered(0.5, chunks, threads)
    finally:
        numba.set_num_threads(before)
    np.testing.assert_array_equal(chunks, 1.0 + np.arange(CHUNKS))
    np.testing.assert_array_equal(np.unique(threads), np.arange(count) * CHUNKS // count)
    _number(0.5, chunks, threads)  # called from Python, by no thread but this
    np.testing.assert_array_equal(chunks, 1.5 * (1.0 + np.arange(CHUNKS)))
    assert set(threads) == {0}
