"""A wave passes a joint with |T| = 1/|1 + iωZ/2k| (Schoenberg 1980): the joint is a spring in the rock, and no more.

Behind it the velocity follows v′ = 2k/Z (v_incident − v), whose solution is compared with that of the disks at the
same time step, of a lattice with and without the joint.
"""

import numpy as np
import pytest

from dembound.disks.scene import build
from dembound.kinds import with_changes

JOINT, BEHIND, END = 15.0, 25.0, 40.0
STIFFNESS = 4e8  # ωZ/2k is 1.6 at the middle of the pulse's spectrum


def passed(lab, stiffness):
    """Time step and mean velocity at 25 m of a P pulse of 12 m that meets a joint of a stiffness, or none."""
    boundary = {"left": {"type": "velocity", "wave_p": "pulse"}}
    case = lab.case("A", (END, 2.5), boundary=boundary, wave=lab.pulse(0.012))
    joint = {"name": "joint", "points": [[JOINT, -1.0], [JOINT, 4.0]], "kn": stiffness, "ks": stiffness}
    scene = build(with_changes(case, {"joint": [joint]} if stiffness else {}))
    # until the wave that the joint sends back to the left end is back
    step = 3e-4
    probes = np.flatnonzero(np.abs(scene.positions[:, 0] - BEHIND) < 0.6 * lab.diameter)
    history = lab.run(scene, probes, (2.0 * JOINT + BEHIND) / lab.speed - 2e-3, step)
    return history.velocity[:, :, 0].mean(axis=1), step


@pytest.mark.parametrize("stiffness", [STIFFNESS, STIFFNESS / 4.0])
def test_what_passes(lab, stiffness):
    alone, step = passed(lab, 0.0)
    behind, _ = passed(lab, stiffness)
    half = stiffness / (lab.density * lab.speed) * step
    expected = np.zeros_like(alone)
    for k in range(1, len(alone)):  # by the trapezoidal rule
        expected[k] = ((1.0 - half) * expected[k - 1] + half * (alone[k] + alone[k - 1])) / (1.0 + half)
    # dispersion of the pulse on its way is in both; the lattice's joint acts between two rows, half a diameter from
    # either: (πD/λ)²/6 = 3e-3 of the shortest waves, of 24 diameters
    assert np.abs(alone).max() > 0.45
    error = np.sqrt(np.mean((behind - expected) ** 2) / np.mean(expected**2))
    assert error < 5e-3
    np.testing.assert_allclose(np.abs(behind).max(), np.abs(expected).max(), rtol=5e-3)
