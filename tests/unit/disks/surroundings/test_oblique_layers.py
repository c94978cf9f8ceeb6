"""The motion of layers under a wave at an angle beside that of uniform ground, at joints, and by the places of ties."""

import numpy as np
import pytest
from ground_motions import GENERAL

from dembound.continuum.medium import Medium, incident_wave, reflected_waves
from dembound.disks.surroundings.ground_waves import GroundWaves
from dembound.disks.surroundings.incident import power_through
from dembound.disks.surroundings.oblique_layers import ObliqueLayers, oblique_in_layers
from dembound.waves import Ricker

PULSE = Ricker(type="ricker", amplitude=1.0, frequency=20.0, start=0.02)
TIMES = np.array([0.05, 0.081, 0.11, 0.13])
SURFACE, MASS, GRAIN = 30.0, 3.0, 0.1
SOFT = Medium.isotropic(1800.0, 500.0, 250.0)


def layers(media: list[Medium], joints: list[float], kind: str = "sv", angle: float = -25.0) -> ObliqueLayers:
    incident = incident_wave(media[-1], kind, angle).shifted(0.01)
    return oblique_in_layers(media, joints, (SURFACE, MASS), incident, PULSE, (0.0, 0.2), GRAIN)


@pytest.mark.parametrize("kind", ["sv", "p"])
def test_equal_layers_move_as_uniform_ground(kind: str) -> None:
    """Of any symmetry, with correctors, with the same first arrival, and with the same power through all sides."""
    incident = incident_wave(GENERAL, kind, -25.0).shifted(0.01)
    waves = (incident, *reflected_waves(GENERAL, incident, SURFACE, MASS))
    uniform = GroundWaves(GENERAL, waves, (PULSE,) * len(waves), GRAIN)
    equal = layers([GENERAL] * 3, [20.0, 8.0], kind)
    rng = np.random.default_rng(1)
    places, corrector = rng.uniform([-9.0, 0.0], 30.0, (20, 2)), 0.1 * rng.normal(size=(3, 4, 20))
    for of in ("displacement", "velocity"):
        expected = uniform.motion(of, TIMES, places, corrector)
        found = equal.motion(of, TIMES, places, corrector)
        np.testing.assert_allclose(found, expected, atol=1e-5 * np.abs(expected).max())
    edges, times = (0.0, 10.0, 15.0, 24.0), np.linspace(0.0, 0.2, 50)
    for side in ("left", "right", "bottom", "top"):
        expected = power_through(side, edges, uniform)(times)
        np.testing.assert_allclose(power_through(side, edges, equal)(times), expected, atol=1e-4 * expected.max())
    assert equal.arrives(places[places[:, 1] < 8.0]) == uniform.arrives(places[places[:, 1] < 8.0])
    assert equal.arrives(np.array([(1.0, 9.0)])) <= uniform.arrives(np.array([(1.0, 9.0)])) + 1e-12


def test_near_a_joint_each_layer_has_its_own_gradients() -> None:
    """Ties within 2 m on both sides of a joint: motion, strain and velocities half a step behind."""
    waves = layers([SOFT, GENERAL], [12.0])
    rng = np.random.default_rng(2)
    places, corrector = rng.uniform([0.0, 10.0], [2.0, 14.0], (20, 2)), rng.normal(size=(3, 4, 20))
    near = waves.near(places)
    exact = waves.motion("displacement", TIMES, places, corrector)
    found = np.einsum("tq,cdq->tdc", near.amplitudes(TIMES, 0.0), near.motion(places, corrector))
    np.testing.assert_allclose(found, exact, atol=2e-4 * np.abs(exact).max())
    exact = waves.motion("velocity", TIMES, places)
    behind = near.amplitudes(TIMES + 1e-3, 1e-3) @ near.velocities(1e-3).T
    found = np.einsum("tq,cdq->tdc", behind, near.motion(places, 0.0 * corrector))
    np.testing.assert_allclose(found, exact, atol=2e-4 * np.abs(exact).max())
