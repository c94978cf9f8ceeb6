"""A settled body stays at rest once the boundaries of the run take over, whatever holds it (Z eqs 5, 6)."""

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.kinds import with_changes
from dembound.motion.simulation import Simulation

ROLLERS = {"left": {"type": "roller"}, "right": {"type": "roller"}, "bottom": {"type": "fixed"}}
GRAVITY = [{"name": "gravity", "acceleration": [0.0, -9.81]}]
SIDES = {
    "left": {"type": "viscoelastic", "distance": 10.0},
    "right": "viscous",
    "bottom": {"type": "viscous_input", "wave_s": "pulse"},
}


def waiting(lab, pattern, material, changes):
    """A scene whose wave comes only after the test."""
    wave = {"type": "cosine", "amplitude": 0.5, "period": 0.05, "start": 100.0}
    brick = {} if pattern == "A" else {"brick": (5.0, 5.0)}
    case = lab.case(pattern, (10.0, 10.0), held=(), boundary=SIDES, wave=wave, **brick)
    return build(with_changes(case, {**{f"material.{key}": value for key, value in material.items()}, **changes}))


@pytest.mark.parametrize(("pattern", "material"), [("A", {}), ("C", {"law": "linearpbond", "fric": 0.5})])
def test_nothing_moves_after_gravity(lab, pattern, material):
    scene = waiting(lab, pattern, material, {"static": {"boundary": ROLLERS}, "load": GRAVITY})
    settled = settle(scene)
    assert settled.ratio <= 1e-5
    assert settled.mean_residual < 1e-3 * settled.mean_reaction
    simulation = lab.simulation(scene, settled.start)
    simulation.run(2000)
    # F_0 is minus the force the same kernel gave; the springs' part of it, which is not, is rounded
    assert np.abs(simulation.state.velocity).max() < 1e-9 * 0.5


def test_nothing_moves_with_locked_in_stress_alone(lab):
    scene = waiting(lab, "B", {"law": "linearpbond", "fric": 0.5, "locked_in": 5e6}, {"static": {}})
    settled = settle(scene)
    assert np.abs(settled.start.displacement).max() > 0.0
    simulation = lab.simulation(scene, settled.start)
    simulation.run(500)
    assert np.abs(simulation.state.velocity).max() < 1e-9 * 0.5


@pytest.mark.parametrize("source", ["viscous_input", "velocity"])
def test_nothing_moves_before_the_wave_begins(lab, source):
    """Nor do supports and local damping start anything."""
    boundary = {"left": {"type": source, "wave_p": "pulse"}, "right": "fixed", "bottom": "viscous"}
    wave = lab.pulse(0.02) | {"start": 0.1}
    scene = lab.scene("B", (20.0, 10.0), boundary=boundary, wave=wave, material={"damp": 0.7})
    step = choose_step(scene)[0]
    simulation = Simulation(scene, step)
    simulation.advance(int(0.1 / step))
    assert not simulation.state.velocity.any()
    assert not simulation.state.displacement.any()
    simulation.advance(10)
    assert simulation.state.velocity[:, scene.edges["left"].nodes].any()
