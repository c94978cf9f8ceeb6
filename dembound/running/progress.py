"""The progress of a run, for its caller."""

import numpy as np

from dembound.motion.trackers import Run, Tracker


class Progress:
    """Receives progress and warnings of a run; the default ignores them."""

    def warned(self, message: str) -> None:
        """A warning about a probable mistake, issued before the first step or when the record is complete."""

    def settling(self, steps: int, ratio: float, stage: str) -> None:
        """A static stage of this name has done this many steps and has reached this force ratio."""

    def running(self, run: Run, steps: int) -> None:
        """A block of steps is done; steps: the number in the whole run."""


class Reports(Tracker):
    """Reports to the progress after every block of steps; steps : the number in the whole run."""

    name = "reports"

    def __init__(self, progress: Progress, steps: int) -> None:
        self._progress, self._steps = progress, steps

    def handle(self, run: Run) -> None:
        """Do nothing: reports are never due at a step."""

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Report."""
        self._progress.running(run, self._steps)
