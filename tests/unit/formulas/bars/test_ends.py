"""Reflection of harmonic waves by layers, from their equations."""

import numpy as np
import pytest

from dembound.bar.layers import EndLayer
from dembound.boundaries.boundary import Layer
from dembound.exact import Lattice
from dembound.formulas.bars.ends import returned

SPACING, SPEED, MASS = 0.01, 1000.0, 3.0


def layer_of(profile: Layer, drag_rate: float = 0.0, horizon: int = 1) -> EndLayer:
    inner = np.arange(horizon)
    stiffness = np.full(horizon, MASS * (SPEED / SPACING) ** 2)
    if horizon > 1:  # as that of peridynamics
        stiffness *= 2.0 / horizon**2 / np.arange(1, horizon + 1) * np.where(inner == horizon - 1, 0.5, 1.0)
    return EndLayer("right", profile, inner, stiffness, MASS, SPACING, SPEED, drag_rate)


@pytest.mark.parametrize(("reflection", "drag_rate"), [(0.1, 0.0), (1e-2, 50.0), (1e-3, 0.0)])
def test_a_long_layer_returns_r0(reflection, drag_rate):
    """It is the echo of its outer end, reduced by dashpots on the way.

    A free end of a whole node is half a spacing farther away, where the rate is the largest. The rest is of the order
    (kΔx)² = 0.004 and (dΔx/c)² = 0.002, and of the numerical dispersion on the way.
    """
    frequency, profile = SPEED / (100 * SPACING), Layer(300, 3.0, reflection)
    layer = layer_of(profile, drag_rate)
    farther = np.exp(-layer.node_rates[-1] * SPACING / SPEED)
    expected = reflection * farther * np.exp(-0.5 * drag_rate * 2.0 * 300.5 * SPACING / SPEED)
    assert returned(layer, frequency, 0.5 * SPACING / SPEED) == pytest.approx(expected, rel=0.01)


def test_what_no_bar_carries_is_nan():
    """No wave runs above ω = 2c/Δx, in peridynamics above the highest frequency of its lattice."""
    waves = np.linspace(1.0, np.pi / SPACING, 500)
    of_lattice = float(np.nanmax(Lattice(3, SPACING, 0.0, SPEED).frequency(waves))) / (2.0 * np.pi)
    step = 1e-4 * SPACING / SPEED
    for horizon, most in ((1, SPEED / (np.pi * SPACING)), (3, of_lattice)):
        layer = layer_of(Layer(40, 3.0, 1e-6), horizon=horizon)
        assert np.isnan(returned(layer, 1.05 * most, step))
        assert returned(layer, 0.9 * most, step) < 1e-3
        assert returned(layer, 0.5 * most, step) < 1e-4
    # nothing is said of very long bonds
    assert np.isnan(returned(layer_of(Layer(200, 3.0, 1e-6), horizon=31), 100.0, 1e-7))
