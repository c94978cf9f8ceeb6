"""Ways of waves over sides, by hand."""

import numpy as np
import pytest

from dembound.motion.paths import Front, Source, first_arrivals, plane_needed
from dembound.table import EVERYWHERE

LEVEL = {"left": (-np.inf, 0.0, np.inf, 0.0), "bottom": (0.0, -np.inf, 0.0, np.inf)}
"""Sources that span the scene: all of the bottom beside a left or right side, all of the left beside bottom or top."""


def source(box, start=0.0):
    return Source(box, start, np.inf, 1.0)


def test_a_front_has_come_its_way_and_the_length_of_its_precursor() -> None:
    # s = 1000 m: (1000 · 0.4² / 8)^(1/3) = 20^(1/3)
    assert Front(500.0, 0.4).reach(2.0) == pytest.approx(1000.0 + 10.0 * 20.0 ** (1.0 / 3.0), rel=1e-14)
    assert Front(500.0, 0.4).reach(-1.0) == 0.0


@pytest.mark.parametrize(
    ("side", "plane", "place", "way"),
    [
        ("right", 10.0, (7.0, 6.0), np.hypot(7.0 + 3.0, 4.0)),  # from (3, 2): 7 m there, 3 m back, 4 m up
        ("left", -1.0, (7.0, 6.0), np.hypot(4.0 + 8.0, 4.0)),
        ("top", 9.0, (7.0, 6.0), np.hypot(4.0, 7.0 + 3.0)),
        ("bottom", -2.0, (7.0, 6.0), np.hypot(4.0, 4.0 + 8.0)),
    ],
)
def test_a_way_over_a_side_is_that_to_the_mirror_image(side: str, plane: float, place, way: float) -> None:
    at = np.array([place])
    found = source((3.0, 2.0, 3.0, 2.0)).distance_over(side, plane, at)

    assert found == pytest.approx([way], rel=1e-15)
    assert source((3.0, 2.0, 3.0, 2.0)).distance(at) == pytest.approx([np.hypot(4.0, 4.0)], rel=1e-15)
    np.testing.assert_array_equal(at, [place])


@pytest.mark.parametrize(
    ("side", "box"),
    [
        ("left", (3.0, 2.0, 3.0, 2.0)),
        ("right", (2.0, 1.0, 30.0, 30.0)),
        ("bottom", LEVEL["left"]),
        ("top", LEVEL["bottom"]),
        ("top", EVERYWHERE),
    ],
)
def test_at_the_plane_needed_the_last_way_is_as_long_as_waves_get(side: str, box) -> None:
    rng = np.random.default_rng(3)
    places, front = rng.uniform(0.0, 10.0, (5, 2)), Front(100.0, 0.1)
    sources = [source(box, 0.01), source((4.0, 4.0, 4.0, 4.0), 0.02)]
    plane = plane_needed(side, sources, places, front, 0.3)
    spare = [(each.distance_over(side, plane, places) - front.reach(0.3 - each.start)).min() for each in sources]

    assert min(spare) == pytest.approx(0.0, abs=1e-12)


def test_the_first_arrival_is_that_of_the_nearest_way_and_the_earliest_source() -> None:
    left = Source((0.0, -np.inf, 0.0, np.inf), 2.0, 3.0, 1.0)
    point = Source((8.0, 0.0, 8.0, 0.0), 5.0, 6.0, 1.0)
    places = np.array([[4.0, 9.0], [8.0, 3.0], [12.0, 0.0]])
    assert first_arrivals([left, point], Front(2.0, 0.1), places) == pytest.approx([4.0, 6.0, 7.0])
    assert np.isinf(first_arrivals([], Front(2.0, 0.1), places)).all()
