"""In a box of disks in the ground that neither open nor break, the history-dependent law moves like the elastic law."""

import numpy as np

from dembound.disks.scene import build
from dembound.motion.simulation import Simulation

STEP, STEPS = 1.5e-4, 1200
LASTING = {"law": "linearpbond", "elastic_start": False, "geometry": "reference", "pb_ten": 1e12, "pb_coh": 1e12}
BONDS = {"emod": 0.0, "pb_emod": 2.5e9}
"""Bonds alone, as contacts would open."""


def test_it_does(lab) -> None:
    """Forces are summed from increments, so that each of the 1,200 steps rounds by ε of the largest force."""
    found = []
    for law in ({}, LASTING):
        scene = build(lab.window("A", (20.0, 20.0, 40.0, 40.0), material=BONDS | law, hole=True))
        simulation = Simulation(scene, STEP)
        simulation.run(STEPS)
        found.append(simulation.state.velocity)
    assert simulation.system.uses_history
    assert np.abs(found[0]).max() > 0.1
    assert np.abs(found[1] - found[0]).max() < 1e-10 * np.abs(found[0]).max()
