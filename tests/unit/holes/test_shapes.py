"""Positions in holes, shape by shape."""

import numpy as np
import pytest
from pydantic import ValidationError

from dembound.holes import Ellipse, Hole, Polygon, Rectangle

HORSESHOE = ((1.0, 1.0), (4.0, 1.0), (4.0, 5.0), (3.0, 5.0), (3.0, 2.0), (2.0, 2.0), (2.0, 5.0), (1.0, 5.0))


def test_an_ellipse_is_turned_counter_clockwise() -> None:
    hole = Ellipse(name="h", type="ellipse", centre=(1.0, 2.0), semi_axes=(3.0, 1.0), angle=60.0)
    along = np.array([0.5, np.sqrt(0.75)])
    across = np.array([-along[1], along[0]])
    places = np.stack([2.99 * along, 3.01 * along, -2.99 * along, 0.99 * across, 1.01 * across])

    assert hole.takes(places + np.array([1.0, 2.0]), 1.0).tolist() == [True, False, True, True, False]


@pytest.mark.parametrize("points", [HORSESHOE, HORSESHOE[::-1]])
def test_a_polygon_may_go_round_either_way_and_hollows_stay_out(points) -> None:
    hole = Polygon(name="h", type="polygon", points=points)
    places = np.array([(1.5, 4.0), (2.5, 1.5), (3.5, 2.0), (2.5, 2.0 + 1e-9), (2.5, 4.0), (0.5, 3.0), (4.5, 1.5)])
    assert hole.takes(places, 0.1).tolist() == [True, True, True, False, False, False, False]
    # a corner on the ray counts once
    rhomb = Polygon(name="h", type="polygon", points=((0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)))
    places = np.array([(0.5, 0.0), (-2.0, 0.0), (-2.0, 1.0), (0.0, 0.0)])
    assert rhomb.takes(places, 0.1).tolist() == [True, False, False, True]


@pytest.mark.parametrize(
    ("shape", "keys", "message"),
    [
        (Rectangle, {"corners": (1.0, 0.0, 1.0, 2.0)}, "must have x0 < x1 and y0 < y1"),
        (Polygon, {"points": ((0.0, 0.0), (1.0, 1.0))}, "has 2, must have at least three"),
    ],
)
def test_shapes_without_an_inside_are_refused(shape: type[Hole], keys: dict[str, object], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        shape(name="h", type=shape.__name__.lower(), **keys)
