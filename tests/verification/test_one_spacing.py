"""Peridynamics with a horizon of one spacing is the central difference scheme, but for its soft ends."""

import numpy as np
import pytest

from dembound.motion.simulation import Simulation

CELLS, STEPS = 300, 100
TOLERANCE = 4.0 * np.finfo(float).eps * STEPS**2
"""Each step rounds the displacements, below 1, and velocities of either bar by a few ε; those add up to STEPS²/2."""


@pytest.fixture
def motion(lab):
    """Moves a bar from a random shape; returns its displacements (n,)."""

    def move(method: dict) -> np.ndarray:
        scene = lab.bar(CELLS, method)
        simulation = Simulation(scene, 0.5 * lab.diameter / lab.speed)
        simulation.state.u[0, simulation.state.layout.slot] = (
            np.random.default_rng(0).uniform(-1.0, 1.0, scene.count) / 4.0
        )
        simulation.advance(STEPS)
        return simulation.state.displacement[0]

    return move


def test_with_corrected_ends_they_are_the_same(motion):
    central = motion({"type": "finite_difference"})
    peridynamic = motion({"type": "peridynamics", "horizon": 1, "corrected_ends": True})
    np.testing.assert_allclose(peridynamic, central, rtol=0, atol=TOLERANCE)


def test_soft_ends_are_only_heard_as_far_as_one_node_a_step(motion):
    central = motion({"type": "finite_difference"})
    peridynamic = motion({"type": "peridynamics", "horizon": 1})
    inside = slice(STEPS, CELLS + 1 - STEPS)
    np.testing.assert_allclose(peridynamic[inside], central[inside], rtol=0, atol=TOLERANCE)
    # half a volume at the end halves the last bond, which matters to a wave as short as this
    assert np.abs(peridynamic - central)[[0, -1]].min() > 1e-3
