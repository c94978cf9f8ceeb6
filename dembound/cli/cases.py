"""The commands check, run, resume and rerun."""

from __future__ import annotations

import gc
import shlex
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from typer import Argument, Option

from dembound.cli.advise import Error, Keep, Longest, bound_of, chosen, name_within, print_estimate
from dembound.cli.app import MORE, Cases, Name, Output, Settings, Threads, app, changed, load_case, prepare_computing
from dembound.cli.console import compact_table, ending_with, err, out
from dembound.errors import CaseError
from dembound.version import IMPORT_BEGAN
from dembound.words import columns, in_one_unit

if TYPE_CHECKING:
    from dembound.casefile.model import Case
    from dembound.results.folder import Folder
    from dembound.running.job import Progress

MOST_MONITORS = 10
"""Largest number of monitors whose peaks are printed."""

FILES = ("run.h5", "summary.json", "histories.png", "histories_stress.png", "scene.png", "paraview")
"""Results in the folder of a run in the order of the list, without files for continuing it."""


def ending(folder: Path, summary: Mapping[str, Any], *, estimated: bool = False) -> Iterator[str]:
    """The lines after a run with results in a folder; scripts may read the lines that begin with its name.

    estimated : whether its errors will be estimated, so that the command for it is not printed; nor is it where errors
    are not predicted.
    """
    from dembound.accuracy.judge import judge_of
    from dembound.kinds import kind_of_record
    from dembound.results.summary import end_in_words
    from dembound.running.recorded import recorded_case

    name = summary["name"]
    for fact in (*end_in_words(summary), *kind_of_record(folder / "run.h5").outcome(summary)):
        yield f"{name}: {fact}"
    yield from (f"  {line}" for line in peaks(summary["monitors"]))
    yield f"{name}: results in {folder}"
    there = [f"{file}/" if (folder / file).is_dir() else file for file in FILES if (folder / file).exists()]
    yield f"  {', '.join(there)}"
    path = shlex.quote(str(folder))
    yield f"  next: dembound report {path}"
    if summary["monitors"] and not estimated:
        case = recorded_case(folder / "run.h5")
        try:
            judge_of(case).require_known(case)
        except CaseError:
            return
        yield f"        dembound estimate {path}"


def peaks(monitors: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """A table of the largest component of velocity at each monitor but twins in a free field: its size and its time."""
    from dembound.casefile.disks.load import FREE_FIELD

    own = [name for name in monitors if not name.endswith(FREE_FIELD)]
    shown = {name: monitors[name] for name in own[:MOST_MONITORS]}
    if not shown:
        return []
    sizes, speed = in_one_unit([abs(each["peak_velocity"]) for each in shown.values()], "m/s")
    times, second = in_one_unit([each["peak_time"] or 0.0 for each in shown.values()], "s")
    rows: list[Sequence[str]] = [("monitor", "component", f"peak ({speed})", f"at ({second})")]
    for (name, each), size, at in zip(shown.items(), sizes, times, strict=True):
        moves = each["peak_time"] is not None
        rows.append((name, f"v_{each['component']}" if moves else "-", size, at if moves else "-"))
    more = len(own) - len(shown)
    return [*columns(rows), *([f"… and {more} more in summary.json"] if more else [])]


@app.command("check")
def check_cases(cases: Cases, changes: Settings = None, threads: Threads = None) -> None:
    """Print size, time step, cost and warnings of cases; runs nothing.

    Warnings are about what is probably a mistake. Writes nothing.
    """
    from dembound.check import check
    from dembound.cli.progress import print_warning

    prepare_computing(threads)
    for case in [load_case(path, changes) for path in cases]:
        facts, warnings = check(case)
        table = compact_table(title=f"{case.name}: {case.title}" if case.title else case.name, show_header=False)
        for name, value in facts.items():
            for number, line in enumerate(value.splitlines()):
                table.add_row("" if number else name, line)
        out.print(table)
        for warning in warnings:
            print_warning(case.name, warning)


@app.command("run")
def run(
    cases: Cases,
    output: Output = Path("results"),
    changes: Settings = None,
    name: Name = None,
    threads: Threads = None,
    estimate: Annotated[bool, Option("--estimate", help="Estimate the errors of each run afterwards.")] = False,
    error: Error = None,
    keep: Keep = None,
    longest: Longest = None,
) -> None:
    """Run cases; each writes its folder of results.

    All case files are read before the first is run, so a mistake in the last one is found at once.

    With --error each is run with the cheapest choice of dembound advise for this error.

    Its results are then in NAME_1pct, for an error of 0.3 % in NAME_0_3pct, unless --name is given.
    """
    from dembound.results.folder import Folder
    from dembound.running.planning import preflight
    from dembound.running.recorded import require_replaceable

    spent = {"import": time.perf_counter() - IMPORT_BEGAN}
    bound = bound_of(error)
    for option in [name for name, given in (("--keep", keep), ("--longest", longest)) if given and bound is None]:
        raise CaseError([f"{option}: needs --error, without which nothing is changed"])
    prepare_computing(threads)
    loaded = [load_case(path, changes, name) for path in cases]
    if name is not None and len(cases) > 1:
        raise CaseError(["--name: names the results of one case, there are several here"])
    if estimate and (silent := [case.name for case in loaded if not case.monitor]):
        needs = "has no monitor whose error could be estimated; give a [[monitor]]"
        raise CaseError([f"--estimate: {name} {needs}" for name in silent])
    names = [case.name for case in loaded]
    if len(set(names)) < len(names):
        raise CaseError(["CASE: two case files have the same name, so one would overwrite the other's results"])
    if bound is not None and name is None:
        loaded = [replace(case, name=name_within(case.name, bound)) for case in loaded]
    for case in loaded:
        folder = Folder(output, case.name)
        folder.check()
        require_replaceable(folder, case)
    if bound is not None:
        loaded = [chosen(case, bound, keep, changes, longest) for case in loaded]
    for case in loaded:
        _print_replaced(case, output)
    for case in loaded[1:]:  # the first is planned below, before anything is written
        preflight(case)
    for number, case in enumerate(loaded):
        if number > 0:
            gc.collect()  # the arrays of the run before, whose objects refer to each other
        _run(case, output, spent, estimated=estimate or bound is not None)
        spent = {}  # counted for the first case only


@app.command("resume", rich_help_panel=MORE)
def resume(
    results: Annotated[list[Path], Argument(metavar="RESULTS...", help="Folders of results, or NAME.partial.")],
    until: Annotated[float | None, Option(min=0.0, help="New duration in s; needed for a complete run.")] = None,
    threads: Threads = None,
) -> None:
    """Continue stopped runs.

    The results are the same as without the interruption.

    A complete run is continued to a later time; histories, ledger and snapshots keep their intervals.
    """
    from dembound.results.folder import Folder
    from dembound.running.job import resume_case
    from dembound.running.recorded import recorded_case
    from dembound.running.unfinished import changes_since

    prepare_computing(threads)
    for folder in results:
        if (folder / "run.h5").is_file():
            for line in changes_since(folder):
                err.print(f"warning: {line}")
        done = _watched(Folder.of(folder), partial(resume_case, folder, until))
        _print_results(done, estimated=recorded_case(done / "run.h5").output.estimate)


@app.command("rerun", rich_help_panel=MORE)
def rerun(
    record: Annotated[Path, Argument(metavar="RESULTS", help="Folder of results, or its run.h5.")],
    output: Output = Path("results"),
    changes: Settings = None,
    name: Name = None,
    threads: Threads = None,
) -> None:
    """Run the case of a record again, from the record alone.

    Case, seeds and wave files are in it.

    Ledger and snapshots of a run that was continued have the intervals of the record, unless the duration is changed.
    """
    from dembound.running.recorded import recorded_beginning, recorded_case

    path = record if record.suffix == ".h5" else record / "run.h5"
    recorded = recorded_case(path)
    case = changed(recorded, changes, name)
    if changes:
        _require_another_folder(path, output, case.name)
    prepare_computing(threads)
    _print_replaced(case, output)
    begun_for = recorded_beginning(path) if case.run.duration == recorded.run.duration else None
    if begun_for is not None:
        err.print(f"{case.name}: ledger and snapshots at the intervals of the run as it was begun, for {begun_for:g} s")
    _run(case, output, {}, begun_for)


def _require_another_folder(record: Path, output: Path, name: str) -> None:
    """Raise CaseError if a changed case would replace the results that it is read from."""
    from dembound.results.folder import Folder

    target = Folder(output, name)
    if record.parent.resolve() in (target.final.resolve(), target.partial.resolve()):
        advice = "give another --name or --output"
        raise CaseError([f"--set: would replace {record}, from which the case is read; {advice}"])


def _print_replaced(case: Case, output: Path) -> None:
    """Print the results that a run of the case will replace."""
    from dembound.results.folder import Folder
    from dembound.running.unfinished import replaced_in_words

    for line in replaced_in_words(Folder(output, case.name), case):
        err.print(f"{case.name}: {line}")


def _run(
    case: Case, output: Path, spent: dict[str, float], begun_for: float | None = None, *, estimated: bool = False
) -> None:
    """Run a case, with its progress, and print its outcome; spent : seconds before, by section; begun_for : s.

    estimated : whether to estimate its errors even if the case does not request it.
    """
    from dembound.results.folder import Folder
    from dembound.running.job import run_case

    folder = Folder(output, case.name)
    done = _watched(folder, partial(run_case, case, output, seconds=spent, begun_for=begun_for))
    _print_results(done, estimated=estimated or case.output.estimate)


def _watched(folder: Folder, work: Callable[[Progress], Path]) -> Path:
    """Run work on the results in a folder, with its progress; if it ends early, print its partial results."""
    from dembound.cli.progress import progress_of
    from dembound.running.unfinished import left_of

    left = partial(left_of, folder.partial, f"dembound resume {folder.partial}")
    try:
        with (
            ending_with(lambda: f"{folder.name}: stopped; {'; '.join(left()) or 'the run had not begun'}"),
            progress_of(folder.name) as progress,
        ):
            return work(progress)
    except (OSError, MemoryError) as error:
        for line in left():
            error.add_note(f"{folder.name}: {line}")
        raise


def _print_results(folder: Path, *, estimated: bool) -> None:
    """Print the outcome of a run, the peaks at its monitors, its files, and the next command; estimate its errors."""
    from dembound.results.summary import read_summary

    for line in ending(folder, read_summary(folder), estimated=estimated):
        out.print(line)
    if estimated:
        print_estimate(folder)
