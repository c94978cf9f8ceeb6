"""A scene between free-field sides: the column beside the body, its sides, its monitors, and what changes them."""

import numpy as np
import pytest

from dembound.casefile import Case
from dembound.disks.scene import DiskScene, build
from dembound.errors import CaseError

FREE_FIELD = {"type": "free_field"}
BASE = {"type": "viscous_input", "wave_s": "pulse"}
RANDOM = {"size": [12.0, 10.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [6.0, 5.0]}
PACKINGS = {
    "A": {"pattern": "A", "size": [4.0, 3.0], "radius": 0.25},
    "B": {"pattern": "B", **RANDOM},
    "C": {"pattern": "C", **RANDOM, "edge_radius": 0.26},
}


@pytest.fixture
def ground(bar):
    """Makes ground between free-field sides, shaken from below."""

    def make(pattern: str = "A", **changes: object) -> Case:
        boundary = {"left": FREE_FIELD, "right": FREE_FIELD, "bottom": BASE}
        tables = {"packing": PACKINGS[pattern], "boundary": boundary, "monitor": [], "motion.held": []}
        return bar({**tables, **changes})

    return make


def test_each_monitor_has_a_twin_in_the_column(ground) -> None:
    monitors = [{"name": "wall", "position": [0.1, 1.2]}, {"name": "crown", "position": [2.2, 2.9]}]
    scene = build(ground(monitor=monitors))

    assert list(scene.monitors) == ["wall", "crown", "wall.free_field", "crown.free_field"]
    for name, place in (("wall", [0.25, 1.25]), ("crown", [2.25, 2.75])):
        node, twin = scene.monitors[name], scene.monitors[f"{name}.free_field"]
        assert scene.assembly.positions[node].tolist() == place
        assert twin == scene.seam.twin[node] < scene.seam.count
        assert scene.assembly.positions[twin, 1] == place[1]


@pytest.mark.parametrize("pattern", PACKINGS)
def test_a_hole_must_leave_the_ground_that_the_column_meets(ground, pattern: str) -> None:
    width, height = PACKINGS[pattern]["size"]

    def hollow(left: float, right: float) -> DiskScene:
        corners = [left, 0.4 * height, right, 0.6 * height]
        return build(ground(pattern, hole=[{"name": "niche", "type": "rectangle", "corners": corners}]))

    # between the sides: no disk that is cut loose, and none that a contact ties to the outside, is taken
    scene = hollow(0.3 * width, 0.7 * width)
    whole = build(ground(pattern))
    assert scene.count < whole.count
    assert np.array_equal(scene.seam.neighbour, whole.seam.neighbour)
    for side, left, right in (("left", -1.0, 0.1 * width), ("right", 0.9 * width, width + 1.0)):
        with pytest.raises(CaseError, match=rf"hole\[1, niche\]: reaches boundary.{side}, where the free field has no"):
            hollow(left, right)
