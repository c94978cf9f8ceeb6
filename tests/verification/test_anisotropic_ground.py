"""Claim: where ground is stiffer along one axis than along the other, a side goes by the waves along its own normal.

The ground is a lattice of equal disks that touch across the way of the waves and stand apart along it. Only bonds, all
alike, hold them, so that waves run faster along the way than across it, in the ratio of the spacings.
"""

import numpy as np
import pytest

from dembound.disks.matching import homogenised_beta
from dembound.packings.brick import Brick

STRETCH, CELLS, PERIOD, HEIGHT = 1.5, 200, 0.1, 0.5
BONDS = 2.5e9
"""Stiffness of a bond, N/m; against shear it is half of that."""

SIDES = (("left", "right"), ("bottom", "top"))
OWN = {"emod": 0.0, "pb_emod": BONDS, "pb_kratio": 2.0}
NAMED = {"p_wave_speed": 1000.0, "contact_share": 0.0, "pb_kratio": 2.0}
"""The same bonds, but P dashpots for another speed, which a factor then has to make up for."""


def stretched(diameter: float, axis: int) -> Brick:
    """One disk in a cell that is STRETCH diameters long along an axis and one diameter wide."""
    size = np.full(2, diameter)
    size[axis] *= STRETCH
    disk = np.full((1, 2), 0.5 * diameter), np.full(1, 0.5 * diameter)
    return Brick(size, *disk, np.zeros((2, 2), int), np.eye(2, dtype=int), np.zeros((1, 2), bool), np.zeros(3), 0.0)


@pytest.mark.parametrize("axis", [0, 1], ids=["along x", "along y"])
@pytest.mark.parametrize("material", [OWN, NAMED], ids=["own speeds", "homogenised factors"])
def test_waves_come_in_whole_and_leave_whole(lab, axis: int, material: dict):
    near, far = SIDES[axis]
    copies = (CELLS, 1) if axis == 0 else (1, CELLS)
    spacing = STRETCH * lab.diameter
    length = CELLS * spacing

    def column(factors: dict[str, float]):
        boundary = dict.fromkeys(SIDES[1 - axis], "periodic")
        boundary[near] = {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"} | factors
        boundary[far] = {"type": "viscous"} | factors
        words = {"held": ("rotation",), "material": material, "boundary": boundary}
        return lab.tiled(stretched(lab.diameter, axis), copies, wave=lab.pulse(PERIOD), **words)

    scene = column({})
    if material is NAMED:
        scene = column({f"beta_{motion}": homogenised_beta(scene, far, motion) for motion in ("p", "s")})
    # a chain of masses ρDh on springs k has c = h√(k/m)
    speeds = np.sqrt(BONDS * STRETCH / lab.density * np.array([1.0, 0.5]))
    middle = np.argsort(scene.positions[:, axis])[[CELLS // 2]]
    history = lab.run(scene, middle, 1.5 * length / speeds.min() + PERIOD)
    for component, speed in zip((axis, 1 - axis), speeds, strict=True):
        velocity = history.velocity[:, 0, component]
        passed = history.times > 0.5 * length / speed + PERIOD
        # half of the end disk's mass is too much for a matched end: it returns (h/4c) ∂v/∂t, at most πh/4cT of the
        # pulse. A tenth of that more is ample for dispersion, (2πh/cT)² = 0.3 %. Dashpots for waves across the way
        # would return (1.5 − 1)/(1.5 + 1) = 20 % and let in 2/(1 + 1.5) = 80 %
        error = 1.1 * np.pi * spacing / (4.0 * speed * PERIOD)
        assert velocity[~passed].max() == pytest.approx(HEIGHT, rel=error)
        assert np.abs(velocity[passed]).max() < error * HEIGHT
