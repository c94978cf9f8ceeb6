"""Zones of peridynamics fit into finite differences: no ghost force, no lost momentum, hardly an echo.

A bond of length p that replaces κp of each of the p springs it spans has under a wave e^{±jθi}, θ = kΔx, the force

    κ[(Σ_i e^{jθi})² − p Σ_i e^{2jθi}] ~ κ[(sin(pθ/2)/sin(θ/2))² − p sin(pθ)/sin θ],  about κp²(p² − 1)θ²/12.

These are the sources of an echo. Springs of stiffness k pass it on with 2 tan(θ/2)/2k, and the bonds of a half-infinite
zone add up to 1/|1 − e^{2jθ}|. With k = EA/Δx, κ = k(2/m²)w_p/p, Σ w_p p = m²/2 and Σ w_p p³ = (m⁴ + m²)/4 the
amplitude is (m² − 1)θ²/96 for long waves: with m = 3 that is 0.083 θ².
"""

from dataclasses import replace

import numpy as np
import pytest

from dembound.bar.scene import BarScene
from dembound.kernels import bar
from dembound.methods import Patch
from dembound.methods.bonds import Bonds
from dembound.methods.rod import Rod
from dembound.motion.simulation import Simulation

CELLS = 1600
SEAM, GAUGE, CYCLES = 900, 450, 6
EPS = np.finfo(float).eps


class Zones(Patch):
    """Patches that are there from the start."""

    zones: list[tuple[int, int]]

    def begin(self, rod: Rod) -> Bonds:
        bonds = Bonds(rod, self.horizon, complement=True)
        for first, last in self.zones:
            bonds.add_zone(first, last)
        return bonds


def with_zones(scene: BarScene, zones: list[tuple[int, int]], horizon: int = 3) -> BarScene:
    method = Zones(type="patch", horizon=horizon, zones=zones)
    return replace(scene, case=replace(scene.case, method=method))


@pytest.fixture(scope="module")
def echo(rock):
    """Measures the share of a wave's amplitude that comes back from a long zone, at so many cells per wavelength.

    A tapered burst passes the gauge twice; its spectra at its own frequency do not suffer from its shortness. The run
    is over before the ends' echoes come.
    """

    def measure(cells: float, horizon: int, courant: float = 0.5) -> float:
        spacing = rock.length / CELLS
        step = courant * spacing / rock.speed
        theta = 2.0 * np.pi / cells
        frequency = 2.0 * np.arcsin(courant * np.sin(0.5 * theta)) / (2.0 * np.pi * step)  # of central differences
        burst = {"type": "sine_burst", "amplitude": 1.0, "frequency": frequency, "cycles": CYCLES}
        plain = rock.scene({"type": "patch", "horizon": horizon}, spacing=spacing, load={"pressure": 1e6}, wave=burst)
        scene = with_zones(plain, [(SEAM, CELLS + 1)], horizon)
        steps = int((2 * SEAM + GAUGE) / courant)
        velocity = Simulation(scene, step, np.array([GAUGE])).advance(steps)[:, 0, 3]
        split = int(SEAM / courant)
        time = step * np.arange(steps)
        passing = velocity * np.exp(-2j * np.pi * frequency * time)
        return float(abs(passing[split:].sum() / passing[:split].sum()))

    return measure


@pytest.mark.parametrize(("cells", "horizon"), [(20, 2), (60, 3), (30, 5)])
def test_echo_of_a_long_zone(echo, horizon, cells):
    """The next term is smaller by about θ², 10 % with 20 cells."""
    theta = 2.0 * np.pi / cells
    assert echo(cells, horizon) == pytest.approx((horizon**2 - 1) * theta**2 / 96.0, rel=theta**2)


ZONES = {
    "one": [(40, 70)],
    "merged": [(40, 70), (65, 90)],
    "touching": [(40, 70), (70, 90)],
    "at the left end": [(0, 25)],
    "all": [(0, 101)],
    "as small as can be": [(50, 52)],
}


def forces(bonds: Bonds, u: np.ndarray) -> np.ndarray:
    """Forces (n,) N on all nodes by the kernel, none of them left to the stencil of plain ones."""
    arrays, force = bonds.arrays(np.arange(len(u)), 1.0), np.empty(len(u))
    bar.forces(u, arrays, force)
    return force


@pytest.mark.parametrize("zones", ZONES.values(), ids=ZONES.keys())
@pytest.mark.parametrize("horizon", [3, 8])
def test_no_ghost_forces(rock, zones, horizon):
    """Rigid motion pulls nowhere, uniform strain as much on either side of a node; but for rounding.

    A node adds up 2m + 2 pulls, none stronger than EAε, from displacements rounded by ε of themselves, up to a hundred
    springs' elongation.
    """
    scene = with_zones(rock.scene({"type": "patch", "horizon": horizon}, spacing=0.01), zones, horizon)
    (part,) = Simulation(scene, 1e-7).system.parts
    displacement = np.zeros((3, scene.count))
    displacement[0] = 1.0
    assert not forces(part.bonds, displacement[0]).any()
    strain = 1e-4
    displacement[0] = strain * scene.positions[:, 0]
    (part_of_rod,) = scene.rod.ranges
    pull = part_of_rod.modulus * part_of_rod.section * strain
    expected = np.zeros(scene.count)
    expected[[0, -1]] = pull, -pull
    tolerance = (2 * horizon + 2) * EPS * pull * scene.count
    np.testing.assert_allclose(forces(part.bonds, displacement[0]), expected, rtol=0, atol=tolerance)
    np.testing.assert_allclose(part.stress(displacement), part_of_rod.modulus * strain, rtol=1e-12)
