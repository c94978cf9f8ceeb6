"""Settings of a continuum that are chosen from an accuracy have it.

Beside bodies and grids so large that nothing returns.

RMS of the velocities of all disks farther than five diameters from the force, over that of these velocities.
"""

import numpy as np
import pytest

from dembound.casefile import Case
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.disks.surroundings.near_fields import signals_of
from dembound.formulas.disks.continuum import lattice_errors
from dembound.kinds import with_changes
from dembound.motion.simulation import Simulation

SIDES = ("left", "right", "bottom")
SIZE = (40.0, 20.0)
WIDE = 130.0
"""Additional ground of the large body at each side, m: a P wave needs 0.26 s to its sides and back."""

WAVES = {
    "cosine": {"type": "cosine", "amplitude": 1.0, "period": 0.1},
    "ricker": {"type": "ricker", "amplitude": 1.0, "frequency": 20.0},
}
PLACES = {"surface": (20.5, 19.5), "inside": (12.5, 8.5)}


def pushed(lab, wave: dict, place: tuple[float, float], size: tuple[float, float] = SIZE, sides=SIDES) -> Case:
    """A force on isotropic disks of 1 m with c_p = 1000 m/s, c_s = 707 m/s."""
    return lab.case(
        "A",
        size,
        radius=0.5,
        held=(),
        material={"fric": 0.5, "p_wave_speed": 1000.0},
        boundary=dict.fromkeys(sides, "outside"),
        wave=wave,
        load=[{"position": place, "force": [3e5, -1e6], "wave": "pulse"}],
        duration=0.25,
    )


def velocities(scene: DiskScene, corner: float, step: float, steps: int) -> np.ndarray:
    """Velocities (samples, disks, 2) of the disks right of and above a corner (m), row by row, every third step."""
    place = scene.positions[: scene.recorded] - corner
    inside = np.flatnonzero(((place > 0.0) & (place < SIZE)).all(axis=1))
    inside = inside[np.lexsort(place[inside].round(3).T)]
    return Simulation(scene, step, inside).advance(steps)[::3, :, 3:5]


@pytest.mark.parametrize(("wave", "where"), [("cosine", "surface"), ("ricker", "inside")])
def test_velocities_have_the_accuracy_asked_for(lab, wave: str, where: str) -> None:
    """Errors may be those of the ties, if these are larger: 0.09 % is expected of the pulse, 0.55 % of the wavelet.

    Measured with 1 % and 0.2 %: 0.24 and 0.40 %, then 0.08 and 0.10 % of the pulse, 0.29 and 0.28 % of the wavelet.
    """
    x, y = PLACES[where]
    scenes = [
        build(with_changes(pushed(lab, WAVES[wave], (x, y)), {"outside.accuracy": accuracy}))
        for accuracy in (1e-2, 2e-3)
    ]
    step = 0.95 * min(choose_step(scene)[0] for scene in scenes)
    steps = int(0.25 / step)
    size = SIZE[0] + 2.0 * WIDE, SIZE[1] + WIDE
    large = velocities(build(pushed(lab, WAVES[wave], (x + WIDE, y + WIDE), size, ())), WIDE, step, steps)
    column, row = np.meshgrid(np.arange(40) + 0.5, np.arange(20) + 0.5)
    away = np.hypot(column - x, row - y).ravel() > 5.0
    for scene in scenes:
        error = velocities(scene, 0.0, step, steps) - large
        relative = np.sqrt(np.sum(error[:, away] ** 2) / np.sum(large[:, away] ** 2))
        ties, _ = lattice_errors(scene, signals_of(scene.case))
        assert relative < max(scene.case.outside.accuracy, ties)
    if wave == "ricker":
        assert relative > 0.25 * ties
