"""Runs one case, from its tables or a checkpoint to a folder of results."""

import logging
import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from dembound.casefile.model import Case
from dembound.errors import CaseError, RecordError, RunError
from dembound.interrupts import Interrupts, put_off
from dembound.kinds import kind_of
from dembound.motion.kind import Beginning, Kind, Plan, StalledError
from dembound.motion.simulation import Simulation
from dembound.motion.trackers import Clock, Run, Tracker
from dembound.results.checkpoint import FILE as CHECKPOINT
from dembound.results.checkpoint import FOLDER as STAGES
from dembound.results.checkpoint import Checkpoints, KeptStages, facts_of
from dembound.results.folder import Folder
from dembound.results.new_record import write_derived
from dembound.results.reader import open_record, trust, understood
from dembound.results.recorder import Recorder
from dembound.results.recording import Histories, Snapshots
from dembound.results.summary import summarise
from dembound.results.text_files import write_json
from dembound.results.vtk import write_paraview
from dembound.results.warnings import never_past_peak, never_silent
from dembound.running.planning import (
    about,
    bytes_left,
    plan,
    require_ready,
    simulation_of,
    space_in_words,
    space_warnings,
    warnings_before,
)
from dembound.running.recorded import Shared, require_replaceable
from dembound.running.unfinished import Unfinished, find_unfinished


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


SECTIONS = ("import", "compile", "build", "settle", "step", "record", "export", "pictures")
"""The parts of a run whose time is measured, in the order of the summary."""

LARGE = 1e9
"""Bytes of results above which their size is logged before the run."""

RESUMED_SECTIONS = ("settle", "step", "record")
"""Parts of a run that a resumed run does not repeat."""


def run_case(
    case: Case,
    results: Path,
    progress: Progress | None = None,
    seconds: Mapping[str, float] | None = None,
    begun_for: float | None = None,
    shared: Shared | None = None,
) -> Path:
    """Run a case and write ``results/<case name>/``; returns that folder.

    Everything is written to ``<case name>.partial``, which is renamed when the run is complete, so a finished folder is
    always complete. After a run that fails the partial folder contains the histories so far; after a static stage that
    stalls it contains a snapshot of the state it reached. A run that a signal or the end of its process has stopped is
    continued by `resume_case` from its last checkpoint.

    All warnings are sent to the progress and written to the summary; seconds: time already spent, by `SECTIONS`;
    begun_for: s, the duration from which the intervals of ledger and snapshots are found, by default that of the case.
    shared: with other runs, by default nothing.

    Raises the errors of `plan`, RunError when the static stage does not settle or the motion grows without bound,
    Stopped after a signal, CaseError when another run is writing the same folder or it has results of another case, and
    OSError when a file cannot be written.
    """
    folder = Folder(results, case.name)
    folder.check()
    require_replaceable(folder, case)
    return _Job(case, folder, progress or Progress(), seconds or {}, begun_for=begun_for, shared=shared).run()


def resume_case(
    folder: Path,
    until: float | None = None,
    progress: Progress | None = None,
    seconds: Mapping[str, float] | None = None,
    shared: Shared | None = None,
) -> Path:
    """Continue a run from its last checkpoint, to the same results as if it had never stopped; returns its folder.

    folder : partial or complete folder of its results. until : s, another duration, required for a complete run;
    histories, ledger and snapshots keep their intervals. shared: as of `run_case`.

    Raises CaseError if there is no checkpoint, if it is of another version or another case than the record, or if the
    run has reached that time; RecordError if it is damaged; else errors as `run_case`.
    """
    found = find_unfinished(folder, until)
    return _Job(found.case, found.folder, progress or Progress(), seconds or {}, found, shared=shared).run()


class _Job:
    """The work on one folder of results.

    Parameters
    ----------
    case : to be run; folder : of its results; progress : is informed; seconds : spent before, by section.
    found : an unfinished run of the case; None: a new run. begun_for : of a new run, as of `run_case`.
    """

    def __init__(
        self,
        case: Case,
        folder: Folder,
        progress: Progress,
        seconds: Mapping[str, float],
        found: Unfinished | None = None,
        begun_for: float | None = None,
        shared: Shared | None = None,
    ) -> None:
        self.case, self.folder, self.progress, self.found = case, folder, progress, found
        self.begun_for, self.shared = begun_for, shared or Shared()
        self.clock = Clock()
        self.clock.seconds.update(dict.fromkeys(SECTIONS, 0.0) | dict(seconds))
        for section, spent in (found.facts["seconds"] if found else {}).items():
            self.clock.seconds[section] += spent

    def run(self) -> Path:
        """Run it, and write all files; returns the folder of the complete results."""
        case, clock = self.case, self.clock
        with Interrupts(), clock.with_compiling():
            planned = self._plan()
            require_ready(planned)
            self._announce_size(planned)
            with about(case), self.folder.writing(anew=self.found is None) as partial, self._without_copies():
                if self.found is not None:
                    self.found.copy_to(partial)
                summary = self._record(planned, partial)
                del planned  # files and pictures are made from the record alone
                self._export(partial)
                summary |= {"wall_time": sum(clock.seconds.values()), "seconds": clock.seconds}
                write_json(partial / "summary.json", summary)
                self.folder.finish()
        return self.folder.final

    @contextmanager
    def _without_copies(self) -> Iterator[None]:
        """Inside, a damaged record of a complete run that is continued removes its copies."""
        try:
            yield
        except RecordError:
            if self.found is not None and self.found.path != self.folder.partial:
                self.folder.discard()
            raise

    def _announce_size(self, planned: Plan) -> None:
        """Warn if the disk has too little space for the remaining results, and log their size if it is large."""
        results, written = self.folder.final.parent, 0 if self.found is None else self.found.written
        short = _passed_on(list(space_warnings(planned, results, written)), self.progress)
        if not short and sum(bytes_left(planned, written).values()) > LARGE:
            logging.getLogger(__name__).info(f"{self.case.name}: {space_in_words(planned, results, written)}")

    def _plan(self) -> Plan:
        """The plan.

        A resumed run has its checkpoint's time step, after checking that its record can be continued.
        """
        planned = plan(self.case, self.clock)
        if self.found is None:
            if self.begun_for is None:
                return planned
            return replace(planned, regular_steps=max(1, round(self.begun_for / planned.time_step)))
        time_step, regular_steps = (self.found.facts[name] for name in ("time_step", "regular_steps"))
        if abs(planned.time_step - time_step) > 1e-9 * time_step:
            raise CaseError([f"run.time_step: is {planned.time_step} s here, and {time_step} s in the checkpoint"])
        self.found.require_record(planned.scene)
        steps = max(1, math.ceil(self.case.run.duration / time_step - 1e-9))
        return replace(planned, time_step=time_step, steps=steps, regular_steps=regular_steps)

    def _record(self, planned: Plan, partial: Path) -> dict[str, Any]:
        """Run a plan and record it; returns the summary."""
        record, kind = partial / "run.h5", planned.kind
        warnings = _passed_on(warnings_before(planned), self.progress)
        simulation, beginning = self._simulate(planned, partial)
        trust(record)
        summary = summarise(planned, simulation, record, self.clock.seconds)
        summary |= kind.summarise(planned.scene, simulation, beginning, record)
        with open_record(record) as file:
            ending = planned.scene, summary["ended"], file
            loud = [*never_silent(*ending), *never_past_peak(*ending)]
        warnings += _passed_on([*kind.warnings_after(planned.scene, summary, record), *loud], self.progress)
        simulation.forget_trackers()
        resumed = [] if self.found is None else self.found.resumed
        return summary | {"warnings": warnings, "resumed": resumed}

    def _simulate(self, planned: Plan, partial: Path) -> tuple[Simulation, Beginning]:
        """Start from the state given by the kind of body, or from a checkpoint, and advance to the end."""
        case, steps, found = planned.scene.case, planned.steps, self.found
        counts = None if found is None else found.facts["counts"]
        beginning = self._begin(planned, partial)
        simulation, ledger = simulation_of(planned, beginning, self.clock)
        with Recorder(
            partial / "run.h5", simulation, planned.step_limit, case.output.history_interval, ledger,
            beginning.stages, counts,
        ) as recorder:  # fmt: skip
            with put_off():  # until there is a checkpoint for the record
                if found is None and (late := planned.kind.late(planned.scene)) is not None:
                    recorder.note({"late": late})
                if planned.regular_steps != steps:
                    recorder.note({"regular_steps": planned.regular_steps})
                checkpoints = self._checkpoints(planned, partial, None, recorder)
                at_rest = bool(beginning.stages)
                snapshots = Snapshots(recorder, case.output.snapshots, planned.regular_steps, at_rest=at_rest)
                simulation.track(Histories(recorder), ledger, snapshots, Reports(self.progress, steps))
                simulation.track(*planned.kind.trackers(simulation), checkpoints)
                if found is not None and counts is not None:
                    with understood(found.path / CHECKPOINT):
                        simulation.state.take(found.arrays())
            simulation.run(steps)
            with put_off():
                checkpoints.write(simulation, durable=False)
                if simulation.stopped:
                    snapshots.take_last(simulation)
                time = simulation.time
                with simulation.a_step_ahead() as motion:
                    snapshots.complete()
                    recorder.end(time, motion)
                recorder.flush(durable=False)
                write_derived(recorder.file, planned.kind.derived(planned.scene, recorder.file))
        return simulation, beginning

    def _begin(self, planned: Plan, partial: Path) -> Beginning:
        """The first state of the run; if a stage before it stalls, the stage's state is written to the record."""
        case, kind, found = self.case, planned.kind, self.found
        in_stage = None if found is None or found.stage is None else (found.stage, found.arrays)
        keys = kind.stage_keys(planned.stepped)
        own = partial / STAGES if case.run.checkpoint > 0.0 else None
        stages = KeptStages(
            self.shared.stages(keys) or own,
            keys,
            lambda name: self._checkpoints(planned, partial, name, None),
            kind.stages_from(case),
            in_stage,
        )
        try:
            with self.clock.of("settle"), self.shared.settling(keys):
                return kind.begin(planned.stepped, planned.time_step, self.progress.settling, stages)
        except StalledError as stalled:
            with Recorder(partial / "run.h5", stalled.run, planned.step_limit) as recorder:
                recorder.stalled_snapshot(stalled)
                raise RunError(f"{stalled}\nto see it: dembound plot {partial} --field unbalanced") from None

    def _checkpoints(self, planned: Plan, partial: Path, stage: str | None, recorder: Recorder | None) -> Checkpoints:
        """The tracker that writes checkpoints of the run, or of a stage before it."""
        interval = self.case.run.checkpoint

        def facts(run: Run, durable: bool) -> dict[str, Any]:
            if recorder is not None:
                recorder.flush(durable=durable)
            return facts_of(self.case) | {
                "stage": stage,
                "step": run.state.step,
                "time_step": planned.time_step,
                "regular_steps": planned.regular_steps,
                "counts": None if recorder is None else recorder.counts,
                "resumed": [] if self.found is None else self.found.resumed,
                "seconds": {name: self.clock.seconds[name] for name in RESUMED_SECTIONS},
            }

        return Checkpoints(partial / CHECKPOINT if interval > 0.0 else None, interval, facts)

    def _export(self, partial: Path) -> None:
        """Write the files that are made from the record."""
        kind = kind_of(self.case)
        with self.clock.of("export"):
            write_paraview(partial / "run.h5", partial / "paraview", kind, self.case.output.paraview)
        with self.clock.of("pictures"):
            if self.case.output.pictures:
                _draw(self.case, kind, partial)


def _passed_on(warnings: list[str], progress: Progress) -> list[str]:
    """Warnings in their order, each sent to the progress."""
    for warning in warnings:
        progress.warned(warning)
    return warnings


def _draw(case: Case, kind: Kind[Any, Any], folder: Path) -> None:
    """Draw the pictures of a run into its folder: the monitors' velocities, and pictures of its kind from snapshots."""
    from dembound.plot.histories import plot_histories
    from dembound.plot.style import save

    record = folder / "run.h5"
    if case.output.snapshots:
        for name, figure in kind.pictures(record):
            save(figure, folder / f"{name}.png")
    if case.monitor:
        save(plot_histories([record]), folder / "histories.png")
