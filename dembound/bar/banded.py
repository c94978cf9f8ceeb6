"""The stability limit of a chain whose stiffness matrix has few bands."""

import numpy as np

ROUNDING = 1e-9
"""Share by which a step may exceed its limit, as rounding may shift the limit to either side of a round number."""

BISECTIONS = 60
"""Number of bisections of the bracket of the largest eigenvalue: more than the bits of a float."""


def largest_stable_step(bands: np.ndarray, mass: np.ndarray, held: np.ndarray) -> float:
    """Largest stable step 2/ω_max of central differences, s; infinite where nothing vibrates.

    bands (b, n) N/m: the stiffness matrix, row d contains the entries K[i + d, i]; mass (n,) kg; held (h,) nodes that
    cannot move. ω_max² is the largest eigenvalue of M⁻¹K, the least λ for which λM − K has a Cholesky factor; it is
    found to the last bits by bisection.
    """
    scaled = _by_mass(bands, mass, held)
    low, high = 0.0, _row_sums(scaled)
    if high == 0.0:
        return np.inf
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        low, high = (low, middle) if _is_above(scaled, middle) else (middle, high)
    return float(2.0 / np.sqrt(high))


def is_stable(step: float, bands: np.ndarray, mass: np.ndarray, held: np.ndarray) -> bool:
    """Whether central differences are stable with a time step (s).

    Bands, mass and held nodes as in `largest_stable_step`.
    """
    return _is_above(_by_mass(bands, mass, held), 4.0 / step**2)


def _by_mass(bands: np.ndarray, mass: np.ndarray, held: np.ndarray) -> np.ndarray:
    """Bands of M^(-1/2) K M^(-1/2) (1/s²), without the nodes that are held."""
    root = 1.0 / np.sqrt(mass)
    root[held] = 0.0
    scaled = bands * root
    for d, band in enumerate(scaled):
        band[: len(root) - d] *= root[d:]
        band[len(root) - d :] = 0.0
    return scaled


def _row_sums(bands: np.ndarray) -> float:
    """Largest sum of |entries| in a row of a symmetric banded matrix: no eigenvalue is larger (Gershgorin)."""
    sums = np.abs(bands[0])
    for d, band in enumerate(np.abs(bands[1:]), start=1):
        sums = sums + band
        sums[d:] += band[:-d]
    return float(sums.max())


def _is_above(bands: np.ndarray, value: float) -> bool:
    """Whether a value lies above all eigenvalues of a symmetric banded matrix."""
    from scipy.linalg import LinAlgError, cholesky_banded

    shifted = -bands
    shifted[0] += value
    try:
        cholesky_banded(shifted, lower=True, overwrite_ab=True, check_finite=False)
    except LinAlgError:
        return False
    return True
