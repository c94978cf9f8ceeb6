"""The first bonds of disks that break, as numbers to compare between runs."""

import numpy as np

from dembound.edges import is_within
from dembound.motion.kind import Finding
from dembound.motion.trackers import Run
from dembound.table import EVERYWHERE, Box

BREAK_TIME, BREAK_X, BREAK_Y = "break time", "break x", "break y"
"""Names of the findings about the first broken bonds."""


def first_break(run: Run, inside: Box | None = None) -> dict[str, Finding]:
    """Time (s) of the step in which the first bonds break, and the mean of their places (m) then; empty without one.

    inside : the part of the scene that counts, by default all. The run's list of broken bonds is emptied, as by every
    `System.take_cracks`.
    """
    cracks = run.system.take_cracks(run.state.step)
    settled = 0.5 * run.state.datum[:2, cracks.pair].sum(axis=2).T
    places = cracks.position - settled
    counted = is_within(inside or EVERYWHERE, places, float(run.scene.size.max()))
    if not counted.any():
        return {}
    step = int(cracks.step[counted].min())
    x, y = np.mean(places[counted & (cracks.step == step)], axis=0)
    return {
        BREAK_TIME: Finding(float(step * run.time_step), "s"),
        BREAK_X: Finding(float(x), "m"),
        BREAK_Y: Finding(float(y), "m"),
    }
