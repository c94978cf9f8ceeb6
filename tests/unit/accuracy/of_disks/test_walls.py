"""What formulas say of walls made of disks."""

import pytest
from small_cases import PUSHED, small

from dembound.accuracy.of_disks.walls import STRAIGHT, misfit, of_hole, wall_error
from dembound.casefile.disks import DiskCase
from dembound.holes import Circle, Rectangle


def test_walls_of_circles_are_of_first_order_and_those_of_rectangles_of_second() -> None:
    """docs/charts.md: 7 % with 10 disks along the radius; docs/error_bound.md: 4.7 % with 3 along the smaller half."""
    circle = Circle.model_validate({"type": "circle", "name": "a", "centre": (0.0, 0.0), "radius": 10.0})
    long = Rectangle.model_validate({"type": "rectangle", "name": "b", "corners": (0.0, 0.0, 6.0, 20.0)})
    assert of_hole(circle, 1.0) == pytest.approx(0.07)
    assert of_hole(circle, 0.5) == pytest.approx(0.035)
    assert of_hole(long, 1.0) == pytest.approx(0.05)
    assert of_hole(long, 0.5) == pytest.approx(0.0125)


def test_walls_that_are_not_between_disks_change_the_size_of_a_hole() -> None:
    """Disks of 1 m from the origin on: walls at 2, 8 and 20 m fit, one at 8.4 m is 0.4 m off, of a half of 3.2 m."""
    box = (0.0, 0.0, 30.0, 30.0)

    def hole(right: float, top: float = 20.0) -> Rectangle:
        return Rectangle.model_validate({"type": "rectangle", "name": "b", "corners": (2.0, 2.0, right, top)})

    assert misfit(hole(8.0), 1.0, box) == pytest.approx(0.0, abs=1e-12)
    assert misfit(hole(8.4), 1.0, box) == pytest.approx(0.4 / 3.2)
    assert misfit(hole(8.4), 1.0, (0.4, 0.0, 30.4, 30.0)) == pytest.approx(0.4 / 3.2)  # there the left one is off
    assert misfit(hole(8.4), 0.4, box) == pytest.approx(0.0, abs=1e-12)
    assert misfit(hole(8.0, top=31.5), 1.0, box) == pytest.approx(0.0, abs=1e-12)  # open at the surface
    assert misfit(hole(8.4), 1.0, None) == 0.0  # no lattice


def test_an_error_beside_holes_is_that_of_their_walls_and_of_their_size() -> None:
    cave = {"name": "cave", "type": "rectangle", "corners": [4.0, 0.5, 6.1, 2.0]}
    case = small(PUSHED, changes={"hole": [cave], "packing.size": [10.0, 3.0]})
    assert isinstance(case, DiskCase)
    assert wall_error(case, 0.5) == pytest.approx(STRAIGHT / 1.5**2 + 0.1 / 0.75)
    assert wall_error(small(PUSHED), 0.5) == 0.0  # type: ignore[arg-type]
