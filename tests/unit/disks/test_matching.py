"""Matching of dashpots to a packing."""

import numpy as np
import pytest

from dembound.disks.matching import homogenised_beta
from dembound.disks.material.packing_waves import slowest_speed
from dembound.disks.scene import build
from dembound.running import plan, warnings_before


def test_factors_are_those_of_speeds_that_are_not_the_lattices_own(bar) -> None:
    scene = build(bar({"motion.held": []}))

    # equal disks that touch, and the speed of the lattice; a solve with one unknown
    for side in ("left", "right"):
        assert [homogenised_beta(scene, side, motion) for motion in ("p", "s")] == pytest.approx([1.0, 1.0], rel=1e-12)
    moduli = {"density": 2500.0, "emod": 1.25e9, "pb_emod": 1.25e9, "s_wave_speed": 250.0}
    other = build(bar({"motion.held": [], "material": moduli}))

    # c_s = 500 m/s where the dashpots assume 250
    assert homogenised_beta(other, "right", "s") == pytest.approx(2.0, rel=1e-12)


@pytest.mark.parametrize("held", [["y", "rotation"], ["rotation"]])
def test_a_motion_that_nothing_resists_has_no_factor_and_no_speed(bar, held: list[str]) -> None:
    """Contacts without bonds and friction have no shear stiffness."""
    plain = {"density": 2500.0, "p_wave_speed": 1000.0, "contact_share": 1.0}
    case = bar({"material": plain, "motion.held": held, "boundary.right": {"type": "viscous"}, "monitor": []})
    planned = plan(case)
    scene = planned.scene

    # a row of springs, whose long waves have the lattice's speed; one unknown
    assert scene.ground.wave_speeds(0)[0] == pytest.approx(1000.0, rel=1e-12)
    assert np.isnan(scene.ground.wave_speeds(0)[1])
    assert slowest_speed(scene.ground) == pytest.approx(1000.0, rel=1e-12)
    assert np.isnan(homogenised_beta(scene, "right", "s"))
    assert not any("nan" in line or "inf" in line for line in warnings_before(planned))
