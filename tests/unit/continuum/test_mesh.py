"""Meshes: nodes, elements and layers."""

import numpy as np
import pytest
from meshes import ORDER, buried, stepped, uneven

from dembound.continuum.edges import free_edges
from dembound.continuum.mesh import NONE, Around, Mesh


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
