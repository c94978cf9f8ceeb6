"""The ends of a bar: free and fixed ones reflect all, a viscous one lets a wave leave, or come in.

A dashpot ρcA on half a node, under a wave e^{jωt}(e^{−jθi} + R e^{jθi}) of central differences, θ = kΔx, gives

    R = (ν sin θ − sin ωΔt)/(ν sin θ + sin ωΔt) ≈ −(1 − ν²)θ²/16,    ν = cΔt/Δx :

nothing comes back at ν = 1. Soft ends of peridynamics are in test_where_methods_fail_bars.
"""

import numpy as np
import pytest

from dembound.exact import Lattice
from dembound.motion.simulation import Simulation

CELLS, GAUGE, CYCLES = 1600, 1000, 6
CENTRAL = {"type": "finite_difference"}


CORRECTED = {"type": "peridynamics", "horizon": 3, "corrected_ends": True}


@pytest.fixture(scope="module")
def echo(rock):
    """Measures how the right end reflects velocity and stress, R each, at so many cells per wavelength.

    From the spectra, at the burst's own frequency, of what passes the gauge on the way there and back.
    """

    def measure(method: dict, end: str, cells: float, courant: float = 0.5) -> np.ndarray:
        spacing = rock.length / CELLS
        step = courant * spacing / rock.speed
        theta = 2.0 * np.pi / cells
        lattice = Lattice(method.get("horizon", 1), spacing, step, rock.speed)
        frequency = float(lattice.frequency(theta / spacing)) / (2.0 * np.pi)
        scene = rock.scene(
            method,
            spacing=spacing,
            load={"pressure": 1e6},
            wave={"type": "sine_burst", "amplitude": 1.0, "frequency": frequency, "cycles": CYCLES},
            boundary={"right": {"type": end}},
        )
        steps, split = int((2 * CELLS + GAUGE) / courant), int(CELLS / courant)
        motion = Simulation(scene, step, np.array([GAUGE])).advance(steps)[:, 0, [3, 6]]
        motion = motion * np.exp(-2j * np.pi * frequency * step * np.arange(steps))[:, None]
        return motion[split:].sum(axis=0) / motion[:split].sum(axis=0) * np.exp(2j * theta * (CELLS - GAUGE))

    return measure


@pytest.mark.parametrize(("end", "sign"), [("free", 1.0), ("fixed", -1.0)])
def test_free_and_fixed_ends_reflect_all(echo, end, sign):
    """Velocity comes back as it is from a free end, stress from a fixed one, the other reversed.

    To rounding at ν = 1; with m = 3 to (mθ)³, as a corrected end has no softness and no mass too much.
    """
    np.testing.assert_allclose(echo(CENTRAL, end, 20, 1.0), [sign, -sign], rtol=0, atol=1e-12)
    third = (3 * 2.0 * np.pi / 80) ** 3
    np.testing.assert_allclose(echo(CORRECTED, end, 80), [sign, -sign], rtol=0, atol=third)


def test_viscous_end_takes_all_at_courant_one(echo):
    """To rounding: its dashpot leaves the half node nothing of its velocity, whatever the wavelength."""
    for cells in (4, 60):
        assert np.abs(echo(CENTRAL, "viscous", cells, 1.0)).max() < 1e-12


@pytest.mark.parametrize(("cells", "courant"), [(60, 0.1), (20, 0.5)])
def test_echo_of_a_viscous_end(echo, cells, courant):
    """The next term is smaller by about θ²."""
    theta = 2.0 * np.pi / cells
    expected = -(1.0 - courant**2) * theta**2 / 16.0
    assert echo(CENTRAL, "viscous", cells, courant)[0] == pytest.approx(expected, rel=theta**2)


def test_wave_comes_in_through_a_viscous_end(rock):
    """At every node it is the incident wave, sample by sample at ν = 1."""
    wave = rock.triangle(0.12e-3)
    end = {"type": "viscous_input", "wave_p": "pulse"}
    scene = rock.scene(CENTRAL, spacing=5e-3, wave=wave, boundary={"left": end, "right": {"type": "viscous"}})
    step = rock.step(scene, 1.0)
    nodes = np.array([0, 77, 200])
    simulation = Simulation(scene, step, nodes)
    velocity = simulation.advance(600)[:, :, 3]
    expected = scene.case.wave["pulse"].velocity(step * np.arange(600)[:, None] - nodes * step)
    np.testing.assert_allclose(velocity, expected, rtol=0, atol=1e-12)
    assert np.abs(simulation.state.velocity[0]).max() < 1e-12
