"""Disks far below the scene: found where they touch nothing, put to rest without a loss of energy; turns of bonds."""

from typing import Any

import numpy as np
import pytest
from small_cases import small

from dembound.casefile import Case
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.disks.watches import STEPS, FarDisks, Turns, turn_warnings
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

LOOSE: dict[str, Any] = {
    "packing": {"pattern": "A", "size": [2.0, 2.0], "radius": 0.25},
    "material": {
        "law": "linearpbond",
        "density": 2500.0,
        "emod": 1e7,
        "pb_emod": 1e5,
        "pb_ten": 1.0,
        "pb_coh": 1.0,
        "elastic_start": False,
    },
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "run": {"duration": 1.0},
    "output": {"pictures": False},
}
"""A heap that falls apart, and past every floor."""


class Falling:
    """A run of the heap in free fall, disks of which are thrown down."""

    def __init__(self, *, retires: bool) -> None:
        scene = build(small(LOOSE))  # type: ignore[arg-type]
        assert isinstance(scene, DiskScene)
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


FREE: dict[str, Any] = {
    "packing": {"pattern": "A", "size": [2.0, 2.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 1000.0},
    "load": [{"name": "touch", "force": [1e-9, 0.0], "position": [0.2, 0.2], "wave": "w"}],
    "wave": {"w": {"type": "cosine", "amplitude": 1.0, "period": 1.0}},
    "run": {"duration": 1.0},
    "output": {"pictures": False},
}
KEPT: dict[str, Any] = {"law": "linearpbond", "geometry": "reference", "elastic_start": False}


def free(**material: Any) -> Case:
    return small(FREE | {"material": FREE["material"] | material})  # type: ignore[arg-type]


def at_rest(case: Case) -> Simulation:
    return Simulation(build(case), 1e-5)  # type: ignore[arg-type]


@pytest.mark.parametrize("material", [{}, KEPT])
def test_the_largest_turn_is_found_whichever_way_and_wherever_it_is(material) -> None:
    run = at_rest(free(**material))
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
    run, steps, spin = at_rest(free()), 100, 400.0
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
