"""Ranges of a bar have their own fracture energy, and pieces that meet again push each other like any rock."""

import numpy as np
import pytest
import tomli_w

from dembound.bar.fracture import spalls
from dembound.bar.scene import build_bar
from dembound.kinds import loads
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

DENSITY, SPEED, STRENGTH = 2500.0, 2000.0, 10e6
LEFT, RIGHT = 1600.0, 3000.0
"""Fracture energies, J/m²."""


def pulled(strengths: tuple[float, float]) -> tuple[Simulation, Ledger, list]:
    """A bar of two ranges of 0.1 m, pulled apart slowly at its right end."""
    speed = 0.05
    ranges = [
        {"name": "left", "length": 0.1, "strength": strengths[0], "fracture_energy": LEFT},
        {"name": "right", "length": 0.1, "strength": strengths[1], "fracture_energy": RIGHT},
    ]
    tables = {
        "bar": {"spacing": 0.005, "density": DENSITY, "wave_speed": SPEED, "range": ranges},
        "method": {"type": "finite_difference"},
        "wave": {"pull": {"type": "constant", "amplitude": speed}},
        "boundary": {"left": {"type": "fixed"}, "right": {"type": "velocity", "wave_p": "pull"}},
        "run": {"duration": 1.0},
    }
    scene = build_bar(loads(tomli_w.dumps(tables)))
    simulation = Simulation(scene, 0.9 * 0.005 / SPEED)
    opening = 2.0 * (LEFT if strengths[0] < strengths[1] else RIGHT) / STRENGTH
    steps = 5 * int(1.5 * opening / speed / simulation.time_step / 5) + 1
    ledger = Ledger(simulation, 5)
    simulation.track(ledger)
    simulation.run(steps)
    bonds = simulation.system.parts[0].bonds
    return simulation, ledger, spalls(bonds, scene.positions[:, 0], simulation.time_step)


@pytest.mark.parametrize(
    ("strengths", "energy", "side"), [((STRENGTH, 15e6), LEFT, (0.0, 0.1)), ((15e6, STRENGTH), RIGHT, (0.1, 0.2))]
)
def test_the_weaker_range_breaks_and_takes_its_own_energy(strengths, energy, side):
    """Up to 2 % more for the waves of the pulling end, 2ρc·0.05 m/s or 5 % of the strength at the fixed one.

    These carry other planes beyond the strength, which take 2·0.05 of the strain energy of the weaker range,
    ½σ_t²·0.1 m/E = 500 J/m² at most.
    """
    _, ledger, found = pulled(strengths)
    assert len(found) == 1
    assert side[0] <= found[0].start[0] < found[0].start[1] <= side[1]
    crack = [entry.crack for entry in ledger.entries]
    assert 0.995 * energy <= crack[-1] <= energy + 0.1 * 500.0
    assert np.all(np.diff(crack) >= 0.0)
    came_in = max(entry.outside for entry in ledger.entries)
    assert max(abs(entry.error) for entry in ledger.entries) <= 5e-13 * came_in


def test_pressure_passes_through_an_open_crack_that_is_closed():
    """A bar broken in the middle, both pieces at rest and touching, transmits a pulse as if it were whole.

    Finite differences at cΔt = Δx carry it without error, to rounding: 200 steps of some ε of 1 m/s.
    """
    tables = {
        "bar": {
            "length": 1.0,
            "spacing": 0.01,
            "density": DENSITY,
            "wave_speed": SPEED,
            "strength": STRENGTH,
            "fracture_energy": 1000.0,
        },
        "method": {"type": "finite_difference"},
        "wave": {"push": {"type": "cosine", "amplitude": 1.0, "period": 1e-4}},
        "load": [{"name": "hit", "pressure": 5e6, "wave": "push"}],
        "boundary": {"right": {"type": "viscous"}},
        "run": {"duration": 1.0},
    }
    case = loads(tomli_w.dumps(tables))
    records = []
    for broken in (False, True):
        scene = build_bar(case)
        simulation = Simulation(scene, 0.01 / SPEED, np.array([25, 75]))
        bonds = simulation.system.parts[0].bonds
        bonds.stop_triggering()  # all springs are in the hands of the kernel of cracks
        if broken:
            bundle = bonds.opening.bundle
            bundle.row[0], bundle.first[0], bundle.whole[0] = -1, 50, bonds.spring[50]
            bundle.limit[0], bundle.apart[0], bundle.furthest[0] = 2e-5, 2e-4, 3e-4
            bundle.listed[0] = 1
            bonds.spring[50], bonds.spring_broken[50] = 0.0, 0
        simulation.system.parts[0].recall(simulation.system.parts[0].memory())
        records.append(simulation.advance(100)[:, :, 3])
    whole, cracked = records
    assert whole.max() > 0.9
    np.testing.assert_allclose(cracked, whole, rtol=0.0, atol=1e-12)
