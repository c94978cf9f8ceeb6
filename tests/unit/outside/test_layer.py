"""Profiles of the absorbing layer, against the continuous equations they stand for."""

import numpy as np
import pytest

from dembound.outside.layer import Absorption, Profile

LAYER = Profile(thickness=30.0, speed=1000.0, inner=200.0)
Q = np.linspace(0.0, 1.0, 2001)


def mean(values: np.ndarray) -> float:
    """Mean of a profile over the depth."""
    return float(np.trapezoid(values, Q))


def test_the_strength_belongs_to_the_reflection() -> None:
    # a wave decays by exp(−∫σ dx/c) on its way in, and again on its way out
    assert np.exp(-2.0 * LAYER.thickness * mean(LAYER.damping(Q)) / LAYER.speed) == pytest.approx(1e-4, rel=1e-4)
    assert LAYER.strongest == pytest.approx(3.0 * 1000.0 * np.log(1e4) / 60.0)


def test_the_shift_is_that_of_what_lies_inside() -> None:
    np.testing.assert_allclose(LAYER.shift(np.array([0.0, 0.5, 1.0])), [0.75, 0.375, 0.0])


@pytest.mark.parametrize("q", [0.0, 0.3, 1.0])
def test_the_memory_follows_its_equation(q: float) -> None:
    """ψ′ = −(σ + α)ψ − σ g for κ = 1; for a constant g the recursion is exact."""
    step, depth = 1e-3, np.array([q])
    sigma, alpha = LAYER.damping(depth)[0], LAYER.shift(depth)[0]
    decay, gain = LAYER.decay(depth, step)[0], LAYER.gain(depth, step)[0]
    memory = 0.0
    for _ in range(50):
        memory = decay * memory + gain
    exact = -sigma / (sigma + alpha) * (1.0 - np.exp(-(sigma + alpha) * 50 * step))

    assert memory == pytest.approx(exact, rel=1e-12, abs=1e-300)


def test_nothing_is_remembered_where_neither_acts() -> None:
    bare = Profile(30.0, 1000.0, 200.0, Absorption(shift=0.0))

    assert bare.gain(np.zeros(1), 1e-3).tolist() == [0.0]
    assert bare.decay(np.zeros(1), 1e-3).tolist() == [1.0]


def test_the_delay_is_a_part_of_the_step() -> None:
    np.testing.assert_allclose(LAYER.delay(np.array([0.0, 0.5, 1.0]), 2e-3), [0.0, 0.5e-4, 2e-4])


def test_the_expected_reflection() -> None:
    high, low = LAYER.expected_reflection(1e4), LAYER.expected_reflection(0.05)
    assert high == pytest.approx(1e-4, rel=1e-3)
    passed = (2 * np.pi * 0.05) ** 2 / ((2 * np.pi * 0.05) ** 2 + LAYER.shift(Q) ** 2)
    share = mean(LAYER.damping(Q) * passed) / mean(LAYER.damping(Q))
    assert low == pytest.approx(1e-4**share, rel=1e-3)
    # S waves of half the speed take twice as long; at 60° the path along the normal counts half
    assert LAYER.expected_reflection(1e4, speed=500.0) == pytest.approx(1e-8, rel=1e-3)
    assert LAYER.expected_reflection(1e4, angle=60.0) == pytest.approx(1e-2, rel=1e-3)
