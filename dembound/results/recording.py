"""Trackers that write a run to its record."""

import numpy as np

from dembound.motion.state import Arrays
from dembound.motion.trackers import NEVER, Run, Tracker
from dembound.results.recorder import Recorder


class Histories(Tracker):
    """Writes the motion of the monitors, and broken bonds, after every block of steps."""

    name = "histories"

    def __init__(self, recorder: Recorder) -> None:
        self.recorder = recorder

    def handle(self, run: Run) -> None:
        """Do nothing: histories are never due at a step."""

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Append the record."""
        self.recorder.append(record)


class Snapshots(Tracker):
    """Writes the whole scene at some steps.

    Parameters
    ----------
    recorder : writes the file.
    number : of snapshots in `steps`, evenly spaced, the last one at the end; a longer run continues at this spacing.
    steps : of the run as it was begun. at_rest : whether a static stage precedes it, whose state is written first, at
    step 0, besides these.
    """

    name = "snapshots"

    def __init__(self, recorder: Recorder, number: int, steps: int, *, at_rest: bool = False) -> None:
        self.recorder = recorder
        self._number, self._steps = min(number, steps), steps
        self._last, self._next, self._is_open = -1, NEVER, False
        self._after(-1)
        if at_rest and number > 0:
            self._next = 0
        self.due = self._next

    def _after(self, step: int) -> None:
        """Set the first snapshot after this step: at the first k·steps/number, rounded down, above it."""
        later = -(-(step + 1) * self._number // self._steps)
        self._next = self._steps * max(1, later) // self._number if self._number > 0 else NEVER

    def handle(self, run: Run) -> None:
        """Give the snapshot of the step before, if any, the velocities of its time, and write that of this step."""
        self.complete()
        if self._next <= run.state.step:
            self.recorder.snapshot()
            self._last, self._is_open = run.state.step, True
            self._after(run.state.step)
        self.due = run.state.step + 1 if self._is_open else self._next

    def complete(self) -> None:
        """Give the snapshot of the step before, if any, the velocities of its time."""
        if self._is_open:
            self.recorder.centre()
            self._is_open = False

    def take_last(self, run: Run) -> None:
        """Write the scene at the end of a run that ended early, unless just written or the run has no snapshots."""
        if self._number > 0 and self._last < run.state.step:
            self._next = run.state.step
            self.handle(run)

    def saved_arrays(self) -> Arrays:
        """The next snapshot, and whether one lacks the velocities of its time."""
        return {**super().saved_arrays(), "next": np.array(self._next), "is_open": np.array(self._is_open)}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        super().restore(saved)
        self._next, self._is_open = int(saved["next"]), bool(saved["is_open"])
