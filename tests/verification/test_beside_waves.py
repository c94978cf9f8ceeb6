"""Errors by sides along a plane wave are predicted without a run; compared with runs with free fields there."""

import numpy as np
import pytest
from small_cases import small

from dembound.casefile.disks import DiskCase
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.formulas.disks.beside_wave import taken_from_waves
from dembound.motion.simulation import Simulation
from dembound.results.compare import relative_error

POINTS = 0.03
"""Largest difference of shares.

Nodes are up to half an element from the monitors, a 36th of the body, over which shares between 0 and 1 vary.
"""


def case(motion: str, side: dict) -> DiskCase:
    """40 × 24 disks of 1 m, a pulse 1.25 (S) or 1.8 (P) times as long as high through the bottom."""
    made = small(
        {
            "packing": {"pattern": "A", "size": [40.0, 24.0], "radius": 0.5},
            "material": {"density": 2500.0, "p_wave_speed": 1000.0, "fric": 0.5},
            "boundary": {"left": side, "right": side, "bottom": {"type": "viscous_input", f"wave_{motion}": "pulse"}},
            "wave": {"pulse": {"type": "cosine", "amplitude": 0.01, "period": 0.0425}},
            "monitor": [
                {"name": "middle", "position": [20.0, 12.0]},
                {"name": "surface", "position": [20.0, 23.5]},
                {"name": "beside", "position": [3.0, 16.0]},
            ],
            "run": {"duration": 0.12},
        }
    )
    assert isinstance(made, DiskCase)
    return made


def velocities(of: DiskCase, component: int) -> np.ndarray:
    """Velocity (n, m) of the disks at the monitors."""
    scene = build(of)
    simulation = Simulation(scene, choose_step(scene)[0])
    disks = [scene.monitors[monitor.name] for monitor in of.monitor]
    rows = []
    for step in range(1, int(of.run.duration / simulation.time_step)):
        simulation.run(step)
        rows.append(simulation.state.velocity[component, disks])
    return np.array(rows)


@pytest.mark.parametrize(
    ("motion", "side"),
    [
        ("s", {"type": "viscous"}),
        ("p", {"type": "viscoelastic", "distance": 20.0}),
        ("s", {"type": "free", "artificial": True}),
    ],
    ids=["S, viscous", "P, viscoelastic", "S, free"],
)
def test_the_share_that_sides_take_is_foreseen(motion: str, side: dict) -> None:
    held_back = case(motion, side)
    component = 0 if motion == "s" else 1
    beside, whole = (velocities(of, component) for of in (held_back, case(motion, {"type": "free_field"})))
    measured = [relative_error(own - far, far) for own, far in zip(beside.T, whole.T, strict=True)]
    (found,) = taken_from_waves(build(held_back))

    assert found.sides == ["left", "right"]
    assert list(found.shares.values()) == pytest.approx(measured, abs=POINTS)
    assert min(measured) > 0.3
