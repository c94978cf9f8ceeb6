"""Motions of ground under plane waves, for tests of several modules."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from dembound.continuum.medium import Medium, incident_wave, reflected_waves
from dembound.disks.surroundings.ground_waves import GroundWaves

GENERAL = Medium(2500.0, c11=2.5e9, c22=2.2e9, c12=0.4e9, c66=0.9e9, c16=0.2e9, c26=0.3e9)
RAMP = SimpleNamespace(velocity=lambda t: np.ones_like(t), displacement=lambda t: np.array(t))
"""A constant velocity of 1 m/s: uniform gradients."""


def sine(frequency: float) -> SimpleNamespace:
    """A wave sin(ωt) m/s."""
    omega = 2.0 * np.pi * frequency
    return SimpleNamespace(velocity=lambda t: np.sin(omega * t), displacement=lambda t: -np.cos(omega * t) / omega)


def ground(signal: Any, grain: float = 0.1, mass: float = 0.0) -> GroundWaves:
    incident = incident_wave(GENERAL, "sv", 25.0)
    waves = (incident, *reflected_waves(GENERAL, incident, 30.0, mass))
    return GroundWaves(GENERAL, waves, (signal,) * len(waves), grain)
