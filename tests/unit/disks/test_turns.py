"""How far bonds that keep their directions have turned."""

from typing import Any

import numpy as np
import pytest
from small_cases import small

from dembound.casefile import Case
from dembound.disks.scene import build
from dembound.disks.watches import Turns, turn_warnings
from dembound.motion.simulation import Simulation

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
