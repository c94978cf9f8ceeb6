"""Responses whose histories are known in closed form, and ratios of Bessel functions of high orders."""

import math

import numpy as np
import pytest

from dembound.exact import transform as module
from dembound.exact.transform import decaying_ratios, growing_ratios, respond

PERIOD, DELAY, RATE = 0.5, 0.2, 3.0


def pulse(t: np.ndarray) -> np.ndarray:
    return np.where(t < PERIOD, 0.5 * (1.0 - np.cos(2.0 * math.pi * t / PERIOD)), 0.0)


def decay(s: np.ndarray) -> list[np.ndarray]:
    """A delay, then u̇ + RATE·u = p; and twice as much of it."""
    one = np.exp(-s * DELAY) / (s + RATE)
    return [one, 2.0 * np.stack([one, s * one])]


def expected(times: np.ndarray) -> np.ndarray:
    """Convolution of the pulse with the decay, in closed form."""
    t = np.clip(times - DELAY, 0.0, PERIOD)
    w = 2.0 * math.pi / PERIOD
    during = (1.0 - np.exp(-RATE * t)) / RATE
    during -= (RATE * np.cos(w * t) + w * np.sin(w * t) - RATE * np.exp(-RATE * t)) / (RATE**2 + w**2)
    return 0.5 * during * np.exp(-RATE * np.maximum(times - DELAY - PERIOD, 0.0))


@pytest.mark.parametrize("window", [8.0, 16.0])
def test_response_is_the_convolution_for_any_window_and_before_t_0(window: float, monkeypatch) -> None:
    monkeypatch.setattr(module, "WINDOW", window)
    times = np.linspace(-0.3, 2.0, 97)
    single, double = respond(decay, pulse, times, 1e-8, [0.0, 0.0])
    # the window leaves 1e-8 of the largest response, times the growth e^(ct) = 10 at most
    np.testing.assert_allclose(single, expected(times), rtol=0.0, atol=1e-7 * expected(times).max())
    np.testing.assert_allclose(double[0], 2.0 * expected(times), rtol=0.0, atol=1e-7 * double[0].max())


def late(s: np.ndarray) -> list[np.ndarray]:
    """A delay alone."""
    return [np.exp(-s * DELAY)]


def test_a_velocity_that_jumps_does_not_converge() -> None:
    with pytest.raises(RuntimeError, match="does not converge to 1e-06"):
        respond(late, lambda t: 1.0 * (t < 0.1), np.linspace(0.0, 1.0, 500), 1e-6, [0.0], most=2**14)


def test_orders_of_thousands_obey_the_wronskian() -> None:
    """Orders above those of cavities, whose motion other tests check."""
    # I_n K_(n+1) + I_(n+1) K_n = 1/z, so (K_(n+1)/K_n + I_(n+1)/I_n) falls with I_n K_n → 1/2n
    z, orders = np.array([0.2 + 3.0j, 0.2 + 1500.0j]), 4000
    product = 1.0 / (z * (decaying_ratios(z, orders) + growing_ratios(z, orders)))
    assert np.isfinite(product).all()
    # Debye's expansion: I_n K_n = 1/(2√(n² + z²)) (1 + O(1/n²))
    np.testing.assert_allclose(product[-1], 0.5 / np.sqrt((orders - 1) ** 2 + z**2), rtol=1e-6)
