"""What lies on an edge, and which of equally near points is meant, is decided as by whole numbers."""

import numpy as np
import pytest

from dembound.boundaries import Fixed
from dembound.boundaries.support import Edge
from dembound.holes import Circle, Ellipse, Hole, Polygon, Rectangle
from dembound.places import is_within, nearest, nearest_number

COUNT = 14
CENTRES = np.stack(np.meshgrid(*2 * [np.arange(1, 2 * COUNT, 2)]), axis=-1).reshape(-1, 2)
"""Centres of a lattice's disks, in radii."""

BOX = (5, 7, 19, 21)
SQUARE = ((5, 7), (19, 7), (19, 21), (5, 21))
POLYGONS = {
    "square": SQUARE,
    "square from another corner, the other way": SQUARE[2::-1] + SQUARE[:2:-1],
    "diamond": ((13, 3), (23, 13), (13, 23), (3, 13)),
    "triangle": ((3, 5), (25, 9), (11, 25)),
    "notched": ((5, 5), (21, 5), (21, 11), (13, 11), (13, 19), (5, 19)),
    "horseshoe": ((3, 3), (21, 3), (21, 23), (17, 23), (17, 9), (9, 9), (9, 23), (3, 23)),
    "notched between disks": ((6, 6), (22, 6), (22, 12), (14, 12), (14, 20), (6, 20)),
    "between disks": ((6, 6), (20, 6), (20, 14), (6, 14)),
}
ROUND = {  # centre, semi-axes; with 3, 4, 5 and 5, 12, 13 times two radii there are disks on the rim
    "circle at a disk": ((13, 13), (10, 10)),
    "circle between disks": ((14, 14), (10, 10)),
    "small circle": ((13, 13), (2, 2)),
    "ellipse": ((13, 15), (10, 6)),
    "upright ellipse": ((13, 15), (5, 10)),
}
MIRRORS = [np.array(m) for m in ([[1, 0], [0, 1]], [[-1, 0], [0, 1]], [[1, 0], [0, -1]], [[0, 1], [1, 0]])]
RADII = [0.2, 0.25, 0.3, 1.0 / 3.0]
SHIFTS = [(0.0, 0.0), (-0.9, 0.1), (1234.56, -7e3 / 3.0)]


def of_polygon(points, places: np.ndarray) -> np.ndarray:
    """1 inside a polygon, 0 on its edge, −1 outside, by winding numbers of whole numbers."""
    found = []
    for x, y in places.tolist():
        on, winding = False, 0
        for (x0, y0), (x1, y1) in zip(points, points[1:] + points[:1], strict=True):
            side = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
            on |= side == 0 and (x - x0) * (x - x1) <= 0 and (y - y0) * (y - y1) <= 0
            winding += (y0 <= y < y1 and side > 0) - (y1 <= y < y0 and side < 0)
        found.append(0 if on else (1 if winding else -1))
    return np.array(found)


def of_ellipse(centre, axes, places: np.ndarray) -> np.ndarray:
    """1 inside an ellipse, 0 on it, −1 outside, by whole numbers."""
    (x, y), (a, b) = (places - centre).T, axes
    return np.sign((a * b) ** 2 - (b * x) ** 2 - (a * y) ** 2)


def placed(numbers, radius: float, shift) -> np.ndarray:
    """Places (k, 2) m, computed as those of a tiled lattice are: whole numbers of radii, then the shift."""
    numbers = np.asarray(numbers)
    return radius * (numbers % 2) + (numbers // 2) * (2.0 * radius) + shift


def typed(numbers, radius: float, shift) -> list[list[float]]:
    """Places (k, 2) m, as somebody types them who computed them otherwise, with twelve digits."""
    each = np.asarray(numbers) * radius + shift
    return [[float(f"{value:.12g}") for value in place] for place in each.tolist()]


def hole(kind: type[Hole], keep: str, **keys) -> Hole:
    """A hole, or a sample."""
    return kind(name="h", type=kind.__name__.lower(), keep=keep, **keys)


@pytest.mark.parametrize("shift", SHIFTS)
@pytest.mark.parametrize("radius", RADII)
@pytest.mark.parametrize("mirror", MIRRORS)
def test_what_lies_on_an_edge_remains(mirror, radius: float, shift) -> None:
    lattice, span, on = placed(CENTRES @ mirror, radius, shift), 2.0 * COUNT * radius, {}

    def require(name: str, expected: np.ndarray, kind: type[Hole], **keys) -> None:
        np.testing.assert_array_equal(hole(kind, "outside", **keys).takes(lattice, span), expected > 0, name)
        np.testing.assert_array_equal(hole(kind, "inside", **keys).takes(lattice, span), expected < 0, name)
        on[name] = int(np.count_nonzero(expected == 0))

    for name, points in POLYGONS.items():
        corners = typed(np.array(points) @ mirror, radius, shift)
        require(name, of_polygon(points, CENTRES), Polygon, points=corners)
    low, high = (each(np.reshape(BOX, (2, 2)) @ mirror, axis=0) for each in (np.min, np.max))
    corners = np.ravel(typed([low, high], radius, shift)).tolist()
    expected = of_polygon(SQUARE, CENTRES)
    require("rectangle", expected, Rectangle, corners=corners)
    np.testing.assert_array_equal(is_within(tuple(corners), lattice, span), expected >= 0)
    for name, (centre, axes) in ROUND.items():
        expected = of_ellipse(centre, axes, CENTRES)
        (middle,) = typed([np.array(centre) @ mirror], radius, shift)
        along = [float(f"{each * radius:.12g}") for each in np.abs(axes @ mirror)]
        require(name, expected, Ellipse, centre=middle, semi_axes=along)
        require(name, expected, Ellipse, centre=middle, semi_axes=along[::-1], angle=90.0)
        if axes[0] == axes[1]:
            require(name, expected, Circle, centre=middle, radius=along[0])
    without = ["notched between disks", "between disks", "circle between disks"]
    assert [name for name in on if on[name] == 0] == without
    assert on["circle at a disk"] == 12


@pytest.mark.parametrize("radius", RADII)
def test_ranges_and_regions_of_the_same_ends_have_the_same_disks(radius: float) -> None:
    along = placed(np.stack([np.arange(1, 61, 2), np.full(30, 29)], axis=1), radius, 0.0)
    top, numbers = Edge("top", np.arange(30), along, np.full(30, 2.0 * radius), 60.0 * radius), np.arange(1, 61, 2)
    for low, high in ((25, 35), (24, 36), (1, 59), (13, 14), (7, 53)):
        ends = float(f"{low * radius:.12g}"), float(f"{high * radius:.12g}")
        held = Fixed(type="fixed", within=ends).part_of(top).nodes
        np.testing.assert_array_equal(held, np.flatnonzero((numbers >= low) & (numbers <= high)))
        np.testing.assert_array_equal(
            held, np.flatnonzero(is_within((ends[0], 0.0, ends[1], 100.0), along, 60.0 * radius))
        )


LATTICE = np.stack(np.meshgrid(np.arange(12.0), np.arange(9.0)), axis=-1).reshape(-1, 2)


def chosen(points: np.ndarray, places: np.ndarray) -> np.ndarray:
    return points[nearest(points, places)]


def test_far_from_ties_it_is_the_nearest_one() -> None:
    places = np.random.default_rng(0).uniform(-2.0, 14.0, (200, 2))
    expected = LATTICE[np.argmin(np.hypot(*(LATTICE[:, None] - places).transpose(2, 0, 1)), axis=0)]
    np.testing.assert_array_equal(chosen(LATTICE, places), expected)


def test_of_equally_near_points_the_lowest_and_of_those_the_leftmost_is_taken() -> None:
    places = np.array([[4.5, 3.0], [4.0, 3.5], [4.5, 3.5], [-7.0, 3.5], [4.5, 20.0]])
    assert chosen(LATTICE, places).tolist() == [[4.0, 3.0], [4.0, 3.0], [4.0, 3.0], [0.0, 3.0], [4.0, 8.0]]

    ring = LATTICE[np.hypot(*(LATTICE - [5.0, 4.0]).T) > 2.1]  # eight are equally near to the middle of this hole
    assert chosen(ring, np.array([[5.0, 4.0]])).tolist() == [[4.0, 2.0]]


@pytest.mark.parametrize("size", [0.1, 0.7, 1.0 / 3.0, 1e-3])
def test_rounding_and_numbering_do_not_decide(size: float) -> None:
    """The lattice from origins at which its coordinates round differently, in any order: the same one of its points."""
    rng = np.random.default_rng(1)
    halves = 0.5 * rng.integers(2, 16, (60, 2))
    expected = chosen(LATTICE, halves)
    naive = set()
    for origin in (0.0, 96.0, 1234.5, 1e5):
        order = rng.permutation(len(LATTICE))
        points, places = size * LATTICE[order] + size * origin, size * (halves + origin)
        found = order[nearest(points, places)]
        np.testing.assert_array_equal(LATTICE[found], expected)
        distance = np.hypot(*(points[:, None] - places).transpose(2, 0, 1))
        naive.add(tuple(order[distance.argmin(axis=0)]))
    assert len(naive) > 1  # the smallest distance alone finds others


def test_half_way_between_numbers_the_smaller_one_is_taken() -> None:
    assert [nearest_number(value) for value in (0.0, 0.49, 0.5, 0.51, 1.5, 2.5, 7.0)] == [0, 0, 0, 1, 1, 2, 7]
    assert nearest_number(0.35 / 0.1) == nearest_number(3.5 + 1e-12) == 3
