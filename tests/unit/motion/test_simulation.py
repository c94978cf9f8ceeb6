"""The loop: forces, checks and records."""

from dataclasses import replace

import numpy as np
import pytest

from dembound.boundaries.support import SupportBuilder, Supports
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step, step_limit
from dembound.disks.stepping.system import DiskSystem
from dembound.errors import RunError
from dembound.motion.simulation import Simulation
from dembound.motion.trackers import Every

NOBODY = np.zeros(0, dtype=np.int64)
MASS = 2500.0 * 0.5**2
STEP = 0.01


def lone_disk(bar, supports: Supports) -> DiskScene:
    """One disk moved by its supports only."""
    scene = build(bar({"packing.size": [0.5, 0.5], "monitor": [], "motion.held": []}))
    return replace(scene, supports=supports)


def one_row(**columns: object) -> Supports:
    """A support of particle 0 in x."""
    builder = SupportBuilder()
    builder.add(np.array([0]), 0, **columns)  # type: ignore[arg-type]
    return builder.table()


@pytest.mark.parametrize("prescribed", [False, True])
def test_supports_and_steady_loads_push_a_disk_by_central_differences(bar, prescribed: bool) -> None:
    """M (v⁺ − v)/Δt = F − C (v⁺ + v)/2 − K u + 2 t; a prescribed motion v = 2 t is integrated exactly by midpoints."""
    columns = {} if prescribed else {"stiffness": 5.0 * MASS, "damping": 0.4 * MASS / STEP}
    drive = 2.0 * (1.0 if prescribed else MASS)
    scene = lone_disk(bar, one_row(drive=drive, signal=lambda times: times, prescribed=prescribed, **columns))
    load = MASS * np.array([[2.0], [-3.0], [0.0]])
    simulation = Simulation(scene, STEP, system=DiskSystem(scene, STEP, load=load))
    simulation.state.v[0, simulation.state.layout.slot[0]] = v = 1.0
    u = 0.0
    for step in range(10):
        v = 2.0 * (step + 0.5) * STEP if prescribed else (0.8 * v + STEP * (2.0 * step * STEP + 2.0 - 5.0 * u)) / 1.2
        u += STEP * v
    simulation.advance(10)

    # ten steps of a few operations; across, 55 = 1 + … + 10 steps' worth of a Δt²
    np.testing.assert_allclose(simulation.state.velocity[:, 0], [v, -0.3, 0.0], rtol=1e-13)
    np.testing.assert_allclose(simulation.state.displacement[:, 0], [u, -55 * 3e-4, 0.0], rtol=1e-13)


def test_all_falls_alike_beside_free_fields(bar) -> None:
    """Dashpots between disks and their columns see no relative motion, from the first step on."""
    changes = {"boundary": {side: {"type": "free_field"} for side in ("left", "right")}, "wave": {}, "monitor": []}
    scene = build(bar({**changes, "load": [{"name": "weight", "acceleration": [0.0, -10.0]}], "motion.held": []}))
    record = Simulation(scene, 1e-5, np.arange(scene.count)).advance(20)
    falling = -1e-4 * np.arange(20)[:, None] * np.ones(scene.count)
    np.testing.assert_allclose(record[:, :, 4], falling, rtol=1e-9, atol=1e-18)


def simulated(bar, probes: np.ndarray = NOBODY) -> Simulation:
    scene = build(bar())
    return Simulation(scene, choose_step(scene)[0], probes)


class Noting(Every):
    """Writes down the steps at which it sees a run."""

    name = "noting"

    def __init__(self, steps: int, first: int = 0) -> None:
        super().__init__(steps, first)
        self.seen: list[int] = []

    def see(self, simulation: Simulation) -> None:
        self.seen.append(simulation.state.step)


def test_a_run_goes_on_alike_wherever_it_is_cut_and_seen(bar) -> None:
    whole, parts, seen = (simulated(bar, np.array([0, 39])) for _ in range(3))
    seen.track(Noting(3))
    record = whole.advance(29)

    assert np.array_equal(np.concatenate([parts.advance(10), parts.advance(19)]), record)
    assert np.array_equal(seen.advance(29), record)
    for other in (parts, seen):
        assert np.array_equal(other.state.displacement, whole.state.displacement)
        assert np.array_equal(other.state.peaks, whole.state.peaks)
    assert parts.state.step == 29
    assert parts.time == 29 * parts.time_step
    # held motions stay zero, the others do not
    assert whole.state.displacement[0].any()
    assert not whole.state.displacement[1].any()
    assert not whole.state.velocity[1].any()


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


@pytest.mark.parametrize(("axis", "sign"), [(0, -1.0), (1, 1.0)])
def test_a_runaway_node_ends_the_run_whichever_way_it_flies(bar, axis: int, sign: float) -> None:
    simulation = simulated(bar)
    where, limit = 2, simulation.scene.fastest
    place = axis, simulation.state.layout.slot[where]
    watch, none = simulation.trackers[0], np.zeros((0, 0, 6))
    simulation.state.v[place] = 0.9 * sign * limit
    watch.observe(simulation, none)
    x, y = simulation.scene.positions[where]
    for speed in (1.1 * sign * limit, np.nan):
        simulation.state.v[place] = speed
        with pytest.raises(RunError, match=rf"grew without bound.*near \({x:g}, {y:g}\) m"):
            watch.observe(simulation, none)
