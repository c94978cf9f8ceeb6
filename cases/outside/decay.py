"""Noise in a continuum with absorbing layers, without and round disks: its kinetic energy over many steps."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from grid_scene import GridScene, step_limit

from dembound import api
from dembound.continuum.layer import Absorption
from dembound.continuum.medium import Medium
from dembound.continuum.mesh import Around, Mesh
from dembound.continuum.part import GridBody
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.motion.simulation import Simulation

MEAN = 50
"""Steps over which kinetic energies are averaged."""

HOLE = {"name": "hole", "type": "circle", "centre": [20.0, 10.0], "radius": 4.0}


def kinetic(simulation: Simulation, steps: Sequence[int], seed: int = 3) -> np.ndarray:
    """Kinetic energies (k,) up to each of the steps, ascending, over that of the noise the run begins with.

    All components that can move have velocities of the same expected energy.
    """
    scene = simulation.scene
    mass = np.stack([scene.mass, scene.mass, scene.inertia])
    noise = np.random.default_rng(seed).standard_normal(mass.shape) * scene.moves / np.sqrt(mass)
    simulation.state.velocity = noise
    start, energies = float(np.sum(mass * noise**2)), []
    for last in steps:
        simulation.run(last - MEAN)
        total = 0.0
        for _ in range(MEAN):
            simulation.run(simulation.state.step + 1)
            total += float(np.sum(mass * simulation.state.velocity**2))
        energies.append(total / MEAN / start)
    return np.array(energies)


def grid_alone(
    ratio: float = 0.25,
    delay: float = Absorption.delay,
    box: tuple[int, int, int, int] | None = None,
    order: int = 4,
) -> Simulation:
    """Elements of 10 m with layers of three at three sides and R0 = 1e-4, and a free surface, at 0.9 of the limit.

    ratio : Poisson's, of plane strain; delay : k of the layers; box : elements left out; order : of the elements.
    """
    slower = float(np.sqrt((1.0 - 2.0 * ratio) / (2.0 - 2.0 * ratio)))
    mesh = Mesh.uniform(order=order, element=(10.0, 10.0), cells=(12, 6), layer=Around(3, 3, 3, 0), box=box)
    medium = Medium.isotropic(2500.0, 1000.0, 1000.0 * slower)
    body = GridBody(mesh=mesh, medium=medium, absorption=Absorption(delay=delay))
    return Simulation(GridScene(body), 0.9 * step_limit(body))


def disks_and_grid(pattern: str = "A", fric: float = 0.5, element: float = 8.0) -> Simulation:
    """40 m × 20 m of disks of 1 m with a hole, a continuum on three sides, and the automatic step.

    pattern : of the packing; fric : 0 makes C66 = K/4 of the lattice, else ν is 0; element : largest side, m.
    """
    packing: dict[str, Any] = {"pattern": pattern, "size": [40.0, 20.0], "radius": 0.5}
    if pattern == "B":
        packing |= {"radius_ratio": 1.5, "brick": [10.0, 10.0], "seed": 1}
    case = api.case(
        packing=packing,
        material={"density": 2500.0, "p_wave_speed": 1000.0, "fric": fric},
        boundary={side: {"type": "outside"} for side in ("left", "right", "bottom")},
        outside={"element": element, "margin": 1, "layers": 3, "reflection": 1e-4},
        hole=[HOLE],
        run={"duration": 1.0},
    )
    scene = build(case)
    return Simulation(scene, choose_step(scene)[0])


def step_beside(spacing: float, pattern: str = "A") -> float:
    """The automatic step (s) with so many diameters between the nodes of the continuum, in the mean."""
    return disks_and_grid(pattern, element=4.0 * spacing).time_step
