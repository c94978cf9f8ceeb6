"""Trackers: objects that are called during a run, at steps they choose; and the time of the parts of a run."""

import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import ClassVar, Protocol

import numpy as np
from numba.core import event

from dembound.errors import RunError
from dembound.interrupts import look
from dembound.motion.part import System
from dembound.motion.scene import Scene
from dembound.motion.sides import NodeSides, Samples
from dembound.motion.state import Owner, State


class _Looks(event.Listener):
    """Checks before a kernel is compiled or loaded, and before every pass of the compiler."""

    def on_start(self, event: event.Event) -> None:
        """Look."""
        look()

    def on_end(self, event: event.Event) -> None:
        """Do nothing: the next pass or kernel checks."""


for _kind in ("numba:compiler_lock", "numba:run_pass"):
    event.register(_kind, _Looks())


class Clock:
    """Adds up the seconds spent in sections; time in a nested section is not counted for the outer one.

    Parameters
    ----------
    now : the clock in s, by default that of the wall; `time.process_time` counts the CPU time of all threads.

    Attributes
    ----------
    seconds : by section.
    """

    def __init__(self, now: Callable[[], float] | None = None) -> None:
        self._now = now or time.perf_counter
        self.seconds: defaultdict[str, float] = defaultdict(float)
        self._open: list[str] = []
        self._since = 0.0

    @contextmanager
    def of(self, section: str) -> Iterator[None]:
        """Add the time spent inside to a section."""
        self._begin(section)
        try:
            yield
        finally:
            self._end()

    @contextmanager
    def with_compiling(self) -> Iterator[None]:
        """Count the time for compiling or loading kernels inside as a separate section "compile"."""
        with event.install_listener("numba:compiler_lock", _Compiling(self)):
            yield

    def _begin(self, section: str) -> None:
        self._count()
        self._open.append(section)

    def _end(self) -> None:
        self._count()
        self._open.pop()

    def _count(self) -> None:
        """Add the time since the last change to the current section."""
        now = self._now()
        if self._open:
            self.seconds[self._open[-1]] += now - self._since
        self._since = now


class _Compiling(event.Listener):
    """Starts and ends a section of a clock when numba compiles or loads, nested compilations included."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock

    def on_start(self, event: event.Event) -> None:
        """Numba begins to compile."""
        self._clock._begin("compile")

    def on_end(self, event: event.Event) -> None:
        """Numba has finished."""
        self._clock._end()


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


class Tracker(Owner):
    """Called during a run at chosen steps; the loop runs to the next step at which a tracker is due.

    Attributes
    ----------
    name : in the state.
    due : the next step at which it is called; `handle` must set a later one.
    """

    due: int = NEVER
    evolving: ClassVar[tuple[str, ...]] = ("due",)

    def handle(self, run: Run) -> None:
        """Read the run at the step that was due, and set the next one; by default nothing, as it is never due."""

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Receive the record of the probes for the steps since the last call, see `Simulation.advance`."""


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

    def see(self, run: Run) -> None:
        """Read the run at a step that was due; by default nothing, as it is `observe` that reads."""


class Watch(Every):
    """Stops a run whose motion grows without bound, or in which a part detects an instability.

    It checks after every return of the loop, and makes the loop return often.
    """

    name = "watch"

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

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Keep the record."""
        self.records.append(record)
