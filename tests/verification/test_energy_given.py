"""What a run was given is what each of boundaries and loads brought in: lifting ground is no energy from nothing.

A P wave from below lifts settled ground. What its weight takes the settled reactions give, which do not count; the sum
of what boundaries and weight bring in then stays below zero, and measured by that every rounding would be a gain.
"""

import numpy as np

from dembound.disks.rest.stage import settle
from dembound.motion.energy import Ledger


def test_a_wave_that_lifts_ground_under_gravity_runs_through(lab):
    rollers = {"left": {"type": "roller"}, "right": {"type": "roller"}, "bottom": {"type": "fixed"}}
    scene = lab.scene(
        "B",
        (20.0, 20.0),
        held=(),
        material={"law": "linearpbond", "fric": 0.5},
        boundary={"left": "roller", "right": "roller", "bottom": {"type": "viscous_input", "wave_p": "pulse"}},
        wave={"type": "cosine", "amplitude": 0.02, "period": 0.05},
        load=[{"acceleration": [0.0, -9.81]}],
        static={"boundary": rollers},
    )
    simulation = lab.settled(scene, settle(scene).start)
    ledger = Ledger(simulation, 20)
    simulation.track(ledger)
    while simulation.time < 0.1:
        simulation.advance(20)
    came = np.array([entry.outside + entry.load for entry in ledger.entries])
    given = max(entry.outside for entry in ledger.entries)
    assert came.max() < 0.1 * given
    assert max(abs(entry.error) for entry in ledger.entries) < 1e-3 * given
