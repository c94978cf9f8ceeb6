"""Ratios of orders where the functions themselves over- and underflow."""

import numpy as np

from dembound.exact.transform import decaying_ratios, growing_ratios


def test_orders_of_thousands_obey_the_wronskian() -> None:
    """Orders above those of cavities, whose motion other tests check."""
    # I_n K_(n+1) + I_(n+1) K_n = 1/z, so (K_(n+1)/K_n + I_(n+1)/I_n) falls with I_n K_n → 1/2n
    z, orders = np.array([0.2 + 3.0j, 0.2 + 1500.0j]), 4000
    product = 1.0 / (z * (decaying_ratios(z, orders) + growing_ratios(z, orders)))
    assert np.isfinite(product).all()
    # Debye's expansion: I_n K_n = 1/(2√(n² + z²)) (1 + O(1/n²))
    np.testing.assert_allclose(product[-1], 0.5 / np.sqrt((orders - 1) ** 2 + z**2), rtol=1e-6)
