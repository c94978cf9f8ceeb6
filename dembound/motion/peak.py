"""Ends a run once the forces on its driven sides have passed their peaks, as in a test to failure."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dembound.boundaries import driven_components
from dembound.motion.paths import Source
from dembound.motion.scene import Scene
from dembound.motion.state import Arrays
from dembound.motion.trackers import Run, Tracker

ACROSS = 2.0
"""Times that the slowest driven wave crosses the longer side of the body, until the fall of a force is not a wave."""


@dataclass(frozen=True)
class PeakRule:
    """The rule for the end of a run: the forces on all driven sides have fallen, for a time.

    share : of the largest force so far, counted from that at the start, below which a force has fallen.
    hold : s, for which all forces must be below. earliest : s, before which the run does not end.
    """

    share: float
    hold: float
    earliest: float


def peak_rule(scene: Scene, sources: Sequence[Source]) -> PeakRule:
    """The rule for a case with ``until = "peak"``; scene : the whole one, with its sources.

    By default forces must be below for the time in which the slowest driven wave crosses the longer side of the body
    and comes back, so that reflections at the beginning of a test do not end it.
    """
    run = scene.case.run
    slowest = min((source.slowest for source in sources), default=np.inf)
    hold = run.peak_for or ACROSS * float(np.max(scene.size)) / slowest
    begin = max((source.start for source in sources), default=0.0)
    return PeakRule(run.peak_share, hold, begin + hold)


class Peak(Tracker):
    """Ends a run when the forces on all driven sides have been below a share of their peaks for long enough.

    It reads the samples of the sides after every return of the loop without changing these returns.
    """

    name = "peak"

    def __init__(self, rule: PeakRule, scene: Scene, time_step: float) -> None:
        self._share = rule.share
        self._hold, self._earliest = (int(np.ceil(time / time_step)) for time in (rule.hold, rule.earliest))
        names = list(scene.sides)
        each = [(names.index(side), axis) for side, axis in driven_components(scene.case.boundary) if side in names]
        self._side, self._axis = np.array(each, dtype=np.int64).reshape(-1, 2).T
        self._first = np.zeros(0)
        self._peaks = np.zeros(len(self._side))
        self._high = -1

    def handle(self, run: Run) -> None:
        """Do nothing: this tracker is never due."""

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Find the last sample at which any force was high, and end the run if that is long ago."""
        samples = run.side_samples
        force = samples.record[:, self._side, 3 + self._axis]
        if len(force) == 0:
            return
        if self._first.size == 0:
            self._first = force[0].copy()
        force = np.abs(force - self._first)
        so_far = np.maximum(np.maximum.accumulate(force, axis=0), self._peaks)
        high = np.flatnonzero((force >= self._share * so_far).any(axis=1))
        if len(high) > 0:
            self._high = int(samples.steps[high[-1]])
        self._peaks = so_far[-1]
        if run.state.step - max(self._high, self._earliest) > self._hold:
            run.stopped = True

    def saved_arrays(self) -> Arrays:
        """The forces at the start, the largest so far, and the last step at which one was high."""
        return {**super().saved_arrays(), "first": self._first, "peaks": self._peaks, "high": np.array(self._high)}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays`."""
        super().restore(saved)
        self._first, self._peaks, self._high = saved["first"].copy(), saved["peaks"].copy(), int(saved["high"])
