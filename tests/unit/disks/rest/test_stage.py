"""The static stage: where it comes to rest."""

import numpy as np
import pytest
from settling import FIXED, MASS, STANDING, WEIGHT, WRAP, G, scene

from dembound.disks.rest.loading import LOOK
from dembound.disks.rest.stage import settle
from dembound.disks.rest.static_scene import StaticScene
from dembound.disks.scene import DiskScene, column_alone
from dembound.disks.stability import choose_step
from dembound.disks.stepping.system import DiskSystem
from dembound.errors import CaseError
from dembound.kernels.contacts import TENSION
from dembound.motion.simulation import Simulation

K = 2500.0 * 1000.0**2
"""Normal stiffness of a lattice contact and its bond, N/m."""


@pytest.mark.parametrize("law", ["elastic", "linearpbond"])
def test_a_lattice_sinks_under_its_weight_as_its_columns_say(bar, law: str) -> None:
    settled = settle(scene(bar, **{**STANDING, "material.law": law}))
    # disk by disk from below: the contacts carry the weight of three, two and one disks
    sunk = np.cumsum([0.0, 3.0, 2.0, 1.0]) * MASS * G / K
    found = np.sort(settled.start.displacement[1])[::-1].reshape(4, 2)

    # the ratio of 1e-8 leaves 1e-8 of the mean contact force; four springs in a row; half of that for moved normals
    np.testing.assert_allclose(found, np.repeat(-sunk[:, None], 2, axis=1), atol=1e-6 * sunk[-1])
    assert settled.ratio <= 1e-8
    assert settled.steps % LOOK == 0
    # two disks carry all eight: three each besides their own weight
    assert settled.mean_reaction == pytest.approx(4.0 * MASS * G, rel=1e-6)
    assert settled.mean_residual < 1e-7 * settled.mean_reaction
    assert len(settled.cracks) == 0
    assert (not settled.start.contacts) == (law == "elastic")


def test_looks_are_told_from_far_to_near(bar) -> None:
    looks: list[tuple[int, float]] = []
    settled = settle(scene(bar, **STANDING), lambda steps, ratio: looks.append((steps, ratio)))

    assert [steps for steps, _ in looks] == list(range(LOOK, settled.steps + 1, LOOK))
    assert looks[-1] == (settled.steps, settled.ratio)
    assert all(ratio > 1e-8 for _, ratio in looks[:-1])


def test_the_scene_itself_keeps_its_own_supports(bar) -> None:
    body = scene(bar, **STANDING)
    settle(body)

    assert len(body.supports) == 0
    assert not np.any(body.assembly.positions[:, 1] < 0.0)


STRESS = (-1e6, -2e6, 0.4e6)


@pytest.mark.parametrize(
    ("law", "stress"), [("elastic", STRESS), ("linearpbond", (-1e6, -2e6, 0.0)), ("linearpbond", (1e6, 2e6, 0.0))]
)
def test_the_stress_asked_for_is_reached(bar, law: str, stress: tuple[float, float, float]) -> None:
    static = {"ratio": 1e-8, "stress": stress}
    settled = settle(scene(bar, static=static, **{"packing.size": [8.0, 8.0], "material.law": law}))

    # 1e-8 of the contact forces, sixteen disks wide; with moved normals a strain of 8e-4 more
    np.testing.assert_allclose(
        settled.stress, stress, rtol=0.0, atol=1e-3 * 2e6 if law == "linearpbond" else 1e-6 * 2e6
    )
    # nobody is held: the outer disks carry the tractions
    assert settled.mean_residual < 1e-6 * settled.mean_reaction


def test_a_settled_body_has_left_its_forces_behind(bar) -> None:
    body = scene(bar, **STANDING)
    settled = settle(body)
    step, start = choose_step(body)[0], settled.start
    system = DiskSystem(body, step, start)
    simulation = Simulation(body, step, np.array([0, 7]), system=system, datum=start.displacement)
    record = simulation.advance(100)

    # not even the steady weight moves it, though nothing holds it now; motion counts from here
    assert not simulation.state.velocity.any()
    assert not record.any()
    assert np.array_equal(simulation.state.displacement, settled.start.displacement)
    # what pulls at the bottom disks is what held them
    assert system.balance is not None
    pulls = system.load[1] + system.balance.force[1]
    assert pulls.sum() == pytest.approx(0.0, abs=1e-9 * 8.0 * MASS * G)
    assert np.count_nonzero(pulls > 2.0 * MASS * G) == 2


def test_stress_along_a_periodic_axis_is_refused(bar) -> None:
    with pytest.raises(CaseError, match=r"static\.stress: cannot be applied at boundary\.left \(\"periodic\"\)"):
        settle(scene(bar, boundary=WRAP, static={"stress": STRESS}, **{"packing.size": [1.0, 1.0]}))


def test_bonds_may_break_on_the_way(bar) -> None:
    hanging = {"packing.size": [0.5, 4.0], "motion.held": ["x", "rotation"], "material.law": "linearpbond"}
    # the top bond of eight would carry seven weights over 0.5 m: 7 · 625 · 9.81/0.5 Pa
    limit = 7.0 * MASS * G / 0.5
    static = {"ratio": 1e-6, "boundary": {"top": FIXED, "bottom": FIXED}}
    held = settle(scene(bar, **WEIGHT, **hanging, static=static, **{"material.pb_ten": limit}))
    weak = settle(scene(bar, **WEIGHT, **hanging, static=static, **{"material.pb_ten": 0.3 * limit}))

    assert len(held.cracks) == 0
    assert len(weak.cracks) == 1
    assert weak.cracks.position[0, 1] == pytest.approx(3.5, abs=1e-3)  # below the fixed top disk
    assert not weak.cracks.shear[0]
    assert weak.start.has_history


SHAFT = {"name": "shaft", "type": "rectangle", "corners": [1.0, 1.0, 2.0, 3.0], "stage": "after"}
TOWER = {**WEIGHT, "packing.size": [3.0, 4.0], "motion.held": ["x", "rotation"]}
TOUGH = {"material.law": "linearpbond", "material.fric": 0.5}
LAWS = {"elastic": {}, "linearpbond": TOUGH, "with a history": {**TOUGH, "material.elastic_start": False}}


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_an_excavated_body_settles_before_and_after(bar, law: dict) -> None:
    body = scene(bar, **{**TOWER, **law, "hole": [SHAFT]})
    looks: list[tuple[int, float]] = []
    settled = settle(body, lambda steps, ratio: looks.append((steps, ratio)))
    whole = settle(scene(bar, **{**TOWER, **law}))

    assert settled.before is not None
    assert settled.before.before is None
    assert np.array_equal(settled.before.start.displacement, whole.start.displacement)
    assert (settled.before.steps, settled.before.ratio) == (whole.steps, whole.ratio)
    assert [looks.count(stage) for stage in ((whole.steps, whole.ratio), (settled.steps, settled.ratio))] == [1, 1]
    assert settled.ratio <= 1e-8
    # 8 of 48 disks are gone: six at the base carry 40 weights in place of 48
    assert settled.before.mean_reaction == pytest.approx(8.0 * MASS * G, rel=1e-6)
    assert settled.mean_reaction == pytest.approx(40.0 / 6.0 * MASS * G, rel=1e-6)
    assert bool(settled.start.contacts) == body.has_history
    for contacts in settled.start.contacts.values():
        assert np.array_equal(contacts.assembly.positions, body.positions)
        assert np.array_equal(contacts.assembly.pairs, body.assembly.pairs)


def test_a_body_without_history_comes_to_rest_as_if_built_so(bar) -> None:
    excavated = settle(scene(bar, **{**TOWER, "hole": [SHAFT]}))
    built = settle(scene(bar, **{**TOWER, "hole": [{**SHAFT, "stage": "before"}]}))
    assert built.before is None
    # two rests leave 1e-8 of the mean contact force on each disk, and that force is less than the weight of a column of
    # eight: as if disks weighed 8e-8 more or less
    scale = np.abs(built.start.displacement[1]).max()
    np.testing.assert_allclose(
        excavated.start.displacement, built.start.displacement, rtol=0.0, atol=2.0 * 8.0 * 1e-8 * scale
    )


def test_a_hole_between_the_disks_leaves_a_body_at_rest(bar) -> None:
    gap = {"name": "gap", "type": "circle", "centre": [1.0, 1.0], "radius": 0.2, "stage": "after"}
    settled = settle(scene(bar, **{**TOWER, **LAWS["with a history"], "hole": [{**SHAFT, "stage": "before"}, gap]}))

    assert settled.before is not None
    assert settled.steps == LOOK
    before, after = settled.before.start, settled.start
    assert list(before.contacts) == list(after.contacts) == ["body"]
    assert after.has_history
    # what it goes on to settle by is less than what 1e-8 of the mean contact force does, see above
    scale = np.abs(before.displacement).max()
    np.testing.assert_allclose(after.displacement, before.displacement, rtol=0.0, atol=8.0 * 1e-8 * scale)
    shear = [start.contacts["body"].of("shear") for start in (before, after)]
    assert shear[1].any()
    np.testing.assert_allclose(shear[1], shear[0], rtol=0.0, atol=2.0 * 8.0 * 1e-8 * scale)


def test_broken_bonds_stay_broken(bar) -> None:
    hanging = {"packing.size": [0.5, 4.0], "motion.held": ["x", "rotation"], "material.law": "linearpbond"}
    limit = 7.0 * MASS * G / 0.5
    static = {"ratio": 1e-6, "boundary": {"top": FIXED, "bottom": FIXED}}
    nothing = {"name": "gap", "type": "circle", "centre": [0.25, 1.0], "radius": 0.2, "stage": "after"}
    changes = {**hanging, "static": static, "material.pb_ten": 0.3 * limit, "hole": [nothing]}
    settled = settle(scene(bar, **WEIGHT, **changes))

    assert settled.before is not None
    assert (len(settled.before.cracks), len(settled.cracks)) == (1, 0)
    assert np.count_nonzero(settled.start.contacts["body"].arrays.state == TENSION) == 1


PACKED = {"pattern": "B", "size": [4.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}


NICHE = {"hole": [{"name": "niche", "type": "circle", "centre": [2.0, 4.0], "radius": 0.7}]}
"""A hole in the top, beside which the ground comes to rest otherwise than the column."""

LOCKED_IN = {"material.law": "linearpbond", "material.locked_in": 10e6}


def packed_ground(bar, sides: str | None, **changes: object) -> DiskScene:
    """A packed brick between free-field sides, whose cut top relaxes; `sides` is the static table of left and right."""
    supports = {"bottom": FIXED} | ({} if sides is None else {side: {"type": sides} for side in ("left", "right")})
    boundary = {side: {"type": "free_field"} for side in ("left", "right")}
    static = {"ratio": 1e-7, "boundary": supports}
    return scene(bar, packing=PACKED, boundary=boundary, static=static, **LOCKED_IN, **changes)


@pytest.mark.parametrize("sides", [None, "free"])
def test_the_column_holds_the_body_while_it_settles(bar, sides: str | None) -> None:
    ground = packed_ground(bar, sides)
    moved = settle(ground).start.displacement
    # body and column come to rest each to 1e-7 of the contact forces, hence of overlaps; some ten rows of disks, whose
    # softest motions are a hundred times softer than a contact, and means that single disks exceed
    apart = np.abs(moved - moved[:, ground.seam.twin])[:2]
    assert apart.max() < 1e-3 * np.abs(moved[:2]).max()

    # a cut side alone would give way
    alone = scene(bar, packing=PACKED, **LOCKED_IN)
    left = settle(alone).start.displacement[0, alone.edges["left"].nodes]
    held = moved[0, ground.edges["left"].nodes]
    assert np.abs(left - held).max() > 0.1 * np.abs(moved[:2]).max()


@pytest.mark.parametrize(("sides", "still"), [("fixed", [0, 1]), ("roller", [0])])
def test_static_supports_hold_free_field_sides(bar, sides: str, still: list[int]) -> None:
    ground = packed_ground(bar, sides, **NICHE)
    displacement = settle(ground).start.displacement
    right = ground.edges["right"].nodes
    moved = np.abs(displacement[:, right] - displacement[:, ground.seam.twin[right]]).max(axis=1)
    # held where the column has come to rest; beside the body it goes on to rest from a ratio of 1e-7
    assert [axis for axis in (0, 1) if moved[axis] < 1e-5 * np.abs(displacement[:2]).max()] == still


def test_the_dashpots_of_a_free_field_act_unless_the_stage_has_its_own_side(bar) -> None:
    grounds = [packed_ground(bar, sides, **NICHE) for sides in (None, "free")]
    beside = np.setdiff1d(grounds[0].edges["right"].nodes, grounds[0].edges["bottom"].nodes)
    of_run = damping(grounds[0], beside)
    in_stage = [damping(StaticScene(ground, ground.case.static).scene, beside) for ground in grounds]
    assert np.all(of_run > 0.0)
    assert np.array_equal(in_stage[0], of_run)
    assert not in_stage[1].any()
    # they outdo local damping, so that the body creeps into place
    steps = [settle(ground).steps for ground in grounds]
    assert steps[0] > steps[1]


def damping(ground: DiskScene, nodes: np.ndarray) -> np.ndarray:
    """Dashpot constants (2, k) N·s/m along x and y on nodes (k,)."""
    found = np.zeros((3, ground.count))
    found[ground.supports.component, ground.supports.node] = ground.supports.damping
    return found[:2, nodes]


def test_what_is_carried_is_the_base_s_and_not_the_dashpots(bar) -> None:
    boundary = {side: {"type": "free_field"} for side in ("left", "right")}
    settled = settle(scene(bar, **{**STANDING, "boundary": boundary}))

    # two disks of the body and one of the column stand on the base, each under three more
    assert settled.mean_reaction == pytest.approx(4.0 * MASS * G, rel=1e-6)
    assert settled.mean_residual < 1e-7 * settled.mean_reaction


def test_beside_a_free_field_the_column_settles_first_and_alone(bar) -> None:
    ground = packed_ground(bar, None, **NICHE)
    looks: list[tuple[int, float]] = []
    settled = settle(ground, lambda steps, ratio: looks.append((steps, ratio)))
    alone = settle(column_alone(ground))

    assert settled.column is not None
    assert np.array_equal(settled.column.start.displacement, alone.start.displacement)
    assert (settled.column.steps, settled.column.ratio) == (alone.steps, alone.ratio)
    assert looks.index((alone.steps, alone.ratio)) == alone.steps // LOOK - 1
    assert len(looks) == (alone.steps + settled.steps) // LOOK
    assert settled.column.column is None
    assert settled.before is None


def test_without_a_free_field_there_is_no_column(bar) -> None:
    assert settle(scene(bar, **STANDING)).column is None


def test_a_body_begins_to_settle_where_its_column_rests(bar) -> None:
    # without the niche body and column are the same ground, and only the sides' cut packing makes a difference
    boundary = {side: {"type": "free_field"} for side in ("left", "right")}
    settled = settle(scene(bar, **{**STANDING, "boundary": boundary}, **TOUGH))

    assert settled.column is not None
    # a lattice has none: it stays where it began, with the column's ratio
    assert settled.steps == LOOK < settled.column.steps
    column = settled.column.start.displacement[1]
    # 1e-8 of the contact forces, four disks high, as above
    np.testing.assert_allclose(
        settled.start.displacement[1, 4:], np.repeat(column, 2), rtol=0.0, atol=1e-6 * np.abs(column).max()
    )


@pytest.mark.parametrize("law", [LAWS["elastic"], LAWS["with a history"]], ids=["elastic", "with a history"])
def test_with_an_excavation_the_column_is_that_of_before(bar, law: dict) -> None:
    boundary = {side: {"type": "free_field"} for side in ("left", "right")}
    shaft = {"name": "shaft", "type": "rectangle", "corners": [1.0, 1.0, 2.0, 3.0], "stage": "after"}
    tower = {**STANDING, **law, "packing.size": [3.0, 4.0], "boundary": boundary}
    settled = settle(scene(bar, **{**tower, "hole": [shaft]}))

    assert settled.column is None
    assert settled.before is not None
    assert settled.before.column is not None
    before, after = settled.before.start.contacts, settled.start.contacts
    assert list(before) == list(after) == (["column", "body"] if law else [])
    if law:  # the column has lost nothing, the body some
        assert np.array_equal(after["column"].of("first"), before["column"].of("first"))
        assert len(after["body"].live) < len(before["body"].live)
