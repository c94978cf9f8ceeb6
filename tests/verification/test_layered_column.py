"""Layers of disks move as layers of continua on a half-space, to the second order of the disks.

Three layers under an incident S or P wave, 2.5 times whose frequency has 40 disks in a wavelength of the slowest layer.
"""

from collections.abc import Sequence

import numpy as np
import pytest
import tomli_w

from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.exact.column import Column, Layer
from dembound.formulas.disks.entry import late_by, mass_begins
from dembound.kinds import loads
from dembound.motion.simulation import Simulation

SPEEDS, DENSITIES, THICKNESSES = (200.0, 350.0, 700.0), (1800.0, 2000.0, 2300.0), (30.0, 40.0)
LAYERS = [
    {"thickness": 30.0},
    {"thickness": 40.0, "density": 2000.0, "s_wave_speed": 350.0},
    {"density": 2300.0, "s_wave_speed": 700.0},
]
ROUND = {side: {"type": "periodic"} for side in ("left", "right")}


def error(lab, packing: dict, motion: str, bottom: dict, disks: float, qualities: Sequence[float] = ()) -> float:
    """RMS error of the mean velocity of the uppermost disks over its RMS, so many disks in the shortest wavelength.

    qualities : Q of layers from the surface down, others are undamped.
    """
    frequency, component = SPEEDS[0] / disks, {"s": 0, "p": 1}[motion]
    damped = zip(LAYERS, qualities, strict=False)
    tables = {
        "packing": packing,
        "material": {"density": 1800.0, "s_wave_speed": 200.0, "fric": 0.5},
        "layer": [each | {"quality_factor": q} for each, q in damped] + LAYERS[len(qualities) :],
        "boundary": ROUND | {"bottom": bottom | {f"wave_{motion}": "pulse"}},
        "wave": {"pulse": {"type": "ricker", "amplitude": 1.0, "frequency": frequency / 2.5}},
        "run": {"duration": 1.2 + 20.0 / frequency},
    }
    scene = build(loads(tomli_w.dumps(tables)))
    top, (_, _, _, surface) = np.flatnonzero(scene.positions[:, 1] > scene.case.box[3] - 1.0), scene.case.box
    history, mass = lab.run(scene, top, tables["run"]["duration"]), scene.mass[top]
    found = np.average(history.velocity[:, :, component], axis=1, weights=mass)
    relative = [each and each.relative_modulus for each in scene.ground.mechanisms_by_layer]
    speeds = [each.material.wave_speeds(1)[1 - component] for each in reversed(scene.ground.layers)]
    ends = mass_begins(scene, "top")  # depth of the surface of the mass below that asked for
    way = late_by(scene) * speeds[-1] + surface - sum(THICKNESSES)  # in the lowest layer, to where the wave enters
    thicknesses = (THICKNESSES[0] - ends, THICKNESSES[1], way, 1.0)
    each = zip(thicknesses, *map(_and_below, (DENSITIES, speeds, relative)), strict=True)
    column = Column([Layer(high, density, speed, relative=modulus) for high, density, speed, modulus in each])
    pulse = scene.case.wave["pulse"].velocity(history.times)
    depth = surface - ends - float(np.average(scene.positions[top, 1], weights=mass))
    exact = column.history(pulse, float(history.times[1]), depth)
    return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))


def _and_below(values: Sequence) -> list:
    """Values of layers, with those of the last one again for the half-space below it."""
    return [*values, values[-1]]


LATTICE = {"pattern": "A", "radius": 0.5, "size": [1.0, 110.0]}
HALF = {"type": "viscous_input", "half_mass": True}


@pytest.mark.parametrize("motion", ["s", "p"])
def test_a_lattice_has_the_motion_of_its_layers(lab, motion) -> None:
    """0.047 % of S waves, 0.036 % of P waves; S waves without corrected joints leave 0.23 %."""
    assert error(lab, LATTICE, motion, HALF, 40.0) < 1e-3


def test_the_error_falls_with_the_square_of_the_disks(lab) -> None:
    coarse, fine = (error(lab, LATTICE, "s", HALF, disks) for disks in (40.0, 80.0))
    assert coarse / fine > 3.5


def test_a_random_packing_has_the_motion_of_its_layers(lab) -> None:
    """0.06 % at 60 disks; joints without corrections leave 0.85 %."""
    packing = {"pattern": "B", "radius": 0.5, "radius_ratio": 1.66, "brick": [22.0, 22.0], "seed": 1}
    assert error(lab, packing | {"size": [22.0, 110.0]}, "s", {"type": "outside"}, 60.0) < 1.5e-3


PACKINGS = {
    "A": {"pattern": "A", "radius": 0.5, "size": [12.0, 24.0]},
    "B": {"pattern": "B", "radius": 0.25, "radius_ratio": 1.5, "brick": [6.0, 6.0], "size": [12.0, 24.0]},
    "C": {
        "pattern": "C",
        "edge_radius": 0.25,
        "radius": 0.25,
        "radius_ratio": 1.5,
        "brick": [6.0, 6.0],
        "size": [12.0, 24.0],
    },
}


@pytest.mark.parametrize(
    ("pattern", "quality"),
    [("A", None), *(pytest.param(each, None, marks=pytest.mark.slow) for each in "BC"), ("B", 10.0)],
)
def test_a_body_beside_free_fields_follows_its_column(pattern, quality) -> None:
    """Both have the same layers: nothing but rounding drives them apart. quality : Q of the upper layer."""
    sides = {side: {"type": "free_field"} for side in ("left", "right")}
    damped = {} if quality is None else {"quality_factor": quality}
    tables = {
        "packing": PACKINGS[pattern],
        "material": {"density": 1800.0, "s_wave_speed": 200.0, "fric": 0.5},
        "layer": [{"thickness": 7.0} | damped, {"thickness": 8.2, "s_wave_speed": 350.0}, {"s_wave_speed": 700.0}],
        "boundary": sides | {"bottom": {"type": "viscous_input", "wave_s": "pulse", "wave_p": "pulse"}},
        "wave": {"pulse": {"type": "ricker", "amplitude": 1.0, "frequency": 6.0}},
        "run": {"duration": 0.4},
    }
    scene = build(loads(tomli_w.dumps(tables)))
    step = choose_step(scene)[0]
    simulation = Simulation(scene, step)
    apart, peak = 0.0, 0.0
    for _ in range(8):
        simulation.advance(int(0.05 / step))
        velocity = simulation.state.velocity
        apart = max(apart, float(np.abs(velocity - velocity[:, scene.twin]).max()))
        peak = max(peak, float(np.abs(velocity).max()))
    assert peak > 0.5  # the pulse did run
    assert apart < 1e-9 * peak


@pytest.mark.parametrize(
    ("bottom", "qualities"),
    [(HALF, (20.0, 40.0)), ({"type": "outside"}, (20.0, 40.0)), ({"type": "outside"}, (20.0, 40.0, 20.0))],
    ids=["dashpots", "undamped rock", "damped rock"],
)
def test_layers_of_unlike_damping_have_the_motion_of_a_column(lab, bottom: dict, qualities: tuple) -> None:
    """0.03 % beside a column with the same M(ω); with forces of unrelaxed springs from below 9 % in damped rock."""
    assert error(lab, LATTICE, "s", bottom, 40.0, qualities) < 1e-3
