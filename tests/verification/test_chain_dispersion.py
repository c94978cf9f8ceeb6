"""A row of equal disks is the textbook chain, and leapfrog steps through it exactly."""

import numpy as np
import pytest

from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

DISKS, STEPS = 40, 1000


@pytest.mark.parametrize("waves_per_row", [1, 13, 20])
def test_travelling_wave_keeps_its_frequency(lab, waves_per_row):
    """sin(ωΔt/2) = Δt √(k/m) sin(qa/2): the space and time discretisation solved together."""
    boundary = {"left": "periodic", "right": "periodic"}
    scene = lab.scene("A", (DISKS * lab.diameter, lab.diameter), boundary=boundary)
    step = choose_step(scene)[0]
    # one contact per row carries E = ρc² (Z eq. 11), a disk has ρD²: √(k/m) = c/D
    per_disk = 2.0 * np.pi * waves_per_row / DISKS
    advance = 2.0 * np.arcsin(step * lab.speed / lab.diameter * np.sin(0.5 * per_disk))

    def displacement(steps: float) -> np.ndarray:
        return np.cos(per_disk * np.arange(DISKS) - advance * steps)

    simulation = Simulation(scene, step)
    order = lab.row(scene)
    simulation.state.u[0, simulation.state.layout.slot[order]] = displacement(0)
    simulation.state.v[0, simulation.state.layout.slot[order]] = (displacement(0) - displacement(-1)) / step
    simulation.advance(STEPS)

    # each step rounds u by ε and Δt·v by a few ε; a velocity error made at step k moves the disk for all steps
    # left, so the worst sum is 4ε·STEPS²/2
    tolerance = 2.0 * np.finfo(float).eps * STEPS**2
    np.testing.assert_allclose(simulation.state.displacement[0, order], displacement(STEPS), rtol=0, atol=tolerance)
    assert not simulation.state.displacement[1:].any()
