"""Disks far below the scene: found where they touch nothing, put to rest without a loss of energy; turns of bonds."""

from typing import Any

import numpy as np
import pytest
from scene_tables import point, pulse
from small_cases import GRAINS, around, small

from dembound.disks.bearing import BearingTie
from dembound.disks.reduced import OneRow, reduced
from dembound.disks.scene import DiskScene, build
from dembound.disks.sides import medium_of_side
from dembound.disks.stability import choose_step
from dembound.disks.watches import STEPS, FarDisks, Turns, turn_warnings
from dembound.errors import CaseError
from dembound.kernels.follower import bearing_forces
from dembound.kinds.disks.kind import Disks
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation
from dembound.running import plan, require_ready

LOOSE: dict[str, Any] = {
    "packing": {"pattern": "A", "size": [2.0, 2.0], "radius": 0.25},
    "material": {"law": "linearpbond", "density": 2500.0, "emod": 1e7, "pb_emod": 1e5, "pb_ten": 1.0, "pb_coh": 1.0}
    | {"elastic_start": False},
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "run": {"duration": 1.0},
    "output": {"pictures": False},
}
"""A heap that falls apart, and past every floor."""


class Falling:
    """A run of the heap in free fall, disks of which are thrown down."""

    def __init__(self, *, retires: bool) -> None:
        scene = build(small(LOOSE))
        self.scene, self.step = scene, choose_step(scene)[0]
        self.run = Simulation(scene, self.step)
        self.far, self.ledger = FarDisks(scene, retires=retires), Ledger(self.run, STEPS // 4)
        self.run.track(self.far, self.ledger)
        x, y = scene.positions.T
        self.thrown = np.flatnonzero(y < 0.5)
        velocity = self.run.state.velocity.copy()
        velocity[1] += 5.0
        velocity[1, self.thrown] = -15.0 - 3.0 * x[self.thrown]
        self.run.state.velocity = velocity

    def until(self, steps: int) -> None:
        self.run.advance(steps - self.run.state.step)


@pytest.fixture(scope="module")
def fallen() -> dict[bool, Falling]:
    """Runs with and without retirement, one look long."""
    found = {retires: Falling(retires=retires) for retires in (False, True)}
    for each in found.values():
        each.until(STEPS + STEPS // 4)
    return found


def test_they_are_those_below_the_base_by_the_height_of_the_scene_that_touch_nothing(fallen) -> None:
    falling = fallen[False]
    y = (falling.scene.positions[:, 1] + falling.run.state.displacement[1])[falling.far.far]
    assert falling.far.far.sum() == 4
    assert y.max() < -2.0
    assert np.isin(np.flatnonzero(falling.far.far), falling.thrown).all()


def test_those_that_retire_stay_where_they_are_with_their_energy_accounted_for(fallen) -> None:
    falling = fallen[True]
    chosen, state = falling.far.far, falling.run.state
    assert np.array_equal(chosen, fallen[False].far.far)
    before = state.displacement[:, chosen].copy()
    falling.until(falling.run.state.step + 50)
    assert not state.velocity[:, chosen].any()
    assert np.array_equal(state.displacement[:, chosen], before)
    fallen[False].until(falling.run.state.step)
    entry, other = (each.ledger.entries[-1] for each in (falling, fallen[False]))
    assert entry.time == other.time
    # what turning normals leave is the same; some 2,000 steps of sums of a hundred terms of the size of all energy
    assert abs(entry.error - other.error) < 1e-10 * entry.supplied
    assert abs(entry.load - other.load) > 0.1 * entry.supplied
    speeds = np.sum(falling.scene.mass[chosen] * 0.5 * 15.0**2)
    assert entry.damping > speeds
    # the others do not notice
    rest = ~chosen
    assert np.array_equal(state.displacement[:, rest], fallen[False].run.state.displacement[:, rest])


KEPT: dict[str, Any] = {"law": "linearpbond", "geometry": "reference", "elastic_start": False}


def at_rest(**material: Any) -> Simulation:
    free = {
        "material": {"density": 2500.0, "p_wave_speed": 1000.0} | material,
        "load": [point((1e-9, 0.0), (0.2, 0.2))],
    }
    return Simulation(build(small(LOOSE | free | {"wave": pulse(1.0)})), 1e-5)


@pytest.mark.parametrize("material", [{}, KEPT])
def test_the_largest_turn_is_found_whichever_way_and_wherever_it_is(material) -> None:
    run = at_rest(**material)
    x, y = run.scene.positions.T
    for turn in (0.3, -0.4):
        run.state.displacement = np.stack([2.0 - turn * y, turn * x - 3.0, 0.0 * x])
        assert Turns().describe(run)["turn"] == pytest.approx(abs(turn), rel=1e-9)
    run.state.displacement = np.stack([0.2 * y, 0.05 * x, 0.0 * x])  # upright bonds turn by −0.2, level ones by 0.05
    assert Turns().describe(run)["turn"] == pytest.approx(0.2, rel=1e-9)
    run.state.displacement = np.stack([0.5 * (x - 1.0), 0.5 * y, 0.0 * x])  # it stretches, and does not turn
    assert Turns().describe(run)["turn"] < 1e-12
    run.state.displacement = np.stack([0.1 * (y > 1.5), 0.0 * x, 0.0 * x])  # the upper row slides by 0.1 m
    found = Turns().describe(run)
    assert found["turn"] == pytest.approx(0.2, rel=1e-9)
    assert found["position"][1] == pytest.approx(1.5)


def test_a_body_that_spins_under_the_elastic_law_grows_as_said() -> None:
    run, steps, spin = at_rest(), 100, 400.0
    arm = (run.scene.positions - run.scene.positions.mean(axis=0)).T
    run.state.velocity = spin * np.stack([-arm[1], arm[0], np.ones(len(arm[0]))])
    tracker = Turns()
    run.track(tracker)
    run.advance(steps)
    found = tracker.describe(run)
    assert found["turn"] == pytest.approx(spin * steps * run.time_step, rel=1e-6)
    assert found["time"] == pytest.approx(steps * run.time_step)
    grown = np.hypot(*(arm + run.state.displacement[:2])) / np.hypot(*arm)
    np.testing.assert_allclose(grown, np.hypot(1.0, found["turn"]), rtol=1e-6)

    (said,) = turn_warnings(found, "elastic", has_history=False)
    assert said.startswith(
        'material.law: is "elastic", so bonds keep their directions of the start, but by t = 0.001 s'
    )
    assert "has turned by 0.4 rad: a body that turns so grows by 7.7 %" in said
    again = Turns()
    again.restore(tracker.saved_arrays())
    np.testing.assert_array_equal(again.found, tracker.found)


PERIODIC = around("periodic", "left", "right")
PLAIN_COLUMN = {"type": "free_field", "bearing": False}


def scene(sides: dict[str, Any], **bearing: float) -> DiskScene:
    bottom = {"type": "viscous_input", "wave_s": "pulse", "bearing": bearing or True}
    made = build(small(GRAINS | {"boundary": sides | {"bottom": bottom}}))  # type: ignore[arg-type]
    assert made.bearing is not None
    return made


def forces(body: DiskScene, moved: np.ndarray, datum: np.ndarray | None = None) -> np.ndarray:
    """Forces (3, n) of the springs at displacements (3, n)."""
    assert body.bearing is not None
    tie = BearingTie(body.bearing, body.layout)
    tie.rest_at(np.zeros_like(moved) if datum is None else datum)
    supported = np.union1d(tie.nodes, [0, body.count - 1])
    force, found = np.zeros((len(supported), 3)), np.zeros((3, body.count))
    u = body.layout.spread(moved)
    bearing_forces(tie.bundle(supported), u, u, force)
    assert np.array_equal(force, tie.force_on(supported))
    found[:, supported] = force.T
    return found


def test_a_free_field_side_pulls_back_its_disks_by_their_share_of_the_shear_modulus() -> None:
    kind = {"type": "free_field", "bearing": {"alpha_n": 3.0, "alpha_s": 0.25}}
    sides = around(kind, "left", "right")
    body = scene(sides, alpha_n=0.0, alpha_s=0.5)
    left, bottom = body.sides["left"], body.sides["bottom"]
    moved = np.zeros((3, body.count))
    moved[:2, left.nodes[:, None]] = [[[0.01]], [[0.02]]]
    found, modulus = forces(body, moved), medium_of_side(body, "left").shear_modulus
    stiffness = np.outer([3.0, 0.25], modulus * left.widths / left.length)
    in_left = {int(node): k for k, node in enumerate(left.nodes)}
    both = [k for k, node in enumerate(bottom.nodes) if int(node) in in_left]  # disks of the corner have both springs
    corner = [in_left[int(bottom.nodes[k])] for k in both]
    stiffness[:, corner] += np.outer([0.5, 0.0], modulus * bottom.widths[both] / bottom.length)
    np.testing.assert_allclose(found[:2, left.nodes], -stiffness * [[0.01], [0.02]], rtol=1e-13)
    assert both
    total = np.zeros((body.count, 2))
    for node, share in body.borne.values():
        total[node] += share
    np.testing.assert_allclose(total[left.nodes], 1.0, rtol=1e-15)


TWINS_OR_MEAN = pytest.mark.parametrize("sides", [around(PLAIN_COLUMN, "left", "right"), PERIODIC])


@TWINS_OR_MEAN
def test_motion_of_the_ground_without_the_body_meets_no_force(sides) -> None:
    body = scene(sides)
    rng = np.random.default_rng(1)
    own = np.repeat(rng.uniform(-1.0, 1.0, (3, 1)), body.count, axis=1)
    if body.seams:
        own = rng.uniform(-1.0, 1.0, (3, body.count))[:, body.seams[0].twin]
    assert np.abs(forces(body, own)).max() < 1e-15 * body.bearing.stiffness.max() * len(body.bearing.node)


@TWINS_OR_MEAN
def test_one_disk_is_pulled_back_by_its_share_of_the_shear_modulus(sides) -> None:
    body = scene(sides, alpha_n=3.0, alpha_s=0.25)
    edge, datum = body.sides["bottom"], 0.1 * np.random.default_rng(2).uniform(-1.0, 1.0, (3, body.count))
    node, moved = int(edge.nodes[5]), datum.copy()
    moved[:, node] += [0.01, 0.02, 0.3]
    found = forces(body, moved, datum)
    modulus = medium_of_side(body, "bottom").shear_modulus
    stiffness = np.outer([0.25, 3.0], modulus * edge.widths / edge.length)
    share = edge.widths / edge.widths.sum() if body.twin is None else np.zeros(len(edge.nodes))
    apart = np.outer([0.01, 0.02], (edge.nodes == node) - share[5])
    # differences of numbers of size 0.1
    np.testing.assert_allclose(found[:2, edge.nodes], -stiffness * apart, rtol=0.0, atol=1e-15 * stiffness.max())
    assert not found[2].any()
    assert not np.delete(found, edge.nodes, axis=1).any()
    if body.twin is None:  # they bear no net force
        assert np.abs(found.sum(axis=1)).max() < 1e-12 * np.abs(found).max()


LATTICE: dict[str, Any] = {
    "packing": {"pattern": "A", "size": [10.0, 8.0], "radius": 0.25},
    "material.law": "linearpbond",
    "material.pb_ten": 1e6,
    "wave": {"push": {"type": "cosine", "amplitude": 1.0, "period": 0.1}},
    "monitor": [],
    "motion.held": [],
}
BOTTOM = {"type": "viscous_input", "wave_s": "push"}


def zoned(bar, **boundary: dict[str, Any]):
    return build(bar({**LATTICE, "boundary": boundary}))


@pytest.mark.parametrize("depth", [1, 2, 4])
def test_a_zone_is_as_many_rows_of_a_lattice(bar, depth) -> None:
    body = zoned(bar, bottom=BOTTOM | {"intact": depth}, left={"type": "viscous", "intact": 1})
    x, y = body.positions.T
    assert np.array_equal(body.intact_zones["bottom"], np.flatnonzero(y < 0.5 * depth))
    assert np.array_equal(body.intact_zones["left"], np.flatnonzero(x < 0.5))
    assert body.intact is not None
    assert np.array_equal(body.intact, (y < 0.5 * depth) | (x < 0.5))


def test_a_zone_of_more_than_half_of_the_body_is_refused(bar) -> None:
    assert zoned(bar, bottom=BOTTOM | {"intact": 8}).intact is not None
    with pytest.raises(CaseError, match=r"boundary.bottom.intact: is 9: bonds of 180 of 320 disks would not break"):
        Disks().build(bar({**LATTICE, "boundary": {"bottom": BOTTOM | {"intact": 9}}}))


def test_a_zone_may_be_larger_than_the_strip_in_which_its_side_is_examined(bar) -> None:
    """What a run computes before its first step is computed by a check: here when waves enter, in a strip."""
    wide = {"packing": {"pattern": "A", "size": [40.0, 2.0], "radius": 0.25}, "monitor": LATTICE["monitor"]}
    side = {"type": "viscous_input", "wave_p": "push", "intact": 20}
    require_ready(plan(bar({**LATTICE, **wide, "boundary": {"left": side}})))


P_INPUT = {"boundary.left": {"type": "viscous_input", "wave_p": "pulse"}}
S_INPUT = {"motion.held": ["x"], "boundary.left": {"type": "viscous_input", "wave_s": "pulse"}}
SPRINGS = {"type": "viscoelastic", "distance": 20.0}
HOLE = {"hole": [{"name": "gap", "type": "circle", "centre": [5.25, 1.25], "radius": 0.1}]}
BROAD = {"packing.size": [10.0, 2.0]}
"""20 × 4 disks."""


@pytest.fixture
def plain(bar):
    """Makes scenes of 20 × 4 disks under a P pulse, y held, with keys of the case changed."""

    def make(changes=None):
        return build(bar({**BROAD, "motion.held": ["y"], **P_INPUT, **(changes or {})}))

    return make


def load(**keys):
    return {"load": [{"name": "push", **keys}]}


def both(kind: str) -> dict[str, Any]:
    """Lower and upper sides of a type, with free motion."""
    return {"boundary.bottom": {"type": kind}, "boundary.top": {"type": kind}, "motion.held": []}


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"monitor": [{"name": "corner", "position": [0.0, 2.0]}]},
        both("roller"),
        both("symmetry"),
        {"boundary.right": SPRINGS},
        S_INPUT | both("periodic"),
        load(region=[2.0, 0.0, 4.0, 2.0], force=[1e6, 0.0]),
        load(region=[2.0, 0.0, 4.0, 2.0], force=[1e6, 0.0], wave="pulse"),
    ],
)
def test_rows_that_move_identically_are_stepped_as_one(plain, changes) -> None:
    whole = plain(changes)
    row = reduced(whole).scene

    assert isinstance(row, OneRow)
    assert row.whole is whole
    assert row.count == 20
    assert row.weight == pytest.approx(4.0, rel=1e-15)
    assert row.low.tolist() == [0.0, 1.0]  # of the third of four rows
    assert row.reduced == ("rows: 4 identical rows are stepped as one, 20 of 80 disks",)


@pytest.mark.parametrize(
    "changes",
    [
        {"reduce.rows": False},
        {"packing.size": [10.0, 0.5]},  # a single row
        HOLE,
        load(position=[5.25, 1.25], force=[1e3, 0.0]),
        load(region=[2.0, 0.0, 4.0, 1.0], force=[1e6, 0.0]),
        {"motion.held": [], **load(acceleration=[0.0, -9.81])},
        {"boundary.bottom": {"type": "viscous", "beta_s": 1e-9}},
        {"boundary.bottom": SPRINGS | {"alpha_n": 0.0}},
        {"boundary.right": {"type": "viscoelastic", "source": [0.0, 1.0]}},
        S_INPUT,  # the outer rows have one contact less that resists their rotation
        S_INPUT | both("symmetry"),
        {"material.law": "linearpbond"},
        {"static.stress": [-1e6, -1e6, 0.0]},
        {"boundary.right": {"type": "free_field"}, "motion.held": []},
    ],
)
def test_rows_that_differ_are_stepped_one_by_one(plain, changes) -> None:
    whole = plain(changes)

    assert reduced(whole).scene is whole
    assert whole.whole is whole
    assert whole.reduced == ()
    assert whole.weight == 1.0
