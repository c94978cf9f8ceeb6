"""Places of points in a mesh, displacements and slopes there, and the static fields beside elements."""

import math

import numpy as np
import pytest
from meshes import buried, one_across, uneven

from dembound.continuum.interpolation import (
    FORCES,
    HOLES,
    PASSED,
    TIES,
    WIDER,
    NearField,
    interpolation,
    located,
    slopes,
)
from dembound.continuum.mesh import Mesh


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


HOLE = (-2.0, -1.0, 4.0, 1.0)
"""6 m × 2 m, 3 m from elements: its field varies within 4 m."""


def blast(gap: float = 3.0) -> NearField:
    return NearField(HOLE, gap, "pressure")


@pytest.mark.parametrize("order", [3, 6])
def test_elements_beside_a_force_are_in_proportion_to_its_distance(order: int) -> None:
    near, far = (NearField((5.0, 5.0, 5.0, 5.0), gap, "force") for gap in (8.0, 16.0))
    side = near.largest_side(order, 1e-3)

    assert side == FORCES[order] * 8.0
    assert far.largest_side(order, 1e-3) == pytest.approx(2.0 * side)
    assert near.error(order, side) == pytest.approx(1e-3)
    assert near.error(order, 2.0 * side) == pytest.approx(8e-3)
    assert near._replace(gap=0.0).error(order, side) == near._replace(gap=0.0).largest_side(order, 1e-3) == 0.0


@pytest.mark.parametrize("order", [3, 4, 5, 6])
def test_elements_as_wide_as_the_box_round_a_blast_have_the_measured_error_and_narrower_ones_less(order: int) -> None:
    assert blast().distance == 4.0
    assert blast().error(order, 8.0) == HOLES[order]
    assert blast().error(order, 4.0) == pytest.approx(HOLES[order] * 0.5 ** (order + 1))
    assert blast().error(order, 16.0) == pytest.approx(HOLES[order] * 2.0**WIDER)
    assert blast(7.0).error(order, 16.0) == HOLES[order]
    for accuracy in (1e-3, 0.1):
        assert blast().error(order, blast().largest_side(order, accuracy)) == pytest.approx(accuracy)


def test_beside_a_hole_that_waves_pass_it_is_the_part_of_the_motion_that_the_hole_makes() -> None:
    passed = blast()._replace(source="waves", wave_number=0.1)
    assert passed.error(4, 8.0) == pytest.approx(PASSED * 0.1 * 3.0 * (3.0 / 6.0) * HOLES[4])
    assert passed.error(4, 4.0) == pytest.approx(passed.error(4, 8.0) / 8.0)
    assert passed.error(4, passed.largest_side(4, 1e-3)) == pytest.approx(1e-3)
    assert passed._replace(wave_number=math.inf).error(4, 8.0) == HOLES[4]
    assert passed._replace(wave_number=0.0).largest_side(4, 1e-3) == math.inf
    assert passed.of_ties(1.0) == 0.0 == passed._replace(source="force").of_ties(1.0)
    assert blast().of_ties(0.5) == pytest.approx(TIES / 64.0)


def test_slopes_in_the_element_that_closes_a_period() -> None:
    mesh = Mesh.uniform(order=3, element=(1.5, 1.0), cells=(4, 2), periodic=(True, False))
    point = np.array([[5.7, 0.3]])  # of the last column, whose right nodes are those of the first one
    local = mesh.rule.slope(np.array([0.6]))[0] / 0.75

    np.testing.assert_allclose(slopes(mesh, point)[0].reshape(4, 4).sum(axis=0), local, rtol=1e-12)


def test_points_beyond_a_periodic_side_have_places_within_it() -> None:
    mesh = one_across()
    element, place = located(mesh, np.array([[-1.0, -1.0], [7.0, 0.5]]))
    assert mesh.elements[element].tolist() == [[0, 2], [0, 2]]
    np.testing.assert_allclose(place, [[2.0 * 5.0 / 6.0 - 1.0, 0.0], [2.0 / 6.0 - 1.0, 1.5]])


def test_errors_of_a_blast_are_largest_at_the_elements() -> None:
    """With the square of the distance inside, and less beyond; other fields are alike at all places."""
    places = [np.array([4.0, y]) for y in (0.0, 3.0, 4.0, 7.0)]  # 1, 3, 4 and 7 m from what is in the hole
    assert [blast().part_at(place) for place in places] == pytest.approx([1 / 16, 9 / 16, 1.0, (4 / 7) ** 4])
    assert blast().part_at(np.array([-5.0, 2.5])) == 1.0
    assert [blast()._replace(source=each).part_at(places[0]) for each in ("force", "waves")] == [1.0, 1.0]
    assert math.isfinite(NearField((0.0, 0.0, 0.0, 0.0), 1.0, "pressure").part_at(np.zeros(2)))
