"""Which contacts of a disk with walls count: faces before vertices, the deeper first, each with a normal of its own."""

import numpy as np
import pytest
from small_cases import small

from dembound.disks.scene import build
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.wall_contacts import NX, NY, PUSH, nearest

R = 0.25
ONE = {
    "packing": {"pattern": "A", "size": [0.5, 0.5], "radius": R, "origin": [-R, -R]},
    "material": {"density": 2500.0, "law": "linearpbond", "emod": 1e8, "pb_emod": 0.0, "fric": 0.5},
    "run": {"duration": 0.1},
}
"""A disk of radius 0.25 m at the origin."""

D = 0.24
"""Distance (m) of walls from its centre."""


def at(angle: float, distance: float = D) -> list[float]:
    """A place in a direction, degrees from downwards."""
    return [distance * np.sin(np.radians(angle)), -distance * np.cos(np.radians(angle))]


def tangent(angle: float, before: float, after: float) -> list[list[float]]:
    """A segment that touches the circle of radius `D` in a direction, so far before and after that place, m."""
    along = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    return [(np.array(at(angle)) + s * along).tolist() for s in (-before, after)]


def directions(*lines: list[list[float]]) -> list[float]:
    """Angles, degrees from downwards to either side, of the contacts of the disk with walls through these points."""
    walls = [{"name": f"w{k}", "points": points} for k, points in enumerate(lines)]
    scene = build(small(ONE | {"wall": walls}))
    part = DiskSystem(scene, 1e-4).walls
    part.push(np.zeros((3, 1)))
    touch = part.touching
    kept = touch.kept[0] if len(touch.disk) else np.zeros((0, 8))
    return sorted(abs(float(np.degrees(np.arctan2(-c[NX], c[NY])))) for c in kept if c[PUSH] > 0.0)


def corner(half: float) -> list[list[float]]:
    """Two faces at the distance D whose normals differ by twice an angle, degrees, and which meet below the disk."""
    low, rise = -D / np.cos(np.radians(half)), np.tan(np.radians(half))
    return [[-1.0, low + rise], [0.0, low], [1.0, low + rise]]


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ([tangent(0.0, 1.0, 1.0)], [0.0]),
        ([[[-1.0, -0.3], [1.0, -0.3]]], []),
        ([[[-1.0, -D], [0.0, -D], [1.0, -D]]], [0.0]),  # a joint right below it
        ([[[-1.0, -D], [0.02, -D], [0.04, -D], [0.06, -D], [1.0, -D]]], [0.0]),  # ends of others are in it, too
        ([[[-1.0, -D], [0.0, -D]], [[0.0, -D], [1.0, -D]]], [0.0]),  # two walls that meet
        ([corner(10.0)], [10.0]),  # 20° apart: one of them
        ([corner(30.0)], [30.0, 30.0]),
        ([[[-1.0, -1.0], [0.0, -D], [0.3, -1.0]]], [0.0]),  # the tip of a wedge
        ([tangent(-90.0, 1.0, 1.0), tangent(90.0, 1.0, 1.0)], [90.0, 90.0]),  # a slot
        ([[*tangent(0.0, 1.0, 0.06), [0.06, 1.0]]], [0.0, 90.0]),  # the upright face is in it, its foot does not count
        ([[[-1.0, -0.2], [0.14, -0.2], [0.3, -1.0]]], [0.0]),  # the end of the face, 35° off, does not count
    ],
)
def test_contacts_that_count(lines, expected) -> None:
    found = directions(*lines)
    assert found == pytest.approx(expected, abs=1e-9)


def test_the_nearest_point_of_a_segment() -> None:
    ends = np.array([[0.0, 0.0, 4.0, 3.0]])
    assert nearest(1.0, 2.0, ends, 0, 0.0, 0.0) == pytest.approx((1.6, 1.2, True))
    assert nearest(-1.0, 0.0, ends, 0, 0.0, 0.0) == (0.0, 0.0, False)
    assert nearest(9.0, 9.0, ends, 0, 0.5, -0.5) == (4.5, 2.5, False)
