"""Modified Bessel functions of all orders n = 0 … N−1, as ratios of neighbouring orders, which never overflow.

K_{n+1}(z)/K_n(z) is computed upwards and I_{n+1}(z)/I_n(z) downwards, the directions in which the recurrences
K_{n+1} = K_{n−1} + (2n/z) K_n and I_{n−1} = I_{n+1} + (2n/z) I_n are stable (Abramowitz & Stegun 9.6.26). Re z > 0.
"""

import numpy as np

EXTRA = 30
"""Orders above the last one at which the recurrence downwards begins; each multiplies its error by (z/2n)² or less."""


def decaying_ratios(z: np.ndarray, orders: int) -> np.ndarray:
    """K_{n+1}(z)/K_n(z) (orders, m) at z (m,)."""
    from scipy.special import kve

    ratios = np.empty((orders, len(z)), dtype=complex)
    ratios[0] = kve(1, z) / kve(0, z)
    for n in range(1, orders):
        ratios[n] = 1.0 / ratios[n - 1] + 2.0 * n / z
    return ratios


def growing_ratios(z: np.ndarray, orders: int) -> np.ndarray:
    """I_{n+1}(z)/I_n(z) (orders, m) at z (m,); the orders must reach beyond |z|."""
    ratios = np.empty((orders, len(z)), dtype=complex)
    ratio = np.zeros_like(z)
    for n in range(orders + EXTRA, 0, -1):
        ratio = 1.0 / (2.0 * n / z + ratio)
        if n <= orders:
            ratios[n - 1] = ratio
    return ratios


def from_ratios(first: np.ndarray, ratios: np.ndarray) -> np.ndarray:
    """Functions (orders, m) of all orders from the function of order 0, (m,), and the ratios (orders, m)."""
    return np.cumprod(np.concatenate([first[None], ratios[:-1]]), axis=0)
