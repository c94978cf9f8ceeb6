"""The steps of a bar as arrays of numpy are those of the kernels."""

import numpy as np
import pytest

from dembound.api import case
from dembound.bar.linear_steps import LinearSteps
from dembound.bar.scene import build_bar
from dembound.motion.simulation import Simulation

PLACE, STEPS = 12, 300
"""Node that is pushed, farther than a horizon from both ends, and steps."""


@pytest.mark.parametrize("horizon", [1, 3])
@pytest.mark.parametrize("attenuation", [0.0, 2.0])
def test_a_push_moves_all_nodes_as_in_a_run(horizon, attenuation):
    """One end with a dashpot, one with a layer; to rounding of some hundred steps."""
    given = case(
        bar={"length": 0.3, "spacing": 0.01, "density": 2000.0, "wave_speed": 2000.0, "attenuation": attenuation},
        method={"type": "peridynamics", "horizon": horizon} if horizon > 1 else {"type": "finite_difference"},
        boundary={"left": {"type": "viscous"}, "right": {"type": "matched_layer", "nodes": 10}},
        run={"duration": 1.0},
    )
    scene = build_bar(given)
    step = 0.8 * scene.step_limit()
    kept = (1.0 - 0.5 * step * scene.rod.drag_rate[PLACE]) / (1.0 + 0.5 * step * scene.rod.drag_rate[PLACE])
    simulation = Simulation(scene, step, np.arange(scene.count))
    before = np.zeros((3, scene.count))
    before[0, PLACE] = 1.0 / kept
    simulation.state.velocity = before
    expected = simulation.advance(STEPS)[:, :, 3]

    force = np.zeros(scene.count)
    force[PLACE] = scene.mass[PLACE] * (1.0 + 0.5 * step * scene.rod.drag_rate[PLACE]) / step
    found = LinearSteps(scene, scene.layers, step).after(force, np.zeros(scene.count), STEPS)
    np.testing.assert_allclose(0.5 * (found[1:] + found[:-1]), expected[1:], rtol=0.0, atol=1e-13)


def test_a_motion_that_is_prescribed_is_that_of_the_first_step_alone():
    ends = {"left": {"type": "velocity", "wave_p": "p"}}
    wave = {"p": {"type": "cosine", "amplitude": 1.0, "period": 1e-4}}
    bar = {"length": 0.3, "spacing": 0.01, "density": 2000.0, "wave_speed": 2000.0}
    scene = build_bar(
        case(bar=bar, method={"type": "finite_difference"}, boundary=ends, wave=wave, run={"duration": 1})
    )
    motion = np.zeros(scene.count)
    motion[0] = 1.0
    found = LinearSteps(scene, {}, 5e-6).after(np.zeros(scene.count), motion, 5)
    np.testing.assert_array_equal(found[:, 0], [1.0, 0.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(found[:3, 1:3], [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], atol=1e-13)  # ν = 1
