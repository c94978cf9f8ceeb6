"""The books of a bar close to rounding, whatever the method, the ends, and what breaks.

Kinetic energy ½m v⁻·v⁺, strain energy ½k e² and work F·½(v⁻ + v⁺)Δt add up exactly for central differences. A spring
of length e⁻ a step ago and e now takes ½k e⁻e with it when it breaks, and a change of method between two steps adds
the difference of ½u⁻ᵀKu. Both are what the balance of half steps has in the place of strain energy.
"""

import numpy as np
import pytest

from dembound.motion.simulation import Simulation

ROUNDING = 5e-13
"""Rounding over the energy that came in: some 500 steps of sums of 500 terms, each rounded by ε of that, either way."""

METHODS = {
    "finite_difference": {"type": "finite_difference"},
    "peridynamics": {"type": "peridynamics", "horizon": 3},
    "corrected ends": {"type": "peridynamics", "horizon": 3, "corrected_ends": True},
    "switch": {"type": "switch", "horizon": 3},
    "switch from one spacing": {"type": "switch", "horizon": 3, "before": "peridynamics"},
    "patch": {"type": "patch", "horizon": 3},
}
IN = {"left": {"type": "viscous_input", "wave_p": "pulse"}}
BARS = {
    "unbroken": {},
    "fracture and change of method": {"strength": 10e6},
    "torn at an end": {"load": {"pressure": -15e6}, "strength": 10e6},
    "attenuation": {"attenuation": 0.52, "strength": 5e6},
    "viscous end": {"boundary": {"right": {"type": "viscous"}}, "attenuation": 0.52},
    "wave from a viscous end": {"load": None, "boundary": IN, "strength": 5e6},
    "fixed end": {"boundary": {"right": {"type": "fixed"}}, "strength": 5e6},  # breaks when the pulse is back
    "cracks that open and close": {"strength": 5e6, "fracture_energy": 100.0},
}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in ("unbroken", "fixed end") else name for name in BARS]
)
def test_books_close(lab, rock, name, method):
    """An entry every eleven steps, while a pulse comes in, has been at both ends, and is back."""
    words = {"load": {"pressure": 15e6}, "wave": rock.triangle(0.12e-3)} | BARS[name]
    scene = rock.scene(METHODS[method], spacing=4e-3, **words)
    simulation = Simulation(scene, rock.step(scene, 0.9))
    ledger = lab.ledger(simulation, 11)
    simulation.run(11 * int(0.9e-3 / simulation.time_step / 11) + 1)
    came_in, last = max(entry.outside for entry in ledger.entries), ledger.entries[-1]
    assert came_in > 0.0
    assert max(abs(entry.error) for entry in ledger.entries) <= ROUNDING * came_in
    assert (last.crack != 0.0) == ("strength" in words)

    if name == "fracture and change of method":
        changed = len(simulation.state.laws) > 1
        assert (abs(last.law_switch) > ROUNDING * last.outside) == changed
    if name == "torn at an end":  # where local springs of corrected ends break as well
        assert np.all(simulation.system.take_cracks(simulation.state.step).position[0] < 0.02)
    if "attenuation" in words:
        assert np.all(np.diff([entry.damping for entry in ledger.entries]) >= 0.0)
        assert last.damping > 0.0
    if name == "viscous end":  # which takes what attenuation has left, but for an echo below a tenth of the amplitude
        assert last.outside - last.damping < 0.01 * came_in
    if name == "cracks that open and close":  # what they take never decreases
        assert np.all(np.diff([entry.crack for entry in ledger.entries]) >= 0.0)
