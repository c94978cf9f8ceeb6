"""Claim: in a plane P wave the stress of every particle is −ρc times its velocity."""

import numpy as np
import pytest

from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

PERIOD, HEIGHT = 0.04, 0.5
ENDS = {"left": {"type": "viscous_input", "wave_p": "pulse"}, "right": "viscous"}


@pytest.mark.parametrize("law", ["elastic", "linearpbond"])
def test_stress_is_minus_impedance_times_velocity(lab, law: str) -> None:
    memory = {} if law == "elastic" else {"law": law, "elastic_start": False}
    scene = lab.scene("A", (100.0, 1.0), material=memory, boundary=ENDS, wave=lab.pulse(PERIOD))
    step, _ = choose_step(scene)
    simulation = Simulation(scene, step)
    simulation.advance(round(0.07 / step))  # the pulse is 40 m long and its middle stands at 50 m
    before = simulation.state.velocity[0].copy()
    stress = simulation.system.stress(simulation.state.displacement)
    simulation.advance(1)
    if law == "linearpbond":  # which knows the forces at the beginning of a step once it is done
        stress = simulation.system.stress(simulation.state.displacement)
    velocity = 0.5 * (before + simulation.state.velocity[0])

    # of a harmonic wave σ/v = −ρc cos(qa/2)/√(1 − ν² sin²(qa/2)), ν = cΔt/a, or −ρc (1 − (qa)² (1 − ν²)/8): what is
    # wrong is a²(1 − ν²)/8 times ∂²v/∂x², at most M/2 (2π/cT)². That jumps where a pulse begins and ends; what rings
    # there is at most as much again
    courant = lab.speed * step / lab.diameter
    bend = 0.5 * HEIGHT * (2.0 * np.pi / (lab.speed * PERIOD)) ** 2
    error = 2.0 * lab.diameter**2 * (1.0 - courant**2) / 8.0 * bend
    if law == "linearpbond":  # whose ways to contacts become shorter by v/c
        error += HEIGHT**2 / lab.speed
    x = scene.assembly.positions[:, 0]
    inner = (x > lab.diameter) & (x < 100.0 - lab.diameter)  # all but the ends, which the outside pushes, too
    impedance = lab.density * lab.speed
    assert velocity.max() == pytest.approx(HEIGHT, rel=0.01)
    np.testing.assert_allclose(stress[inner, 0], -impedance * velocity[inner], rtol=0.0, atol=impedance * error)
