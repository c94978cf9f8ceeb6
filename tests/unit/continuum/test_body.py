"""Masses and slots of a continuum, and its stable step."""

import numpy as np
import pytest
from grid_scene import step_limit

from dembound.continuum.layer import Absorption
from dembound.continuum.medium import Layered, Medium
from dembound.continuum.mesh import Around, Mesh
from dembound.continuum.part import GridBody

ROCK = Medium(2500.0, c11=9e9, c22=7e9, c12=2e9, c66=3e9, c16=0.4e9, c26=-0.3e9)
SOIL = Medium(1800.0, c11=2e9, c22=3e9, c12=1e9, c66=0.5e9, c16=0.1e9)


def test_mass_is_that_of_the_medium_and_what_is_added(grid) -> None:
    body = grid()
    added = np.arange(body.count, dtype=float)

    assert body.mass.sum() == pytest.approx(2500.0 * body.mesh.areas.sum())
    np.testing.assert_allclose(grid(added_mass=added).mass, body.mass + added)
    np.testing.assert_allclose(grid(thickness=2.0).mass, 2.0 * body.mass)


def test_a_joint_inside_elements_is_refused() -> None:
    mesh = Mesh.uniform(order=3, element=(3.0, 2.0), cells=(2, 3))
    GridBody(mesh=mesh, medium=Layered((ROCK, SOIL), (7.0,)))  # above the mesh
    with pytest.raises(ValueError, match="the joint of layers at y = 3 m lies inside elements"):
        GridBody(mesh=mesh, medium=Layered((ROCK, SOIL), (3.0,)))


def test_layers_of_one_medium_have_the_forces_of_that_medium(grid) -> None:
    """To the last bit of each element; at shared nodes elements are added in another order."""
    one, three = grid(), grid(medium=Layered((ROCK, ROCK, ROCK), (-2.0, 0.0)))
    u = np.random.default_rng(0).standard_normal((3, one.count))
    forces = []
    for body in (one, three):
        moved, force = np.zeros((2, 3, body.blocks.end))
        moved[:, body.blocks.slot] = u
        body.fill_forces(moved, force)
        forces.append(force[:, body.blocks.slot])
    np.testing.assert_allclose(forces[1], forces[0], atol=1e-12 * np.abs(forces[0]).max())


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


@pytest.mark.parametrize("medium", [ROCK, Layered((ROCK, SOIL), (4.0,))])
def test_the_step_limit_counts_the_delay(medium: Medium | Layered) -> None:
    delay = 0.5
    mesh = Mesh.uniform(order=3, element=(3.0, 2.0), cells=(3, 3), layer=Around(1, 1, 1, 0))
    body = GridBody(mesh=mesh, medium=medium, absorption=Absorption(delay=delay))

    # the iteration ends within 1e-3 of ω², on the safe side
    assert 0.0 <= 1.0 - step_limit(body) / dense_limit(body, delay) < 5e-4
