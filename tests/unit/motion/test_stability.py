"""The largest eigenvalue of a scene, for any forces, against dense ones."""

import numba
import numpy as np
import pytest

from dembound.motion.stability import TOLERANCE, largest_eigenvalue
from dembound.motion.state import Layout

NODES, FREE = 60, np.array([1.0, 1.0, 0.0])


def scene() -> tuple[Layout, np.ndarray, np.ndarray]:
    """Slots in another order than the nodes, masses, and a stiffness matrix (2n, 2n) of both displacements."""
    rng = np.random.default_rng(1)
    layout = Layout(np.arange(NODES)[::-1] + 3, NODES + 8)
    root = rng.standard_normal((2 * NODES, 2 * NODES))
    return layout, rng.uniform(1.0, 3.0, NODES), root @ root.T


@pytest.mark.parametrize("held", [0, 25, NODES])
def test_it_is_that_of_the_matrix_without_what_is_held(held: int) -> None:
    layout, mass, stiffness = scene()
    moves = np.ones((3, NODES), dtype=np.bool_)
    moves[:2, :held] = False
    kept = moves[:2].ravel()

    def fill(u: np.ndarray, force: np.ndarray) -> None:
        force[:] = 0.0
        force[:2, layout.slot] = (-stiffness @ layout.gather(u)[:2].ravel() * kept).reshape(2, NODES)

    found = largest_eigenvalue(layout, mass, mass, FREE, moves, fill)
    if held == NODES:  # nothing moves
        assert found == 0.0
        return
    matrix = stiffness / np.tile(mass, 2)[:, None]
    exact = np.linalg.eigvals(matrix[np.ix_(kept, kept)]).real.max()

    rounding = 1e-13  # of 70 to 120 dense eigenvalues, whose matrix is not symmetric
    assert -rounding <= found / exact - 1.0 <= TOLERANCE


@pytest.mark.skipif(numba.config.NUMBA_NUM_THREADS < 2, reason="needs two threads")
def test_any_number_of_threads_gives_the_same_bits() -> None:
    layout, mass, stiffness = scene()
    moves, found, allowed = np.ones((3, NODES), dtype=np.bool_), [], numba.get_num_threads()

    def fill(u: np.ndarray, force: np.ndarray) -> None:
        force[:2, layout.slot] = (-stiffness @ layout.gather(u)[:2].ravel()).reshape(2, NODES)

    try:
        for threads in (1, 2):
            numba.set_num_threads(threads)
            found.append(largest_eigenvalue(layout, mass, mass, FREE, moves, fill))
    finally:
        numba.set_num_threads(allowed)
    assert found[0] == found[1]
