"""Runs one case: from its tables to a folder of results."""

import gc
import json
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from dembound.casefile import Case
from dembound.errors import CaseError, DemboundError, RunError
from dembound.kinds import checked, kind_of
from dembound.motion.clock import Clock
from dembound.motion.energy import Ledger
from dembound.motion.kind import Beginning, Kind, Plan, StalledError
from dembound.motion.silence import Silence, silent_rule
from dembound.motion.simulation import Simulation
from dembound.motion.trackers import Run, Tracker
from dembound.results.recorder import Histories, Recorder, Snapshots
from dembound.results.summary import summarise
from dembound.results.vtk import write_vtu

MOST_STEPS = 1e11
"""Largest number of steps. Even a few nodes would take more than a day for it: a mistake in a time."""

LARGE = 1e8
"""Bytes of a scene from which on it is removed from memory at once after the run; this takes some tenths of a second.

Files and pictures are made from the record alone.
"""

ENTRIES = 100
"""Entries of the energy ledger where the case does not give an interval."""


SECTIONS = ("import", "compile", "build", "settle", "step", "record", "export", "pictures")
"""The parts of a run whose time is measured, in the order of the summary."""


class Progress:
    """Receives progress and warnings of a run; the default ignores them."""

    def warned(self, message: str) -> None:
        """A warning about a probable mistake, issued before the first step or when the record is complete."""

    def settling(self, steps: int, ratio: float) -> None:
        """The static stage has done this many steps and has reached this force ratio."""

    def running(self, run: Run, steps: int) -> None:
        """A block of steps is done; steps: the number in the whole run."""


def plan(case: Case, clock: Clock | None = None) -> Plan:
    """Build the scene and choose the step; the clock counts the time under "build".

    Raises PackingError for an impossible brick. Raises CaseError for an invalid case that was not read from a file, a
    load that acts on no particle, a material without stiffness, a step above the stability limit, and a step so small
    that the run would take more than `MOST_STEPS`.
    """
    case = checked(case)
    kind = kind_of(case)
    with _about(case), (clock or Clock()).of("build"):
        scene = kind.build(case)
        time_step, limit = kind.choose_step(scene)
        steps = case.run.duration / time_step
        if steps > MOST_STEPS:
            asked = f"takes {steps:.3g} steps of {time_step:.3g} s"
            raise CaseError([f"run.duration: {asked}, must take no more than {MOST_STEPS:g}"])
        reduction = kind.reduced(scene)
    count = max(1, int(np.ceil(steps - 1e-9)))
    return Plan(kind, scene, reduction.scene, time_step, limit, count, reduction.refused)


@contextmanager
def _about(case: Case) -> Iterator[None]:
    """Adds the name of the case to failures raised inside."""
    try:
        yield
    except DemboundError as error:
        error.source = case.name
        raise


def preflight(case: Case) -> None:
    """Find errors that would stop a case later, as far as this takes little time.

    Builds the scene, whose brick is then cached. Where the time step is found quickly, it also plans the run. Raises
    the errors of `plan`.
    """
    kind = kind_of(case)
    if kind.is_planned_quickly(case):
        plan(case)
        return
    with _about(case):
        kind.build(case)


def warnings_before(planned: Plan) -> list[str]:
    """Warnings about probable mistakes, known before the run, one line each."""
    return planned.kind.warnings_before(planned.scene, planned.time_step)


def run_case(
    case: Case, results: Path, progress: Progress | None = None, seconds: Mapping[str, float] | None = None
) -> Path:
    """Run a case and write ``results/<case name>/``; returns that folder.

    Everything is written to ``<case name>.partial``, which is renamed when the run is complete, so a finished folder is
    always complete. After a run that fails the partial folder contains the histories so far; after a static stage that
    stalls it contains a snapshot of the state it reached.

    All warnings are sent to the progress and written to the summary; seconds: time already spent, by `SECTIONS`.

    Raises the errors of `plan`, and RunError when the static stage does not settle or the motion grows without bound.
    """
    clock = Clock()
    clock.seconds.update(dict.fromkeys(SECTIONS, 0.0) | dict(seconds or {}))
    folder, partial = results / case.name, results / f"{case.name}.partial"
    with clock.with_compiling():
        summary = _record(case, folder, partial, progress or Progress(), clock)
        if summary["memory_bytes"] > LARGE:
            gc.collect()
        kind = kind_of(case)
        with clock.of("export"):
            write_vtu(partial / "run.h5", partial / "paraview", kind)
        with clock.of("pictures"):
            if case.output.pictures:
                _draw(case, kind, partial)
    summary |= {"wall_time": sum(clock.seconds.values()), "seconds": clock.seconds}
    (partial / "summary.json").write_text(json.dumps(summary, indent=2) + "\n")
    if folder.exists():
        shutil.rmtree(folder)
    partial.rename(folder)
    return folder


def _record(case: Case, folder: Path, partial: Path, progress: Progress, clock: Clock) -> dict[str, Any]:
    """Run a case that is to end in a folder, and record it in the partial one; returns the summary."""
    planned = plan(case, clock)
    for old in (folder, partial):
        _must_be_replaceable(old)
    if partial.exists():
        shutil.rmtree(partial)
    partial.mkdir(parents=True)
    record = partial / "run.h5"
    with _about(case), _gone_if_empty(partial):
        warnings = _passed_on(warnings_before(planned), progress)
        simulation, beginning = _simulate(planned, record, progress, clock)
    summary = summarise(planned, simulation, record, clock.seconds)
    summary |= planned.kind.summarise(planned.scene, simulation, beginning, record)
    warnings += _passed_on(planned.kind.warnings_after(planned.scene, summary, record), progress)
    return summary | {"warnings": warnings}


def _passed_on(warnings: list[str], progress: Progress) -> list[str]:
    """The same warnings, after the progress has received each."""
    for warning in warnings:
        progress.warned(warning)
    return warnings


def _draw(case: Case, kind: Kind[Any, Any], folder: Path) -> None:
    """Draw the pictures of a run into its folder: the monitors' velocities, and from snapshots those of its kind."""
    from dembound.plot.histories import plot_histories
    from dembound.plot.style import save

    record = folder / "run.h5"
    if case.output.snapshots:
        for name, figure in kind.pictures(record):
            save(figure, folder / f"{name}.png")
    if case.monitor:
        save(plot_histories([record]), folder / "histories.png")


def _must_be_replaceable(folder: Path) -> None:
    """Raise CaseError where a new run would delete a folder that does not contain a run."""
    if folder.exists() and not (folder / "run.h5").is_file() and not _is_empty(folder):
        raise CaseError([f"{folder}: exists and holds no run, give another --output or --name"])


def _is_empty(folder: Path) -> bool:
    """Whether a path is an empty folder."""
    return folder.is_dir() and not any(folder.iterdir())


@contextmanager
def _gone_if_empty(folder: Path) -> Iterator[None]:
    """Remove the folder after a failure inside if it is empty."""
    try:
        yield
    finally:
        if _is_empty(folder):
            folder.rmdir()


def _simulate(planned: Plan, path: Path, progress: Progress, clock: Clock) -> tuple[Simulation, Beginning]:
    """Start from the state given by the kind of body, then advance to the end while trackers record."""
    case, steps = planned.scene.case, planned.steps
    with clock.of("settle"):
        beginning = _begin(planned, path, progress)
    simulation, ledger = simulation_of(planned, beginning, clock)
    shots = min(case.output.snapshots, steps)
    interval = case.output.history_interval
    with Recorder(path, simulation, planned.step_limit, interval, ledger, beginning.stages) as recorder:
        snapshots = Snapshots(recorder, [steps * number // shots for number in range(1, shots + 1)])
        simulation.track(Histories(recorder), ledger, snapshots, Reports(progress, steps))
        simulation.run(steps)
        if simulation.stopped:
            snapshots.take_last(simulation)
    return simulation, beginning


def simulation_of(planned: Plan, beginning: Beginning, clock: Clock) -> tuple[Simulation, Ledger]:
    """The simulation of a planned run in its first state, with the monitors as probes, and its energy ledger.

    The ledger still has to be tracked.
    """
    scene = planned.stepped
    simulation = Simulation(
        scene,
        planned.time_step,
        list(scene.monitors.values()),
        system=beginning.system,
        datum=beginning.datum,
        clock=clock,
    )
    if scene.case.run.until == "silent":
        simulation.track(Silence(silent_rule(planned.scene, planned.kind.sources(planned.scene)), planned.time_step))
    return simulation, Ledger(simulation, _steps_between_entries(planned), last=planned.steps - 1)


class Reports(Tracker):
    """Reports to the progress after every block of steps; steps : the number in the whole run."""

    name = "reports"

    def __init__(self, progress: Progress, steps: int) -> None:
        self._progress, self._steps = progress, steps

    def handle(self, run: Run) -> None:
        """Does nothing, as it is never due."""

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Report."""
        self._progress.running(run, self._steps)


def _begin(planned: Plan, path: Path, progress: Progress) -> Beginning:
    """The state at which the run begins; if a stage before it stalls, its state is written to the record."""
    try:
        return planned.kind.begin(planned.stepped, planned.time_step, progress.settling)
    except StalledError as stalled:
        with Recorder(path, stalled.run, planned.step_limit) as recorder:
            recorder.stalled_snapshot(stalled)
            raise RunError(f"{stalled}\nto see it: dembound plot {path.parent} --field unbalanced") from None


def _steps_between_entries(planned: Plan) -> int:
    """Steps from one entry of the energy ledger to the next."""
    interval = planned.scene.case.output.energy_interval
    return max(1, round(interval / planned.time_step) if interval > 0.0 else planned.steps // ENTRIES)
