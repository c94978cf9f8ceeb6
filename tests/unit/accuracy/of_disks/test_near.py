"""Errors near forces and beside holes."""

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.accuracy.history import History
from dembound.accuracy.of_disks.near import CURVED, NEAR, errors_near_loads, wall_error
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene, build
from dembound.holes import Circle, Rectangle
from dembound.holes.rectangle import STRAIGHT
from dembound.packings import Square

RATE = 2.0 * np.pi * 20.0
TIME = np.linspace(0.0, 0.5, 2001)
SPEED = 500.0
"""Of S waves on a lattice whose bonds alone carry shear, m/s."""


def scene(radius: float) -> DiskScene:
    """Disks beside a force at (2, 1) m."""
    push = {"name": "push", "force": [1e5, 0.0], "region": [1.5, 0.5, 2.5, 1.5], "wave": "push"}
    packing = {"pattern": "A", "size": [10.0, 3.0], "radius": radius}
    return build(small(PUSHED, changes={"packing": packing, "boundary": {}, "load": [push]}))  # type: ignore[arg-type]


def recorded(place: tuple[float, float], move: tuple[float, float]) -> History:
    """Motion of one frequency along a vector."""
    shape = np.array(move)
    velocity = np.sin(RATE * TIME)[:, None] * shape
    return History(
        np.array(place), TIME, {"velocity": velocity, "displacement": -np.cos(RATE * TIME)[:, None] * shape / RATE}
    )


def test_it_is_of_second_order_in_the_disks_times_the_curvature_along_the_ray() -> None:
    own = recorded((7.0, 1.0), (1.0, 0.0))
    expected = NEAR * (0.5 * (RATE / SPEED + CURVED / 5.0)) ** 2
    for quantity, error in errors_near_loads(scene(0.25), own).items():
        assert error == pytest.approx(expected, rel=1e-3), quantity  # differences of TIME: (ωΔt)²/6 = 2e-4
    finer = errors_near_loads(scene(0.125), own)
    assert finer["velocity"] == pytest.approx(expected / 4.0, rel=1e-3)


def test_motion_across_the_ray_has_none_as_its_waves_are_shear() -> None:
    found = errors_near_loads(scene(0.25), recorded((7.0, 1.0), (0.0, 1.0)))
    assert found == pytest.approx({"velocity": 0.0, "displacement": 0.0}, abs=1e-12)


def test_half_of_motion_at_45_degrees_is_along_the_ray() -> None:
    """Of v along x the ray's part is v cos 45°, of which cos 45° is along x."""
    own = recorded((2.0 + 1.2, 1.0 + 1.2), (1.0, 0.0))
    expected = 0.5 * NEAR * (0.5 * (RATE / SPEED + CURVED / (1.2 * 2.0**0.5))) ** 2
    assert errors_near_loads(scene(0.25), own)["velocity"] == pytest.approx(expected, rel=1e-3)


def test_there_is_none_without_a_force_and_a_finite_one_at_it() -> None:
    driven = build(small(PUSHED))  # type: ignore[arg-type]
    assert errors_near_loads(driven, recorded((7.0, 1.0), (1.0, 0.0))) == {"velocity": 0.0, "displacement": 0.0}
    at_it = errors_near_loads(scene(0.25), recorded((2.25, 1.0), (1.0, 0.0)))["velocity"]
    assert at_it == pytest.approx(NEAR * (0.5 * (RATE / SPEED + CURVED / 0.5)) ** 2 * 0.5**2, rel=1e-3)


def test_the_nearest_copy_of_a_force_counts() -> None:
    """Across periodic sides the force at 2 m is 3 m to the right of a monitor at 9 m of 10 m."""
    periodic = {"boundary": {"left": {"type": "periodic"}, "right": {"type": "periodic"}}}
    push = {"name": "push", "force": [1e5, 0.0], "region": [1.5, 0.5, 2.5, 1.5], "wave": "push"}
    packing = {"pattern": "A", "size": [10.0, 3.0], "radius": 0.25}
    wrapped = build(small(PUSHED, changes={"packing": packing, "load": [push], **periodic}))  # type: ignore[arg-type]
    found = errors_near_loads(wrapped, recorded((9.0, 1.0), (1.0, 0.0)))["velocity"]  # type: ignore[arg-type]
    assert found == pytest.approx(NEAR * (0.5 * (RATE / SPEED + CURVED / 3.0)) ** 2, rel=1e-3)


def test_walls_of_circles_are_of_first_order_and_those_of_rectangles_of_second() -> None:
    """docs/charts.md: 7 % with 10 disks along the radius; docs/errors.md: 4.7 % with 3 along the smaller half."""
    circle = Circle.model_validate({"type": "circle", "name": "a", "centre": (0.0, 0.0), "radius": 10.0})
    long = Rectangle.model_validate({"type": "rectangle", "name": "b", "corners": (0.0, 0.0, 6.0, 20.0)})

    def between(axis: int, place: float) -> float:
        return 0.0

    assert circle.wall_error(1.0, between) == pytest.approx(0.07)
    assert circle.wall_error(0.5, between) == pytest.approx(0.035)
    assert long.wall_error(1.0, between) == pytest.approx(0.05)
    assert long.wall_error(0.5, between) == pytest.approx(0.0125)


def test_walls_that_are_not_between_disks_change_the_size_of_a_hole() -> None:
    """Disks of 1 m from the origin on: walls at 2, 8 and 20 m fit, one at 8.4 m is 0.4 m off, of a half of 3.2 m."""

    def misfit(right: float, diameter: float = 1.0, top: float = 20.0, origin: float = 0.0) -> float:
        corners = (2.0, 2.0, right, top)
        hole = Rectangle.model_validate({"type": "rectangle", "name": "b", "corners": corners})
        lattice = Square(radius=0.5 * diameter, size=(30.0, 30.0), origin=(origin, 0.0))
        return hole.wall_error(diameter, lattice.apart) - hole.wall_error(diameter, lambda axis, place: 0.0)

    assert misfit(8.0) == pytest.approx(0.0, abs=1e-12)
    assert misfit(8.4) == pytest.approx(0.4 / 3.2)
    assert misfit(8.4, origin=0.4) == pytest.approx(0.4 / 3.2)  # there the left one is off
    assert misfit(8.4, diameter=0.4) == pytest.approx(0.0, abs=1e-12)
    assert misfit(8.0, top=31.5) == pytest.approx(0.0, abs=1e-12)  # open at the surface


def test_an_error_beside_holes_is_that_of_their_walls_and_of_their_size() -> None:
    cave = {"name": "cave", "type": "rectangle", "corners": [4.0, 0.5, 6.1, 2.0]}
    case = small(PUSHED, changes={"hole": [cave], "packing.size": [10.0, 3.0]})
    assert isinstance(case, DiskCase)
    assert wall_error(case, 0.5) == pytest.approx(STRAIGHT / 1.5**2 + 0.1 / 0.75)
    assert wall_error(small(PUSHED), 0.5) == 0.0  # type: ignore[arg-type]
