"""A load that stays on a half-space: the displacement beside it for sides of several types, and the exact one.

In two dimensions the displacement under a constant load goes on as ln t: the ground in motion becomes ever larger, and
all of it beyond the particles is that of the sides.
"""

from typing import Any

import numpy as np
from grid_scene import GridScene, step_limit

from dembound import api
from dembound.accuracy.of_disks.exact import exact_motions
from dembound.continuum.medium import Medium
from dembound.continuum.mesh import Around, Mesh
from dembound.continuum.part import GridBody
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.exact.lamb import surface_displacement
from dembound.motion.simulation import Simulation

RADIUS, SPEED = 0.25, 300.0
"""Radius (m) and wave speed (m/s) of Z's problem, section 3.2. The lattice is isotropic, ν = 0."""

WIDTH, HEIGHT = 25.5, 10.0
"""Size of the body, m: 51 × 20 disks."""

SETTINGS: dict[str, Any] = {"element": 6.4, "margin": 1, "layers": 3, "reflection": 1e-4}
"""Keys of [outside]: elements of 6.4 m × 5 m."""

DISTANCE = 10.0
"""Distance from the load to the receiver, m: 20 disks."""

RISE = 0.5
"""s, in which the load is put on."""

SIDES = ("left", "right", "bottom")

TYPES: dict[str, dict[str, Any]] = {
    "viscous": {"type": "viscous"},
    "viscoelastic": {"type": "viscoelastic", "source": (0.5 * WIDTH, HEIGHT)},
    "outside": {"type": "outside"},
}


def half_space(side: str = "outside", duration: float = 20.0, **keys: Any) -> api.Case:
    """A force of 450 kN that is put on and stays, on the middle of a body's surface.

    side : a key of `TYPES`; keys : of [outside] in place of `SETTINGS`.
    """
    middle, top = 0.5 * WIDTH, HEIGHT - RADIUS
    return api.case(
        packing={"pattern": "A", "size": [WIDTH, HEIGHT], "radius": RADIUS},
        material={"density": 2500.0, "p_wave_speed": SPEED, "fric": 0.5},
        boundary=dict.fromkeys(SIDES, TYPES[side]),
        wave={"on": {"type": "constant", "amplitude": 1.0, "rise": RISE}},
        load=[{"name": "weight", "position": [middle, top], "force": [0.0, -450e3], "wave": "on"}],
        monitor=[{"name": "receiver", "position": [middle + DISTANCE, top]}],
        run={"duration": duration},
        outside=SETTINGS | keys,
    )


def settlement(case: api.Case, times: np.ndarray) -> np.ndarray:
    """Displacement of the receiver at times (k,) s, downwards, m."""
    scene = build(case)
    step = choose_step(scene)[0]
    record = Simulation(scene, step, [scene.monitors["receiver"]]).advance(int(times[-1] / step) + 2)
    return -np.interp(times, step * np.arange(len(record)), record[:, 0, 1])


def inner(case: api.Case) -> float:
    """L, the larger side of what lies within the layers, m."""
    outside = build(case).outside
    assert outside is not None
    return outside.body.mesh.inner


def rule(reached: np.ndarray | float) -> np.ndarray | float:
    """Missing part of the displacement near a load at c_p t/L from 70 to 200, within a quarter, for R0 = 1e-4."""
    return 6e-7 * reached**2


def exact_settlement(case: api.Case, times: np.ndarray) -> np.ndarray:
    """Settlement (k,) m of the half-space."""
    receiver = exact_motions(build(case))[1]["receiver"]
    return -receiver.at(times).displacement[:, 1]


def on_a_grid(ratio: float, times: np.ndarray, elements: int = 3) -> tuple[np.ndarray, np.ndarray, float]:
    """Settlement (k,) m beside a unit force on a continuum without disks at times (k,) s, exact one, and L_inner, m.

    ratio : Poisson's; elements : of 10 m, and twice as many along the surface, within three layers. c_p is `SPEED`.
    """
    slow = SPEED * float(np.sqrt((1.0 - 2.0 * ratio) / (2.0 - 2.0 * ratio)))
    mesh = Mesh.uniform(order=4, element=(10.0, 10.0), cells=(2 * elements + 6, elements + 3), layer=Around(3, 3, 3, 0))
    body = GridBody(mesh=mesh, medium=Medium.isotropic(2500.0, SPEED, slow))
    top = np.flatnonzero(mesh.positions[:, 1] == mesh.positions[:, 1].max())
    x = mesh.positions[top, 0]
    middle, receiver = (int(np.argmin(np.abs(x - 0.5 * mesh.size[0] - away))) for away in (0.0, 2.0 * DISTANCE))
    load = np.zeros((3, body.count))
    load[1, top[middle]] = -1.0
    step = 0.9 * step_limit(body)
    simulation = Simulation(GridScene(body, load=load), step, top[[receiver]])
    record = simulation.advance(int(times[-1] / step) + 2)
    found = -np.interp(times, step * np.arange(len(record)), record[:, 0, 1])
    expected = surface_displacement(times, x[receiver] - x[middle], np.ones_like, 2500.0, SPEED, slow)[1]
    return found, expected, mesh.inner
