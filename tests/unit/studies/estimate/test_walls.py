"""What formulas say of walls made of disks."""

import pytest

from dembound.holes import Circle, Rectangle
from dembound.studies.estimate.walls import of_hole


def test_walls_of_circles_are_of_first_order_and_those_of_rectangles_of_second() -> None:
    """docs/charts.md: 7 % with 10 disks along the radius; docs/error_bound.md: 4.7 % with 3 along the smaller half."""
    circle = Circle.model_validate({"type": "circle", "name": "a", "centre": (0.0, 0.0), "radius": 10.0})
    long = Rectangle.model_validate({"type": "rectangle", "name": "b", "corners": (0.0, 0.0, 6.0, 20.0)})
    assert of_hole(circle, 1.0) == pytest.approx(0.07)
    assert of_hole(circle, 0.5) == pytest.approx(0.035)
    assert of_hole(long, 1.0) == pytest.approx(0.05)
    assert of_hole(long, 0.5) == pytest.approx(0.0125)
