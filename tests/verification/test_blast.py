"""A pressure on the wall of a hole moves the rock as the exact cylindrical cavity moves, to first order in D/a."""

from pathlib import Path

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.exact.explosion import cavity_motion
from dembound.exact.solid import Solid
from dembound.kinds import load, with_changes
from dembound.motion.simulation import Simulation

CASE = load(Path(__file__).parents[2] / "cases" / "blast.toml")
RADIUS, PRESSURE = 10.0, 5e6
SOLID = Solid(density=2500.0, p_wave_speed=1000.0, s_wave_speed=1000.0 / np.sqrt(2.0))
MIRRORS = {"left": {"type": "symmetry"}, "bottom": {"type": "symmetry"}}
BEYOND = {"right": {"type": "outside"}, "top": {"type": "outside"}}


def quarter(diameter: float, **changes: object) -> DiskScene:
    """A quarter of the rock between two mirror planes through the axis, 20 m × 20 m."""
    keys = {
        "packing": {"pattern": "A", "size": [20.0, 20.0], "radius": 0.5 * diameter},
        "boundary": MIRRORS | BEYOND,
        "hole.tunnel.centre": [0.0, 0.0],
        "monitor": [],
        "run.duration": 0.1,
    }
    return build(with_changes(CASE, keys | changes))


def error(diameter: float, on: str) -> float:
    """RMS error over time of the radial displacement, mean over eight disks at 1.5 radii."""
    scene = quarter(diameter, **{"load.blast.on": on})
    disks = scene.positions[: scene.recorded]
    angles = np.radians(np.linspace(5.0, 85.0, 8))
    requested = 1.5 * RADIUS * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    nodes = [int(np.argmin(np.hypot(*(disks - place).T))) for place in requested]
    step = choose_step(scene)[0]
    record = Simulation(scene, step, nodes).advance(round(scene.case.run.duration / step))
    times, distances = step * np.arange(len(record)), np.hypot(*disks[nodes].T)
    wave = CASE.wave["burst"]
    exact = [cavity_motion(times, float(r), lambda t: PRESSURE * wave.velocity(t), RADIUS, SOLID) for r in distances]
    expected = np.mean([each.displacement for each in exact], axis=0)
    found = np.mean(np.sum(record[:, :, :2] * (disks[nodes] / distances[:, None]), axis=2), axis=1)
    return float(np.sqrt(np.sum((found - expected) ** 2) / np.sum(expected**2)))


@pytest.mark.parametrize(("on", "diameters_off"), [("outline", 0.25), ("bonds", 0.5)])
def test_the_rock_moves_as_round_the_exact_cavity(on: str, diameters_off: float) -> None:
    """Disks are removed whole, so that the wall has steps of up to a diameter.

    A slow pressure moves the rock by pa²/2μr, so a hole that is wider by kD moves it by 2kD/a more. Cut bonds push the
    disks beyond the steps, half a diameter behind the wall: k is below 1/2. The outline pushes the same disks, but
    with less force where these lie farther out: about half of that. The error halves with the diameter, but for the
    chance of the steps. A wrong sign or factor of two would be an error of 100 or 200 %.
    """
    coarse, fine = error(1.0, on), error(0.5, on)

    assert coarse < 2.0 * diameters_off * 1.0 / RADIUS
    assert fine < 2.0 * diameters_off * 0.5 / RADIUS
    assert fine < 0.7 * coarse


def test_a_steady_pressure_holds_a_body_open_that_nothing_else_holds(lab) -> None:
    """It is in balance, so the body comes to rest without supports, and stays where it is in the run."""
    tables = {
        "packing": {"pattern": "A", "size": [10.0, 10.0], "radius": 0.25},
        "hole": [{"name": "tunnel", "type": "circle", "centre": [5.1, 4.8], "radius": 2.0}],
        "load": [{"name": "gas", "hole": "tunnel", "pressure": 1e6}],
        "static": {"ratio": 1e-8},
        "boundary": {},
        "monitor": [],
    }
    scene = build(with_changes(CASE, tables))
    settled = settle(scene)
    moved, away = settled.start.displacement[:2].T, scene.positions - (5.1, 4.8)
    wall = scene.steady_load.any(axis=0)

    # outwards all round the wall, by about pa/2μ
    assert (np.sum(moved * away, axis=1)[wall] > 0.0).all()
    assert np.hypot(*moved[wall].T).mean() == pytest.approx(1e6 * 2.0 / (2.0 * SOLID.shear), rel=0.5)
    simulation = lab.simulation(scene, settled.start, probes=range(scene.count))
    # the forces that are left are balanced: a wave under this pressure would have p/ρc_p, 0.4 m/s
    assert np.abs(simulation.advance(200)[:, :, 3:]).max() < 1e-9
