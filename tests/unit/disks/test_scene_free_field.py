"""A scene between free-field sides: the column beside the body, its sides, its monitors, and what changes them."""

import numpy as np
import pytest

from dembound.casefile import Case
from dembound.disks.scene import DiskScene, build, column_alone, with_boundaries
from dembound.disks.stepping.contact_lists import contact_lists
from dembound.disks.stepping.system import DiskSystem
from dembound.errors import CaseError
from dembound.motion.supports import NodeSupports

FREE_FIELD = {"type": "free_field"}
BASE = {"type": "viscous_input", "wave_s": "pulse"}
STEP = 1e-4
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


@pytest.fixture(params=PACKINGS)
def scene(ground, request) -> DiskScene:
    return build(ground(request.param))


def test_bottom_and_top_run_on_into_the_column_as_their_twins_do(scene: DiskScene) -> None:
    count, width = scene.seam.count, scene.seam.width
    for side in ("bottom", "top"):
        edge = scene.edges[side]
        in_column = edge.nodes[edge.nodes < count]
        # a disk belongs to it where its twin does, whatever the cut at the sides shows of it
        assert len(in_column) > 0
        assert np.array_equal(edge.nodes, np.flatnonzero(np.isin(scene.seam.twin, in_column)))
        assert edge.length == scene.assembly.extent[0] + width
        assert np.array_equal(edge.positions, scene.assembly.positions[edge.nodes])
        assert np.array_equal(edge.diameters, 2.0 * scene.assembly.radii[edge.nodes])


def test_left_and_right_are_those_of_the_body_alone(ground) -> None:
    free = build(ground("B", boundary={"bottom": BASE}))
    scene = build(ground("B"))

    assert free.seam is None
    for side in ("left", "right"):
        assert np.array_equal(scene.edges[side].nodes, free.edges[side].nodes + scene.seam.count)
        assert scene.edges[side].length == free.edges[side].length


def test_the_column_is_all_that_is_seen_from_below_of_an_endless_ground(ground) -> None:
    scene = build(ground("B"))
    around = {side: {"type": "periodic"} for side in ("left", "right")}
    endless = build(ground(packing={**PACKINGS["B"], "size": [6.0, 10.0]}, boundary={**around, "bottom": BASE}))

    for side in ("bottom", "top"):
        nodes = scene.edges[side].nodes
        assert nodes[nodes < scene.seam.count].tolist() == sorted(endless.edges[side].nodes)


def test_disks_of_the_body_that_a_side_follows_have_the_dashpots_of_their_twin_below(scene: DiskScene) -> None:
    supports = scene.supports
    bottom = np.setdiff1d(scene.edges["bottom"].nodes, [*scene.edges["left"].nodes, *scene.edges["right"].nodes])
    damping = dict(zip(zip(supports.node, supports.component, strict=True), supports.damping, strict=True))

    assert len(bottom) > scene.seam.count * 0.02
    for node in bottom:
        for component in (0, 1):
            assert damping[node, component] == damping[scene.seam.twin[node], component]
    follows = np.unique(supports.node[supports.follow > 0.0])
    assert np.array_equal(follows, np.union1d(scene.edges["left"].nodes, scene.edges["right"].nodes))


def test_each_monitor_has_a_twin_in_the_column(ground) -> None:
    monitors = [{"name": "wall", "position": [0.1, 1.2]}, {"name": "crown", "position": [2.2, 2.9]}]
    scene = build(ground(monitor=monitors))

    assert list(scene.monitors) == ["wall", "crown", "wall.free_field", "crown.free_field"]
    for name, place in (("wall", [0.25, 1.25]), ("crown", [2.25, 2.75])):
        node, twin = scene.monitors[name], scene.monitors[f"{name}.free_field"]
        assert scene.assembly.positions[node].tolist() == place
        assert twin == scene.seam.twin[node] < scene.seam.count
        assert scene.assembly.positions[twin, 1] == place[1]


def test_a_lattice_pushes_across_the_seam_as_its_next_column_would(ground) -> None:
    # every column of disks moves alike, one disk wide: the seam makes up for the neighbours that the sides lack
    scene = build(ground())
    (tie,), law = DiskSystem(scene, STEP).ties, scene.ground.stiffness
    u = np.random.default_rng(1).uniform(-1.0, 1.0, (3, scene.count))[:, scene.seam.twin]
    across = tie.elastic_forces(u).T

    # neighbours at rest relative to it, turning with it: k_s (−l θ − l θ) across the contact, no bending
    turn = u[2, scene.seam.node]
    outward = np.where(scene.assembly.positions[scene.seam.node, 0] > 2.0, 1.0, -1.0)
    slip = -(law.arm_i[0] + law.arm_j[0]) * turn
    assert np.array_equal(np.unique(np.abs(scene.assembly.positions[scene.seam.node, 0] - 2.0)), [1.75])
    # a few products of size k
    expected = law.shear[0] * np.stack([0.0 * turn, outward * slip, law.arm_i[0] * slip], axis=1)
    np.testing.assert_allclose(across, expected, rtol=0.0, atol=1e-14 * law.normal[0])


def test_the_seam_table_knows_all_supported_nodes(scene: DiskScene) -> None:
    ties = DiskSystem(scene, STEP).ties
    supports = NodeSupports(scene, ties, STEP)
    nodes, table, slot = supports.nodes, ties[0].bundle(supports.nodes), scene.layout.slot
    many = np.diff(table.start.astype(int))

    assert np.array_equal(nodes, np.union1d(scene.supports.node, scene.seam.node))
    assert np.array_equal(nodes[many > 0], scene.seam.node)
    assert np.array_equal(many[many > 0], scene.seam.contact_counts)
    assert np.array_equal(table.twin[many > 0], slot[scene.seam.twin[scene.seam.node]])
    assert np.array_equal(supports.slots, slot[nodes])
    assert np.array_equal(supports.twin, np.where(nodes < scene.seam.count, -1, slot[scene.seam.twin[nodes]]))
    assert not many[nodes < scene.seam.count].any()
    # nodes are stepped in their order, and a twin comes before who follows it
    assert np.all(scene.seam.twin[nodes] <= nodes)


def test_along_half_cells_the_seam_is_of_half_contacts(ground) -> None:
    scene = build(ground(**{"boundary.bottom.half_mass": True}))
    seam, whole = scene.seam, len(scene.ground.brick.pairs)
    halves = scene.edges["bottom"].nodes
    low = scene.assembly.positions[np.repeat(seam.node, seam.contact_counts), 1] == 0.25

    assert 0 < np.count_nonzero(low) < len(low)
    assert np.array_equal(seam.contact_type >= whole, low)
    along = np.isin(scene.assembly.pairs, halves).all(axis=1)
    assert np.array_equal(scene.assembly.contact_type >= whole, along)
    # column and body alike: a row of 8 disks has 7 contacts, the column's one disk touches itself
    assert np.count_nonzero(along) == 8
    assert set(scene.mass[halves]) == {0.5 * scene.ground.mass[0]}


CHANGES = {
    "half cells": {"boundary.bottom.half_mass": True},
    "no column": {"boundary.left": {"type": "viscous"}, "boundary.right": {"type": "viscous"}},
    "a column on one side": {"boundary.left": {"type": "viscous"}},
}


@pytest.mark.parametrize("change", CHANGES)
def test_boundaries_that_are_built_into_the_body_build_it_anew(ground, change: str) -> None:
    plain, changed = ground(), ground(**CHANGES[change])
    for before, after in ((plain, changed), (changed, plain)):
        found, expected = with_boundaries(build(before), after), build(after)
        assert np.array_equal(found.mass, expected.mass)
        assert np.array_equal(found.assembly.contact_type, expected.assembly.contact_type)
        assert (found.seam is None) == (expected.seam is None)
        if expected.seam is not None:
            assert np.array_equal(found.seam.node, expected.seam.node)


def test_other_factors_leave_the_body_as_it_is(ground) -> None:
    scene = build(ground())
    other = with_boundaries(scene, ground(**{"boundary.left.beta_p": 0.5}))

    assert other.seam is scene.seam
    follows = scene.supports.follow > 0.0
    assert set(other.supports.follow[follows] / scene.supports.follow[follows]) == {0.5, 1.0}
    assert not other.supports.follow[~follows].any()


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


def test_a_hole_may_reach_a_side_without_a_free_field(ground) -> None:
    niche = {"name": "niche", "type": "rectangle", "corners": [-1.0, 1.0, 1.0, 2.0]}
    scene = build(ground(boundary={"right": FREE_FIELD, "bottom": BASE}, hole=[niche]))

    assert len(scene.edges["left"].nodes) == 4


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

STAGE = {"boundary": {"left": {"type": "roller"}, "bottom": {"type": "fixed"}}}
NICHE = {"name": "niche", "type": "circle", "centre": [2.0, 1.5], "radius": 0.4}


@pytest.fixture(params=["A", "A, half cells below", "B", "C"])
def beside(ground, request) -> tuple[DiskScene, DiskScene]:
    """Ground with loads, a static stage and a hole, and its column alone."""
    pattern, half = request.param[0], "half" in request.param
    boundary = {
        "left": FREE_FIELD,
        "right": FREE_FIELD,
        "bottom": {**BASE, "half_mass": half},
        "top": {"type": "viscous"},
    }
    monitor = [{"name": "wall", "position": [0.1, 1.2]}]
    case = ground(pattern, boundary=boundary, monitor=monitor, load=EVERYWHERE + HERE, static=STAGE, hole=[NICHE])
    scene = build(case)
    return scene, column_alone(scene)


def test_a_column_alone_is_that_beside_the_body_particle_by_particle(beside: tuple[DiskScene, DiskScene]) -> None:
    scene, column = beside
    count = scene.seam.count
    shift = scene.positions[:count] - column.positions

    assert column.count == count < scene.count
    # one shift for all, rounded as places of 10 m are
    np.testing.assert_allclose(shift, np.broadcast_to(shift[0], shift.shape), rtol=0.0, atol=1e-14)
    assert abs(shift[0, 1]) < 1e-14
    assert np.array_equal(column.assembly.radii, scene.assembly.radii[:count])
    assert np.array_equal(column.assembly.brick_particle, scene.assembly.brick_particle[:count])
    assert np.array_equal(column.mass, scene.mass[:count])
    assert np.array_equal(column.inertia, scene.inertia[:count])
    assert column.size[0] == scene.seam.width
    assert column.seam is None
    assert column.ground is scene.ground
    assert not column.monitors


def test_a_column_alone_has_the_contacts_of_that_beside_the_body(beside: tuple[DiskScene, DiskScene], in_order) -> None:
    scene, column = map(in_order, beside)
    count = scene.seam.count
    inside = scene.assembly.pairs.max(axis=1) < count
    beside, (alone,) = scene.rows[0], column.rows

    assert np.array_equal(column.assembly.pairs, scene.assembly.pairs[inside])
    assert np.array_equal(column.assembly.contact_type, scene.assembly.contact_type[inside])
    assert alone.begin == beside.begin == 0
    for name in ("start", "neighbour", "contact_type", "constants"):
        assert np.array_equal(getattr(alone, name), getattr(beside, name))
    assert contact_lists(column)["body"].periods == contact_lists(scene)["column"].periods == (scene.seam.width, None)


def test_a_column_alone_has_the_supports_and_the_loads_that_it_has_beside_the_body(
    beside: tuple[DiskScene, DiskScene],
) -> None:
    scene, column = beside
    count = scene.seam.count
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


def test_a_column_alone_stands_between_bottom_and_top(beside: tuple[DiskScene, DiskScene]) -> None:
    scene, column = beside
    count = scene.seam.count

    assert list(column.edges) == ["bottom", "top"]
    for side, edge in column.edges.items():
        nodes = scene.edges[side].nodes
        assert np.array_equal(np.sort(edge.nodes), nodes[nodes < count])
        assert edge.length == scene.seam.width
    assert list(column.case.static.boundary) == ["bottom"]
    assert column.case.static.boundary["bottom"].type == "fixed"
    assert {side: table.type for side, table in column.case.boundary.items()} == {
        "left": "periodic",
        "right": "periodic",
        "bottom": "viscous_input",
        "top": "viscous",
    }
    assert column.case.hole == ()


def test_of_no_static_stage_a_column_has_none_either(ground) -> None:
    assert column_alone(build(ground("B"))).case.static is None
