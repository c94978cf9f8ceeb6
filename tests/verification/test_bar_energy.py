"""The books of a bar close to rounding, whatever the method, the ends, and what breaks.

Kinetic energy ½m v⁻·v⁺, strain energy ½k e² and work F·½(v⁻ + v⁺)Δt add up exactly for central differences. A spring
of length e⁻ a step ago and e now takes ½k e⁻e with it when it breaks, and a change of method between two steps adds
the difference of ½u⁻ᵀKu. Both are what the balance of half steps has in the place of strain energy.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from dembound.motion.energy import Entry, Ledger
from dembound.motion.simulation import Simulation

ROUNDING = 5e-13
"""Of the energy that came in: some 500 steps of sums of 500 terms, each rounded by ε of that, either way."""

METHODS = {
    "finite_difference": {"type": "finite_difference"},
    "peridynamics": {"type": "peridynamics", "horizon": 3},
    "corrected ends": {"type": "peridynamics", "horizon": 3, "corrected_ends": True},
    "switch": {"type": "switch", "horizon": 3},
    "switch from one spacing": {"type": "switch", "horizon": 3, "before": "peridynamics"},
    "patch": {"type": "patch", "horizon": 3},
}


@dataclass(frozen=True)
class Books:
    """A run that is over, and the entries of its ledger."""

    simulation: Simulation
    entries: list[Entry]


@pytest.fixture(params=METHODS.values(), ids=METHODS.keys())
def books(request, rock):
    """Keeps the books of a bar, an entry every eleven steps, while a pulse comes in, is reflected and goes on."""

    def keep(**words) -> Books:
        words = {"load": {"pressure": 15e6}, "wave": rock.triangle(0.12e-3)} | words
        scene = rock.scene(request.param, spacing=4e-3, **words)
        simulation = Simulation(scene, rock.step(scene, 0.9))
        ledger = Ledger(simulation, 11)
        simulation.track(ledger)
        steps = 0.9e-3 / simulation.time_step  # until all of the pulse has been at both ends, and been back
        simulation.run(11 * int(steps / 11) + 1)
        return Books(simulation, ledger.entries)

    return keep


def check_closed(kept: Books) -> None:
    came_in = max(entry.outside for entry in kept.entries)
    assert came_in > 0.0
    assert max(abs(entry.error) for entry in kept.entries) <= ROUNDING * came_in


def test_unbroken(books):
    kept = books()
    check_closed(kept)
    assert kept.entries[-1].crack == 0.0


def test_through_fracture_and_change_of_method(books):
    kept = books(strength=10e6)
    check_closed(kept)
    last = kept.entries[-1]
    assert last.crack > 0.0
    changed = len(kept.simulation.state.laws) > 1
    assert (abs(last.law_switch) > ROUNDING * last.outside) == changed


def test_torn_at_an_end(books):
    """Where local springs of corrected ends break as well."""
    kept = books(load={"pressure": -15e6}, strength=10e6)
    check_closed(kept)
    assert np.all(kept.simulation.system.take_cracks(kept.simulation.state.step).position[0] < 0.02)
    assert kept.entries[-1].crack != 0.0


def test_with_attenuation(books):
    kept = books(attenuation=0.52, strength=5e6)
    check_closed(kept)
    assert kept.entries[-1].crack > 0.0
    damping = [entry.damping for entry in kept.entries]
    assert np.all(np.diff(damping) >= 0.0)
    assert damping[-1] > 0.0


def test_with_a_viscous_end(books):
    """Which takes what attenuation has left, but for an echo below a tenth of the amplitude."""
    kept = books(boundary={"right": {"type": "viscous"}}, attenuation=0.52)
    check_closed(kept)
    last = kept.entries[-1]
    assert last.outside - last.damping < 0.01 * max(entry.outside for entry in kept.entries)


def test_with_a_wave_from_a_viscous_end(books):
    end = {"type": "viscous_input", "wave_p": "pulse"}
    kept = books(load=None, boundary={"left": end}, strength=5e6)
    check_closed(kept)
    assert kept.entries[-1].crack > 0.0


def test_between_fixed_ends(books):
    kept = books(boundary={"right": {"type": "fixed"}}, strength=5e6)
    check_closed(kept)
    assert kept.entries[-1].crack > 0.0  # at the left end, which the pulse comes back to


def test_through_cracks_with_a_fracture_energy(books):
    """Pieces open, come off and meet again; what cracks take never decreases."""
    kept = books(strength=5e6, fracture_energy=100.0, load={"pressure": 15e6})
    check_closed(kept)
    crack = [entry.crack for entry in kept.entries]
    assert crack[-1] > 0.0
    assert np.all(np.diff(crack) >= 0.0)
