"""Reflection of plane waves along the normal of a side."""

import math

import pytest
from small_cases import PUSHED, small

from dembound.disks.scene import build
from dembound.formulas.disks.reflections import Reflected, Reflections, factor_for

STEP = 1e-4


def shares(side="right", **keys):
    boundary = {
        "left": {"type": "velocity", "wave_p": "push"},
        **{name: {"type": "periodic"} for name in ("bottom", "top")},
        side: {"type": "viscous", **keys},
    }
    wave = {"push": {"type": "cosine", "amplitude": 0.5, "period": 0.04}}
    return Reflections().of(build(small(PUSHED | {"boundary": boundary, "wave": wave})), side, STEP)


def test_each_motion_has_its_own_factor_and_sign():
    found = shares(beta_p=0.5, beta_s=1.5, half_mass=True)
    assert found["p"].dashpots == pytest.approx(0.5 / 1.5, rel=1e-3)
    assert found["s"].dashpots == pytest.approx(-0.5 / 2.5, rel=1e-3)
    # waves have some 60 disks, of which half cells reflect tan²(qD/4) < 1e-3 more
    assert found["p"].signed == pytest.approx(1.0 / 3.0, abs=3e-3)
    assert found["s"].signed == pytest.approx(-0.2, abs=3e-3)


def test_whole_cells_reflect_out_of_phase():
    whole, half = (shares(half_mass=half)["p"] for half in (False, True))
    # tan(qD/4) of waves of 0.5 m × 1000 m/s × 0.04 s: with q = 2πf/c for the RMS of f, some 15 Hz
    assert whole.out_of_phase == pytest.approx(math.tan(2.0 * math.pi * 15.0 / 1000.0 * 0.5 / 4.0), rel=0.3)
    assert whole.out_of_phase > 20.0 * half.out_of_phase
    assert whole.dashpots == pytest.approx(0.0, abs=1e-6)
    share = Reflected(0.5, -0.3)  # parts in and out of phase make the size
    assert (share.signed, share.out_of_phase) == (-0.5, pytest.approx(0.4))
    assert Reflected(0.1, 0.3).out_of_phase == 0.0
    for reflection in (-0.4, 0.0, 0.3):
        factor = factor_for(reflection)
        assert (1.0 - factor) / (1.0 + factor) == pytest.approx(reflection)
