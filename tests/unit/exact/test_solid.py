"""Moduli of an isotropic solid."""

import math

import pytest

from dembound.exact import Solid


def test_moduli_follow_from_the_speeds() -> None:
    solid = Solid(2500.0, 1000.0, 1000.0 / math.sqrt(3.0))
    assert solid.uniaxial == pytest.approx(2.5e9)
    assert solid.shear == pytest.approx(2.5e9 / 3.0)
    assert solid.lame == pytest.approx(solid.shear)  # ν = 1/4


@pytest.mark.parametrize("speeds", [(1000.0, 0.0), (1000.0, 1000.0), (-1.0, 0.5)])
def test_what_is_no_solid_is_refused(speeds: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match="speeds must be"):
        Solid(2500.0, *speeds)
    with pytest.raises(ValueError, match="density"):
        Solid(0.0, 1000.0, 500.0)
