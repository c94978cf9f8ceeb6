"""Mechanisms fitted to a constant Q, and the memories that follow from them."""

import numpy as np
import pytest

from dembound.damping import fitted

BAND, MIDDLE = (0.3, 10.0), 3.0**0.5


@pytest.mark.parametrize("quality", [5.0, 100.0])
@pytest.mark.parametrize(("count", "error"), [(2, 0.08), (3, 0.01), (4, 0.002)])
def test_q_is_nearly_constant_over_the_band(quality: float, count: int, error: float) -> None:
    found = fitted(quality, BAND, MIDDLE, count)

    assert abs(quality / found.quality(np.geomspace(*BAND, 500)) - 1.0).max() < error
    assert found.range[0] < quality < found.range[1]


@pytest.mark.parametrize("frequency", [0.3, MIDDLE, 10.0])
def test_the_speed_holds_at_its_frequency(frequency: float) -> None:
    """C = 1/Re √(ρ/M), so M/M₀ there has Re (M/M₀)^(−1/2) = 1; beyond all mechanisms M is M_U."""
    found = fitted(20.0, BAND, frequency, 3)

    assert np.real(found.relative_modulus(frequency) ** -0.5) == pytest.approx(1.0, rel=1e-12)
    assert abs(found.relative_modulus(1e9)) == pytest.approx(found.unrelaxed, rel=1e-7)


def test_memories_respond_as_the_modulus() -> None:
    """To e^{iωnΔt} they answer Σ g(1 + z)/(1 − e z), z = e^{−iωΔt}, which is Σ w/(1 + iωτ) to second order in Δt/τ."""
    found = fitted(20.0, BAND, MIDDLE, 3)
    frequency = np.geomspace(0.1, 20.0, 30)
    exact = 1.0 - found.relative_modulus(frequency) / found.unrelaxed
    errors = []
    for step in (2e-4, 1e-4):
        (e, g), z = found.per_step(step), np.exp(-2j * np.pi * frequency * step)[:, None]
        errors.append(abs((g * (1.0 + z) / (1.0 - e * z)).sum(axis=1) - exact).max())

    assert errors[1] == pytest.approx(errors[0] / 4.0, rel=0.05)
    assert errors[1] < 1e-6
