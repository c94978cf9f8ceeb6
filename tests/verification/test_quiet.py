"""No wave, no motion: supports and local damping start nothing, and what is to come does not show early."""

import pytest

from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

STEPS = 1000


@pytest.mark.parametrize("pattern", ["A", "B", "C"])
@pytest.mark.parametrize("damp", [0.0, 0.7])
def test_nothing_moves_without_a_wave(lab, pattern, damp):
    boundary = {"left": "viscous", "right": "fixed", "bottom": "viscous"}
    scene = lab.scene(pattern, (20.0, 10.0), held=(), boundary=boundary, material={"damp": damp})
    simulation = Simulation(scene, choose_step(scene)[0])
    simulation.advance(STEPS)
    assert not simulation.state.velocity.any()
    assert not simulation.state.displacement.any()


@pytest.mark.parametrize("source", ["viscous_input", "velocity"])
def test_nothing_moves_before_the_wave_begins(lab, source):
    wave = lab.pulse(0.02) | {"start": 0.1}
    scene = lab.scene("B", (20.0, 10.0), boundary={"left": {"type": source, "wave_p": "pulse"}}, wave=wave)
    step = choose_step(scene)[0]
    simulation = Simulation(scene, step)
    simulation.advance(int(0.1 / step))
    assert not simulation.state.velocity.any()
    simulation.advance(10)
    assert simulation.state.velocity[:, scene.edges["left"].nodes].any()
