"""The level floor that holes leave beside a side."""

import pytest

from dembound.holes import Circle, Polygon, Rectangle
from dembound.holes.hole import floor_beside

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
