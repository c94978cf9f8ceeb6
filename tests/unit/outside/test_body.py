"""Masses and slots of a continuum, and its stable step."""

import numpy as np
import pytest

from dembound.outside.body import GridBody
from dembound.outside.grid_scene import step_limit
from dembound.outside.layer import Absorption
from dembound.outside.medium import Medium
from dembound.outside.mesh import Around, Mesh

ROCK = Medium(2500.0, c11=9e9, c22=7e9, c12=2e9, c66=3e9, c16=0.4e9, c26=-0.3e9)


def test_mass_is_that_of_the_medium_and_what_is_added(grid) -> None:
    body = grid()
    added = np.arange(body.count, dtype=float)

    assert body.mass.sum() == pytest.approx(2500.0 * body.mesh.areas.sum())
    np.testing.assert_allclose(grid(added_mass=added).mass, body.mass + added)
    np.testing.assert_allclose(grid(thickness=2.0).mass, 2.0 * body.mass)


def dense_limit(body: GridBody, delay: float) -> float:
    """Largest stable step by a dense eigenvalue: ω² times 1 + 2kq² on the nodes of layers."""
    n = body.count
    columns = []
    for component in (0, 1):
        for node in range(n):
            u, force = np.zeros((2, 3, body.blocks.end))
            u[component, body.blocks.slot[node]] = 1.0
            body.fill_forces(u, force)
            columns.append(-force[:2, body.blocks.slot].ravel())
    matrix = np.array(columns) / np.tile(body.mass, 2)[:, None]
    q = body.mesh.depth.max(axis=1)
    matrix *= np.tile(1.0 + 2.0 * delay * q**2, 2)[:, None]
    kept = np.tile(~body.mesh.held, 2)
    return float(2.0 / np.sqrt(np.linalg.eigvals(matrix[np.ix_(kept, kept)]).real.max()))


def test_the_step_limit_counts_the_delay() -> None:
    delay = 0.5
    mesh = Mesh.uniform(order=3, element=(3.0, 2.0), cells=(3, 3), layer=Around(1, 1, 1, 0))
    body = GridBody(mesh=mesh, medium=ROCK, absorption=Absorption(delay=delay))

    # the iteration ends within 1e-3 of ω², on the safe side
    assert 0.0 <= 1.0 - step_limit(body) / dense_limit(body, delay) < 5e-4
