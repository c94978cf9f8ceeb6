"""Rows of elements beside ground whose layers differ at its sides."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.continuum.layer import USUAL
from dembound.continuum.medium import Layered, Medium, Unlike
from dembound.continuum.part import GridBody
from dembound.disks.surroundings.elements import mesh_of, shared_edges
from dembound.disks.surroundings.settings import Settings

ROCK, SOFT, CLAY = (Medium.isotropic(2500.0, speed, 0.5 * speed) for speed in (1000.0, 400.0, 600.0))
UNLIKE = Unlike(Layered((ROCK, SOFT), (8.0,)), Layered((ROCK, CLAY, SOFT), (8.2, 13.0)))


def test_joints_of_either_side_that_are_near_share_an_edge() -> None:
    assert UNLIKE.joints == (8.0, 8.2, 13.0)
    assert UNLIKE.between_joints == ((ROCK, ROCK), (SOFT, ROCK), (SOFT, CLAY), (SOFT, SOFT))
    assert shared_edges(UNLIKE, 0.5) == (8.0, 13.0)
    assert shared_edges(UNLIKE, 0.1) == (8.0, 8.2, 13.0)
    twice = Unlike(UNLIKE.left, Layered((ROCK, CLAY, SOFT), (7.9, 8.2)))
    assert shared_edges(twice, 0.5) == (8.0, 8.2)


def test_elements_have_the_layers_of_their_side() -> None:
    settings = Settings(4, 5.0, 0.0, 1, 2, USUAL, 0.1, beside=(1.0, 1.0, 2.0))
    mesh = mesh_of(settings, (0.0, 0.0, 20.0, 20.0), ("left", "right", "bottom"), ground=UNLIKE)
    edges = mesh.origin[1] + mesh.axes[1].edges
    assert all(np.abs(edges - joint).min() < 1e-9 for joint in (8.0, 13.0))
    body = GridBody(mesh=mesh, medium=Unlike(UNLIKE.left, replace(UNLIKE.right, joints=(8.0, 13.0))))
    x, y = mesh.rectangles[:, ::2].mean(axis=1), mesh.rectangles[:, 1::2].mean(axis=1)
    expected = np.where(x > 20.0, 2 + (y > 8.0) + (y > 13.0), 1 * (y > 8.0))
    np.testing.assert_array_equal(body.layer, expected)
    areas = [body.ground.media[number].density for number in body.layer]
    assert body.mass.sum() == pytest.approx(np.dot(areas, np.prod(mesh.element_sizes, axis=1)))
    assert body.ground.at(-3.0) is ROCK
    with pytest.raises(ValueError, match="not the same"):
        body.ground.at(15.0 - 4.0)
    with pytest.raises(ValueError, match="one medium"):
        _ = body.ground.only
