"""The stress of ground at rest by height."""

import numpy as np

from dembound.disks.material.at_rest import StressAtRest


def test_a_plane_between_layers_is_the_upper_ones_whatever_rounding() -> None:
    """0.3 and 0.1 + 0.2 differ by rounding; K₀ jumps there, so that half the contacts of a row would have another."""
    layers = StressAtRest(
        uniform=np.zeros(3), tops=np.array([0.9, 0.3]), growth=np.array([-2e4, -2e4]), k0=np.array([0.5, 1.0]), low=0.0
    )
    heights = np.array([0.3, 0.1 + 0.2, 0.3 - 1e-16, 0.3 - 1e-6, 0.3 + 1e-6])

    assert layers.layer_of(heights).tolist() == [0, 0, 0, 1, 0]
    np.testing.assert_allclose(layers.at(heights[:3])[0], 0.5 * -2e4 * 0.6, rtol=1e-14)
    np.testing.assert_allclose(layers.at(np.array([0.0, 0.1]))[:2], -2e4 * np.array([[0.9, 0.8]] * 2), rtol=1e-14)
    assert layers.layer_of(np.array([0.9, 1.0])).tolist() == [0, 0]  # the surface, and above it
