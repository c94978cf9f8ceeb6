"""Estimated errors of artificial sides are those beside the same disks without an end.

Lamb's problem, half of it, 20 m × 20 m of a lattice beside viscous and viscoelastic sides. The truth is the difference
of the run to the same disks with sides so far away that nothing returns within it; the estimate comes from two or three
runs with three times larger disks, of which 14 are in the shortest S wave that matters. What such disks disperse
changes echoes that run s = 40 m by a phase of qs(qD)²/24, 0.2 rad at the wave of 14 disks, so that the size of an error
is met within some per cent; a factor of 1.3 also holds at places where echoes cancel in part. The sizes themselves are
16 to 48 %, so that no other factor (a half, the ratio of diameters 3, its square) is within it.
"""

from dataclasses import replace

import numpy as np
import pytest
from small_cases import Tables, small

from dembound.accuracy.budget import Budget
from dembound.accuracy.estimate import causes_of
from dembound.accuracy.judge import extended
from dembound.accuracy.runner import measure
from dembound.formulas.cause import SIDES
from dembound.formulas.history import History
from dembound.running import Progress

SPRINGS: Tables = {"type": "viscoelastic", "alpha_n": 1.0, "alpha_s": 0.5, "source": [0.0, 20.0]}

HALF_SPACE: Tables = {
    "packing": {"pattern": "A", "size": [20.0, 20.0], "radius": 0.25},
    "material": {"density": 2500.0, "p_wave_speed": 300.0, "fric": 0.5},
    "wave": {"pulse": {"type": "cubic_spline", "amplitude": 1.0, "period": 0.1}},
    "load": [{"name": "hammer", "force": [0.0, -225e3], "position": [0.25, 19.75], "wave": "pulse"}],
    "monitor": [
        {"name": "near", "position": [5.25, 19.75]},
        {"name": "far", "position": [15.25, 19.75]},
        {"name": "deep", "position": [2.75, 10.25]},
    ],
    "run": {"duration": 0.4},
    "output": {"pictures": False},
}


@pytest.mark.parametrize(
    "side",
    [pytest.param({"type": "viscous"}, marks=pytest.mark.slow), SPRINGS],  # which have dashpots as well
    ids=["viscous", "viscoelastic"],
)
def test_estimated_errors_are_the_true_ones(side: Tables) -> None:
    case = small(HALF_SPACE | {"boundary": {"left": {"type": "symmetry"}, "right": side, "bottom": side}})
    run = measure(case, Progress())[0]
    far = measure(extended(case).case, Progress())[0].motions
    recorded = {
        name: History(at.place, at.time, {"velocity": at.velocity[:, :2], "displacement": at.displacement[:, :2]})
        for name, at in run.motions.items()
    }
    causes = causes_of(case, recorded, run.time_step, run.work)
    found = Budget(causes.motions or recorded, causes)
    assert not found.causes.unknown
    assert not found.causes.limits
    for name, own in recorded.items():
        for quantity, values in own.values.items():
            column = own.component(quantity)
            error = (values - far[name].values[quantity][:, :2])[:, column]
            truth = np.linalg.norm(error) / np.linalg.norm(far[name].values[quantity][:, column])
            assert truth > 0.1
            assert 1.0 / 1.3 < found.shares(name, quantity)[SIDES] / truth < 1.3
            sides = replace(found.motions[name], values={quantity: found.correction(name, quantity)}).at(own.time)
            corrected = error - sides.values[quantity][:, column]
            assert np.linalg.norm(corrected) < 0.5 * np.linalg.norm(error)
