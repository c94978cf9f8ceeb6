"""Runs of choices and of companions: their costs, and the records of their monitors.

A companion is an additional run of a case with other sides, disks or seeds, which shows their effect. No files of
results are written.
"""

import math
import time
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np

from dembound.accuracy.choice import AnyCase, digest
from dembound.casefile import Case
from dembound.casefile.tables import ENDING
from dembound.formulas.history import History, Motions
from dembound.motion.kind import Finding, Plan
from dembound.motion.trackers import Clock, Records
from dembound.running import Progress, Reports, plan, simulation_of
from dembound.table import Box

STEP_AND_END = ("time_step", "safety", "courant", *ENDING)
"""Keys of ``[run]`` that a companion with a given step and duration does not have."""

BUDGET, SHORT = 0.1, 5e7
"""Share of the work of a run that its estimate may take by default, and work that it may take in any case.

That is the work of less than a second: short runs have fine companions, too.
"""


@dataclass
class Run:
    """The results of a run; where a case is run several times, of the first run except for the costs.

    Attributes
    ----------
    failure : why it has no results; empty otherwise.
    time_step, step_limit (s), steps : of the run. count : number of nodes that are stepped.
    work : in the unit of its kind of body. threads : of the steps. late : delay of all motion relative to waves that
    start
    at the planes of sides, s, see `Kind.late`.
    motions, findings : by name. laws : names of those used. settled : numbers of the stages before, see `Beginning`.
    cpu, wall : s, of every timed run: CPU time of all threads while stepping, and time of the whole run.
    """

    failure: str = ""
    time_step: float = 0.0
    step_limit: float = 0.0
    steps: int = 0
    count: int = 0
    work: int = 0
    threads: int = 1
    late: float = 0.0
    motions: Motions = field(default_factory=dict)
    findings: Mapping[str, Finding] = field(default_factory=dict)
    laws: tuple[str, ...] = ()
    settled: Mapping[str, Any] | None = None
    cpu: list[float] = field(default_factory=list)
    wall: list[float] = field(default_factory=list)

    def finding(self, name: str) -> float:
        """A number found by the run, such as the time (s) of its first break; infinite if it is missing."""
        found = self.findings.get(name)
        return math.inf if found is None else found.value


class Kept(Protocol):
    """Runs by the digest of their case."""

    def get(self, key: str) -> Run | None:
        """The run of the case with this digest; None if there is none."""

    def add(self, key: str, run: Run) -> None:
        """Keep the run of a case."""


class InMemory(dict[str, Run]):
    """Runs that are kept as long as this object."""

    def add(self, key: str, run: Run) -> None:
        """Keep the run of a case."""
        self[key] = run


Shown = Callable[[str], AbstractContextManager[Progress]]
"""Returns the progress of a run, given its name."""


def unseen(name: str) -> AbstractContextManager[Progress]:
    """No progress."""
    return nullcontext(Progress())


class Runner:
    """Runs cases, each once.

    Attributes
    ----------
    work : total work of its runs, in the unit of their kind of body. count : their number.
    """

    def __init__(self, kept: Kept | None = None, shown: Shown = unseen) -> None:
        self.work = self.count = 0
        self._shown = shown
        self._kept: Kept = InMemory() if kept is None else kept

    def run(self, case: Case, name: str = "", inside: Box | None = None) -> Run:
        """The run of a case, without costs unless they are kept; name, inside : see `Shown` and `measure`.

        Raises the errors of `measure`.
        """
        key = digest(case)
        if (found := self._kept.get(key)) is None:
            planned = plan(case)
            with self._shown(f"{name}, {planned.stepped.count:,} particles × {planned.steps:,} steps") as progress:
                found, _, _ = measure(case, progress, inside=inside, timed=False, planned=planned)
            self._kept.add(key, found)
            self.work += found.work + found.count * int((found.settled or {}).get("steps", 0))
            self.count += 1
        return found


def at_step(case: AnyCase, step: float) -> AnyCase:
    """The case with a given time step, s."""
    return replace(case, run=case.run.model_copy(update={"time_step": step}))


def measure(
    case: Case,
    progress: Progress,
    watched: bool = True,
    inside: Box | None = None,
    timed: bool = True,
    planned: Plan | None = None,
) -> tuple[Run, float, float]:
    """Run a case; returns its results without costs, CPU time while stepping and time of the whole run, s.

    The whole run is building, settling and stepping, without files and pictures. Times do not include compiling.
    watched : whether the energy ledger detects runs that gain energy; it interrupts the stepping a few hundred times,
    which takes longer than all steps of a short bar. inside : the part of the scene in which findings are looked for.
    timed : whether CPU time is measured, a query that takes half a millisecond on some systems; else elapsed time is
    returned in its place. planned : the case, if it has been planned before.

    Raises the errors of `running.plan` and of runs.
    """
    wall, cpu = Clock(), Clock(time.process_time) if timed else Clock()
    with wall.with_compiling(), wall.of("whole"):
        planned = planned or plan(case)
        beginning = planned.kind.begin(planned.stepped, planned.time_step, progress.settling)
        simulation, ledger = simulation_of(planned, beginning, cpu)
        records = Records()
        simulation.track(records, *([ledger] if watched else []), Reports(progress, planned.steps))
        simulation.track(*planned.kind.trackers(simulation))
        with cpu.with_compiling():
            simulation.run(planned.steps)
    scene, kind, stepped = planned.scene, planned.kind, simulation.scene
    run = Run("", planned.time_step, planned.step_limit, planned.steps, stepped.count, kind.work(simulation))
    run.threads, run.late = stepped.threads, kind.late(scene) or 0.0
    run.motions, run.findings = _motions(planned, records), kind.findings(scene, simulation, inside)
    run.laws, run.settled = tuple(name for name, _ in simulation.state.laws), beginning.summary
    return run, cpu.seconds["step"], wall.seconds["whole"]


def _motions(planned: Plan, records: Records) -> dict[str, History]:
    """The records of the monitors, at the interval of the case's histories."""
    scene, step = planned.scene, planned.time_step
    stride = max(1, round(scene.case.output.history_interval / step))
    record = np.concatenate(records.records)[::stride]
    times = stride * step * np.arange(len(record))
    motion = planned.stepped.observed(record, times)
    found = {}
    for index, (name, place) in enumerate(scene.monitored.items()):
        if name in scene.places:  # without the twins in a free-field column
            own = motion[:, index]
            found[name] = History.of(place, times, own[:, :3], own[:, 3:6], own[:, 6] if own.shape[1] > 6 else None)
    return found
