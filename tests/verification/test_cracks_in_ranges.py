"""Ranges of a bar have their own fracture energy, and pieces that meet again push each other like any rock."""

import numpy as np
import pytest
import tomli_w

from dembound.bar.fracture import spalls
from dembound.bar.scene import build_bar
from dembound.casefile import Case
from dembound.kinds import loads
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

DENSITY, SPEED, STRENGTH = 2500.0, 2000.0, 10e6
ENERGIES = {"left": 1600.0, "right": 3000.0}
"""Fracture energies, J/m²."""


def case(spacing: float, wave: dict, bar: dict, **tables) -> Case:
    """A bar of finite differences under a wave, with more keys of its table, and more tables."""
    whole = {"spacing": spacing, "density": DENSITY, "wave_speed": SPEED} | bar
    method, run = {"type": "finite_difference"}, {"duration": 1.0}
    return loads(tomli_w.dumps({"bar": whole, "method": method, "wave": {"w": wave}, "run": run} | tables))


@pytest.mark.parametrize(
    ("weaker", "side"), [("left", (0.0, 0.1)), pytest.param("right", (0.1, 0.2), marks=pytest.mark.slow)]
)
def test_the_weaker_range_breaks_and_takes_its_own_energy(weaker, side):
    """Pulled apart slowly. Up to 2 % more for the waves of the pulling end, 2ρc·0.05 m/s or 5 % of the strength.

    These carry other planes beyond the strength, which take 2·0.05 of the strain energy of the weaker range,
    ½σ_t²·0.1 m/E = 500 J/m² at most.
    """
    speed = 0.05
    ranges = [
        {"name": name, "length": 0.1, "strength": STRENGTH if name == weaker else 15e6, "fracture_energy": energy}
        for name, energy in ENERGIES.items()
    ]
    ends = {"left": {"type": "fixed"}, "right": {"type": "velocity", "wave_p": "w"}}
    scene = build_bar(case(0.005, {"type": "constant", "amplitude": speed}, {"range": ranges}, boundary=ends))
    simulation = Simulation(scene, 0.9 * 0.005 / SPEED)
    opening = 2.0 * ENERGIES[weaker] / STRENGTH
    ledger = Ledger(simulation, 5)
    simulation.track(ledger)
    simulation.run(5 * int(1.5 * opening / speed / simulation.time_step / 5) + 1)
    (found,) = spalls(simulation.system.parts[0].bonds, scene.positions[:, 0], simulation.time_step)
    assert side[0] <= found.start[0] < found.start[1] <= side[1]
    crack = [entry.crack for entry in ledger.entries]
    assert 0.995 * ENERGIES[weaker] <= crack[-1] <= ENERGIES[weaker] + 0.1 * 500.0
    assert np.all(np.diff(crack) >= 0.0)
    came_in = max(entry.outside for entry in ledger.entries)
    assert max(abs(entry.error) for entry in ledger.entries) <= 5e-13 * came_in


def test_pressure_passes_through_an_open_crack_that_is_closed():
    """A bar broken in the middle, both pieces at rest and touching, transmits a pulse as if it were whole.

    Finite differences at cΔt = Δx carry it without error, to rounding: 200 steps of some ε of 1 m/s.
    """
    bar = {"length": 1.0, "strength": STRENGTH, "fracture_energy": 1000.0}
    hit = [{"name": "hit", "pressure": 5e6, "wave": "w"}]
    wave = {"type": "cosine", "amplitude": 1.0, "period": 1e-4}
    given = case(0.01, wave, bar, load=hit, boundary={"right": {"type": "viscous"}})
    records = []
    for broken in (False, True):
        simulation = Simulation(build_bar(given), 0.01 / SPEED, np.array([25, 75]))
        (part,) = simulation.system.parts
        part.bonds.stop_triggering()  # all springs are in the hands of the kernel of cracks
        if broken:
            bundle = part.bonds.opening.bundle
            bundle.row[0], bundle.first[0], bundle.whole[0] = -1, 50, part.bonds.spring[50]
            bundle.limit[0], bundle.apart[0], bundle.furthest[0] = 2e-5, 2e-4, 3e-4
            bundle.listed[0] = 1
            part.bonds.spring[50], part.bonds.spring_broken[50] = 0.0, 0
        part.restore(part.saved_arrays())
        records.append(simulation.advance(100)[:, :, 3])
    whole, cracked = records
    assert whole.max() > 0.9
    np.testing.assert_allclose(cracked, whole, rtol=0.0, atol=1e-12)
