"""The energy ledger of a box of disks in the ground closes under a wave, and after a static stage."""

import numpy as np
import pytest

from dembound.disks.rest.stage import settle
from dembound.disks.scene import build

SMALL, WHOLE = (20.0, 20.0, 40.0, 40.0), (0.0, 0.0, 60.0, 60.0)
WEIGHT = [{"acceleration": (0.0, -9.81)}]
STATIC = {"boundary": {"bottom": {"type": "fixed"}}, "ratio": 1e-3}
STEPS = 1500


@pytest.mark.parametrize(("box", "words"), [(WHOLE, {}), (SMALL, {"load": WEIGHT, "static": STATIC})])
def test_it_closes(lab, box, words) -> None:
    """Each step rounds by ε of the energies, or of what the balancing forces have stored."""
    scene = build(lab.window("B", box, hole=True, **words))
    simulation = lab.simulation(scene, settle(scene).start if words else None)
    ledger = lab.ledger(simulation, 50)
    simulation.run(STEPS)
    error = np.array([entry.error for entry in ledger.entries])
    most = max(entry.kinetic for entry in ledger.entries)
    largest = max(max(abs(entry.contact), abs(entry.load), entry.kinetic) for entry in ledger.entries)

    assert np.abs(error - error[0]).max() < 10.0 * STEPS * np.finfo(float).eps * largest
    assert ledger.entries[-1].damping > 0.1 * most  # waves have left
