"""A layered bar compared with d'Alembert's sum: signals at the gauges of the shipped split Hopkinson bar.

With r = (Z₁ − Z₂)/(Z₁ + Z₂) of the bars and of the specimen between them, both pairs of faces in contact, a pulse −σ is
transmitted in steps −σ(1 − r^(2k)) after k ways to and fro in the specimen. What is reflected is +σ r^(2k − 1), as the
forces on both faces differ by one passage. At ν = 1 in every range finite differences are that solution.
"""

from pathlib import Path

import numpy as np

from dembound.bar.scene import build_bar
from dembound.bar.stability import unit_step
from dembound.casefile.bar import BarCase
from dembound.kinds import load, with_changes
from dembound.motion.energy import Ledger
from dembound.motion.simulation import Simulation

CASE = Path(__file__).parents[2] / "cases" / "shpb.toml"


def unshaped() -> BarCase:
    """The case without its pulse shaper, the gauges in the middle of their bars."""
    case = load(CASE)
    ranges = [each.model_dump(exclude_unset=True) for each in case.bar.range if each.name != "pulse_shaper"]
    ranges[1]["interface"] = "contact"  # of the striker, in place of the shaper's bond
    gauges = [{"name": "incident_gauge", "position": 0.8}, {"name": "transmitted_gauge", "position": 2.0109}]
    changed = with_changes(case, {"bar.range": ranges, "monitor": gauges})
    assert isinstance(changed, BarCase)
    return changed


def test_gauges_see_the_steps_of_a_specimen() -> None:
    case = unshaped()
    striker, incident, specimen, _ = case.bar.parts
    scene = build_bar(case)
    step = unit_step(scene)  # at the limit, where bodies may drift once a contact has opened, fronts are exact
    simulation = Simulation(scene, step, scene.probes)
    ledger = Ledger(simulation, 50)
    simulation.track(ledger)
    record = simulation.advance(round(case.run.duration / step))
    before, after = record[:, 0, 6], record[:, 1, 6]

    pulse = 0.5 * incident.density * incident.speed * case.bar.range[0].velocity
    first, second = (part.density * part.speed * part.area for part in (incident, specimen))
    r = (first - second) / (first + second)
    to_face, across = incident.length / 2.0 / incident.speed, specimen.length / specimen.speed
    length = 2.0 * striker.length / striker.speed
    back = 3.0 * to_face
    for k in range(1, 1 + int(length / (2.0 * across))):
        # each step without the samples next to its front
        low, high = ((2 * k - 2) * across, 2 * k * across)
        through = slice(round((back + across + low) / step) + 2, round((back + across + high) / step) - 1)
        np.testing.assert_allclose(after[through], -pulse * (1.0 - r ** (2 * k)), rtol=1e-10)
        sent_back = slice(round((back + low) / step) + 2, round((back + high) / step) - 1)
        np.testing.assert_allclose(before[sent_back], pulse * r ** (2 * k - 1), rtol=1e-10)
    # nothing else has passed the first gauge than the pulse itself
    quiet = slice(round((to_face + length) / step) + 2, round(back / step) - 1)
    assert np.abs(before[quiet]).max() < 1e-10 * pulse
    assert max(abs(entry.error) for entry in ledger.entries) < 1e-12 * ledger.entries[-1].supplied
