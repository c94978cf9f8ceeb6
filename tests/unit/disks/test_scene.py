"""Building the scene of a case: holes, sides, the column beside it, a box in the ground."""

import numpy as np
import pytest
from scene_tables import grains, lattice
from small_cases import GROUND, Tables, around, problems_in, small

from dembound.casefile import Case
from dembound.disks.scene import DiskScene, build, column_alone
from dembound.disks.sides import boundary_medium
from dembound.disks.surroundings.mesh import box_of
from dembound.errors import CaseError, PackingError

RANDOM = {"packing": grains(12.0, 10.0, 0.5, 6.0, 0) | {"brick": [6.0, 5.0]}, "motion.held": []}


def test_a_mirror_image_is_held_like_a_touching_disk(bar) -> None:
    scene = build(bar({"motion.held": [], "boundary.top": {"type": "symmetry"}}))
    supports, law = scene.supports, scene.ground.stiffness
    top = np.isin(supports.node, scene.edges["top"].nodes)

    # all disks of the lattice are alike, so its own contacts are what stands between disk and image
    for component, stiffness in ((1, law.normal[0]), (2, law.bending[0])):
        chosen = supports.stiffness[top & (supports.component == component)]
        np.testing.assert_allclose(chosen, 20 * [2.0 * stiffness], rtol=1e-14)


def test_dashpots_absorb_into_the_speeds_named_else_into_the_packings_own(bar) -> None:
    moduli = {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9}
    materials = ({"density": 2500.0, "p_wave_speed": 900.0}, moduli | {"s_wave_speed": 300.0}, moduli)
    media = [boundary_medium(build(bar({"material": each})).ground, axis=0) for each in materials]
    assert (media[0].density, media[0].p_wave_speed, media[1].s_wave_speed) == (2500.0, 900.0, 300.0)
    # the lattice with μ = 0: c_p² = (E_c + Ē_c)/ρ, c_s = c_p/2; a solve with one unknown
    assert (media[2].p_wave_speed, media[2].s_wave_speed) == pytest.approx((1000.0, 500.0), rel=1e-12)


TUNNEL = {"name": "tunnel", "type": "circle", "centre": [6.0, 5.0], "radius": 2.0}


def test_a_hole_takes_out_what_is_centred_in_it_and_leaves_the_sides_alone(bar) -> None:
    whole, hollow = build(bar(RANDOM)), build(bar({**RANDOM, "hole": [TUNNEL]}))
    away = np.hypot(*(hollow.assembly.positions - [6.0, 5.0]).T)

    assert away.min() >= 2.0
    near = np.hypot(*(whole.assembly.positions - [6.0, 5.0]).T) < 2.0
    assert hollow.count == whole.count - np.count_nonzero(near) - hollow.assembly.loose + whole.assembly.loose
    for side, edge in whole.edges.items():
        left = hollow.edges[side]
        assert np.array_equal(left.positions, edge.positions)
        assert np.array_equal(hollow.assembly.positions[left.nodes], left.positions)
        assert left.length == edge.length


def test_holes_that_leave_nothing_where_something_acts_are_refused(bar) -> None:
    tables = {"packing.size": [4.0, 4.0], "monitor": [], "boundary.top": {"type": "viscous"}}
    pit = {"name": "pit", "type": "rectangle", "corners": [-1.0, 3.0, 5.0, 5.0]}
    for corners, error, line in (
        ([-1.0, -1.0, 5.0, 5.0], PackingError, "no disk is left of the body"),
        (pit["corners"], CaseError, "hole: holes remove all "),
    ):
        with pytest.raises(error, match=line):
            build(bar({**tables, "hole": [pit | {"corners": corners}]}))
    scene = build(bar({**tables, "boundary.top": {"type": "free"}, "hole": [pit]}))
    assert "top" not in scene.edges


BESIDE = {"type": "free_field"}
BASE = {"type": "viscous_input", "wave_s": "pulse"}
PACKINGS = {"A": lattice(4.0, 3.0, 0.5), "C": RANDOM["packing"] | {"pattern": "C", "edge_radius": 0.26}}


@pytest.fixture
def ground(bar):
    """Makes ground between free-field sides, shaken from below."""

    def make(pattern: str = "A", **changes: object) -> Case:
        boundary = {"left": BESIDE, "right": BESIDE, "bottom": BASE}
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
        assert twin == scene.seams[0].twin[node] < scene.column_count
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
    assert np.array_equal(scene.seams[0].neighbour, whole.seams[0].neighbour)
    for side, left, right in (("left", -1.0, 0.1 * width), ("right", 0.9 * width, width + 1.0)):
        with pytest.raises(CaseError, match=rf"hole\[1, niche\]: reaches boundary.{side}, where the free field has no"):
            hollow(left, right)


BOX: Tables = GROUND | {
    "ground": {"size": [40.0, 30.0]},
    "packing": grains(12.0, 12.0, 1.0, 6.0, 0) | {"origin": [14.0, 6.0]},
    "boundary": around("outside", "left", "right", "bottom", "top"),
    "outside": {"element": 6.0},
}
WEIGHT = {"load": [{"name": "weight", "acceleration": [0.0, -10.0]}], "static.boundary.bottom": {"type": "fixed"}}


def scene(changes: Tables) -> DiskScene:
    return build(small(BOX, changes=changes))


def test_the_continuum_reaches_from_the_box_to_the_surface() -> None:
    shaken = scene({"boundary.bottom.wave_s": "w"})
    mesh = shaken.outside.body.mesh
    offset = shaken.ground.brick.mass_offset
    assert box_of(shaken.assembly.part(slice(shaken.column_count, shaken.disk_count))) == (14.0, 6.0, 26.0, 18.0)
    assert shaken.outside.box == (14.0, 6.0, 26.0, 18.0)
    surface = 30.0 + offset[1]
    assert mesh.positions[:, 1].max() == pytest.approx(surface, abs=0.5)  # less the packing's skin
    assert mesh.positions[:, 1].min() == pytest.approx(6.0 + offset[1] - 4 * 6.0, abs=1e-9)
    assert (shaken.feet[0].box[1], shaken.feet[0].sides) == (0.0, ("bottom",))


def test_a_hole_that_reaches_a_side_is_refused() -> None:
    hole = {"name": "shaft", "type": "circle", "centre": [20.0, 17.0], "radius": 2.0, "stage": "after"}
    with pytest.raises(CaseError, match=r"^hole\[1, shaft\]: reaches boundary.top, where the continuum has no hole"):
        scene(WEIGHT | {"hole": [hole]})


def test_between_box_and_surface_there_is_room_for_an_element() -> None:
    packing = lattice(12.0, 12.0, 1.0)
    said = (
        "packing.origin: the disks end 4 m below the surface of the ground; they must reach it, or end at least 5 m "
        "below, the smallest useful element"
    )
    assert problems_in(lambda: scene({"packing": packing | {"origin": [14.0, 14.0]}})) == [said]
    up_to_it = {"packing": packing | {"origin": [14.0, 18.0]}, "boundary": around("outside")}
    assert scene(up_to_it).outside.count > 0


def test_along_half_cells_the_seam_is_of_half_contacts(ground) -> None:
    scene = build(ground(**{"boundary.bottom.half_mass": True}))
    seam, whole = scene.seams[0], len(scene.ground.brick.pairs)
    halves = scene.edges["bottom"].nodes
    low = scene.assembly.positions[np.repeat(seam.node, seam.contact_counts), 1] == 0.25

    assert 0 < np.count_nonzero(low) < len(low)
    assert np.array_equal(seam.contact_type >= whole, low)
    along = np.isin(scene.assembly.pairs, halves).all(axis=1)
    assert np.array_equal(scene.assembly.contact_type >= whole, along)
    # column and body alike: a row of 8 disks has 7 contacts, the column's one disk touches itself
    assert np.count_nonzero(along) == 8
    assert set(scene.mass[halves]) == {0.5 * scene.ground.mass[0]}


EVERYWHERE = [
    {"name": "weight", "acceleration": [0.5, -9.81]},
    {"name": "shaking", "acceleration": [1.0, 0.0], "wave": "pulse"},
]


HERE = [
    {"name": "foot", "force": [0.0, -1e6], "region": [0.0, 0.0, 2.0, 2.0]},
    {"name": "tap", "force": [1e6, 0.0], "position": [1.0, 1.0], "wave": "pulse"},
    {"name": "lift", "acceleration": [0.0, 1.0], "region": [0.0, 0.0, 2.0, 2.0]},
]


@pytest.mark.parametrize(("pattern", "half"), [("A", True), ("C", False)])
def test_a_column_alone_has_what_it_has_beside_the_body(ground, pattern: str, half: bool) -> None:
    """It has supports and loads on all disks, between bottom and top, and no hole."""
    sides = {"left": BESIDE, "right": BESIDE, "bottom": {**BASE, "half_mass": half}, "top": {"type": "viscous"}}
    niche = {"name": "niche", "type": "circle", "centre": [2.0, 1.5], "radius": 0.4}
    stage = {"boundary": {"left": {"type": "roller"}, "bottom": {"type": "fixed"}}}
    scene = build(ground(pattern, boundary=sides, load=EVERYWHERE + HERE, static=stage, hole=[niche]))
    column, count = column_alone(scene), scene.column_count
    shift = scene.positions[:count] - column.positions

    # one shift for all, rounded as places of 10 m are
    np.testing.assert_allclose(shift, np.broadcast_to([shift[0, 0], 0.0], shift.shape), rtol=0.0, atol=1e-14)
    assert np.array_equal(column.mass, scene.mass[:count])
    assert (column.count, column.size[0], column.seams) == (count, scene.seams[0].width, ())
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
        assert edge.length == scene.seams[0].width
    assert {side: table.type for side, table in column.case.static.boundary.items()} == {"bottom": "fixed"}
    types = {"left": "periodic", "right": "periodic", "bottom": "viscous_input", "top": "viscous"}
    assert {side: table.type for side, table in column.case.boundary.items()} == types
    assert column.case.hole == ()
