"""The books close: a free body keeps energy and momentum, dashpots only take.

The energy of central differences at a half step is ½m v² + ½uⁿ·K uⁿ⁺¹, v between uⁿ and uⁿ⁺¹. It equals ½m v⁻·v⁺ +
½uⁿ·K uⁿ, and a centred dashpot C on (v⁻ + v⁺)/2 = v̄ lowers it by Δt·C v̄² per step, exactly.
"""

import numpy as np
import pytest

from dembound.disks.stability import step_limit
from dembound.motion.simulation import Simulation

STEPS = 1000
EPS = np.finfo(float).eps
SIDES = ("left", "right", "bottom", "top")


def inertia(scene):
    return np.stack([scene.mass, scene.mass, scene.inertia])


def thrown(scene, share: float) -> Simulation:
    """The scene in random motion, without strain."""
    simulation = Simulation(scene, share * step_limit(scene))
    simulation.state.velocity = np.random.default_rng(0).uniform(-1.0, 1.0, (3, scene.count))
    return simulation


def energies(lab, simulation: Simulation, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Energy (J) after each step, and what the dashpots took (J) in each."""
    scene = simulation.scene
    dashpots = np.zeros((3, scene.count))
    dashpots[scene.supports.component, scene.supports.node] = scene.supports.damping
    energy, taken = np.empty(steps), np.empty(steps)
    for k in range(steps):
        before, force = simulation.state.velocity.copy(), lab.forces(scene, simulation.state.displacement)
        simulation.advance(1)
        kinetic = 0.5 * np.sum(inertia(scene) * simulation.state.velocity**2)
        energy[k] = kinetic - 0.5 * np.sum(force * simulation.state.displacement)
        mean = 0.5 * (before + simulation.state.velocity)
        taken[k] = simulation.time_step * np.sum(dashpots * mean**2)
    return energy, taken


@pytest.mark.parametrize("pattern", ["A", "B"])
def test_free_body_keeps_energy_and_momentum(lab, pattern):
    scene = lab.scene(pattern, (10.0, 10.0), held=())
    simulation = thrown(scene, share=0.9)
    x, y = scene.assembly.positions.T

    def momentum() -> np.ndarray:
        """Terms (3, k) of the momenta along x, y and about the origin."""
        p = inertia(scene) * simulation.state.velocity
        zero = np.zeros_like(p)
        return np.stack(
            [
                np.stack([p[0], zero[0], zero[0]]),
                np.stack([p[1], zero[0], zero[0]]),
                np.stack([x * p[1], -y * p[0], p[2]]),
            ]
        ).reshape(3, -1)

    start = momentum()
    energy, _ = energies(lab, simulation, STEPS)
    # each step rounds by a few ε, in the worst case all to one side: 4ε·STEPS = 9e-13
    tolerance = 4.0 * EPS * STEPS
    np.testing.assert_allclose(energy, energy[0], rtol=tolerance)
    assert np.all(np.abs(momentum().sum(axis=1) - start.sum(axis=1)) < tolerance * np.abs(start).sum(axis=1))


@pytest.mark.parametrize("beta", [0.8, 5.0])
def test_dashpots_take_what_is_missing(lab, beta):
    sides = {side: {"type": "viscous", "beta_p": beta, "beta_s": beta} for side in SIDES}
    simulation = thrown(lab.scene("B", (10.0, 10.0), held=(), boundary=sides), share=0.9)
    energy, taken = energies(lab, simulation, STEPS)
    assert np.all(taken > 0.0)
    np.testing.assert_allclose(np.diff(energy), -taken[1:], rtol=0, atol=4.0 * EPS * STEPS * energy[0])
    assert energy[-1] < 0.5 * energy[0]
