"""An explosion below a free surface moves the surface as Garvin's exact solution says."""

import explosion
import numpy as np

RAYLEIGH = 0.874 * 1000.0 / np.sqrt(2.0)
"""m/s, of Rayleigh waves for ν = 0."""

LAG = np.sqrt(15.0) / 24.0
"""Lag of a wave with the motion x^3.5 e^(−x²) at x times the crest's wave number k, on a lattice of pitch D: it lags
by (xkD)²/24 · xkL, whose RMS over this spectrum is √15 (kD)² kL/24."""

RETURNED = np.sqrt(10.0) * (1.0 / 16.0 + 0.1 / 8.0)
"""Part of that wave returned by ties to a continuum, (kD)²(1/16 + 0.1/8), of a mean x⁴ of Γ(6)/2²Γ(4)."""

CONTINUUM = 1e-3
"""The accuracy for which elements and layers are chosen."""


def test_the_surface_moves_as_exactly() -> None:
    """Disks of 1 m, 21 to the shortest S wave, lag, Rayleigh waves most of all; disks of half the size a quarter of it.

    A moment that was wrong by a factor of two or c_p²/c_s², or a pair of forces without the other, would be an error of
    some 100 %, the width of the source left out 1 %.
    """
    coarse, fine = (
        explosion.beside_exact(explosion.lattice(diameter), 1.5 * diameter).errors() / 100.0 for diameter in (1.0, 0.5)
    )
    number = 2.0 * np.pi * explosion.FREQUENCY / RAYLEIGH
    allowed = number**2 * (LAG * number * np.array(explosion.AWAY) + RETURNED) + CONTINUUM

    assert (coarse < allowed).all()
    assert (fine < 0.25 * allowed + CONTINUUM).all()
    assert (fine < 0.4 * coarse).all()
