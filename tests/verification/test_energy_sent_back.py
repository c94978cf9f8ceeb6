"""The energy that a side sends back in a run is what is measured without one.

A pulse enters a strip of random bricks, periodic sideways, through its left side, which is at rest from then on. So all
energy remains in the body but for what the right side absorbs: it is measured before the pulse reaches that side and
when it has left it. Kinetic energy is half a step behind; within a pulse of so many steps this is 1e-4 of both.
"""

import numpy as np
import pytest
from small_cases import small

from dembound.disks.reflection.bricks import end_scene
from dembound.disks.reflection.meter import Meter
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.disks.surroundings.frequencies import frequencies_of
from dembound.motion.simulation import Simulation

PERIOD, LENGTH, BRICK, SPEED = 0.04, 100.0, 5.0, 1000.0

CASE = {
    "packing": {"pattern": "B", "size": [LENGTH, BRICK], "radius": 0.25, "radius_ratio": 1.5, "brick": [BRICK, BRICK]},
    "material": {"density": 2500.0, "p_wave_speed": SPEED, "fric": 0.5},
    "boundary": {"bottom": {"type": "periodic"}, "top": {"type": "periodic"}},
    "wave": {"pulse": {"type": "cosine", "amplitude": 1.0, "period": PERIOD}},
    "run": {"duration": 0.1},
}


def energy_after(simulation: Simulation, time: float) -> float:
    """Energy in the body (J/m) at a time (s)."""
    simulation.run(round(time / simulation.time_step))
    scene, state = simulation.scene, simulation.state
    velocity = scene.layout.gather(state.v)
    inert = np.stack([scene.mass, scene.mass, scene.inertia])
    return float(0.5 * np.sum(inert * velocity**2)) + sum(simulation.system.stored(state.u))


@pytest.mark.parametrize(
    ("motion", "side"),
    [("s", {"type": "viscous", "beta_s": 0.3}), ("p", {"type": "viscoelastic", "distance": 5.0, "alpha_n": 2.5})],
)
def test_energy_of_a_reflected_pulse(motion, side) -> None:
    """Within 3 %.

    Means over 24 frequencies are within 1 % of the integral, and bricks as short as an eighth of the pulse scatter less
    than a per cent of it.
    """
    ends = {"left": {"type": "velocity", f"wave_{motion}": "pulse"}, "right": side}
    case = small({**CASE, "boundary": CASE["boundary"] | ends})
    scene = build(case)
    speed = scene.ground.wave_speeds(0)[0 if motion == "p" else 1]
    simulation = Simulation(scene, choose_step(scene)[0])
    before = energy_after(simulation, 0.5 * (LENGTH / speed + PERIOD))
    after = energy_after(simulation, 2.0 * LENGTH / speed)

    frequencies = frequencies_of(case, scene.ground, 24)
    (found,) = Meter.of("right", simulation.time_step, end_scene(case, "right")).measure(frequencies, [0.0], (motion,))
    expected = float(found.total(motion).mean())
    assert 0.05 < expected < 0.9
    assert after / before == pytest.approx(expected, rel=0.03)
