"""Places of points in a mesh, and displacements and their slopes there."""

import numpy as np
import pytest
from meshes import buried, stepped, uneven

from dembound.continuum.interpolation import interpolation, located, slopes


def test_a_polynomial_and_its_slopes_are_interpolated_and_extrapolated() -> None:
    """Also within the box, from the nearest element."""
    mesh = buried()
    points = np.array([[2.2, 17.3], [23.9, 25.9], [10.1, 20.05], [15.9, 21.8], [13.0, 20.4], [0.9, 16.0]])
    (x, y), (px, py) = mesh.positions.T, points.T
    field = x**2 - 3.0 * y * x + y**4
    node, weight = interpolation(mesh, points)
    along, up = (slopes(mesh, points) * field[node]).sum(axis=2)

    np.testing.assert_allclose((weight * field[node]).sum(axis=1), px**2 - 3.0 * py * px + py**4, rtol=1e-12)
    np.testing.assert_allclose(along, 2.0 * px - 3.0 * py, rtol=1e-9)
    np.testing.assert_allclose(up, 4.0 * py**3 - 3.0 * px, rtol=1e-9)
    np.testing.assert_allclose(weight.sum(axis=1), 1.0, rtol=1e-13)
    nearest = mesh.positions[node].mean(axis=1) - points
    assert (np.abs(nearest) <= np.array([3.0, 2.0])).all()


def test_points_are_located_in_unequal_elements() -> None:
    mesh = uneven()
    rng = np.random.default_rng(0)
    for number, nodes in enumerate(mesh.nodes):
        local = rng.uniform(-1.0, 1.0, (5, 2))
        low, high = mesh.positions[nodes[0, 0]], mesh.positions[nodes[-1, -1]]
        element, found = located(mesh, low + 0.5 * (1.0 + local) * (high - low))
        assert (element == number).all()
        np.testing.assert_allclose(found, local, rtol=0.0, atol=1e-13)


def test_points_in_the_box_and_beyond_the_mesh_belong_to_the_nearest_element() -> None:
    """As found by comparing all of them; those on an edge to the first of both elements."""
    mesh = uneven()
    points = np.random.default_rng(1).uniform((-3.0, -3.0), (12.0, 14.0), (400, 2))
    points[:200] = np.random.default_rng(2).uniform((4.0, 5.0), (7.0, 7.0), (200, 2))
    low, high = (mesh.positions[mesh.nodes[:, i, i]] for i in (0, -1))
    beyond = np.maximum(np.maximum(low - points[:, None], points[:, None] - high), 0.0)
    nearest = np.argmin(np.sum(beyond**2, axis=2), axis=1)

    np.testing.assert_array_equal(located(mesh, points)[0], nearest)
    on_edges = located(mesh, np.array([[1.5, 1.0], [3.0, 5.0], [7.0, 6.0], [5.0, 7.0]]))[0]
    np.testing.assert_array_equal(mesh.elements[on_edges], [[0, 0], [1, 1], [4, 2], [2, 3]])


def test_points_above_a_lower_surface_belong_to_the_highest_element_below() -> None:
    """Beside the box by their columns; those in the box that are beside nothing to the nearest element."""
    mesh = stepped()
    points = np.array([[-4.0, 3.5], [-8.9, 8.0], [7.0, 5.1], [6.1, 9.5], [5.9, 8.5], [0.2, 4.0]])
    element, local = located(mesh, points)

    assert [tuple(mesh.elements[each]) for each in element] == [(1, 2), (0, 2), (5, 3), (5, 3), (5, 3), (2, 2)]
    assert local[0, 1] == pytest.approx(1.0 + 2.0 * 0.5 / 3.0)
    assert (local[:, 1] > 1.0).all()
