"""Disks with a continuum in layered ground follow the exact column: a box on three sides, and rock below a body.

Pattern A, D = 1 m: soil of 200 m/s on rock of 400 m/s from y = 20 m down, under a Ricker pulse of 3 Hz from below; the
shortest wave in the soil, at three times that frequency, is 22 D long.
"""

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


@pytest.mark.parametrize("quality", [None, 20.0], ids=["undamped", "damped"])
@pytest.mark.parametrize("height", [30.0, 10.0], ids=["joint in the box", "rock below"])
def test_a_box_moves_as_the_ground(height: float, quality: float | None) -> None:
    """All its disks; the continuum, which has the scattered motion, is at rest."""
    sides = {key: {"type": "outside"} for key in ("left", "right", "bottom")}
    incident = {"type": "sv", "angle": 0.0, "wave": "pulse", "point": [0.0, -25.0]}
    scene = build(case(20.0, height, sides, 0.9, quality=quality, incident=incident))
    waves = scene.ground_waves
    simulation = Simulation(scene, choose_step(scene)[0])
    disks, moved, off, rest = len(scene.assembly.radii), 0.0, 0.0, 0.0
    while simulation.time < 0.89:
        simulation.run(simulation.state.step + 10)
        time = np.array([simulation.time - 0.5 * simulation.time_step])
        exact = waves.motion("velocity", time, scene.positions[:disks])[0].T[:2]
        found = simulation.state.velocity[:2]
        moved, off = max(moved, np.abs(exact).max()), max(off, np.abs(found[:, :disks] - exact).max())
        rest = max(rest, np.abs(found[:, disks:]).max())
    assert moved > 2.5
    assert off < 1e-3 * moved
    assert rest < 1e-3 * moved


@pytest.mark.parametrize(("kind", "component"), [("s", 0), ("p", 1)])
def test_the_surface_over_rock_below(kind: str, component: int) -> None:
    """A periodic body of 10 m that ends 10 m above the rock: its surface follows the incident wave in the rock."""
    boundary = {key: {"type": "periodic"} for key in ("left", "right")} | {
        "bottom": {"type": "outside", f"wave_{kind}": "pulse"}
    }
    plain = case(10.0, 10.0, boundary, 1.2)
    scene = build(plain)
    simulation = Simulation(scene, choose_step(scene)[0])
    up = scene.assembly.positions[:, 1]
    top = int(np.argmax(up))
    steps = int(1.2 / simulation.time_step)
    velocity = np.zeros(steps)
    for step in range(steps):
        simulation.run(step + 1)
        velocity[step] = simulation.state.velocity[component, top]

    soil, rock = (
        Layer(TOP - JOINT, each.material.density, each.material.wave_speeds(1)[component == 0])
        for each in scene.ground.layers[::-1]
    )
    half = 0.5 * simulation.time_step
    incident = plain.wave["pulse"].velocity(half * np.arange(2 * steps))
    exact = Column([soil, rock]).history(incident, half, TOP - up[top])[1::2]
    assert np.abs(velocity - exact).max() < 1e-3 * np.abs(exact).max()
