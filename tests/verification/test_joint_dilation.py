"""A joint that slides rises by tan ψ per slip up to its end, and the ledger closes.

Friction then takes (τ − σ tan ψ) Δs, as the rest of the work of shear lifts what lies on the joint.
"""

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.kinds import with_changes

FRICTION, ANGLE, END = 0.6, 10.0, 0.02
KEYS = {"fric": FRICTION, "dilation": ANGLE, "dilation_end": END}
TAN = np.tan(np.radians(ANGLE))


@pytest.mark.parametrize("end", [None, 0.01])
def test_under_a_given_pressure_it_rises(lab, end):
    """A block pushed along the joint under its weight, from rest, by 4 cm."""
    case = lab.case(
        "A", (4.0, 3.0), held=(), boundary={"bottom": "fixed"}, wave={"type": "constant", "amplitude": 1.0},
        load=[{"acceleration": [0.0, -400.0]}, {"acceleration": [600.0, 0.0], "wave": "pulse"}],
    )  # fmt: skip
    keys = {key: value for key, value in (KEYS | {"dilation_end": end}).items() if value is not None}
    joint = {"name": "joint", "points": [[-1.0, 1.5], [5.0, 1.5]], "kn": 4e8, "ks": 4e8} | keys
    scene = build(with_changes(case, {"joint": [joint]}))
    simulation = lab.simulation(scene)
    ledger = lab.ledger(simulation, 50)
    simulation.run(round(0.03 / simulation.time_step))
    slip, opening, push = simulation.system.joint_samples(np.array([simulation.state.step - 1]))[0, 0, :3]
    assert slip > 0.04
    # what the joint opens is the rise less its elastic closure, at every moment
    kn = simulation.system.joints[0].faces.stiffness[0]
    np.testing.assert_allclose(opening, TAN * min(slip, end or np.inf) - push / kn, atol=1e-9 + 2e-4 * TAN * slip)
    entry = ledger.entries[-1]
    assert abs(entry.error) < 1e-6 * entry.supplied
    # had friction the work that lifts the block, τ Δs in place of (τ − σ tan ψ) Δs, this were −tan ψ/(μ − tan ψ) =
    # −42 % of it, as long as it rises; dashpots across the joint and pairs that part take 1.1 and 2.2 %
    assert 0.0 <= entry.closing < 0.03 * entry.friction
