"""The motion of layered ground beside that of uniform ground, and by the places of ties."""

import numpy as np
from ground_motions import GENERAL

from dembound.continuum.medium import Medium, incident_wave, reflected_waves
from dembound.disks.surroundings.ground_waves import GroundWaves
from dembound.disks.surroundings.incident import power_through
from dembound.disks.surroundings.layered_waves import LayeredWaves, rising_in_layers
from dembound.waves import Ricker

PULSE = Ricker(type="ricker", amplitude=1.0, frequency=20.0, start=0.02)
TIMES = np.array([0.05, 0.081, 0.11, 0.13])
SURFACE, MASS, GRAIN = 30.0, 30.0, 0.1
SOFT = Medium.isotropic(1800.0, 500.0, 250.0)


def layered(media: list[Medium], joints: list[float], mass: float = MASS) -> LayeredWaves:
    """Ground whose incident wave moves along x and, less, along y at the height 0."""
    half = PULSE.model_copy(update={"amplitude": 0.5})
    return rising_in_layers(media, joints, (SURFACE, mass), (PULSE, half), 0.0, (0.0, 0.15), GRAIN)


def test_equal_layers_move_as_uniform_ground() -> None:
    """Of any symmetry, with a mass on its surface and with correctors, and with the same power from below."""
    waves, signals = [], []
    for kind in ("sv", "p"):
        incident = incident_wave(GENERAL, kind, 0.0)
        part = incident.motion[0] + 0.5 * incident.motion[1]
        signal = PULSE.model_copy(update={"amplitude": part})
        own = [incident, *reflected_waves(GENERAL, incident, SURFACE, MASS)]
        waves, signals = waves + own, signals + [signal] * len(own)
    uniform = GroundWaves(GENERAL, tuple(waves), tuple(signals), GRAIN)
    equal = layered([GENERAL] * 3, [20.0, 8.0])
    rng = np.random.default_rng(1)
    places, corrector = rng.uniform(0.0, 30.0, (20, 2)), 0.1 * rng.normal(size=(3, 4, 20))
    for of in ("displacement", "velocity"):
        expected = uniform.motion(of, TIMES, places, corrector)
        found = equal.motion(of, TIMES, places, corrector)
        np.testing.assert_allclose(found, expected, atol=2e-5 * np.abs(expected).max())
    edges, times = (0.0, 10.0, 2.0, 29.0), np.linspace(0.0, 0.15, 50)
    expected = power_through("bottom", edges, uniform)(times)
    np.testing.assert_allclose(power_through("bottom", edges, equal)(times), expected, atol=1e-4 * expected.max())
    assert not power_through("left", edges, equal)(times).any()


def test_ground_without_a_surface_sends_nothing_back() -> None:
    """Above the uppermost joint; below it runs what the joint reflects, (Z₁ − Z₂)/(Z₁ + Z₂) of the wave."""
    stiff = Medium.isotropic(2300.0, 1000.0, 500.0)
    waves = rising_in_layers([SOFT, stiff], [5.0], None, (PULSE, None), 0.0, (0.0, 0.2), GRAIN)
    times, (below, above) = np.linspace(0.0, 0.2, 40), (2300.0 * 500.0, 1800.0 * 250.0)
    up, down = 5.0 / 500.0 + 2.0 / 250.0, 5.0 / 500.0 + 4.0 / 500.0
    expected = np.stack(
        [
            2.0 * below / (below + above) * PULSE.velocity(times - up),
            PULSE.velocity(times - 1.0 / 500.0) + (below - above) / (below + above) * PULSE.velocity(times - down),
        ],
        axis=1,
    )
    found = waves.motion("velocity", times, np.array([(0.0, 7.0), (0.0, 1.0)]))[:, :, 0]
    np.testing.assert_allclose(found, expected, atol=1e-5)
