"""Soil on a side with rock moves as a layer on a half-space, to the second order of the disks.

The ground of DEEPSOIL's example 2a: 20 m of 500 m/s and 20 kN/m³ on rock of 760 m/s and 25 kN/m³, undamped, under
incident S waves up to 25 Hz. Half cells begin where their dashpots act, D/2 above the plane of the side.
"""

import numpy as np
import tomli_w

from dembound.disks.scene import build
from dembound.exact.column import Column, Layer
from dembound.formulas.disks.entry import mass_begins
from dembound.kinds import loads
from dembound.kinds.disks.incident_wave import Level

GRAVITY = 9.81
SOIL, ROCK = 20e3 / GRAVITY, 25e3 / GRAVITY
BOTTOM = {
    "type": "viscous_input",
    "wave_s": "pulse",
    "rock": {"density": ROCK, "p_wave_speed": 1500.0, "s_wave_speed": 760.0},
}


def error(lab, packing: dict, bottom: dict, of_top: float) -> float:
    """RMS error of the velocity of the surface, the mean of the disks in its uppermost metres, over its RMS."""
    tables = {
        "packing": {"size": [packing["radius"] * 2.0, 20.0]} | packing,
        "material": {"density": SOIL, "p_wave_speed": 500.0 * 2.0**0.5, "fric": 0.5},
        "boundary": {"left": {"type": "periodic"}, "right": {"type": "periodic"}, "bottom": bottom},
        "wave": {"pulse": {"type": "ricker", "amplitude": 1.0, "frequency": 9.0}},
        "run": {"duration": 0.6},
    }
    scene = build(loads(tomli_w.dumps(tables)))
    ground, top = Level.of(scene, "bottom", "s"), np.flatnonzero(scene.positions[:, 1] > 20.0 - of_top)
    history, mass = lab.run(scene, top, 0.6), scene.mass[top]
    found = np.average(history.velocity[:, :, 0], axis=1, weights=mass)
    depth = 20.0 - mass_begins(scene, "top") - float(np.average(scene.positions[top, 1], weights=mass))
    pulse, step = scene.case.wave["pulse"], float(history.times[1])
    column = Column([Layer(ground.height, SOIL, ground.speed), Layer(1.0, ROCK, 760.0)])
    exact = column.history(pulse.velocity(history.times), step, depth)
    return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))


def test_the_error_of_half_cells_falls_with_the_square_of_the_disks(lab) -> None:
    """40 disks in the shortest wavelength leave 0.064 %; whole cells, of first order, would leave 1.8 %."""
    coarse, fine = (
        error(lab, {"pattern": "A", "radius": radius}, BOTTOM | {"half_mass": True}, 1.5 * radius)
        for radius in (0.5, 0.25)
    )
    assert fine < 1e-3
    assert 3.5 < coarse / fine < 4.5


def test_dashpots_of_a_random_side_add_up_to_the_rock(lab) -> None:
    """They have ΣD/H = 1.2: a factor without that leaves 25 %, the right one the 3 % of whole cells."""
    packing = {"pattern": "B", "radius": 0.25, "radius_ratio": 1.5, "brick": [5.0, 5.0], "seed": 1, "size": [5.0, 20.0]}
    assert error(lab, packing, BOTTOM, 1.0) < 0.045
