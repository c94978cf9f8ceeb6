"""The outer edges of meshes: lengths, and which of them are free."""

import numpy as np
import pytest
from meshes import ORDER, below, buried, stepped

from dembound.continuum.edges import edge_lengths, elements_at, free_edges, nodes_at
from dembound.continuum.mesh import Around, Mesh


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


def test_the_top_is_where_each_column_ends() -> None:
    mesh = stepped()
    lengths = edge_lengths(mesh, "top")
    y = mesh.positions[:, 1]

    assert lengths[y == 3.0].sum() == pytest.approx(9.0, rel=1e-13)
    assert lengths[y == 5.0].sum() == pytest.approx(6.0, rel=1e-13)
    assert lengths.sum() == pytest.approx(15.0, rel=1e-13)
    ends = {tuple(line) for line in free_edges(mesh).tolist()}
    assert ends == {(x, 3.0, x + 3.0, 3.0) for x in (-9.0, -6.0, -3.0)} | {(x, 5.0, x + 3.0, 5.0) for x in (6.0, 9.0)}


@pytest.mark.parametrize("side", ["left", "right", "bottom", "top"])
def test_nodes_lie_along_the_side_in_order(side: str) -> None:
    mesh = stepped()
    axis = 0 if side in ("left", "right") else 1
    nodes, rectangles = nodes_at(mesh, side), mesh.rectangles[elements_at(mesh, side)]
    level = rectangles[:, axis + 2 * (side in ("right", "top"))]

    assert (mesh.positions[nodes, axis] == level[:, None]).all()
    assert (np.diff(mesh.positions[nodes, 1 - axis], axis=1) > 0.0).all()
