"""The first bonds of disks that break, as numbers that are compared between runs."""

import numpy as np

from dembound.motion.kind import Finding
from dembound.motion.trackers import Run

BREAK_TIME, BREAK_X, BREAK_Y = "break time", "break x", "break y"
"""Names of what is found about the first broken bonds."""


def first_break(run: Run) -> dict[str, Finding]:
    """Time (s) of the step in which the first bonds break, and the mean of their places (m) then; empty without one.

    The run's list of broken bonds is emptied, as by every `System.take_cracks`.
    """
    cracks = run.system.take_cracks(run.state.step)
    if len(cracks) == 0:
        return {}
    first = cracks.step == cracks.step.min()
    settled = 0.5 * run.state.datum[:2, cracks.pair[first]].sum(axis=2).T
    x, y = np.mean(cracks.position[first] - settled, axis=0)
    return {
        BREAK_TIME: Finding(float(cracks.step[first][0] * run.time_step), "s"),
        BREAK_X: Finding(float(x), "m"),
        BREAK_Y: Finding(float(y), "m"),
    }
