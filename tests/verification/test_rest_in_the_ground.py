"""A box of disks in the ground settles under gravity, with a load on the continuum beside it, and remains at rest."""

import numpy as np
import pytest

from dembound.disks.kind import Disks
from dembound.kinds import with_changes
from dembound.motion.simulation import Simulation

PULSE = {"type": "cosine", "amplitude": 1.0, "period": 0.1}
SIDES = dict.fromkeys(("left", "right", "bottom"), "outside")
HOUSE = {"name": "house", "force": [2e4, -2e5], "region": [25.0, 23.0, 31.0, 24.0]}


@pytest.mark.parametrize("house", [False, True])
def test_it_does_not_move(lab, house: bool) -> None:
    """What the static stage leaves, some 1e-4 of the forces, is balanced: only rounding errors of forces move disks.

    Weights of 2.5e4 N with 1e-16 of forces of 1e6 N on a disk of 2500 kg make 1e-16 m/s in a step of 3e-4 s, and
    sums of some hundred of them 1e-12 m/s at most.
    """
    load = [{"name": "gravity", "acceleration": [0.0, -9.81]}, *([HOUSE] if house else [])]
    static = {"ratio": 1e-4, "boundary": {"bottom": {"type": "fixed"}}}
    case = lab.case("A", (12.0, 12.0), radius=0.5, held=(), material={"fric": 0.5}, boundary=SIDES, wave=PULSE)
    ground = {"ground.size": [40.0, 24.0], "packing.origin": [12.0, 12.0], "outside.element": 5.0, "outside.margin": 2}
    scene = Disks().build(with_changes(case, ground | {"load": load, "static": static}))
    step = Disks().choose_step(scene)[0]
    beginning = Disks().begin(scene, step, lambda *_: None)
    simulation = Simulation(scene, step, system=beginning.system, datum=beginning.datum)
    simulation.run(500)

    assert np.abs(beginning.datum).max() > 1e-4
    assert np.abs(scene.steady_load[:, scene.disk_count :]).any() == house
    assert np.abs(simulation.state.velocity).max() < 1e-12
