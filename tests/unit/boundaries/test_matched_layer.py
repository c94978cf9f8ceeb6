"""The profile of a matched layer, and its table."""

import numpy as np
import pytest
from pydantic import ValidationError

from dembound.boundaries import MatchedLayer
from dembound.boundaries.boundary import Layer
from dembound.boundaries.matched_layer import usual_reflection


def test_a_wave_decays_by_the_root_of_r0_by_rates_that_are_a_power_of_the_depth() -> None:
    """exp(−∫d dx/c) over the length, by the trapezoidal rule: to the 1e-7 of 10,000 intervals."""
    layer, spacing, speed = Layer(nodes=25, power=3.0, reflection=1e-5), 0.02, 3000.0
    depth = np.linspace(0.0, 25.0, 10_001)
    decay = np.exp(-np.trapezoid(layer.rates(depth, spacing, speed), depth * spacing) / speed)
    assert decay == pytest.approx(np.sqrt(1e-5), rel=1e-6)
    rates = Layer(nodes=10, power=2.0, reflection=0.01).rates(np.array([-3.0, 0.0, 5.0, 10.0]), 0.5, 100.0)
    largest = 3.0 * 100.0 * np.log(100.0) / (2.0 * 5.0)
    np.testing.assert_allclose(rates, [0.0, 0.0, 0.25 * largest, largest], rtol=1e-14)


@pytest.mark.parametrize(("nodes", "reflection"), [(20, 1e-5), (80, 1e-8), (5000, 1e-12)])
def test_usual_reflections(nodes: int, reflection: float) -> None:
    assert usual_reflection(nodes) == pytest.approx(reflection, rel=1e-12)
    assert MatchedLayer(type="matched_layer", nodes=nodes).layer.reflection == usual_reflection(nodes)
    assert MatchedLayer(type="matched_layer", reflection=1e-3).layer == Layer(40, 3.0, 1e-3)
    for keys in ({"nodes": 3}, {"reflection": 1.0}, {"nodes": 20_000}):
        with pytest.raises(ValidationError):
            MatchedLayer(type="matched_layer", **keys)
