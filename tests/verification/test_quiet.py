"""No wave, no motion: supports and local damping start nothing, and what is to come does not show early."""

import numpy as np
import pytest

from dembound.simulate import Simulation
from dembound.stability import choose_step

STEPS = 1000


@pytest.mark.parametrize("pattern", ["A", "B", "C"])
@pytest.mark.parametrize("damp", [0.0, 0.7])
def test_nothing_moves_without_a_wave(lab, pattern, damp):
    boundary = {"left": "viscous", "right": "fixed", "bottom": "viscous"}
    scene = lab.scene(pattern, (20.0, 10.0), held=(), boundary=boundary, material={"damp": damp})
    simulation = Simulation(scene, choose_step(scene)[0], np.zeros(0))
    simulation.advance(STEPS)
    assert not simulation.velocity.any()
    assert not simulation.displacement.any()


@pytest.mark.parametrize("source", ["viscous_input", "velocity"])
def test_nothing_moves_before_the_wave_begins(lab, source):
    wave = lab.pulse(0.02) | {"start": 0.1}
    scene = lab.scene("B", (20.0, 10.0), boundary={"left": {"type": source, "wave_p": "pulse"}}, wave=wave)
    step = choose_step(scene)[0]
    simulation = Simulation(scene, step, np.zeros(0))
    simulation.advance(int(0.1 / step))
    assert not simulation.velocity.any()
    simulation.advance(10)
    assert simulation.velocity[:, scene.edges["left"].nodes].any()
