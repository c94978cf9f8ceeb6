"""A continuum of layers: its surface follows the exact column, and its absorbing layers are stable.

Slow ground guides waves, some of which run against their energy. In a layer that absorbs along one axis only these
grow: in the slow layer between rocks by 50 orders of magnitude in 20,000 steps.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from decay import kinetic
from grid_scene import GridScene, step_limit

from dembound.boundaries.support import SupportBuilder
from dembound.continuum.axis import Around, divided
from dembound.continuum.layer import Absorption
from dembound.continuum.medium import Layered, Medium
from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody
from dembound.exact.column import Column, Layer
from dembound.motion.simulation import Simulation

SPEEDS, DENSITIES, JOINTS, TOP = (700.0, 350.0, 200.0), (2300.0, 2000.0, 1800.0), (0.0, 40.0), 70.0
FREQUENCY, DELAY, DURATION = 3.0, 0.6, 3.0
NODES = 8.0
"""Nodes to a wavelength of S waves at three times the frequency of the pulse, where it has 1e-3 of its amplitude."""


def ricker(times: np.ndarray) -> np.ndarray:
    a = (np.pi * FREQUENCY * (times - DELAY)) ** 2
    return (1.0 - 2.0 * a) * np.exp(-a)


@pytest.mark.parametrize(("component", "faster"), [(0, 1.0), pytest.param(1, 2.0, marks=pytest.mark.slow)])
def test_surface_over_a_wave_from_below(component: int, faster: float) -> None:
    """S and P. Forces 2ρcv on the top of the lowest layer send the wave v up and down; the latter is absorbed."""
    media = tuple(Medium.isotropic(rho, 2.0 * c, c) for rho, c in zip(DENSITIES, SPEEDS, strict=True))
    base, *sizes = (4.0 / NODES * c / (3.0 * FREQUENCY) for c in SPEEDS)
    heights = (base,) * 4 + divided(JOINTS[1], sizes[0]) + divided(TOP - JOINTS[1], sizes[1])
    mesh = Mesh(
        order=4,
        widths=(sizes[1],),
        heights=heights,
        origin=(0.0, -4.0 * base),
        layer=Around(bottom=3),
        periodic=(True, False),
    )
    body = GridBody(mesh=mesh, medium=Layered(media, JOINTS))
    nodes = mesh.nodes[4, 0, :]
    area = 0.5 * sizes[1] * mesh.rule.weights
    area = np.array([area[nodes == node].sum() for node in np.unique(nodes)])
    builder = SupportBuilder()
    impedance = DENSITIES[0] * faster * SPEEDS[0]
    builder.add(np.unique(nodes), component, drive=2.0 * impedance * area, signal=ricker)
    steps = int(np.ceil(DURATION / (0.9 * step_limit(body))))
    simulation = Simulation(GridScene(body, supports=builder.table()), DURATION / steps)
    velocity = np.zeros(steps)
    for step in range(steps):
        simulation.run(step + 1)
        velocity[step] = simulation.state.velocity[component, mesh.nodes[-1, -1, 0]]

    layers = [Layer(30.0, DENSITIES[2], faster * SPEEDS[2]), Layer(40.0, DENSITIES[1], faster * SPEEDS[1])]
    column = Column([*layers, Layer(0.0, DENSITIES[0], faster * SPEEDS[0])])
    half = 0.5 * simulation.time_step
    exact = column.history(ricker(half * np.arange(2 * steps)), half)[1::2]
    assert np.abs(velocity - exact).max() < 5e-4 * np.abs(exact).max()


ROCK, SOIL = Medium.isotropic(2300.0, 1400.0, 700.0), Medium.isotropic(1800.0, 400.0, 200.0)
WET = Medium.isotropic(1800.0, 1000.0, 200.0)


def strip(media: Sequence[Medium], joints: Sequence[float], top: float, absorption: Absorption) -> Simulation:
    """Noise in ground on rock; elements 10 m wide, of 20 m at most in rock, and layers of three at three sides."""
    edges = [0.0, *joints, top][-len(media) - 1 :]
    rows = [
        divided(high - low, 20.0 if m is ROCK else 10.0) for m, (low, high) in zip(media, pairwise(edges), strict=True)
    ]
    mesh = Mesh(
        order=4,
        widths=(10.0,) * 12,
        heights=(20.0,) * 4 + tuple(height for row in rows for height in row),
        origin=(0.0, -80.0),
        layer=Around(3, 3, 3, 0),
    )
    body = GridBody(mesh=mesh, medium=Layered(tuple(media), tuple(joints)), absorption=absorption)
    return Simulation(GridScene(body), 0.9 * step_limit(body))


GROUNDS = {
    "slow between fast": ((ROCK, SOIL, ROCK), (20.0, 40.0), 60.0),
    "thin at the surface": ((ROCK, SOIL), (58.0,), 60.0),
    "wet": ((ROCK, WET), (30.0,), 60.0),
}


@pytest.mark.parametrize(
    "name", ["slow between fast", *(pytest.param(n, marks=pytest.mark.slow) for n in list(GROUNDS)[1:])]
)
def test_noise_decays(name: str) -> None:
    energies = kinetic(strip(*GROUNDS[name], Absorption()), [20_000, 40_000, 60_000])

    assert energies.max() < 2e-2
    assert energies[-1] < energies[0]


def test_in_layers_that_absorb_along_one_axis_it_grows() -> None:
    energies = kinetic(strip(*GROUNDS["slow between fast"], Absorption(guided=0.0)), [5_000, 10_000])

    assert energies[1] > 1e10
