"""A settled body stays at rest once the boundaries of the run take over, whatever holds it (Z eqs 5, 6)."""

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build
from dembound.kinds import with_changes

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


@pytest.mark.parametrize("material", [{}, {"law": "linearpbond", "fric": 0.5}], ids=["elastic", "linearpbond"])
@pytest.mark.parametrize("pattern", ["A", "B", "C"])
def test_nothing_moves_after_gravity(lab, pattern, material):
    scene = waiting(lab, pattern, material, {"static": {"boundary": ROLLERS}, "load": GRAVITY})
    settled = settle(scene)
    assert settled.ratio <= 1e-5
    assert settled.mean_residual < 1e-3 * settled.mean_reaction
    simulation = lab.settled(scene, settled.start)
    simulation.run(2000)
    # F_0 is minus the force the same kernel gave; the springs' part of it, which is not, is rounded
    assert np.abs(simulation.state.velocity).max() < 1e-9 * 0.5


@pytest.mark.parametrize("pattern", ["B", "C"])
def test_nothing_moves_with_locked_in_stress_alone(lab, pattern):
    scene = waiting(lab, pattern, {"law": "linearpbond", "fric": 0.5, "locked_in": 5e6}, {"static": {}})
    settled = settle(scene)
    assert np.abs(settled.start.displacement).max() > 0.0
    simulation = lab.settled(scene, settled.start)
    simulation.run(500)
    assert np.abs(simulation.state.velocity).max() < 1e-9 * 0.5


def test_the_stress_asked_for_is_there(lab):
    wanted = np.array([-8e6, -3e6, 1e6])
    scene = waiting(lab, "B", {"law": "linearpbond", "fric": 0.5}, {"static": {"stress": wanted.tolist()}})
    # tractions are corrected until it is within half a per cent of the largest
    assert np.all(np.abs(settle(scene).stress - wanted) < 5e-3 * 8e6)
