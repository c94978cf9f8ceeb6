"""What breaks off a stressed body flies on without the force that balanced its stress."""

import numpy as np
import pytest

from dembound.simulate import Simulation
from dembound.stability import choose_step
from dembound.static import settle

SPEED = 100.0
"""m/s with which the corner is torn off."""


@pytest.mark.parametrize("geometry", ["updated", "reference"])
@pytest.mark.parametrize("stress", [-5e6, 0.3e6])
def test_a_corner_torn_off_gains_no_speed(lab, stress, geometry):
    """Known failure: forces that go on tear at disks of 0.5 m with 800 m/s² per MPa."""
    material = {"law": "linearpbond", "fric": 0.5, "pb_ten": 2e6, "pb_coh": 3e6, "geometry": geometry}
    scene = lab.scene("B", (10.0, 10.0), held=(), material=material, static={"stress": (stress, stress, 0.0)})
    simulation = Simulation(scene, choose_step(scene)[0], np.zeros(0), start=settle(scene).start)
    corner = np.hypot(*(scene.positions - [10.0, 10.0]).T) < 1.5
    simulation.velocity[:2, corner] = SPEED / np.sqrt(2.0)
    simulation.advance(200)
    assert simulation.balance is not None
    assert not simulation.balance.force[:, corner].any()
    # nothing but what touches it pushes it from here on
    assert not simulation._steady[:, corner].any()
    simulation.advance(600)
    assert np.hypot(*simulation.velocity[:2, corner]).max() < 1.1 * SPEED
    # on the rest the forces act on
    assert simulation.balance.force[:, ~corner].any()
