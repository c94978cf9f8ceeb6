"""Trackers: who wants to see a run, and when next."""

from abc import ABC, abstractmethod
from typing import Protocol

import numpy as np

from dembound.errors import RunError
from dembound.motion.clock import Clock
from dembound.motion.part import System
from dembound.motion.scene import Scene
from dembound.motion.state import Arrays, State

NEVER = 2**62
"""A step that no run comes to."""


class Run(Protocol):
    """A run as trackers see it: scene, parts, state, time step (s), clock; setting `stopped` ends it."""

    scene: Scene
    system: System
    state: State
    time_step: float
    clock: Clock
    stopped: bool

    @property
    def time(self) -> float:
        """Time of the current displacements (s)."""


class Tracker(ABC):
    """Sees a run from time to time; the loop runs to the least of the steps that trackers have named.

    Attributes
    ----------
    name : what the state calls it.
    due : the next step it wants to see; `handle` has to name a later one.
    """

    name: str
    due: int = NEVER

    @abstractmethod
    def handle(self, run: Run) -> None:
        """See the run at the step that was due, and name the next one."""

    def observe(self, run: Run, record: np.ndarray) -> None:  # noqa: B027  # few want it
        """Receive what the probes did in each of the steps since this was last called, see `Simulation.advance`."""

    def memory(self) -> Arrays:
        """All that evolves in it, by name."""
        return {"due": np.array(self.due)}

    def recall(self, memory: Arrays) -> None:
        """Take over what `memory` has returned in another run of the same case."""
        self.due = int(memory["due"])


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
        """See the run, and name the next step."""
        self.see(run)
        self.due = run.state.step + self.steps

    @abstractmethod
    def see(self, run: Run) -> None:
        """See the run."""


class Watch(Every):
    """Stops a run whose motion grows without bound, or that is seen to gain energy from nothing.

    It checks whenever the loop returns, and makes the loop return often.
    """

    name = "watch"

    def see(self, run: Run) -> None:
        """Nothing more than at every return of the loop."""

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Raise RunError when a node is faster than any wave could make it, saying when and where."""
        velocity = run.state.velocity
        speed = np.abs(velocity[:2]).max(axis=0)
        sound = speed <= run.scene.fastest  # false for what is not a number, too
        where = run.system.blown_up(velocity) if sound.all() else int(np.argmin(sound))
        if where is not None:
            place = run.scene.positions[where]
            raise RunError(
                f"the motion grew without bound: at t = {run.time:g} s near ({place[0]:g}, {place[1]:g}) m; "
                "take a smaller run.time_step, run.safety or, of a bar, run.courant, or smaller waves and loads"
            )
