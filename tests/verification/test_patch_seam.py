"""Zones of peridynamics fit into finite differences: no ghost force, no lost momentum, hardly an echo.

A bond of length p that takes the place of κp from each of the p springs it spans feels a wave e^{±jθi}, θ = kΔx, as

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
    complement: bool = True

    def begin(self, rod: Rod) -> Bonds:
        bonds = Bonds(rod, self.horizon, complement=self.complement)
        for first, last in self.zones:
            bonds.add_zone(first, last)
        return bonds


def with_zones(scene: BarScene, zones: list[tuple[int, int]], horizon: int = 3, complement: bool = True) -> BarScene:
    method = Zones(type="patch", horizon=horizon, zones=zones, complement=complement)
    return replace(scene, case=replace(scene.case, method=method))


@pytest.fixture(scope="module")
def echo(rock):
    """Measures the share of a wave's amplitude that comes back from a long zone, at so many cells per wavelength.

    A tapered burst passes the gauge twice; its spectra at its own frequency do not suffer from its shortness. The run
    is over before the ends' echoes come.
    """

    def measure(cells: float, horizon: int = 3, complement: bool = True, courant: float = 0.5) -> float:
        spacing = rock.length / CELLS
        step = courant * spacing / rock.speed
        theta = 2.0 * np.pi / cells
        frequency = 2.0 * np.arcsin(courant * np.sin(0.5 * theta)) / (2.0 * np.pi * step)  # of central differences
        burst = {"type": "sine_burst", "amplitude": 1.0, "frequency": frequency, "cycles": CYCLES}
        plain = rock.scene({"type": "patch", "horizon": horizon}, spacing=spacing, load={"pressure": 1e6}, wave=burst)
        scene = with_zones(plain, [(SEAM, CELLS + 1)], horizon, complement)
        steps = int((2 * SEAM + GAUGE) / courant)
        velocity = Simulation(scene, step, np.array([GAUGE])).advance(steps)[:, 0, 3]
        split = int(SEAM / courant)
        time = step * np.arange(steps)
        passing = velocity * np.exp(-2j * np.pi * frequency * time)
        return float(abs(passing[split:].sum() / passing[:split].sum()))

    return measure


@pytest.mark.parametrize("cells", [20, 30, 60])
@pytest.mark.parametrize("horizon", [2, 3, 4, 5])
def test_echo_of_a_long_zone(echo, horizon, cells):
    """The next term is smaller by about θ², 10 % with 20 cells."""
    theta = 2.0 * np.pi / cells
    assert echo(cells, horizon) == pytest.approx((horizon**2 - 1) * theta**2 / 96.0, rel=theta**2)


def test_echo_in_round_numbers(echo):
    """With m = 3; the same whatever the time step, as that acts alike on both sides."""
    assert echo(20) <= 0.01
    assert echo(60) <= 0.001
    for courant in (0.2, 0.9):
        assert echo(20, courant=courant) == pytest.approx(0.085 * (2.0 * np.pi / 20) ** 2, rel=0.1)


def test_without_complement_springs_the_seam_echoes(echo):
    """The seam is too soft over some cells, so the echo grows with θ, not with its square: 6 % at 60 cells."""
    short, long = echo(40, complement=False), echo(60, complement=False)
    assert 0.03 < long < 0.07
    assert short == pytest.approx(1.5 * long, rel=(2.0 * np.pi / 40) ** 2)
    assert long > 50.0 * echo(60)


ZONES = {
    "one": [(40, 70)],
    "close": [(40, 70), (72, 90)],
    "merged": [(40, 70), (65, 90)],
    "touching": [(40, 70), (70, 90)],
    "at the left end": [(0, 25)],
    "near the right end": [(80, 99)],
    "all": [(0, 101)],
    "as small as can be": [(50, 52)],
}


def forces(bonds: Bonds, u: np.ndarray) -> np.ndarray:
    """Forces (n,) N on all nodes by the kernel, none of them left to the stencil of plain ones."""
    arrays, force = bonds.arrays(np.arange(len(u)), 1.0), np.empty(len(u))
    bar.forces(u, arrays, force)
    return force


@pytest.mark.parametrize("zones", ZONES.values(), ids=ZONES.keys())
@pytest.mark.parametrize("horizon", [1, 3, 8])
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


def test_momentum_is_the_impulse(rock):
    """Through both zones, to and fro: sums of n velocities, each rounded by ε of the fastest at each of the steps."""
    pulse = rock.triangle(0.12e-3)
    plain = rock.scene({"type": "patch", "horizon": 3}, load={"pressure": 10e6}, wave=pulse)
    scene = with_zones(plain, [(300, 420), (700, 1001)])
    step = rock.step(scene, 0.9)
    simulation = Simulation(scene, step)
    simulation.advance(400)
    impulse = 10e6 * np.sum(scene.case.wave["pulse"].velocity(step * np.arange(400))) * step
    worst = 0.0
    for _ in range(20):
        simulation.advance(100)
        worst = max(worst, abs(np.sum(scene.mass * simulation.state.velocity[0]) - impulse))
    fastest = 2.0 * 10e6 / (rock.density * rock.speed)
    assert worst < EPS * fastest * scene.mass.sum() * np.sqrt(simulation.state.step)
