"""A plane wave at an angle enters a box of disks in layered ground on all its sides; without a hole nothing scatters.

Pattern A, D = 1 m, layers of 200, 350 and 700 m/s: 10 m, 15 m, and rock below. Waves at 2.5 times the frequency of a
Ricker pulse of 2 Hz are 40 D long in the uppermost layer.
"""

import numpy as np
import pytest

from dembound import api
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

LAYERS = [
    {"thickness": 10.0, "density": 1800.0, "s_wave_speed": 200.0},
    {"name": "sand", "thickness": 15.0, "density": 2000.0, "s_wave_speed": 350.0},
    {},
]


def case(kind: str, angle: float, frequency: float, **more) -> DiskCase:
    return api.case(
        packing={"pattern": "A", "size": [10.0, 30.0], "radius": 0.5, "origin": [-5.0, -30.0]},
        material={"density": 2300.0, "s_wave_speed": 700.0, "fric": 0.5},
        boundary={side: {"type": "outside"} for side in ("left", "right", "bottom")},
        wave={"pulse": {"type": "ricker", "frequency": frequency, "amplitude": 1.0}},
        incident={"type": kind, "angle": angle, "wave": "pulse"},
        outside={"accuracy": 2e-3},
        run={"duration": 2.6 / frequency},
        **{"layer": LAYERS} | more,
    )


def deviations(kind: str, frequency: float) -> tuple[float, float]:
    """Largest deviation of any disk, and velocity of any node of the continuum, over the largest velocity."""
    scene = build(case(kind, 25.0, frequency))
    waves, disks, simulation = scene.ground_waves, scene.disk_count, Simulation(scene, choose_step(scene)[0])
    peak, off, grid = 0.0, 0.0, 0.0
    while simulation.time < 2.5 / frequency:
        simulation.run(simulation.state.step + 20)
        at, found = np.array([simulation.time - 0.5 * simulation.time_step]), simulation.state.velocity[:2]
        expected = waves.motion("velocity", at, scene.positions[:disks])[0].T[:2]
        peak, off = max(peak, np.abs(expected).max()), max(off, np.abs(found[:, :disks] - expected).max())
        grid = max(grid, np.abs(found[:, disks:]).max())
    assert peak > 2.2
    return off / peak, grid / peak


@pytest.mark.parametrize("kind", ["sv", pytest.param("p", marks=pytest.mark.slow)])
def test_nothing_is_scattered_beyond_errors_of_second_order(kind: str) -> None:
    """At 40 D in the shortest wave, and 20 D."""
    fine, coarse = (max(deviations(kind, frequency)) for frequency in (2.0, 4.0))
    assert fine < 1e-3
    assert coarse > 2.5 * fine


def test_the_ledger_closes_and_what_comes_in_leaves(lab) -> None:
    """Through the left side and from below, in each layer by its waves."""
    scene = build(case("sv", 25.0, 4.0))
    simulation = lab.simulation(scene, side_stride=1)
    ledger = lab.ledger(simulation, 50)
    simulation.run(int(1.4 / simulation.time_step))
    came_in, left, _ = np.sum(ledger.side_columns[-1], axis=0)
    assert left == pytest.approx(came_in, rel=5e-3)
    most = max(entry.kinetic for entry in ledger.entries)
    assert max(abs(entry.error) for entry in ledger.entries) < 10.0 * simulation.state.step * np.finfo(float).eps * most


def test_an_angle_beyond_the_critical_one_of_a_layer_is_refused() -> None:
    """P waves run flat in the rock, of 990 m/s, under S waves at 45°; in stiffer sand before."""
    line = "incident.angle: is {}; from the critical angle of layer {} on, {} degrees, a wave no longer runs through it"
    stiff = [LAYERS[0], LAYERS[1] | {"s_wave_speed": 900.0}, {}]
    for angle, changes, name, critical in ((50.0, {}, "3", 45), (-40.0, {"layer": stiff}, "sand", -33.365)):
        with pytest.raises(Exception, match=line.format(f"{angle:g}", name, critical)):
            build(case("sv", angle, 2.0, **changes))
