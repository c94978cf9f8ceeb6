"""A scene between free-field sides: the column beside the body, its sides, its monitors, and what changes them."""

import numpy as np
import pytest

from dembound.casefile import Case
from dembound.disks.scene import DiskScene, build, column_alone
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


EVERYWHERE = [
    {"name": "weight", "acceleration": [0.5, -9.81]},
    {"name": "shaking", "acceleration": [1.0, 0.0], "wave": "pulse"},
]
"""Loads of body and column alike."""

HERE = [
    {"name": "foot", "force": [0.0, -1e6], "region": [0.0, 0.0, 2.0, 2.0]},
    {"name": "tap", "force": [1e6, 0.0], "position": [1.0, 1.0], "wave": "pulse"},
    {"name": "lift", "acceleration": [0.0, 1.0], "region": [0.0, 0.0, 2.0, 2.0]},
]
"""Loads of some particles of the body."""


@pytest.mark.parametrize(("pattern", "half"), [("A", True), ("C", False)])
def test_a_column_alone_has_what_it_has_beside_the_body(ground, pattern: str, half: bool) -> None:
    """It has supports and loads on all disks, between bottom and top, and no hole."""
    sides = {"left": FREE_FIELD, "right": FREE_FIELD, "bottom": {**BASE, "half_mass": half}, "top": {"type": "viscous"}}
    niche = {"name": "niche", "type": "circle", "centre": [2.0, 1.5], "radius": 0.4}
    stage = {"boundary": {"left": {"type": "roller"}, "bottom": {"type": "fixed"}}}
    scene = build(ground(pattern, boundary=sides, load=EVERYWHERE + HERE, static=stage, hole=[niche]))
    column, count = column_alone(scene), scene.seam.count
    shift = scene.positions[:count] - column.positions

    # one shift for all, rounded as places of 10 m are
    np.testing.assert_allclose(shift, np.broadcast_to([shift[0, 0], 0.0], shift.shape), rtol=0.0, atol=1e-14)
    assert np.array_equal(column.mass, scene.mass[:count])
    assert (column.count, column.size[0], column.seam) == (count, scene.seam.width, None)
    theirs, ours = scene.supports, column.supports
    below = theirs.node < count
    for name in ("node", "component", "damping", "stiffness", "prescribed"):
        assert np.array_equal(getattr(ours, name), getattr(theirs, name)[below])
    assert not ours.follow.any()
    times = np.linspace(0.0, 0.01, 7)
    assert np.array_equal(ours.sample(times, 0.001), theirs.sample(times, 0.001)[:, below])
    assert ours.sample(times, 0.001).any()
    assert np.array_equal(column.steady_load, scene.steady_load[:, :count])
    assert column.steady_load[0].any()
    assert [load.name for load in column.case.load] == ["weight", "shaking"]
    assert list(column.edges) == ["bottom", "top"]
    for side, edge in column.edges.items():
        nodes = scene.edges[side].nodes
        assert np.array_equal(np.sort(edge.nodes), nodes[nodes < count])
        assert edge.length == scene.seam.width
    assert {side: table.type for side, table in column.case.static.boundary.items()} == {"bottom": "fixed"}
    types = {"left": "periodic", "right": "periodic", "bottom": "viscous_input", "top": "viscous"}
    assert {side: table.type for side, table in column.case.boundary.items()} == types
    assert column.case.hole == ()
