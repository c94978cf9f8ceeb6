"""Errors near forces."""

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.disks.scene import DiskScene, build
from dembound.formulas.disks.near_disks import ALONG_RAY, CURVED, errors_near_loads
from dembound.formulas.history import History

RATE = 2.0 * np.pi * 20.0
TIME = np.linspace(0.0, 0.5, 2001)
WIDE = 0.5
"""Half a side of the region that the force acts on, m."""

SPEED = 500.0
"""Speed of S waves on a lattice whose bonds alone carry shear, m/s."""


def scene(radius: float) -> DiskScene:
    """Disks beside a force at (2, 1) m."""
    push = {"name": "push", "force": [1e5, 0.0], "region": [1.5, 0.5, 2.5, 1.5], "wave": "push"}
    packing = {"pattern": "A", "size": [10.0, 3.0], "radius": radius}
    return build(small(PUSHED, changes={"packing": packing, "boundary": {}, "load": [push]}))


def recorded(place: tuple[float, float], move: tuple[float, float]) -> History:
    """Motion of one frequency along a vector."""
    shape = np.array(move)
    velocity = np.sin(RATE * TIME)[:, None] * shape
    return History(
        np.array(place), TIME, {"velocity": velocity, "displacement": -np.cos(RATE * TIME)[:, None] * shape / RATE}
    )


def near(diameter: float, distance: float, wide: float = WIDE) -> float:
    """The error at a distance (m) along the force."""
    return ALONG_RAY * (diameter * (RATE / SPEED + CURVED / distance) * distance / (distance + wide)) ** 2


def test_it_is_of_second_order_in_the_disks_times_the_curvature_along_the_ray() -> None:
    own = recorded((7.0, 1.0), (1.0, 0.0))
    expected = near(0.5, 5.0)
    for quantity, error in errors_near_loads(scene(0.25), own).items():
        assert error == pytest.approx(expected, rel=1e-3), quantity  # differences of TIME: (ωΔt)²/6 = 2e-4
    finer = errors_near_loads(scene(0.125), own)
    assert finer["velocity"] == pytest.approx(expected / 4.0, rel=1e-3)


def test_motion_across_the_ray_has_none_as_its_waves_are_shear() -> None:
    found = errors_near_loads(scene(0.25), recorded((7.0, 1.0), (0.0, 1.0)))
    assert found == pytest.approx({"velocity": 0.0, "displacement": 0.0}, abs=1e-12)


def test_half_of_motion_at_45_degrees_is_along_the_ray() -> None:
    """The part along the ray of v along x is v cos 45°, and cos 45° of that is along x."""
    own = recorded((2.0 + 1.2, 1.0 + 1.2), (1.0, 0.0))
    expected = 0.5 * near(0.5, 1.2 * 2.0**0.5)
    assert errors_near_loads(scene(0.25), own)["velocity"] == pytest.approx(expected, rel=1e-3)


def test_there_is_none_without_a_force_and_a_finite_one_at_it() -> None:
    driven = build(small(PUSHED))
    assert errors_near_loads(driven, recorded((7.0, 1.0), (1.0, 0.0))) == {"velocity": 0.0, "displacement": 0.0}
    at_it = errors_near_loads(scene(0.25), recorded((2.25, 1.0), (1.0, 0.0)))["velocity"]
    assert at_it == pytest.approx(near(0.5, 0.5) * 0.5**2, rel=1e-3)
