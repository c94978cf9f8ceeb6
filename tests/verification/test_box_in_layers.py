"""Disks with a continuum in layered ground follow the exact column: a box on three sides, and rock below a body.

Pattern A, D = 1 m: soil of 200 m/s on rock of 400 m/s from y = 20 m down, under a Ricker pulse of 3 Hz from below; the
shortest wave in the soil, at three times that frequency, is 22 D long.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from dembound import api
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.exact.column import Column, Layer
from dembound.motion.simulation import Simulation

TOP, JOINT = 40.0, 20.0


SIDES = {key: {"type": "outside"} for key in ("left", "right", "bottom")}


def case(
    width: float,
    height: float,
    boundary: dict[str, dict[str, str]],
    duration: float,
    *,
    quality: float | None = None,
    **more: Any,
) -> DiskCase:
    damped = {} if quality is None else {"quality_factor": quality}
    return api.case(
        packing={"pattern": "A", "size": [width, height], "radius": 0.5, "origin": [-0.5 * width, TOP - height]},
        material={"density": 2300.0, "s_wave_speed": 400.0, "fric": 0.5} | damped,
        layer=[{"bottom": JOINT, "density": 1800.0, "s_wave_speed": 200.0}, {}],
        boundary=boundary,
        wave={"pulse": {"type": "ricker", "frequency": 3.0, "amplitude": 1.0}},
        outside={"accuracy": 2e-3},
        run={"duration": duration},
        **more,
    )


def exact(plain: DiskCase, kind: str, times: np.ndarray, depth: float, height: float) -> np.ndarray:
    """Velocity at times (k,) s, evenly spaced from 0 on, over the pulse at a height (m) in the rock, at a depth, m."""
    soil, rock = (
        Layer(TOP - JOINT, each.material.density, each.material.wave_speeds(1)[kind == "s"])
        for each in build(plain).ground.layers[::-1]
    )
    incident = plain.wave["pulse"].velocity(times - (JOINT - height) / rock.speed)
    return Column([soil, rock]).history(incident, times[1], depth)


@pytest.mark.parametrize(
    "quality", [pytest.param(None, marks=pytest.mark.slow, id="undamped"), pytest.param(20.0, id="damped")]
)
@pytest.mark.parametrize("height", [30.0, pytest.param(10.0, marks=pytest.mark.slow)])
def test_a_box_moves_as_the_ground(height: float, quality: float | None) -> None:
    """All its disks; the continuum, which has the scattered motion, is at rest."""
    incident = {"type": "sv", "angle": 0.0, "wave": "pulse", "point": [0.0, -25.0]}
    scene = build(case(20.0, height, SIDES, 0.9, quality=quality, incident=incident))
    waves, disks = scene.ground_waves, len(scene.assembly.radii)
    simulation = Simulation(scene, choose_step(scene)[0])
    moved, off, rest = 0.0, 0.0, 0.0
    while simulation.time < 0.89:
        simulation.run(simulation.state.step + 40)
        time = np.array([simulation.time - 0.5 * simulation.time_step])
        expected = waves.motion("velocity", time, scene.positions[:disks])[0].T[:2]
        found = simulation.state.velocity[:2]
        moved, off = max(moved, np.abs(expected).max()), max(off, np.abs(found[:, :disks] - expected).max())
        rest = max(rest, np.abs(found[:, disks:]).max())
    assert moved > 2.5
    assert off < 1e-3 * moved
    assert rest < 1e-3 * moved


MONITORS = {"disk": [0.0, 39.5], "soil": [18.0, 25.0], "rock": [-18.0, 15.0], "below": [5.0, 3.0]}


@pytest.mark.slow
def test_monitors_of_a_box_in_layers(tmp_path: Path) -> None:
    """Under a wave from straight below: in the disks and in the continuum at both sides of the joint, without hole."""
    monitors = [{"name": name, "position": place} for name, place in MONITORS.items()]
    incident = {"type": "sv", "angle": 0.0, "wave": "pulse", "point": [0.0, -25.0]}
    plain = case(20.0, 30.0, SIDES, 0.9, incident=incident, monitor=monitors)
    results = api.run(plain, tmp_path / "run")
    waves = build(plain).ground_waves
    for name in MONITORS:
        history = results.histories[name]
        place = np.array([history.attributes["position"]])
        expected = waves.motion("velocity", history["time"], place)[:, 0, 0]
        assert np.abs(history["velocity"][:, 0] - expected).max() < 2e-3 * np.abs(expected).max(), name


@pytest.mark.parametrize("height", [30.0, pytest.param(10.0, marks=pytest.mark.slow)])
def test_a_box_beside_its_column(height: float) -> None:
    """Waves enter through the foot of a free-field column, with the joint in both or below both.

    The box moves as the column, whose surface moves as that of the ground.
    """
    plain = case(20.0, height, SIDES | {"bottom": {"type": "outside", "wave_s": "pulse"}}, 0.9)
    scene = build(plain)
    column, disks = scene.column_count, len(scene.assembly.radii)
    up = scene.assembly.positions[:, 1]
    top = int(np.argmax(up[:column]))
    simulation = Simulation(scene, choose_step(scene)[0], [top])
    records, apart, rest = [], 0.0, 0.0
    while simulation.time < 0.89:
        records.append(simulation.advance(10))
        found = simulation.state.velocity[:2]
        apart = max(apart, np.abs(found[:, column:disks] - found[:, scene.twin[column:disks]]).max())
        rest = max(rest, np.abs(found[:, scene.outside.nodes]).max())
    velocity = np.concatenate(records)[:, 0, 3]
    times = simulation.time_step * np.arange(len(velocity))
    expected = exact(plain, "s", times, TOP - up[top], min(TOP - height, JOINT))
    peak = np.abs(expected).max()
    assert np.abs(velocity - expected).max() < 1e-3 * peak
    assert max(apart, rest) < 1e-9 * peak


@pytest.mark.parametrize(("kind", "component"), [("s", 0), ("p", 1)])
def test_the_surface_over_rock_below(kind: str, component: int) -> None:
    """A periodic body of 10 m that ends 10 m above the rock: its surface follows the incident wave in the rock."""
    boundary = {key: {"type": "periodic"} for key in ("left", "right")} | {
        "bottom": {"type": "outside", f"wave_{kind}": "pulse"}
    }
    plain = case(10.0, 10.0, boundary, 1.2)
    scene = build(plain)
    up = scene.assembly.positions[:, 1]
    top = int(np.argmax(up))
    simulation = Simulation(scene, choose_step(scene)[0], [top])
    velocity = simulation.advance(int(1.2 / simulation.time_step))[:, 0, 3 + component]
    times = simulation.time_step * np.arange(len(velocity))
    expected = exact(plain, kind, times, TOP - up[top], JOINT)
    assert np.abs(velocity - expected).max() < 1e-3 * np.abs(expected).max()
