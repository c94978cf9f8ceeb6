"""A pulse to and fro in a bar loses its shape as the dispersion relation says, more with each passage and horizon.

L section 3.2: 1 m, E = 20 GPa, 2620 kg/m³, nodes 5 mm apart, steps of 1 µs, a triangle of 8.9 MPa, 0.04 and 0.12 ms
long, stress in the middle. Errors are root mean squares over a passage L/c, in parts of the exact pulse's.

Under a load p on its half end node a bar of central differences has the stress −p e^{j(ωt − kx)} without any factor:
the spring's pull kᵤ(1 − e^{−jθ}) less the inertia 2kᵤ sin²(θ/2) is j kᵤ sin θ, as is the mean pull of both planes
beside a node. So the samples' spectrum, each frequency with its own k(ω) of L eq. 12, is the whole solution.
"""

import numpy as np
import pytest

from dembound.exact import Lattice, bar_stress
from dembound.motion.simulation import Simulation

SPACING, STEP, PASSAGES = 5e-3, 1e-6, 4
MODULUS, PRESSURE, PULSE = 20e9, 8.9e6, 0.12e-3
HORIZONS = [1, 2, 4, 8]
SAMPLES = 2**15  # long enough for all that a flat spectrum spreads in time


class Middle:
    """Stress in the middle of the bar, simulated, exact, and as a lattice would have it."""

    def __init__(self, rock, method: dict) -> None:
        words = {"load": {"pressure": PRESSURE}, "wave": rock.triangle(PULSE), "youngs_modulus": MODULUS}
        self.scene = rock.scene(method, spacing=SPACING, **words)
        self.pulse = self.scene.case.wave["pulse"].velocity
        self.wait = rock.length / self.scene.case.bar.speed
        self.time = STEP * np.arange(int(PASSAGES * self.wait / STEP))

    def simulated(self) -> np.ndarray:
        simulation = Simulation(self.scene, STEP, np.array([self.scene.count // 2]))
        return simulation.advance(len(self.time))[:, 0, 6]

    def exact(self) -> np.ndarray:
        """That of d'Alembert."""
        bar = self.scene.case.bar
        return bar_stress(0.5 * bar.length, self.time, lambda t: PRESSURE * self.pulse(t), bar.length, bar.speed)

    def dispersed(self, horizon: int) -> np.ndarray:
        """The same of waves that run as L eq. 12 says; shorter ones than the lattice carries do not run at all."""
        lattice = Lattice(horizon, SPACING, STEP, self.scene.case.bar.speed)
        wavenumber = np.linspace(0.0, lattice.shortest, 20_000)
        frequency = np.maximum.accumulate(lattice.frequency(wavenumber))
        wanted = 2.0 * np.pi * np.fft.rfftfreq(SAMPLES, STEP)
        spectrum = PRESSURE * np.fft.rfft(self.pulse(STEP * np.arange(SAMPLES))) * (wanted <= frequency[-1])
        way = np.interp(wanted, frequency, wavenumber) * self.scene.case.bar.length
        arrivals = sum((-1.0) ** (k + 1) * np.exp(-1j * way * (k + 0.5)) for k in range(PASSAGES))
        return np.fft.irfft(spectrum * arrivals)[: len(self.time)]

    def errors(self, stress: np.ndarray) -> np.ndarray:
        """Of every passage (PASSAGES,), relative to the exact stress."""
        number = (self.time // self.wait).astype(int)
        squares = [np.bincount(number, (part) ** 2) for part in (stress - self.exact(), self.exact())]
        return np.sqrt(squares[0] / squares[1])


@pytest.fixture(scope="module")
def errors(rock):
    """Measured errors of a method."""

    def of(method: dict) -> np.ndarray:
        middle = Middle(rock, method)
        return middle.errors(middle.simulated())

    return of


def test_errors_grow_with_the_horizon_and_the_passage(errors):
    """Peridynamics as L has it, its ends soft; finite differences, m = 1 with whole ends, are the best of all."""
    methods = [{"type": "peridynamics", "horizon": horizon} for horizon in HORIZONS]
    table = np.array([errors(method) for method in ({"type": "finite_difference"}, *methods)])
    assert np.all(np.diff(table, axis=0) > 0.0)
    assert np.all(np.diff(table, axis=1) > 0.0)


def test_finite_differences_disperse_as_the_lattice(rock):
    """To the 20,000 entries of the table of k(ω), worst at its end, where waves stand still."""
    middle = Middle(rock, {"type": "finite_difference"})
    np.testing.assert_allclose(middle.simulated(), middle.dispersed(1), rtol=0, atol=1e-4 * PRESSURE)


@pytest.mark.parametrize("horizon", HORIZONS)
def test_peridynamics_disperses_as_the_lattice(rock, horizon):
    """With corrected ends, which add an echo (m² − 1)θ²/96 each (test_bar_ends).

    A way of N cells shifts a phase by Nθ³(m² + 1)/48, so an end counts for some 1/(2θ) cells of it: with wavelengths of
    a third of a pulse, 22 cells, for two of a hundred and more, and both ends for less than 5 % of the error.
    """
    middle = Middle(rock, {"type": "peridynamics", "horizon": horizon, "corrected_ends": True})
    measured, expected = (middle.errors(stress) for stress in (middle.simulated(), middle.dispersed(horizon)))
    np.testing.assert_allclose(measured, expected, rtol=0.05)
