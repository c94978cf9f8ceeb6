"""A periodic column of random disks on a continuum moves as a column so tall that nothing returns.

A gap or an overlap of the length d between packing and continuum would reflect waves in the ratio κd/2, 0.1 diameters
by 7e-4 in this test. There are such lengths if the continuum begins elsewhere than the mass of the packing, or if ties
have the motion of their own places. What remains is of second order: (κL)²/24 = 4e-4 for bricks of the length L.
"""

from typing import Any

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

HEIGHT, DEEP = 20.0, 150.0
PULSE = {"type": "cosine", "amplitude": 1.0, "period": 0.25}
SIDES = {"left": "periodic", "right": "periodic"}


def shaken(lab, motion: str, deep: float, bottom: dict[str, Any]):
    """A column whose uppermost disks are pushed, its foot at y = −deep."""
    top = HEIGHT + deep
    force = [1e6, 0.0] if motion == "s" else [0.0, 1e6]
    load = [{"region": [0.0, top - 1.5, 5.0, top], "force": force, "wave": "pulse"}]
    case = lab.case(
        "B",
        (5.0, top),
        brick=(5.0, 5.0),
        held=(),
        material={"fric": 0.5},
        boundary=SIDES | bottom,
        wave=PULSE,
        load=load,
    )
    return build(case)


@pytest.mark.parametrize("motion", ["p", "s"])
def test_nothing_returns_from_it(lab, motion) -> None:
    short = shaken(lab, motion, 0.0, {"bottom": "outside"})
    tall = shaken(lab, motion, DEEP, {})
    step = min(choose_step(short)[0], choose_step(tall)[0])
    steps = int(0.95 * 2.0 * DEEP / tall.ground.wave_speeds(1)[0] / step)
    places = short.positions[: short.recorded]
    chosen = np.flatnonzero(np.abs(places[:, 1] - 2.5) < 0.5)
    away = np.abs(tall.positions[:, None] - [0.0, DEEP] - places[chosen]).sum(axis=2)
    twins = np.argmin(away, axis=0)
    assert away[twins, np.arange(len(chosen))].max() < 1e-9
    found, expected = (
        Simulation(scene, step, nodes).advance(steps) for scene, nodes in ((short, chosen), (tall, twins))
    )
    along = 1 if motion == "p" else 0
    for kind in (0, 3):  # displacement, velocity
        difference = np.abs(found - expected)[:, :, [kind, kind + 1]].max()
        assert difference < 4e-4 * np.abs(expected[:, :, kind + along]).max()
