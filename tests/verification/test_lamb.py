"""Lamb's problem on the isotropic lattice: free of sides, the exact half-space; with sides, their known errors.

The line load of Z section 3.2 acts on half a model with a mirror plane half a disk beyond the first column.
"""

from functools import cache

import numpy as np
import pytest
from small_cases import small

from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.exact.lamb import surface_displacement
from dembound.motion.simulation import Simulation
from dembound.waves import CubicSpline

DENSITY, SPEED, PULSE, FORCE = 2500.0, 300.0, 0.5, 450e3
SPRINGS = {"type": "viscoelastic", "alpha_n": 1.0, "alpha_s": 0.5}


def half_model(size: float, radius: float, side: dict) -> DiskScene:
    """Half a model, with a receiver some 10 m from the load."""
    top = size - radius
    side = side | ({"source": [0.0, size]} if side["type"] == "viscoelastic" else {})
    tables = {
        "packing": {"pattern": "A", "size": [size, size], "radius": radius},
        "material": {"density": DENSITY, "p_wave_speed": SPEED, "fric": 0.5},
        "boundary": {"left": {"type": "symmetry"}, "right": side, "bottom": side},
        "wave": {"pulse": {"type": "cubic_spline", "amplitude": 1.0, "period": PULSE}},
        "load": [{"name": "hammer", "force": [0.0, -0.5 * FORCE], "position": [radius, top], "wave": "pulse"}],
        "monitor": [{"name": "receiver", "position": [10.0 + radius, top]}],
        "run": {"duration": 1.0},
    }
    scene = build(small(tables))
    assert isinstance(scene, DiskScene)
    return scene


@cache
def exact(step: float, steps: int, distance: float) -> np.ndarray:
    """Exact motion of the half-space's surface, downwards, at this distance from the load."""
    pulse = CubicSpline(type="cubic_spline", amplitude=1.0, period=PULSE)
    speeds = SPEED, SPEED / np.sqrt(2.0)
    times = step * np.arange(steps)
    return surface_displacement(times, distance, lambda t: FORCE * pulse.velocity(t), DENSITY, *speeds)[1]


def receiver(size: float, radius: float, duration: float, sides: dict) -> tuple[np.ndarray, np.ndarray]:
    """Vertical displacement of the receiver, downwards, and the exact one."""
    scene = half_model(size, radius, sides)
    # the shortest wave of a model of 20 m is that of the infinite lattice but for (πR/20 m)² = 0.6 %, a small part of
    # the share that run.safety leaves
    step, _ = choose_step(half_model(20.0, radius, sides))
    node = scene.monitors["receiver"]
    record = Simulation(scene, step, np.array([node])).advance(int(duration / step))
    return -record[:, 0, 1], exact(step, len(record), float(scene.assembly.positions[node, 0]))


def rms(found: np.ndarray, expected: np.ndarray) -> float:
    """√(Σ(a − b)²/Σb²)."""
    return float(np.sqrt(np.sum((found - expected) ** 2) / np.sum(expected**2)))


def test_extended_model_is_the_half_space():
    """110 m are too far for anything to return within 0.7 s; load and receiver sit D/2 deep: (D/2x)² = 0.25 %.

    The pulse has passed after 0.55 s.
    """
    assert rms(*receiver(110.0, 0.5, 0.7, {"type": "fixed"})) < 0.0025


@pytest.mark.parametrize(("sides", "error"), [({"type": "viscous"}, 0.37), (SPRINGS, 0.21)], ids=["viscous", "springs"])
def test_known_errors_of_sides(sides, error):
    """For a 100 m model over 3 s, to the half per cent of their uncertainty and of the error of half-metre radii."""
    assert rms(*receiver(100.0, 0.5, 3.0, sides)) == pytest.approx(error, abs=0.0075)
