"""The end of a run by the fall of the forces on its driven sides."""

from types import SimpleNamespace

import numpy as np
import pytest

from dembound.boundaries import Velocity
from dembound.motion.endings import Peak, PeakRule
from dembound.motion.sides import Samples

EVERY = 2
"""Steps between two samples."""


def ended_at(forces: dict[str, np.ndarray], rule: PeakRule, block: int = 1) -> int | None:
    """Step after which a run with these normal forces (k,) on its driven sides ends, looked at after blocks."""
    sides = ["bottom", "left", *forces]
    boundary = {side: Velocity(type="velocity", wave_p="press") for side in forces}
    scene = SimpleNamespace(sides=dict.fromkeys(sides), case=SimpleNamespace(boundary=boundary))
    steps = EVERY * len(next(iter(forces.values())))
    tracker = Peak(rule, scene, 1.0)
    run = SimpleNamespace(state=SimpleNamespace(step=0), stopped=False)
    while run.state.step < steps:
        later = run.state.step + block
        run.side_samples = Samples.between(run.state.step, later, EVERY, len(sides))
        run.side_samples.record[:] = 1e9  # of sides and components that are not driven
        for side, force in forces.items():
            axis = 0 if side == "right" else 1
            rows = run.side_samples.steps // EVERY
            run.side_samples.record[:, sides.index(side), 3 + axis] = force[rows.clip(max=len(force) - 1)]
        run.state.step = later
        tracker.observe(run, np.zeros((0, 0, 0)))
        continued = Peak(rule, scene, 1.0)
        continued.restore(tracker.saved_arrays())
        tracker = continued  # a run continued from its state ends at the same step
        if run.stopped:
            return run.state.step
    return None


RISING = np.linspace(0.0, 10.0, 101)
PAST = np.concatenate([RISING, np.full(100, 6.9)])
"""Its peak is in sample 100, step 200; from step 202 on it is below 0.7 of it."""


@pytest.mark.parametrize("block", [1, 7, 64])
def test_a_run_ends_once_the_force_has_been_below_for_long_enough(block: int) -> None:
    # the last high step is 200; ten steps are 201 … 210, and the run ends after the next one
    assert ended_at({"top": -PAST}, PeakRule(0.7, 10.0, 0.0), block) == -(-211 // block) * block
    assert ended_at({"top": PAST}, PeakRule(0.6, 10.0, 0.0), block) is None
    assert ended_at({"top": RISING}, PeakRule(0.7, 10.0, 0.0), block) is None


def test_forces_count_from_the_start_and_all_sides_must_have_fallen() -> None:
    later = np.concatenate([np.linspace(0.0, 5.0, 151), np.zeros(50)])

    assert ended_at({"top": PAST + 1e6}, PeakRule(0.7, 10.0, 0.0)) == 211  # under a confining force
    assert ended_at({"top": PAST, "right": later}, PeakRule(0.7, 10.0, 0.0)) == 311


def test_waves_at_the_beginning_do_not_end_a_run() -> None:
    ringing = RISING * (1.0 + np.cos(np.arange(101)))  # comes back to zero every six samples

    assert ended_at({"top": ringing}, PeakRule(0.7, 14.0, 0.0)) is None
    noise = np.concatenate([[0.0, 1e-9], np.zeros(60), PAST])  # a body at rest before its wave begins
    assert ended_at({"top": noise}, PeakRule(0.7, 10.0, 0.0)) == 2 + 10 + 1
    assert ended_at({"top": noise}, PeakRule(0.7, 10.0, 130.0)) == 2 * 62 + 211
