"""A free body keeps energy and momentum.

The energy of central differences at a half step is ½m v² + ½uⁿ·K uⁿ⁺¹, v between uⁿ and uⁿ⁺¹. It equals ½m v⁻·v⁺ +
½uⁿ·K uⁿ.
"""

import numpy as np
import pytest

from dembound.disks.stability import step_limit
from dembound.motion.simulation import Simulation

STEPS = 1000
EPS = np.finfo(float).eps


@pytest.mark.parametrize("pattern", ["A", "B"])
def test_free_body_keeps_energy_and_momentum(lab, pattern):
    """From random motion without strain."""
    scene = lab.scene(pattern, (10.0, 10.0), held=())
    simulation, inertia = Simulation(scene, 0.9 * step_limit(scene)), lab.inertia(scene)
    simulation.state.velocity = np.random.default_rng(0).uniform(-1.0, 1.0, (3, scene.count))
    x, y = scene.assembly.positions.T

    def momentum() -> np.ndarray:
        """Terms (3, k) of the momenta along x, y and about the origin."""
        p = inertia * simulation.state.velocity
        zero = np.zeros_like(x)
        return np.stack([[p[0], zero, zero], [p[1], zero, zero], [x * p[1], -y * p[0], p[2]]]).reshape(3, -1)

    start, energy = momentum(), np.empty(STEPS)
    for k in range(STEPS):
        force = lab.forces(scene, simulation.state.displacement)
        simulation.advance(1)
        kinetic = 0.5 * np.sum(inertia * simulation.state.velocity**2)
        energy[k] = kinetic - 0.5 * np.sum(force * simulation.state.displacement)
    # each step rounds by a few ε, in the worst case all to one side: 4ε·STEPS = 9e-13
    tolerance = 4.0 * EPS * STEPS
    np.testing.assert_allclose(energy, energy[0], rtol=tolerance)
    assert np.all(np.abs(momentum().sum(axis=1) - start.sum(axis=1)) < tolerance * np.abs(start).sum(axis=1))
