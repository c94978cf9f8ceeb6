"""Trackers: objects that are called during a run, at steps they choose."""

from abc import ABC, abstractmethod
from typing import Protocol

import numpy as np

from dembound.errors import RunError
from dembound.motion.clock import Clock
from dembound.motion.part import System
from dembound.motion.scene import Scene
from dembound.motion.sides import NodeSides, Samples
from dembound.motion.state import Arrays, State

NEVER = 2**62
"""A step that no run reaches."""


class Run(Protocol):
    """Data of a run that trackers use: scene, parts, state, time step (s), clock; setting `stopped` ends the run.

    sides : the measured sides, None for none; side_samples : of the last steps.
    """

    scene: Scene
    system: System
    state: State
    time_step: float
    clock: Clock
    stopped: bool
    sides: NodeSides | None
    side_samples: Samples

    @property
    def time(self) -> float:
        """Time of the current displacements (s)."""

    def edge_peaks(self, side: str) -> np.ndarray:
        """Smallest and largest velocity so far of the nodes of one side of the whole scene, (k, 3, 2)."""


class Tracker(ABC):
    """Called during a run at chosen steps; the loop runs to the next step at which a tracker is due.

    Attributes
    ----------
    name : in the state.
    due : the next step at which it is called; `handle` must set a later one.
    """

    name: str
    due: int = NEVER

    @abstractmethod
    def handle(self, run: Run) -> None:
        """Read the run at the step that was due, and set the next one."""

    def observe(self, run: Run, record: np.ndarray) -> None:  # noqa: B027  # few trackers use it
        """Receive the record of the probes for the steps since the last call, see `Simulation.advance`."""

    def saved_arrays(self) -> Arrays:
        """All arrays that change during a run, by name."""
        return {"due": np.array(self.due)}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        self.due = int(saved["due"])


class Every(Tracker):
    """A tracker that is due at evenly spaced steps.

    Parameters
    ----------
    steps : from one to the next.
    first : the first of them.
    """

    def __init__(self, steps: int, first: int = 0) -> None:
        self.steps, self.due = steps, first

    def handle(self, run: Run) -> None:
        """Call `see`, and set the next step."""
        self.see(run)
        self.due = run.state.step + self.steps

    @abstractmethod
    def see(self, run: Run) -> None:
        """Read the run at a step that was due."""


class Watch(Every):
    """Stops a run whose motion grows without bound, or in which a part detects an instability.

    It checks after every return of the loop, and makes the loop return often.
    """

    name = "watch"

    def see(self, run: Run) -> None:
        """Do nothing: `observe` checks after every return of the loop."""

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Raise RunError, with time and place, when a node is faster than waves can make it."""
        v = run.state.v[:2]  # by slots: particles are needed only where something has gone wrong
        where: int | None
        if max(v.max(), -v.min()) <= run.scene.fastest:  # False for nan, too
            where = run.system.blown_up(run.state.v)
        else:
            where = int(np.argmin(np.abs(run.state.velocity[:2]).max(axis=0) <= run.scene.fastest))
        if where is not None:
            place = run.scene.positions[where]
            raise RunError(
                f"the motion grew without bound: at t = {run.time:g} s near ({place[0]:g}, {place[1]:g}) m; "
                f"take {run.scene.against_growth}, or smaller waves and loads"
            )


class Records(Tracker):
    """Keeps the records of the probes.

    Attributes
    ----------
    records : (steps, p, columns) each, see `Simulation.advance`.
    """

    name = "records"

    def __init__(self) -> None:
        self.records: list[np.ndarray] = []

    def handle(self, run: Run) -> None:
        """Do nothing: this tracker is never due."""

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Keep the record."""
        self.records.append(record)
