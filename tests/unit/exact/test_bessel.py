"""Ratios of orders beside scipy's functions, and where these over- and underflow."""

import numpy as np
from scipy.special import ive, kve

from dembound.exact.bessel import decaying_ratios, growing_ratios

Z = np.array([0.01, 0.3 + 2.0j, 0.05 + 25.0j, 1.0 + 60.0j])
ORDERS = 90


def test_ratios_are_those_of_scipys_functions() -> None:
    n = np.arange(ORDERS)[:, None]
    for ratios, function in ((decaying_ratios, kve), (growing_ratios, ive)):
        with np.errstate(all="ignore"):
            expected = function(n + 1, Z) / function(n, Z)
        within = np.isfinite(expected) & (expected != 0.0)
        assert within[:, 1:].mean() > 0.9
        # scipy's own error is some 1e-13 here, near zeros of I_n more
        np.testing.assert_allclose(ratios(Z, ORDERS)[within], expected[within], rtol=1e-10)


def test_orders_of_thousands_obey_the_wronskian() -> None:
    # I_n K_(n+1) + I_(n+1) K_n = 1/z, so (K_(n+1)/K_n + I_(n+1)/I_n) falls with I_n K_n → 1/2n
    z, orders = np.array([0.2 + 3.0j, 0.2 + 1500.0j]), 4000
    product = 1.0 / (z * (decaying_ratios(z, orders) + growing_ratios(z, orders)))
    assert np.isfinite(product).all()
    # Debye's expansion: I_n K_n = 1/(2√(n² + z²)) (1 + O(1/n²))
    np.testing.assert_allclose(product[-1], 0.5 / np.sqrt((orders - 1) ** 2 + z**2), rtol=1e-6)
