"""Without a hole, a box of disks in the ground moves as the free-field column does, and the continuum round it rests.

Forces on the disks at the sides are those on their twins, to rounding: sums of some ten numbers in another order, a
few ε of the largest force, over some thousand steps.
"""

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

BOXES = {
    "all of the ground": (0.0, 0.0, 60.0, 60.0),
    "in the middle": (20.0, 20.0, 40.0, 40.0),
    "up to the surface": (20.0, 40.0, 40.0, 60.0),
    "from the foot": (20.0, 0.0, 40.0, 30.0),
    "at the side": (0.0, 10.0, 20.0, 40.0),
}
DURATION = 0.25
"""s, until the S pulse has come down again from the surface."""


@pytest.mark.parametrize(
    ("box", "pattern", "fric", "wave"),
    [
        ("all of the ground", "B", 0.5, "wave_s"),
        pytest.param("in the middle", "A", 0.0, "wave_s", marks=pytest.mark.slow),
        ("up to the surface", "C", 0.5, "wave_p"),
        ("from the foot", "A", 0.5, "wave_p"),
        pytest.param("at the side", "B", 0.5, "wave_s", marks=pytest.mark.slow),
    ],
)
def test_it_does(lab, box: str, pattern: str, fric: float, wave: str) -> None:
    scene = build(lab.window(pattern, BOXES[box], wave=wave, material={"fric": fric}))
    step = choose_step(scene)[0]
    simulation = Simulation(scene, step)
    body = np.arange(scene.column_count, scene.disk_count)
    peak, beside, beyond = 0.0, 0.0, 0.0
    for part in range(1, 26):
        simulation.run(int(DURATION / step * part / 25))
        velocity = simulation.state.velocity
        peak = max(peak, np.abs(velocity[:2, body]).max())
        beside = max(beside, np.abs(velocity[:, body] - velocity[:, scene.seams[0].twin[body]]).max())
        beyond = max(beyond, np.abs(velocity[:, scene.outside.nodes]).max())

    assert peak > (0.9 if BOXES[box][3] == 60.0 else 0.45)  # the pulse of 0.5 m/s, doubled at the surface
    assert max(beside, beyond) < 2e-11 * peak
