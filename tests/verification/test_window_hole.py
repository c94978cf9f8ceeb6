"""A hole in a small box of disks scatters waves as in a larger box, or in ground all of disks.

The continuum has waves of 35 m on elements of 10 m, and the lattice its own dispersion: (qa)²/24 of phase, 0.13 % at
35 m and 0.9 % over the 40 m up and down from the surface. Scattered waves are 15 to 50 % of the motion, so that one
side without ties, a force of the free field that went into the continuum, or one of a wrong sign, changes it by some of
that.
"""

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.kinds import with_changes
from dembound.motion.simulation import Simulation

PLACES = [(25.5, 30.5), (30.5, 34.5), (26.5, 26.5), (30.5, 58.4), (15.5, 30.5)]
WHOLE = (0.0, 0.0, 60.0, 60.0)
BOXES = [(10.0, 10.0, 50.0, 40.0), (20.0, 20.0, 40.0, 40.0), (20.0, 20.0, 40.0, 60.0), (20.0, 0.0, 40.0, 40.0)]
STEP, DURATION = 1.8e-4, 0.3


def motion(case) -> tuple[np.ndarray, np.ndarray]:
    """Velocities (steps, m, 2) at the places, and of the ground without a hole there."""
    monitors = [{"name": f"m{number}", "position": place} for number, place in enumerate(PLACES)]
    scene = build(with_changes(case, {"monitor": monitors}))
    assert choose_step(scene)[1] > STEP
    record = Simulation(scene, STEP, scene.probes).advance(int(DURATION / STEP))
    record = scene.observed(record, STEP * np.arange(len(record)))
    return tuple(np.split(record[..., 3:5], 2, axis=1))


def part(difference: np.ndarray, of: np.ndarray) -> np.ndarray:
    """RMS at each place over that of the motion there."""
    return np.sqrt((difference**2).sum(axis=(0, 2)) / (of**2).sum(axis=(0, 2)))


# measured: A 0.43 % (P 0.24 %). The elements have the moduli of an endless packing; B and C near a box add what their
# disks do beyond the mean strain, and at the surface that they are softer there (place 4): 2.2 and 3.8 %, C 2.8 %, see
# docs/evidence/ground_boxes.md
@pytest.mark.parametrize(
    ("pattern", "within", "wave"),
    [
        ("A", 6e-3, "wave_s"),
        *(pytest.param(*each, marks=pytest.mark.slow) for each in (("B", 4.5e-2, "wave_p"), ("C", 3.5e-2, "wave_s"))),
    ],
)
def test_it_does(lab, pattern: str, within: float, wave: str) -> None:
    expected, free = motion(lab.window(pattern, WHOLE, wave=wave, hole=True))
    assert part(expected - free, expected).min() > 0.14
    for box in BOXES if pattern == "A" else BOXES[1:3]:
        found, beside = motion(lab.window(pattern, box, wave=wave, hole=True))
        assert np.abs(beside - free).max() < 1e-9 * np.abs(free).max()  # the same column, whatever the box
        assert part(found - expected, expected).max() < within
