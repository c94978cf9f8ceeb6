"""Meshes: nodes, elements and layers."""

from dataclasses import replace

import numpy as np
import pytest
from meshes import ORDER, below, buried, stepped, uneven

from dembound.continuum.axis import NONE, Around, Rule
from dembound.continuum.edges import edge_lengths, free_edges, traction_in
from dembound.continuum.interpolation import located
from dembound.continuum.mesh import Mesh
from dembound.table import EVERYWHERE


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


def test_a_periodic_mesh_has_no_last_line() -> None:
    mesh = Mesh.uniform(order=3, element=(1.0, 1.0), cells=(4, 2), periodic=(True, False))

    assert mesh.count == 4 * 3 * (2 * 3 + 1)
    assert mesh.nodes[3, 0, -1] == mesh.nodes[0, 0, 0]
    assert mesh.areas.sum() == pytest.approx(8.0)


def test_columns_and_rows_have_their_sizes() -> None:
    mesh = uneven()
    columns, rows = np.array([0.0, 1.5, 4.0, 6.0, 7.0, 9.0]), np.array([0.0, 3.0, 5.0, 7.0, 10.0, 11.0])
    for (column, row), nodes in zip(mesh.elements, mesh.nodes, strict=True):
        x = np.interp(mesh.rule.points, [-1.0, 1.0], columns[column : column + 2])
        y = np.interp(mesh.rule.points, [-1.0, 1.0], rows[row : row + 2])
        expected = np.stack(np.meshgrid(x, y), axis=-1)
        np.testing.assert_allclose(mesh.positions[nodes], expected, rtol=0.0, atol=1e-14)
        assert mesh.areas[nodes[1:-1, 1:-1]].sum() == pytest.approx(
            np.sum(mesh.rule.weights[1:-1]) ** 2 * 0.25 * np.diff(columns)[column] * np.diff(rows)[row], rel=1e-13
        )

    assert mesh.areas.sum() == pytest.approx(9.0 * 11.0 - 3.0 * 2.0, rel=1e-13)
    np.testing.assert_allclose(mesh.size, [9.0, 11.0])
    # of the elements that are there
    assert set(map(tuple, mesh.shapes.tolist())) == {(w, h) for w in mesh.widths for h in mesh.heights}


def test_elements_round_a_box_divide_its_sides() -> None:
    """At most the largest size is exceeded by rounding: (0.1 + 0.2)/0.1 is above 3."""
    mesh = Mesh.around((0.0, 0.0, 6.0, 2.5), (2.5, 2.0), margin=Around(1, 2, 1, 0), layer=Around())
    assert mesh.widths == (2.0,) * 6
    assert mesh.heights == (1.25,) * 3
    assert mesh.box == (1, 1, 4, 3)
    assert mesh.origin == (-2.0, -1.25)

    mesh = Mesh.around((0.0, 0.0, 0.3, 0.1 + 0.2), (0.1, 0.1), margin=Around(), layer=Around())
    assert mesh.cells == (3, 3)


def test_columns_beside_the_box_end_at_their_own_levels() -> None:
    """3 m and 5 m above the lower side of the box, at the ends of its rows; the layers end there, too."""
    mesh = stepped()
    (left, right), (x, y) = (0.0, 6.0), mesh.positions.T

    assert mesh.heights == (3.0, 3.0, 3.0, 2.0, 4.0)
    assert y[x < left].max() == y[x == left].max() == 3.0
    assert y[x > right].max() == y[x == right].max() == 5.0
    assert mesh.tops.tolist() == [3, 3, 3, 5, 5, 4, 4]
    assert mesh.areas.sum() == pytest.approx(9.0 * 9.0 + 6.0 * 6.0 + 6.0 * 11.0, rel=1e-13)
    assert mesh.held.sum() == np.count_nonzero((x == -9.0) | (x == 12.0) | (y == -6.0))
    assert sorted(map(tuple, mesh.rectangles[mesh.rectangles[:, 3] > 3.0].tolist())) == [
        (6.0, 3.0, 9.0, 5.0),
        (9.0, 3.0, 12.0, 5.0),
    ]


def test_planes_of_symmetry_are_neither_free_nor_absorb() -> None:
    """Their nodes but for those on held edges are known."""
    margin, layer = Around(right=1, bottom=1), Around(right=1, bottom=1)
    mesh = Mesh.around((0.0, 0.0, 6.0, 2.0), (3.0, 2.0), ORDER, margin=margin, layer=layer, mirror=Around(left=1))
    x, y = mesh.positions.T

    np.testing.assert_array_equal(mesh.on_mirrors(0), np.flatnonzero((x == 0.0) & (y > -4.0)))
    assert len(mesh.on_mirrors(1)) == 0
    assert {tuple(line) for line in free_edges(mesh).tolist()} == {(6.0, 2.0, 9.0, 2.0), (9.0, 2.0, 12.0, 2.0)}


SMALL = {"order": 3, "element": (1.0, 1.0), "cells": (4, 3)}
BOX = {"box": (0.0, 0.0, 6.0, 2.0), "size": (3.0, 2.0), "margin": NONE, "layer": NONE}
ONLY_BESIDE = "only beside a box that reaches the free surface"
NO_PLACE = "leaves no place for a margin or a layer at the top"


@pytest.mark.parametrize(
    ("make", "keys", "message"),
    [
        (Mesh.around, BOX | {"box": (0.0, 0.0, 6.0, 0.0)}, "the box is empty"),
        (Mesh.around, BOX | {"surface": 1.0}, "the free surface, y = 1 m, is below the top of the box, 2 m"),
        (Mesh.around, BOX | {"surface": 3.0, "margin": Around(top=1)}, NO_PLACE),
        (Mesh.around, BOX | {"size": (6.0, 2.0), "layer": Around(left=1), "periodic": (True, False)}, "periodic along"),
        (Mesh.around, BOX | {"layer": Around(left=1), "mirror": Around(left=1)}, "plane of symmetry across axis 0 has"),
        (Mesh.uniform, SMALL | {"box": (1, 1, 2, 3), "periodic": (True, False), "levels": (2, 3)}, ONLY_BESIDE),
        (Mesh.uniform, SMALL | {"layer": Around(bottom=2, top=2)}, "more elements along axis 1 than the mesh, 3"),
    ],
)
def test_meshes_that_cannot_be_are_refused(make, keys: dict, message: str) -> None:
    box = [keys[name] for name in ("box", "size")] if make == Mesh.around else []
    more = {name: value for name, value in keys.items() if not box or name not in ("box", "size")}
    with pytest.raises(ValueError, match=message):
        make(*box, **more)


EACH = pytest.mark.parametrize("order", range(3, 7))


def test_points_of_order_four_are_those_of_the_books() -> None:
    np.testing.assert_allclose(Rule(4).points, [-1.0, -np.sqrt(3 / 7), 0.0, np.sqrt(3 / 7), 1.0], rtol=0.0, atol=4e-16)
    np.testing.assert_allclose(Rule(4).weights, np.array([9, 49, 64, 49, 9]) / 90, rtol=1e-14)


@EACH
def test_the_quadrature_is_exact_up_to_degree_2p_minus_1(order: int) -> None:
    rule = Rule(order)
    for degree in range(2 * order):
        exact = 2.0 / (degree + 1) if degree % 2 == 0 else 0.0
        assert np.sum(rule.weights * rule.points**degree) == pytest.approx(exact, abs=1e-14)
    # a Lobatto rule is not exact one degree higher
    assert abs(np.sum(rule.weights * rule.points ** (2 * order)) - 2.0 / (2 * order + 1)) > 1e-4


@EACH
def test_shapes_interpolate_and_extrapolate_polynomials(order: int) -> None:
    rule, x = Rule(order), np.array([-1.3, -1.0, 0.123, 1.0, 1.2])
    # Lagrange polynomials grow to some 1.3^p beyond the ends
    np.testing.assert_allclose(rule.shape(x) @ rule.points**order, x**order, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(rule.shape(rule.points), np.eye(order + 1), rtol=0.0, atol=1e-14)


@pytest.mark.parametrize(("side", "length"), [("left", 6.0), ("right", 6.0), ("bottom", 18.0), ("top", 12.0)])
def test_lengths_along_the_edges(side: str, length: float) -> None:
    """Round a box that takes up a part of the top edge."""
    mesh = below()
    place = mesh.positions[:, 0 if side in ("left", "right") else 1]
    at_end = place == (place.min() if side in ("left", "bottom") else place.max())
    lengths = edge_lengths(mesh, side)

    assert lengths.sum() == pytest.approx(length)
    assert set(np.flatnonzero(lengths)) == set(np.flatnonzero(at_end))


def test_the_surface_is_what_is_free_beyond_the_box() -> None:
    """Sides without a layer, but not those that face the box: of a mesh on the left alone bottom and top."""
    left = Mesh.around((0.0, 0.0, 6.0, 4.0), (3.0, 2.0), ORDER, margin=Around(left=1), layer=Around(left=1))
    ends = {tuple(line) for line in free_edges(left).tolist()}
    assert ends == {(x, y, x + 3.0, y) for x in (-6.0, -3.0) for y in (0.0, 4.0)}
    ends = {tuple(line) for line in free_edges(below()).tolist()}
    assert ends == {(x, 2.0, x + 3.0, 2.0) for x in (-6.0, -3.0, 6.0, 9.0)}
    above = Mesh.around((0.0, 0.0, 6.0, 4.0), (3.0, 2.0), ORDER, margin=Around(top=1), layer=Around(top=1))
    ends = {tuple(line) for line in free_edges(above).tolist()}
    assert ends == {(x, y, x, y + 2.0) for x in (0.0, 6.0) for y in (4.0, 6.0)}
    assert len(free_edges(buried())) == 0
    round_a_pipe = Mesh.uniform(
        order=3, element=(1.0, 1.0), cells=(4, 2), periodic=(True, False), layer=Around(bottom=1)
    )
    assert (free_edges(round_a_pipe)[:, [1, 3]] == 2.0).all()


TOP = 2.0


def ground() -> Mesh:
    """Round a box of 6 m × 2 m at the surface y = 2 m; elements 3 m wide, layers beyond x = −6 m and 15 m."""
    return Mesh.around((0.0, 0.0, 6.0, TOP), (3.0, 2.0), 4, margin=Around(2, 3, 1, 0), layer=Around(1, 1, 1, 0))


@pytest.mark.parametrize(("first", "last"), [(6.0, 15.0), (7.1, 10.1), (8.0, 13.7), (-6.0, -3.0), (-5.2, -0.7)])
def test_forces_are_those_of_a_uniform_traction(first: float, last: float) -> None:
    mesh = ground()
    traction = traction_in(mesh, (first, 1.9, last, 2.5))
    x, y = mesh.positions[traction.node].T

    assert (y == TOP).all()
    assert traction.length == pytest.approx(last - first, rel=1e-12)
    assert traction.least == pytest.approx(3.0, rel=1e-12)
    assert not traction.absorbs
    # shape functions of order 4 have all of these polynomials, whose means over the width follow
    for power in range(5):
        mean = (last ** (power + 1) - first ** (power + 1)) / ((power + 1) * (last - first))
        assert traction.share @ x**power == pytest.approx(mean, rel=1e-11)


def test_sides_of_the_box_and_inner_edges_are_no_surface() -> None:
    mesh = ground()

    assert traction_in(mesh, (0.0, 1.0, 6.0, 2.0)).length == 0.0  # the body's own surface
    assert traction_in(mesh, (7.0, -1.0, 12.0, 1.9)).length == 0.0
    assert len(traction_in(mesh, (7.0, -1.0, 12.0, 1.9)).node) == 0
    below = Mesh.around((0.0, 0.0, 6.0, TOP), (3.0, 2.0), 4, margin=Around(0, 0, 2, 0), layer=Around(0, 0, 1, 0))
    side = traction_in(below, (-1.0, -3.5, 0.5, -0.5))  # the left edge below the body is free
    x, y = below.positions[side.node].T
    assert (x == 0.0).all()
    assert side.length == pytest.approx(3.0, rel=1e-12)
    assert side.least == pytest.approx(2.0, rel=1e-12)
    assert side.share @ y == pytest.approx(-2.0, rel=1e-12)


def test_layers_are_not_loaded() -> None:
    mesh = ground()
    traction = traction_in(mesh, (11.0, 2.0, 16.0, 2.0))

    assert traction.absorbs
    assert mesh.positions[traction.node, 0].max() == 15.0
    assert traction_in(mesh, (-9.0, -6.0, 18.0, -1.5)).absorbs is False  # outer edges of layers are held


def test_the_ground_may_end_above_the_surface_of_the_mesh() -> None:
    """The skin is not a part of the mesh: a region with either of both has the surface."""
    mesh, depth = ground(), {"top": 0.4}

    for bottom, top in ((2.3, 2.4), (1.7, 2.1), (1.0, 3.0)):
        traction = traction_in(mesh, (7.0, bottom, 11.0, top), depth)
        assert traction.length == pytest.approx(4.0, rel=1e-12)
    assert traction_in(mesh, (7.0, 2.41, 11.0, 3.0), depth).length == 0.0
    assert traction_in(mesh, (7.0, 2.1, 11.0, 2.4)).length == 0.0
    assert traction_in(mesh, (7.0, 1.0, 11.0, 1.9), depth).length == 0.0


def test_mirror_planes_and_periodic_sides_are_no_surface() -> None:
    plain = {"order": 3, "element": (1.0, 2.0), "cells": (3, 2)}

    assert traction_in(Mesh.uniform(**plain), EVERYWHERE).length == pytest.approx(14.0, rel=1e-12)
    assert traction_in(Mesh.uniform(**plain, mirror=Around(left=1)), EVERYWHERE).length == pytest.approx(
        10.0, rel=1e-12
    )
    around = traction_in(Mesh.uniform(**plain, periodic=(True, False)), EVERYWHERE)
    assert around.length == pytest.approx(6.0, rel=1e-12)
    assert around.share.sum() == pytest.approx(1.0, rel=1e-12)


def test_a_slit_doubles_the_nodes_below_the_corner_of_the_box() -> None:
    """Elements right of it have the copies, also that above the corner; all others, and their areas, are the same."""
    plain = Mesh.around(
        (0.0, 0.0, 4.0, 2.0), (1.0, 1.0), 3, margin=Around(1, 1, 1), layer=Around(1, 1, 2), levels=(2, 1)
    )
    mesh = replace(plain, slit=True)
    own, copies = mesh.doubled

    assert mesh.count == plain.count + len(own) == plain.count + 3 * 3 + 1
    assert np.array_equal(mesh.positions[own], mesh.positions[copies])
    np.testing.assert_allclose(mesh.positions[own, 0], 4.0)
    np.testing.assert_allclose(mesh.positions[own[[0, -1]], 1], [-3.0, 0.0])
    right = mesh.rectangles[:, 0] > 3.9
    assert np.array_equal(mesh.is_right, right)
    assert not np.isin(mesh.nodes[right], own).any()
    assert not np.isin(mesh.nodes[~right], copies).any()
    where = np.append(np.arange(plain.count), own)  # the node of each in the mesh without a slit
    assert np.array_equal(where[mesh.nodes], plain.nodes)
    np.testing.assert_allclose(np.bincount(where, mesh.areas), plain.areas, rtol=1e-14)
    # places just left and right of it, which lie in elements of other sides where that is asked for
    places = np.array([[3.9, -0.5], [4.1, -0.5], [4.1, -0.5]])
    found, _ = located(mesh, places, np.array([False, True, False]))
    assert mesh.is_right[found].tolist() == [False, True, False]
