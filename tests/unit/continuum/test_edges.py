"""The outer edges of meshes: lengths, which of them are free, and tractions on them."""

import numpy as np
import pytest
from meshes import ORDER, below, buried

from dembound.continuum.edges import edge_lengths, free_edges, traction_in
from dembound.continuum.mesh import Around, Mesh
from dembound.table import EVERYWHERE


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
