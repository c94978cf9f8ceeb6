"""Centred dashpots cost no stability, however stiff: the limit of the undamped body holds."""

import numpy as np
import pytest

from dembound.disks.stability import step_limit
from dembound.motion.simulation import Simulation
from dembound.motion.stability import TOLERANCE

SIDES = ("left", "right", "bottom", "top")


@pytest.mark.parametrize(("pattern", "beta"), [("A", 2.0), ("B", 2e4)])
def test_bounded_at_the_undamped_limit(lab, pattern, beta):
    """With the lagged velocity v⁻, β = 2 would allow but half of the step."""
    sides = {side: {"type": "viscous", "beta_p": beta, "beta_s": beta} for side in SIDES}
    scene = lab.scene(pattern, (10.0, 10.0), held=(), boundary=sides)
    free = lab.scene(pattern, (10.0, 10.0), held=())
    simulation = Simulation(scene, 0.999 * step_limit(free))
    simulation.state.velocity = np.random.default_rng(0).uniform(-1.0, 1.0, (3, scene.count))
    start = np.sum(lab.inertia(scene) * simulation.state.velocity**2)
    simulation.advance(2000)
    # as in test_stability_limit: ½mv²(1 − r²) is at most the energy, and dashpots only lower it
    share = 0.999 * (1.0 + TOLERANCE)
    assert np.sum(lab.inertia(scene) * simulation.state.velocity**2) < start / (1.0 - share**2)
