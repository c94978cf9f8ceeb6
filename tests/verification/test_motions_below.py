"""The same ground moves alike under its incident wave, outcrop, motion within, and under the deconvolved surface."""

from collections.abc import Sequence

import numpy as np
import pytest
import tomli_w

from dembound.disks.scene import build
from dembound.exact.column import Column, Layer
from dembound.kinds import loads
from dembound.kinds.disks.incident_wave import Level
from dembound.kinds.disks.kind import Disks
from dembound.studies.deconvolution import incident_below, level_ground

ROCK = {"density": 2400.0, "p_wave_speed": 1100.0, "s_wave_speed": 672.0}
PULSE = {"type": "ricker", "amplitude": 1.0, "frequency": 6.0}


LAYERS = [{"thickness": 8.0, "density": 1800.0, "s_wave_speed": 170.0}, {"s_wave_speed": 300.0}]


def column(bottom: dict, wave: dict, *, half_mass: bool = True, layers: Sequence[dict] = ()):
    """A column, 20 m high, of S waves of 212 m/s, 70 disks in the shortest wave; maybe of layers."""
    given = {"type": "viscous_input", "wave_s": "w", "half_mass": half_mass} | bottom
    given = {key: value for key, value in given.items() if value is not None}
    tables = {
        "packing": {"pattern": "A", "size": [0.5, 20.0], "radius": 0.25},
        "material": {"density": 1900.0, "p_wave_speed": 300.0, "fric": 0.5},
        "boundary": {"left": {"type": "periodic"}, "right": {"type": "periodic"}, "bottom": given},
        "wave": {"w": wave, "v": PULSE | {"frequency": 4.0}},
        "run": {"duration": 1.0},
        "layer": [*layers],
    }
    return loads(tomli_w.dumps(tables))


def surface(lab, case, duration: float = 1.0):
    """Times (k,) and velocities (k, 2) of the uppermost disk."""
    scene = Disks().build(case)
    history = lab.run(scene, [int(np.argmax(scene.positions[:, 1]))], duration)
    return history.times, history.velocity[:, 0, :2]


@pytest.mark.parametrize("half_mass", [True, False], ids=["half", "whole"])
@pytest.mark.parametrize("below", [{"rock": ROCK}, {}], ids=["rock", "same"])
def test_motion_within_and_at_the_outcrop(lab, below: dict, half_mass: bool) -> None:
    """Dispersion leaves 0.5 % of the undamped, ringing ground (70 disks in 35 m); a wrong kind of motion 30 % and more.

    Whole cells have their own incident wave, found from where their mass and dashpots begin.
    """
    case = column(below, PULSE | {"motion": "within"}, half_mass=half_mass)
    ground = Level.of(build(case), "bottom", "s")
    times, found = surface(lab, case)
    rock = Layer(1.0, 1900.0, 212.132) if not below else Layer(1.0, 2400.0, 672.0)
    exact = Column([Layer(ground.height, 1900.0, ground.speed), rock])
    expected = exact.history(case.wave["w"].velocity(times), times[1], 0.25, "within")
    assert np.linalg.norm(found[:, 0] - expected) < 0.008 * np.linalg.norm(expected)

    _, outcrop = surface(lab, column(below, PULSE | {"motion": "outcrop"}, half_mass=half_mass))
    _, incident = surface(lab, column(below, PULSE, half_mass=half_mass))
    assert np.array_equal(2.0 * outcrop, incident)


def test_both_components_on_rock_do_not_disturb_each_other(lab) -> None:
    """P waves along y and S waves along x at once are the sum of both alone, with the impedance of each in the rock."""
    _, both = surface(lab, column({"rock": ROCK, "wave_p": "v"}, PULSE))
    times, s = surface(lab, column({"rock": ROCK}, PULSE))
    assert np.abs(both[:, 0] - s[:, 0]).max() < 1e-12
    exact = Column([Layer(19.75, 1900.0, 300.0), Layer(1.0, 2400.0, 1100.0)])
    expected = exact.history(column({}, PULSE).wave["v"].velocity(times), times[1], 0.25)
    assert np.linalg.norm(both[:, 1] - expected) < 1e-3 * np.linalg.norm(expected)


@pytest.mark.parametrize(
    ("below", "half_mass", "layers"),
    [
        ({"rock": ROCK}, True, ()),
        ({"rock": ROCK}, False, ()),
        ({}, True, ()),
        ({}, False, ()),
        ({"rock": ROCK}, True, LAYERS),
        ({"type": "outside", "half_mass": None}, False, LAYERS),
    ],
    ids=["rock", "rock, whole cells", "same", "same, whole cells", "layers on rock", "layers on continuum"],
)
def test_the_deconvolved_surface_comes_back(lab, tmp_path, below: dict, half_mass: bool, layers) -> None:
    """In a run to 0.5 %: dispersion, and lines between samples of 0.5 ms."""
    step = 5e-4
    time = step * np.arange(1600)
    record = column({}, PULSE).wave["w"].velocity(time)
    found = incident_below(level_ground(column(below, PULSE, half_mass=half_mass, layers=layers)), record, step)
    delayed = np.concatenate([np.zeros(round(found.early / step)), record])
    path = tmp_path / "below.txt"
    np.savetxt(path, np.column_stack([step * np.arange(len(found.velocity)), found.velocity]))
    wave = {"type": "file", "path": str(path)}
    times, moved = surface(lab, column(below, wave, half_mass=half_mass, layers=layers))
    expected = np.interp(times, step * np.arange(len(delayed)), delayed)
    assert np.linalg.norm(moved[:, 0] - expected) < 0.005 * np.linalg.norm(expected)
