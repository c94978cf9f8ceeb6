"""The outer edges of meshes: lengths, and which of them are free."""

import numpy as np
import pytest
from meshes import ORDER, below, buried

from dembound.continuum.edges import edge_lengths, free_edges
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
