"""The loop: what it applies, watches and hands out."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.boundaries.support import SupportBuilder, Supports
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step, step_limit
from dembound.disks.stepping.contact_lists import contact_lists
from dembound.disks.stepping.start import Start
from dembound.disks.stepping.system import DiskSystem
from dembound.errors import RunError
from dembound.motion.scene import FASTEST
from dembound.motion.simulation import Simulation
from dembound.motion.trackers import Every, Tracker
from dembound.running import plan

NOBODY = np.zeros(0, dtype=np.int64)
MASS = 2500.0 * 0.5**2
STEP = 0.01


def lone_disk(bar, supports: Supports) -> DiskScene:
    """One disk that nothing but its supports moves."""
    scene = build(bar({"packing.size": [0.5, 0.5], "monitor": [], "motion.held": []}))
    return replace(scene, supports=supports)


def one_row(**columns: object) -> Supports:
    """A support of particle 0 in x."""
    builder = SupportBuilder()
    builder.add(np.array([0]), 0, **columns)  # type: ignore[arg-type]
    return builder.table()


def test_a_dashpot_slows_a_disk_as_the_centred_update_says(bar) -> None:
    simulation = Simulation(lone_disk(bar, one_row(damping=0.4 * MASS / STEP)), STEP)
    simulation.state.v[0, simulation.state.layout.slot[0]] = 1.0
    simulation.advance(5)

    # (m/Δt − C/2)/(m/Δt + C/2) = 0.8/1.2 each step; rounding of five products
    assert simulation.state.velocity[0, 0] == pytest.approx((0.8 / 1.2) ** 5, rel=1e-14)


def test_spring_and_drive_push_a_disk(bar) -> None:
    drive = {"drive": 2.0 * MASS, "signal": lambda times: times}
    simulation = Simulation(lone_disk(bar, one_row(stiffness=5.0 * MASS, **drive)), STEP)
    u = v = 0.0
    for step in range(10):
        v += STEP * (2.0 * step * STEP - 5.0 * u)
        u += STEP * v
    simulation.advance(10)

    # ten steps of a few operations
    assert simulation.state.displacement[0, 0] == pytest.approx(u, rel=1e-13)
    assert simulation.state.velocity[0, 0] == pytest.approx(v, rel=1e-13)


def test_a_prescribed_disk_moves_by_the_midpoint_rule(bar) -> None:
    row = one_row(drive=1.0, signal=lambda times: times, prescribed=True)
    simulation = Simulation(lone_disk(bar, row), STEP)
    simulation.advance(10)

    # v = t is integrated exactly by midpoints: u = t²/2; ten sums
    assert simulation.state.velocity[0, 0] == pytest.approx(0.095, rel=1e-14)
    assert simulation.state.displacement[0, 0] == pytest.approx(0.5 * simulation.time**2, rel=1e-14)


def simulated(bar, probes: np.ndarray = NOBODY) -> Simulation:
    scene = build(bar())
    return Simulation(scene, choose_step(scene)[0], probes)


class Heard(Tracker):
    """Writes down whenever the loop comes back, after which step, with how many in the record."""

    name = "heard"

    def __init__(self) -> None:
        self.seen: list[tuple[int, int]] = []

    def handle(self, simulation: Simulation) -> None:
        raise AssertionError("it is never due")

    def observe(self, simulation: Simulation, record: np.ndarray) -> None:
        self.seen.append((simulation.state.step, len(record)))


class Noting(Every):
    """Writes down the steps at which it sees a run."""

    name = "noting"

    def __init__(self, steps: int, first: int = 0) -> None:
        super().__init__(steps, first)
        self.seen: list[int] = []

    def see(self, simulation: Simulation) -> None:
        self.seen.append(simulation.state.step)


def test_held_motions_stay_zero_and_the_others_do_not(bar) -> None:
    simulation = simulated(bar)
    simulation.advance(29)

    assert simulation.state.displacement[0].any()
    assert not simulation.state.displacement[1].any()
    assert not simulation.state.velocity[1].any()


def test_time_goes_on_from_call_to_call(bar) -> None:
    whole, parts = simulated(bar, np.array([0, 39])), simulated(bar, np.array([0, 39]))
    records = [parts.advance(10), parts.advance(19)]

    assert np.array_equal(np.concatenate(records), whole.advance(29))
    assert np.array_equal(parts.state.displacement, whole.state.displacement)
    assert np.array_equal(parts.state.peaks, whole.state.peaks)
    assert parts.state.step == 29
    assert parts.time == 29 * parts.time_step


def test_a_run_goes_block_by_block_to_the_step_asked_for(bar) -> None:
    simulation, heard = simulated(bar), Heard()
    simulation.track(heard)
    simulation.run(DiskScene.block + 10)

    assert heard.seen == [(DiskScene.block, DiskScene.block), (DiskScene.block + 10, 10)]


def test_a_run_stops_at_the_steps_that_trackers_have_named(bar) -> None:
    simulation, heard, early, late = simulated(bar), Heard(), Noting(7), Noting(5, first=9)
    simulation.track(heard, early, late)
    simulation.run(20)

    assert early.seen == [0, 7, 14]
    assert late.seen == [9, 14, 19]
    assert heard.seen == [(7, 7), (9, 2), (14, 5), (19, 5), (20, 1)]


def test_a_run_goes_on_alike_however_often_it_is_seen(bar) -> None:
    seen, plain = simulated(bar, np.array([7])), simulated(bar, np.array([7]))
    seen.track(Noting(3))

    assert np.array_equal(seen.advance(29), plain.advance(29))
    assert np.array_equal(seen.state.displacement, plain.state.displacement)


def test_a_tracker_may_end_a_run(bar) -> None:
    class Enough(Noting):
        def see(self, simulation: Simulation) -> None:
            simulation.stopped = True

    simulation = simulated(bar)
    simulation.track(Enough(5, first=5))
    simulation.run(20)

    assert simulation.state.step == 5


def test_peaks_of_a_side_are_the_extremes_of_its_particles(bar) -> None:
    edges = build(bar()).edges
    simulation = simulated(bar, edges["right"].nodes)
    velocities = [simulation.state.velocity[:, simulation.scene.edges["right"].nodes].T]
    for _ in range(60):
        simulation.advance(1)
        velocities.append(simulation.state.velocity[:, simulation.scene.edges["right"].nodes].T)
    history = np.array(velocities)

    assert np.array_equal(simulation.edge_peaks("right")[..., 0], history.min(axis=0))
    assert np.array_equal(simulation.edge_peaks("right")[..., 1], history.max(axis=0))
    # the pulse of 0.5 m/s has gone through by then, and has come to no other side's account
    assert simulation.edge_peaks("right")[0, 0, 1] > 0.4
    assert [len(simulation.edge_peaks(side)) for side in edges] == [2, 2, 20, 20]


def test_the_probes_record_the_motion_of_their_particles(bar) -> None:
    nodes = np.array([7, 31])
    simulation = simulated(bar, nodes)
    places, records = [], []
    for _ in range(20):
        places.append(simulation.state.displacement[:, nodes].T.copy())
        records.append(simulation.advance(1))
    record = np.concatenate(records)

    assert np.array_equal(record[..., :3], np.array(places))
    # velocities are means over two half steps: the differences of displacements two steps apart
    centred = (record[2:, :, :3] - record[:-2, :, :3]) / (2.0 * simulation.time_step)
    # differences of displacements of 1e-3 m lose 1e-19 m, over a step of 4e-4 s
    np.testing.assert_allclose(record[1:-1, :, 3:], centred, atol=1e-14)


def test_motion_that_grows_without_bound_ends_the_run_and_says_when_and_where(bar) -> None:
    scene = build(bar())
    step = 2.0 * step_limit(scene)
    simulation = Simulation(scene, step)
    with pytest.raises(RunError, match=r"grew without bound: at t = [\d.]+ s near \([\d.]+, [\d.]+\) m") as caught:
        simulation.run(100_000)

    # twice the limit multiplies by −7 − √48 = −13.9 each step: 308 decimal powers are gone within 271 steps
    assert simulation.state.step <= 2 * DiskScene.block
    assert f"t = {simulation.state.step * step:g} s" in str(caught.value)
    assert caught.value.exit_code == 3


def test_growth_is_seen_long_before_numbers_overflow(bar) -> None:
    scene = build(bar())
    simulation = Simulation(scene, 1.01 * step_limit(scene))
    simulation.state.v[2, simulation.state.layout.slot[5]] = (
        1e-9  # the fastest mode turns the disks, which a plane wave never does
    )
    with pytest.raises(RunError, match="grew without bound"):
        simulation.run(100_000)

    # per step e^(2 acosh 1.01) = 1.33, so within a block at most 1.33^256 = 1e31 above the bound
    assert np.abs(simulation.state.velocity).max() < 1e40


def test_what_is_not_a_number_ends_the_run(bar) -> None:
    simulation = simulated(bar)
    simulation.state.u[0, simulation.state.layout.slot[5]] = np.nan
    with pytest.raises(RunError, match="grew without bound"):
        simulation.advance(1)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_runaway_node_ends_the_run_whichever_way_it_flies(bar, axis: int, sign: float) -> None:
    simulation = simulated(bar)
    where, limit = 2, simulation.scene.fastest
    simulation.state.v[axis, simulation.state.layout.slot[where]] = 0.9 * sign * limit
    watch = simulation.trackers[0]
    none = np.zeros((0, 0, 6))
    watch.observe(simulation, none)

    simulation.state.v[axis, simulation.state.layout.slot[where]] = 1.1 * sign * limit
    x, y = simulation.scene.positions[where]
    with pytest.raises(RunError, match=rf"near \({x:g}, {y:g}\) m"):
        watch.observe(simulation, none)


def test_a_speed_ends_the_run_before_its_energy_is_no_number(spalling) -> None:
    planned = plan(spalling())  # a load moves it, whose effect no wave bounds
    simulation = Simulation(planned.scene, planned.time_step)
    simulation.state.v[0, simulation.state.layout.slot] = 0.9 * FASTEST  # of all nodes, so that no bond feels it
    simulation.advance(1)
    assert np.isfinite(np.sum(planned.scene.mass * simulation.state.velocity[0] ** 2))

    simulation.state.v[0, simulation.state.layout.slot] *= 1.2
    with pytest.raises(RunError, match="smaller waves and loads"):
        simulation.advance(1)


def test_a_calm_scene_stays_at_rest(bar) -> None:
    simulation = Simulation(build(bar({"wave.pulse.start": 1.0})), 1e-4)
    simulation.advance(100)

    assert not simulation.state.displacement.any()
    assert not simulation.state.peaks.any()


def test_a_steady_load_moves_a_disk(bar) -> None:
    scene = lone_disk(bar, SupportBuilder().table())
    load = MASS * np.array([[2.0], [-3.0], [0.0]])
    simulation = Simulation(scene, STEP, system=DiskSystem(scene, STEP, load=load))
    simulation.advance(10)

    # 55 = 1 + … + 10 steps' worth of a Δt²
    np.testing.assert_allclose(simulation.state.velocity[:, 0], [0.2, -0.3, 0.0], rtol=1e-14)
    np.testing.assert_allclose(simulation.state.displacement[:, 0], [55 * 2e-4, -55 * 3e-4, 0.0], rtol=1e-14)


def test_local_damping_is_the_materials_unless_told_otherwise(bar) -> None:
    body = {"packing.size": [0.5, 0.5], "monitor": [], "motion.held": [], "boundary": {}, "wave": {}}
    scene = build(bar({**body, "material.damp": 0.5}))
    load = MASS * np.array([[1.0], [0.0], [0.0]])
    own, other = (Simulation(scene, STEP, system=DiskSystem(scene, STEP, load=load), damp=damp) for damp in (None, 0.2))
    for simulation in (own, other):
        simulation.advance(11)

    # the first step finds it at rest
    assert own.state.velocity[0, 0] == pytest.approx(STEP * (1.0 + 10 * 0.5), rel=1e-14)
    assert other.state.velocity[0, 0] == pytest.approx(STEP * (1.0 + 10 * 0.8), rel=1e-14)


PACKED = {
    "packing": {"pattern": "B", "size": [4.0, 4.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]},
    "material.law": "linearpbond",
    "material.locked_in": 10e6,
    "static": {},
    "motion.held": [],
    "boundary": {},
    "wave": {},
    "monitor": [],
}


def at_rest(scene: DiskScene) -> Simulation:
    """A body as built, taken as settled."""
    start, step = Start(np.zeros((3, scene.count)), contact_lists(scene)), choose_step(scene)[0]
    return Simulation(scene, step, system=DiskSystem(scene, step, start), datum=start.displacement)


def test_what_is_locked_in_is_balanced_unless_the_body_shall_settle(bar) -> None:
    scene = build(bar(PACKED))
    step, _ = choose_step(scene)
    calm = at_rest(scene)
    settling = Simulation(scene, step, system=DiskSystem(scene, step, settling=True))
    for simulation in (calm, settling):
        simulation.advance(20)

    assert not calm.state.velocity.any()
    # cut faces lack the push of 10 MPa: outwards
    outwards = scene.assembly.positions - 2.0
    assert np.sum(outwards.T * settling.state.displacement[:2]) > 0.0


@pytest.mark.parametrize("has_history", [False, True])
def test_a_body_that_settles_anew_is_pushed_by_all_its_contacts(bar, has_history: bool) -> None:
    scene = build(bar({**PACKED, "material.fric": 0.5}))
    # far less than the overlaps of 10 MPa, so that the elastic law holds
    displacement = 1e-9 * np.random.default_rng(1).uniform(-1.0, 1.0, (3, scene.count))
    contacts, twin = contact_lists(scene), contact_lists(scene)
    for lists in (contacts, twin):
        lists["body"].start_from_displacements(displacement)
        lists["body"].arrays.slip[:] = 1e-9 * has_history  # friction has its part of the force
    pushed = np.zeros_like(displacement)
    twin["body"].push(displacement, reference=not has_history)
    twin["body"].add_forces(pushed)
    load = np.random.default_rng(2).uniform(-1e3, 1e3, (3, scene.count))
    step, _ = choose_step(scene)
    system = DiskSystem(scene, step, Start(displacement, contacts, has_history), settling=True, load=load)
    simulation = Simulation(scene, step, system=system, datum=displacement, damp=0.0)
    simulation.advance(1)

    assert simulation.state.laws == [("linearpbond" if has_history else "elastic", 0)]
    inertia = np.stack([scene.mass, scene.mass, scene.inertia])
    # some ten forces of up to 10 MPa times a diameter per disk, of which 1e-9/1e-3 are the displacements'; normals that
    # turn by 1e-9/0.5 make a share of 1e-8 of difference
    size = np.abs(pushed).max()
    tolerance = 1e-8 if has_history else 1e-12
    np.testing.assert_allclose(
        inertia * simulation.state.velocity / step, pushed + load, rtol=0.0, atol=tolerance * size
    )


@pytest.mark.parametrize("elastic_start", [True, False])
def test_the_law_with_a_memory_takes_over_where_it_must(bar, elastic_start: bool) -> None:
    scene = build(bar({**PACKED, "material.elastic_start": elastic_start}))
    simulation = at_rest(scene)
    assert simulation.state.laws == ([("elastic", 0)] if elastic_start else [("linearpbond", 0)])
    simulation.advance(5)
    assert len(simulation.state.laws) == 1

    simulation.state.v[:2, simulation.state.layout.slot] = np.random.default_rng(1).uniform(-5.0, 5.0, (2, scene.count))
    simulation.advance(50)
    names, steps = zip(*simulation.state.laws, strict=True)
    assert names == (("elastic", "linearpbond") if elastic_start else ("linearpbond",))
    assert steps[0] == 0
    assert not elastic_start or 5 < steps[1] < 55


HISTORY = ("material.locked_in", "material.geometry", "static")


def test_across_a_seam_both_laws_move_a_body_alike(bar) -> None:
    free_field = {side: {"type": "free_field"} for side in ("left", "right")}
    changes = {**PACKED, "material.geometry": "reference", "boundary": free_field}
    own = {key: value for key, value in changes.items() if key not in HISTORY} | {"material.law": "elastic"}
    step = choose_step(build(bar(changes)))[0]
    moves = []
    for elastic in (True, False):
        scene = build(bar(own if elastic else changes))
        simulation = Simulation(scene, step) if elastic else at_rest(scene)
        simulation.state.velocity = 1e-4 * np.random.default_rng(3).uniform(-1.0, 1.0, (3, scene.count))
        if not elastic:
            assert list(simulation.system.contacts) == ["column", "body"]
            for pairs in simulation.system.contacts.values():  # their first push adds this step
                pairs.start_from_displacements(-simulation.time_step * simulation.state.velocity)
        simulation.advance(50)
        assert [name for name, _ in simulation.state.laws] == ["elastic" if elastic else "linearpbond"]
        moves.append(simulation.state.displacement)

    # locked-in forces of 5 MN are rounded in every step; beside them those of the motion are 1e9 N/m · 1e-4 m/s · Δt
    rounding = 50 * 10.0 * np.finfo(float).eps * 5e6 / (1e9 * 1e-4 * simulation.time_step)
    assert np.abs(moves[0] - moves[1]).max() < rounding * np.abs(moves[0]).max()
