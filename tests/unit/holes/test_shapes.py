"""What lies in a hole, shape by shape."""

import numpy as np
import pytest
from pydantic import ValidationError

from dembound.holes import Circle, Ellipse, Hole, Polygon, Rectangle

HORSESHOE = ((1.0, 1.0), (4.0, 1.0), (4.0, 5.0), (3.0, 5.0), (3.0, 2.0), (2.0, 2.0), (2.0, 5.0), (1.0, 5.0))
SHAPES = [
    Circle(name="h", type="circle", centre=(3.0, -1.0), radius=2.0),
    Ellipse(name="h", type="ellipse", centre=(3.0, -1.0), semi_axes=(2.0, 0.5), angle=30.0),
    Rectangle(name="h", type="rectangle", corners=(1.0, -2.0, 4.0, 1.5)),
    Polygon(name="h", type="polygon", points=HORSESHOE),
]


def scattered(hole: Hole) -> np.ndarray:
    """Places (k, 2) in and around a hole's box."""
    x0, y0, x1, y1 = hole.box
    low, high = np.array([2.0 * x0 - x1, 2.0 * y0 - y1]), np.array([2.0 * x1 - x0, 2.0 * y1 - y0])
    return np.random.default_rng(1).uniform(low, high, (90_000, 2))


@pytest.mark.parametrize(
    ("hole", "area"),
    list(zip(SHAPES, [4.0 * np.pi, np.pi, 10.5, 9.0], strict=True)),
    ids=[hole.type for hole in SHAPES],
)
def test_a_hole_fills_its_area_and_touches_the_sides_of_its_box(hole: Hole, area: float) -> None:
    places = scattered(hole)
    inside = places[hole.contains(places)]
    x0, y0, x1, y1 = hole.box
    wide, high = x1 - x0, y1 - y0
    share = area / (9.0 * wide * high)

    # four standard deviations of a count
    assert len(inside) == pytest.approx(90_000 * share, abs=4.0 * np.sqrt(90_000 * share * (1.0 - share)))
    assert np.all(inside >= (x0, y0))
    assert np.all(inside <= (x1, y1))
    # 10,000 places fall in the box. A cap of an ellipse 2 % of the box deep is 4/3·√2·2·0.02^1.5 = 0.5 % of it, and
    # misses all of them with a probability of e^-50
    assert np.all(inside.min(axis=0) < (x0 + 0.02 * wide, y0 + 0.02 * high))
    assert np.all(inside.max(axis=0) > (x1 - 0.02 * wide, y1 - 0.02 * high))


def test_an_ellipse_is_turned_counter_clockwise() -> None:
    hole = Ellipse(name="h", type="ellipse", centre=(1.0, 2.0), semi_axes=(3.0, 1.0), angle=60.0)
    along = np.array([0.5, np.sqrt(0.75)])
    across = np.array([-along[1], along[0]])
    places = np.stack([2.99 * along, 3.01 * along, -2.99 * along, 0.99 * across, 1.01 * across])

    assert hole.contains(places + np.array([1.0, 2.0])).tolist() == [True, False, True, True, False]


@pytest.mark.parametrize("points", [HORSESHOE, HORSESHOE[::-1]])
def test_a_polygon_may_go_round_either_way_and_hollows_stay_out(points) -> None:
    hole = Polygon(name="h", type="polygon", points=points)
    places = np.array([(1.5, 4.0), (2.5, 1.5), (3.5, 2.0), (2.5, 2.0 + 1e-9), (2.5, 4.0), (0.5, 3.0), (4.5, 1.5)])
    assert hole.contains(places).tolist() == [True, True, True, False, False, False, False]
    # a corner on the ray counts once
    rhomb = Polygon(name="h", type="polygon", points=((0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)))
    places = np.array([(0.5, 0.0), (-2.0, 0.0), (-2.0, 1.0), (0.0, 0.0)])
    assert rhomb.contains(places).tolist() == [True, False, False, True]


def test_what_lies_on_the_rim_of_a_round_or_upright_hole_stays() -> None:
    circle, _, rectangle, _ = SHAPES
    assert not circle.contains(np.array([(5.0, -1.0), (3.0, 1.0)])).any()
    assert not rectangle.contains(np.array([(1.0, 0.0), (2.0, 1.5), (4.0, -2.0)])).any()


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
