"""One case, from tables to a folder of results."""

import json
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from dembound.any_scene import build_scene
from dembound.bar.scene import BarScene
from dembound.bar.warnings import bar_warnings
from dembound.case import Case, DiskCase
from dembound.disk_warnings import disk_warnings
from dembound.errors import CaseError, DemboundError, RunError
from dembound.export import write_vtu
from dembound.plot.bar import plot_bar
from dembound.plot.histories import plot_histories
from dembound.plot.scene import plot_scene
from dembound.plot.style import save
from dembound.record import Recorder
from dembound.run_warnings import run_warnings
from dembound.scene import Scene, build
from dembound.simulate import Simulation
from dembound.stability import choose_step
from dembound.static import Settled, StalledError, settle
from dembound.summary import Plan, summarise

MOST_STEPS = 1e11
"""Steps that no run of a few nodes finishes within a day: a mistake in a time."""

ENTRIES = 100
"""Entries of the energy ledger where the case does not say how often."""


class Progress:
    """Receives progress and warnings of a run; the default ignores them."""

    def warned(self, message: str) -> None:
        """Something was probably not meant; said before the first step or when the record is complete."""

    def settling(self, steps: int, ratio: float) -> None:
        """The static stage has done so many steps and come to a force ratio."""

    def running(self, simulation: Simulation, steps: int) -> None:
        """A block is done, of so many steps in all."""


def plan(case: Case) -> Plan:
    """Build the scene and choose the step.

    Raises PackingError for an impossible brick and CaseError for a load that no particle feels, a material without
    stiffness, a step above the stability limit and one so small that the run would never end.
    """
    with _told_of(case):
        scene = build_scene(case)
        _ = scene.steady_load  # a load beside all particles must be found before anything is written
        if isinstance(scene, Scene):
            _ = scene.ground.material_tensor  # the summary needs it: a singular material must not end a finished run
        time_step, limit = choose_step(scene)
        steps = case.run.duration / time_step
        if steps > MOST_STEPS:
            asked = f"takes {steps:.3g} steps of {time_step:.3g} s"
            raise CaseError([f"run.duration: {asked}, must take no more than {MOST_STEPS:g}"])
    return Plan(scene, time_step, limit, max(1, int(np.ceil(steps - 1e-9))))


@contextmanager
def _told_of(case: Case) -> Iterator[None]:
    """Failures within say which case they are about."""
    try:
        yield
    except DemboundError as error:
        error.source = case.name
        raise


def foresee(case: Case) -> None:
    """Find what would stop a case later, as far as it can be found cheaply.

    Builds the scene, whose brick is then cached, and compares a given time step with the stability limit. Raises
    CaseError and PackingError.
    """
    if not isinstance(case, DiskCase) or case.run.time_step != "auto":
        plan(case)
        return
    with _told_of(case):
        scene = build(case)
        _ = scene.steady_load, scene.ground.material_tensor


def warnings_before(planned: Plan) -> list[str]:
    """What the run will do that was probably not meant, one line each."""
    scene = planned.scene
    if isinstance(scene, BarScene):
        return bar_warnings(scene.case, planned.time_step)
    return disk_warnings(scene, planned.time_step)


def run_case(case: Case, results: Path, progress: Progress | None = None) -> Path:
    """Run a case and leave ``results/<case name>/``; returns that folder.

    Everything is written to ``<case name>.partial`` first and takes its name when the run is complete, so a
    finished folder is always whole. A run that fails leaves the partial folder with the histories so far, a static
    stage that stalls with a snapshot of the state it reached.

    Warnings go to the progress and, all of them, to the summary.

    Raises the errors of `plan`, and RunError when the static stage does not settle or the motion grows without bound.
    """
    planned, progress = plan(case), progress or Progress()
    folder, partial = results / case.name, results / f"{case.name}.partial"
    for old in (folder, partial):
        _must_be_replaceable(old)
    if partial.exists():
        shutil.rmtree(partial)
    partial.mkdir(parents=True)
    with _told_of(case), _gone_if_empty(partial):
        warnings = _passed_on(warnings_before(planned), progress)
        began = time.perf_counter()
        simulation, settled = _simulate(planned, partial / "run.h5", progress)
        wall_time = time.perf_counter() - began
    summary = summarise(planned, simulation, settled, partial / "run.h5", wall_time)
    warnings += _passed_on(run_warnings(planned.scene, summary, partial / "run.h5"), progress)
    summary["warnings"] = warnings
    (partial / "summary.json").write_text(json.dumps(summary, indent=2) + "\n")
    write_vtu(partial / "run.h5", partial / "paraview")
    if case.output.pictures:
        _draw(planned, partial)
    if folder.exists():
        shutil.rmtree(folder)
    partial.rename(folder)
    return folder


def _passed_on(warnings: list[str], progress: Progress) -> list[str]:
    """The same warnings, after the progress has received each."""
    for warning in warnings:
        progress.warned(warning)
    return warnings


def _draw(planned: Plan, folder: Path) -> None:
    """The pictures of a run beside its record: the scene and the monitors' velocities, of bars their stresses, too."""
    record, bar = folder / "run.h5", isinstance(planned.scene, BarScene)
    save(plot_bar(record) if bar else plot_scene(record), folder / "scene.png")
    if planned.scene.case.monitor:
        save(plot_histories([record]), folder / "histories.png")
        if bar:
            save(plot_histories([record], quantity="stress"), folder / "histories_stress.png")


def _must_be_replaceable(folder: Path) -> None:
    """Raise CaseError where a new run would delete something that no run has written."""
    if folder.exists() and not (folder / "run.h5").is_file() and not _is_empty(folder):
        raise CaseError([f"{folder}: exists and holds no run, give another --output or --name"])


def _is_empty(folder: Path) -> bool:
    """Whether a path is a folder without anything in it."""
    return folder.is_dir() and not any(folder.iterdir())


@contextmanager
def _gone_if_empty(folder: Path) -> Iterator[None]:
    """Where something within fails, do not leave the folder behind with nothing in it."""
    try:
        yield
    finally:
        if _is_empty(folder):
            folder.rmdir()


def _simulate(planned: Plan, path: Path, progress: Progress) -> tuple[Simulation, Settled | None]:
    """Settle if the case says so, then advance to the end, recording histories, snapshots, energies and the rest."""
    case, steps = planned.scene.case, planned.steps
    settled = _settled(planned, path, progress)
    monitors = np.array(list(planned.scene.monitors.values()), dtype=np.int64)
    start = settled.start if settled is not None else None
    simulation = Simulation(planned.scene, planned.time_step, monitors, start=start)
    snapshots = min(max(1, case.output.snapshots), steps)
    shots = {steps * number // snapshots for number in range(1, snapshots + 1)}
    entries = {*range(0, steps, _steps_between_entries(planned)), steps - 1}
    with Recorder(path, simulation, planned.step_limit, case.output.history_interval, settled) as recorder:

        def keep(simulation: Simulation, record: np.ndarray) -> None:
            recorder.append(record)
            progress.running(simulation, steps)

        for due in sorted(shots | entries):
            simulation.run(due, keep)
            if due in shots:
                recorder.snapshot()
            if due in entries:
                keep(simulation, recorder.enter_energy())
    return simulation, settled


def _settled(planned: Plan, path: Path, progress: Progress) -> Settled | None:
    """What the static stage comes to, if there is one; where it stalls, the record keeps the state it reached."""
    scene = planned.scene
    if not isinstance(scene, Scene) or scene.case.static is None:
        return None
    try:
        return settle(scene, progress.settling)
    except StalledError as stalled:
        with Recorder(path, stalled.simulation, planned.step_limit, 0.0) as recorder:
            recorder.stalled_snapshot(stalled.unbalanced, stalled.cracks)
            raise RunError(f"{stalled}; to see it: dembound plot {path.parent} --field unbalanced") from None


def _steps_between_entries(planned: Plan) -> int:
    """Steps from one entry of the energy ledger to the next."""
    interval = planned.scene.case.output.energy_interval
    return max(1, round(interval / planned.time_step) if interval > 0.0 else planned.steps // ENTRIES)
