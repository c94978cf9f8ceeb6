"""Holes shape by shape: positions in them, their outlines, and the level floor that they leave at a side."""

import numpy as np
import pytest
from pydantic import ValidationError

from dembound.holes import Circle, Ellipse, Hole, Polygon, Rectangle
from dembound.holes.hole import floor_beside
from dembound.holes.outline import EllipseOutline, Outline, PolygonOutline

HORSESHOE = ((1.0, 1.0), (4.0, 1.0), (4.0, 5.0), (3.0, 5.0), (3.0, 2.0), (2.0, 2.0), (2.0, 5.0), (1.0, 5.0))
HOLES = [
    Circle(name="h", type="circle", centre=(3.0, -1.0), radius=2.0),
    Ellipse(name="h", type="ellipse", centre=(3.0, -1.0), semi_axes=(2.0, 0.5), angle=30.0),
    Rectangle(name="h", type="rectangle", corners=(1.0, -2.0, 4.0, 1.5)),
    Polygon(name="h", type="polygon", points=HORSESHOE),
    Polygon(name="h", type="polygon", points=HORSESHOE[::-1]),
]
ONE_ROUND = np.linspace(0.0, 1.0, 20_001)


def curve(outline: Outline) -> np.ndarray:
    """Points (20001, 2) of one round."""
    return outline.at(outline.period * ONE_ROUND)


@pytest.mark.parametrize("hole", HOLES, ids=[hole.type for hole in HOLES])
def test_an_outline_runs_counter_clockwise_between_inside_and_outside(hole) -> None:
    outline = hole.outline
    places = 0.5 * (outline.period / 20_000.0) + outline.period * ONE_ROUND[:-1]  # no corners
    points, ahead = outline.at(places), outline.at(places + 1e-6)
    right = np.stack([(ahead - points)[:, 1], (points - ahead)[:, 0]], axis=1)
    right *= 1e-4 / np.hypot(*right.T)[:, None]

    assert hole.takes(points - right, 1.0).all()
    assert not hole.takes(points + right, 1.0).any()
    np.testing.assert_allclose(
        outline.at(np.array([0.3 * outline.period])), outline.at(np.array([-0.7, 1.3]) * outline.period)[:1], atol=1e-12
    )
    x0, y0, x1, y1 = hole.box
    closed = curve(outline)
    np.testing.assert_allclose([*closed.min(axis=0), *closed.max(axis=0)], [x0, y0, x1, y1], atol=1e-3)


OUTLINES = [hole.outline for hole in HOLES] + [EllipseOutline((1.0, 2.0), (9.0, 0.3), 0.7)]


@pytest.mark.parametrize("outline", OUTLINES)
def test_the_nearest_point_is_at_the_least_distance_and_all_is_in_a_box_around_it(outline: Outline) -> None:
    closed = curve(outline)
    low, high = closed.min(axis=0), closed.max(axis=0)
    places = np.random.default_rng(1).uniform(low - 1.0, high + 1.0, (100, 2))
    found = outline.nearest(places)
    distance = np.hypot(*(outline.at(found) - places).T)
    least = np.array([np.hypot(*(closed - place).T).min() for place in places])

    assert ((found >= 0.0) & (found < outline.period)).all()
    # every point of the curve is half a spacing or less, 1 mm, from one of these 20,000
    spacing = np.hypot(*np.diff(closed, axis=0).T).max()
    assert (distance <= least + 1e-9).all()
    assert (distance >= least - 0.51 * spacing).all()
    # a point of the curve is its own nearest one
    np.testing.assert_allclose(outline.at(outline.nearest(outline.at(found))), outline.at(found), atol=1e-9)
    assert outline.within((*(low - 1.0), *(high + 1.0))) == [(0.0, outline.period)]
    assert outline.within((*(high + 1.0), *(high + 2.0))) == []


@pytest.mark.parametrize("outline", OUTLINES)
@pytest.mark.parametrize("box", [(2.0, -9.0, 9.0, 9.0), (1.4, -1.4, 3.6, 1.2)])
def test_parts_within_a_box_are_all_that_lies_in_it(outline: Outline, box: tuple[float, float, float, float]) -> None:
    places = outline.period * ONE_ROUND[:-1]
    points = outline.at(places)
    inside = ((points > box[:2]) & (points < box[2:])).all(axis=1)
    parts = outline.within(box)
    covered = np.zeros(len(places), dtype=int)
    for start, length in parts:
        covered += (places - start) % outline.period < length

    # but for one point at each end of a part
    assert np.count_nonzero(covered != inside) <= 2 * len(parts)
    assert covered.max(initial=0) <= 1
    for part in parts:
        assert not outline.beyond(np.array([part[0] + 0.5 * part[1]]), part).any()


def test_a_part_is_as_far_as_its_nearer_end_and_along_a_side_of_the_box_there_is_none() -> None:
    circle = EllipseOutline((0.0, 0.0), (1.0, 1.0))
    np.testing.assert_allclose(
        circle.beyond(np.array([5.5, 6.2, 0.2, 1.2, 2.0]), (5.8, 1.0)),
        [0.3, 0.0, 0.0, 1.2 + circle.period - 6.8, 2.0 + circle.period - 6.8],
        atol=1e-12,
    )
    assert circle.within((-0.1, -0.1, 0.1, 0.1)) == []
    square = PolygonOutline(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]))
    ((start, length),) = square.within((-1.0, -1.0, 3.0, 2.0))
    np.testing.assert_allclose(square.at(np.array([start, start + length])), [[0.0, 2.0], [2.0, 2.0]], atol=1e-12)
    assert length == pytest.approx(6.0)
    assert square.within((-1.0, -1.0, 2.0, 2.0))[0][1] == pytest.approx(4.0)


def test_edges_that_cross_or_touch_are_found() -> None:
    def crosses(*points: tuple[float, float]) -> bool:
        return PolygonOutline(np.array(points)).crosses_itself

    assert not any(crosses(*hole.points) for hole in HOLES[3:])
    assert not crosses((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
    assert not crosses((0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (2.0, 0.0), (0.0, 1.0))  # a point twice, three in line
    assert crosses((0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0))
    assert crosses((0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 0.0), (0.0, 2.0))  # a corner on an edge
    assert Polygon(name="h", type="polygon", points=((0, 0), (2, 2), (2, 0), (0, 2))).outline is None


BOX = (10.0, 0.0, 70.0, 30.0)


def polygon(*points: tuple[float, float]) -> Polygon:
    return Polygon(type="polygon", name="cut", points=points)


def rectangle(*corners: float) -> Rectangle:
    return Rectangle(type="rectangle", name="cut", corners=corners)


SLOPE = polygon((35.0, 31.0), (55.0, 15.3), (71.0, 15.3), (71.0, 31.0))


def test_a_slope_leaves_a_floor_at_one_side() -> None:
    """It is level up to where the slope, of 15.7 m in 20 m, is half a diameter high; an eighth of one is rounding."""
    floor = floor_beside([SLOPE], BOX, "right", 1.0)

    assert floor.height == pytest.approx(15.3, abs=1e-12)
    assert floor.width == pytest.approx(15.0 + 0.5 * 20.0 / 15.7, abs=0.125)
    assert floor_beside([SLOPE], BOX, "left", 1.0) is None
    assert floor_beside([], BOX, "left", 1.0) is None


def test_holes_join_and_floors_may_be_below_the_disks_or_narrow() -> None:
    floor = floor_beside([rectangle(0.0, 20.0, 30.0, 31.0), rectangle(5.0, 12.0, 16.0, 20.5)], BOX, "left", 1.0)
    assert floor.height == pytest.approx(12.0, abs=1e-12)
    assert floor.width == pytest.approx(6.0, abs=0.125)
    floor = floor_beside([rectangle(60.0, -5.0, 80.0, 40.0)], BOX, "right", 1.0)
    assert floor.height == 0.0  # the lower side of the disks
    floor = floor_beside([polygon((35.0, 31.0), (71.0, 10.0), (71.0, 31.0))], BOX, "right", 1.0)
    assert floor.width < 2.0  # of a slope up to the side


@pytest.mark.parametrize(
    "hole",
    [
        rectangle(60.0, 10.0, 80.0, 29.0),
        rectangle(30.0, 10.0, 60.0, 40.0),
        Circle(type="circle", name="cut", centre=(70.0, 15.0), radius=4.0),
    ],
    ids=["covered", "inside", "niche"],
)
def test_without_a_way_down_along_the_side_there_is_none(hole) -> None:
    assert floor_beside([hole], BOX, "right", 1.0) is None


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
