"""Meshes: nodes, elements, layers, and interpolation."""

import numpy as np
import pytest

from dembound.outside.mesh import Around, Mesh

ORDER = 4


def buried() -> Mesh:
    """Round a box of 2 × 1 elements of 3 × 2 m on all four sides."""
    return Mesh.around((10.0, 20.0, 16.0, 22.0), (3.0, 2.0), ORDER, margin=Around(1, 2, 1, 1), layer=Around(2, 1, 1, 1))


def below() -> Mesh:
    """Round a box that reaches the free surface."""
    return Mesh.around((0.0, 0.0, 6.0, 2.0), (3.0, 2.0), ORDER, margin=Around(1, 1, 1, 0), layer=Around(1, 1, 1, 0))


def test_the_box_is_left_out() -> None:
    mesh = buried()
    x, y = mesh.positions.T

    assert mesh.cells == (8, 5)
    assert len(mesh.elements) == 8 * 5 - 2
    assert mesh.origin == (10.0 - 3 * 3.0, 20.0 - 2 * 2.0)
    np.testing.assert_allclose(mesh.size, [24.0, 10.0])
    inside = (x > 10.0) & (x < 16.0) & (y > 20.0) & (y < 22.0)
    assert not inside.any()
    on_sides = (x >= 10.0) & (x <= 16.0) & (y >= 20.0) & (y <= 22.0)
    assert on_sides.sum() == 2 * (2 * ORDER + 1) + 2 * (ORDER + 1) - 4
    # without the inner nodes of two elements and of the edge between them
    assert mesh.count == (8 * ORDER + 1) * (5 * ORDER + 1) - (2 * ORDER - 1) * (ORDER - 1)


def test_nodes_are_shared_by_neighbours_and_lie_at_their_points() -> None:
    mesh = buried()
    corner = np.array(mesh.origin) + mesh.elements * mesh.element
    local = 0.5 * (1.0 + mesh.rule.points)
    x = corner[:, 0, None, None] + 3.0 * local + 0.0 * local[:, None]
    y = corner[:, 1, None, None] + 2.0 * local[:, None] + 0.0 * local

    np.testing.assert_allclose(mesh.positions[mesh.nodes], np.stack([x, y], axis=-1), rtol=0.0, atol=1e-13)
    assert len(np.unique(mesh.positions.round(9), axis=0)) == mesh.count
    # row by row from the bottom, from left to right
    assert (np.lexsort(mesh.positions.T) == np.arange(mesh.count)).all()


def test_areas_add_up() -> None:
    mesh = buried()

    assert mesh.areas.sum() == pytest.approx(24.0 * 10.0 - 6.0 * 2.0, rel=1e-13)
    assert mesh.areas.min() == pytest.approx(1.5 * 1.0 * 0.1**2, rel=1e-13)


def test_layers_lie_at_the_sides() -> None:
    mesh = below()
    x, y = mesh.positions.T
    qx = np.maximum(np.maximum(-3.0 - x, x - 9.0) / 3.0, 0.0)
    qy = np.maximum(-2.0 - y, 0.0) / 2.0

    np.testing.assert_allclose(mesh.depth, np.stack([qx, qy], axis=1), rtol=0.0, atol=1e-14)
    assert (mesh.held == ((x == -6.0) | (x == 12.0) | (y == -4.0))).all()
    assert (mesh.absorbs[:, 0] == ((mesh.elements[:, 0] == 0) | (mesh.elements[:, 0] == 5))).all()
    assert (mesh.absorbs[:, 1] == (mesh.elements[:, 1] == 0)).all()
    assert mesh.inner == 12.0
    assert mesh.thickness(0) == (3.0, 3.0)
    assert mesh.thickness(1) == (2.0, 0.0)


@pytest.mark.parametrize("right", [1, 3])
def test_the_outer_edge_is_held_for_any_size_of_element(right: int) -> None:
    """Sizes that binary numbers do not have."""
    mesh = Mesh(order=5, element=(0.1, 0.7), cells=(7, 3), layer=Around(0, right, 0, 0), origin=(0.3, 0.0))

    assert mesh.held.sum() == 3 * 5 + 1


def test_a_periodic_mesh_has_no_last_line() -> None:
    mesh = Mesh(order=3, element=(1.0, 1.0), cells=(4, 2), periodic=(True, False))

    assert mesh.count == 4 * 3 * (2 * 3 + 1)
    assert mesh.nodes[3, 0, -1] == mesh.nodes[0, 0, 0]
    assert mesh.areas.sum() == pytest.approx(8.0)


def test_a_polynomial_is_interpolated_and_extrapolated() -> None:
    mesh = buried()
    points = np.array([[2.2, 17.3], [23.9, 25.9], [10.1, 20.05], [15.9, 21.8], [13.0, 20.4], [0.9, 16.0]])
    field = mesh.positions[:, 0] ** 2 - 3.0 * mesh.positions[:, 1] * mesh.positions[:, 0]
    node, weight = mesh.interpolation(points)

    # also within the box, from the nearest element
    expected = points[:, 0] ** 2 - 3.0 * points[:, 1] * points[:, 0]
    np.testing.assert_allclose((weight * field[node]).sum(axis=1), expected, rtol=1e-12)
    np.testing.assert_allclose(weight.sum(axis=1), 1.0, rtol=1e-13)
    nearest = mesh.positions[node].mean(axis=1) - points
    assert (np.abs(nearest) <= np.array([3.0, 2.0])).all()


def test_boxes_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ValueError, match=r"the height of the box is 1.25 elements, must be a whole number"):
        Mesh.around((0.0, 0.0, 6.0, 2.5), (3.0, 2.0), margin=Around(1, 1, 1, 0), layer=Around())


def test_layers_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ValueError, match="periodic along axis 0 has no absorbing layers"):
        Mesh(order=3, element=(1.0, 1.0), cells=(4, 2), periodic=(True, False), layer=Around(left=1))
    with pytest.raises(ValueError, match=r"more elements along axis 1 than the mesh, 2"):
        Mesh(order=3, element=(1.0, 1.0), cells=(4, 2), layer=Around(bottom=2, top=1))
