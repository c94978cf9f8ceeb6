"""The part of a continuum: mass, energies, stress, its stable step, and what it refuses."""

import numpy as np
import pytest
from grid_scene import GridScene, step_limit

from dembound.boundaries.support import SupportBuilder
from dembound.continuum.axis import Around
from dembound.continuum.layer import Absorption
from dembound.continuum.medium import Layered, Medium
from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody, GridPart, stress
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

SOIL = Medium(1800.0, c11=2e9, c22=3e9, c12=1e9, c66=0.5e9, c16=0.1e9)


@pytest.mark.parametrize("soil", [False, True])
def test_the_ledger_closes_with_supports_at_the_edge_of_a_layer(grid, noise, soil: bool) -> None:
    """Nodes at the free surface of a layer and of its first edge, on springs and driven."""
    body = grid(medium=Layered((grid().medium, SOIL), (0.0,))) if soil else grid()
    mesh = body.mesh
    surface = np.flatnonzero((mesh.positions[:, 1] == mesh.positions[:, 1].max()) & ~mesh.held)
    of_layers = np.intersect1d(surface, mesh.nodes[mesh.absorbs[:, 0]])
    builder = SupportBuilder()
    builder.add(of_layers, 1, stiffness=1e9, damping=1e5)
    builder.add(surface[:3], 0, drive=0.5, signal=np.cos, prescribed=True)
    scene = GridScene(body, supports=builder.table())
    simulation = Simulation(scene, 0.5 * step_limit(body))
    simulation.state.velocity = noise(body)
    ledger = Ledger(simulation, 50)
    simulation.track(ledger)
    simulation.run(501)

    # rounding of sums over nodes and elements, step by step
    change = [entry.error - ledger.entries[0].error for entry in ledger.entries]
    largest = max(abs(getattr(entry, name)) for entry in ledger.entries for name in ("kinetic", "contact", "damping"))
    assert np.abs(change).max() < 500 * np.finfo(float).eps * largest
    assert abs(ledger.entries[-1].outside) > 5e-3 * largest


@pytest.mark.parametrize("even", [True, False])
def test_stress_of_a_uniform_strain(grid, even: bool) -> None:
    body = grid(even=even)
    gradient = np.array([[1e-4, 3e-4], [-1e-4, -2e-4]])  # ∂u_a/∂b
    displacement = np.zeros((3, 5 + body.count))
    displacement[:2, 5:] = gradient @ body.mesh.positions.T
    fields = GridPart(body, 1e-4, first_node=5).snapshot(displacement)

    values, unit = fields["stress"]
    expected = body.medium.matrix @ [1e-4, -2e-4, 2e-4]
    np.testing.assert_allclose(values, np.tile(expected, (body.count, 1)), rtol=1e-9)
    assert unit == "Pa"


def test_supports_that_cannot_be_accounted_for_are_refused(grid) -> None:
    body = grid()
    mesh = body.mesh
    inside = mesh.nodes[mesh.absorbs[:, 1]][0, 2, 2]
    with pytest.raises(ValueError, match="a supported node is inside an element that absorbs"):
        GridPart(body, 1e-4, supported=np.array([inside]))
    with pytest.raises(ValueError, match="a supported node is on a held edge"):
        GridPart(body, 1e-4, supported=np.flatnonzero(mesh.held)[:1])


ROCK = Medium(2500.0, c11=9e9, c22=7e9, c12=2e9, c66=3e9, c16=0.4e9, c26=-0.3e9)


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
    mesh = Mesh.uniform(order=4, element=(3.0, 2.0), cells=(3, 3), layer=Around(1, 1, 1, 0))
    body = GridBody(mesh=mesh, medium=medium, absorption=Absorption(delay=delay))

    # the iteration ends within 1e-3 of ω², on the safe side
    assert 0.0 <= 1.0 - step_limit(body) / dense_limit(body, delay) < 5e-4


def test_the_absorbing_layer_has_the_fastest_speed_in_it(grid) -> None:
    ground = Layered((SOIL, ROCK), (0.0,))
    body, uniform = grid(medium=ground), grid(medium=SOIL)

    left, bottom = body.profile("left"), body.profile("bottom")
    assert left is not None
    assert left.speed == ROCK.normal_speed(0)
    assert left.guides
    assert bottom == uniform.profile("bottom")
    assert body.profile("top") is None


def test_stress_at_a_kink_is_the_mean_by_area(grid) -> None:
    """Strain a in the element on the left of an edge, 3 m wide, and b on its right, 2.5 m wide."""
    body = grid(even=False)
    x = body.mesh.positions[:, 0]
    edge = 3.0
    displacement = np.zeros((2, body.count))
    displacement[0] = np.where(x < edge, 1e-4, 5e-4) * (x - edge)
    found = stress(body, displacement)[np.abs(x - edge) < 1e-9]

    expected = body.medium.matrix[:, 0] * (3.0 * 1e-4 + 2.5 * 5e-4) / 5.5
    np.testing.assert_allclose(found, np.tile(expected, (len(found), 1)), rtol=1e-11)


def test_stress_of_layers_is_that_of_each_medium() -> None:
    mesh = Mesh.uniform(order=4, element=(3.0, 2.0), cells=(2, 2))
    rock = Medium(2500.0, c11=9e9, c22=7e9, c12=2e9, c66=3e9)
    body = GridBody(mesh=mesh, medium=Layered((rock, SOIL), (2.0,)))
    x, y = mesh.positions.T
    found = stress(body, np.stack([1e-4 * x, np.zeros_like(x)]))

    for there, c11, c12 in ((y < 1.9, 9e9, 2e9), (y > 2.1, 2e9, 1e9), (np.abs(y - 2.0) < 0.1, 5.5e9, 1.5e9)):
        np.testing.assert_allclose(found[there, 0], 1e-4 * c11)
        np.testing.assert_allclose(found[there, 1], 1e-4 * c12)
