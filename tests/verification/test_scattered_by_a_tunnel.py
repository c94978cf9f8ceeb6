"""A tunnel's wall moves under P and SV waves at an angle as that of the exact cavity, to first order in D/a."""

import pytest
import scattering


@pytest.mark.parametrize("kind", [pytest.param("p", marks=pytest.mark.slow), "sv"])
def test_the_wall_moves_along_itself_as_that_of_the_exact_cavity(kind: str) -> None:
    """Disks are removed whole, so the wall is off by at most D/2 of the radius, or (D/2)/a of it.

    What the cavity adds under slow waves grows with the square of the radius, so at one place it is off by twice that,
    D/a, and is less than the whole motion. The error halves with the diameter but for the chance of the steps. A wave
    with the opposite sign, from the other side, or with a factor of two, would be an error of some 100 %.
    """
    coarse, fine = (scattering.errors(kind, 30.0, diameter, places=24)[:2] / 100.0 for diameter in (1.0, 0.5))

    assert (coarse < 1.0 / scattering.RADIUS).all()
    assert (fine < 0.5 / scattering.RADIUS).all()
    assert (fine < 0.7 * coarse).all()
