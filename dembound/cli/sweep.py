"""Commands for many runs: sweep, library and respond."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer
from typer import Argument, Option

from dembound.cli.app import (
    MORE,
    Name,
    Output,
    PictureTitle,
    Scheduler,
    Settings,
    Threads,
    Vary,
    app,
    load_case,
    load_disks,
    prepare_computing,
    require_one_place,
)
from dembound.cli.calibration import OneCase
from dembound.cli.console import ending_with, err, out, print_rows, print_written, seldom
from dembound.cli.options import leave
from dembound.errors import CaseError
from dembound.studies.asked import Method
from dembound.words import in_one_unit

if TYPE_CHECKING:
    from dembound.studies.library import LoadFactor
    from dembound.studies.sweep.members import Member
    from dembound.studies.sweep.study import Report, Standing
    from dembound.studies.sweep.tables import Statistic, Swept

FAILED = 3
"""Exit code of a sweep with members that failed."""


PREFIXED = ("m/s", "m", "s", "Pa")
"""Units that are printed with the prefix that suits the number."""

MOST_ROWS = 40
"""Largest number of rows of the printed table."""

MOST_WARNINGS = 10
"""Largest number of distinct warnings of members that are printed."""


SweepAction = Literal["run", "calibrate"]
"""The action for every member."""


@app.command("sweep")
def sweep(
    case: OneCase,
    vary: Vary = None,
    together: Annotated[
        bool | None,
        Option("--together/--product", help="First values of all keys together, then the second ones."),
    ] = None,
    action: Annotated[
        SweepAction | None, Option(metavar="ACTION", help="run or calibrate (all sides with dashpots).")
    ] = None,
    method: Annotated[Method | None, Option(metavar="METHOD", help="Method of calibration.")] = None,
    processes: Annotated[
        int | None, Option("--processes", "-p", min=1, help="Members at once; as many as cores by default.")
    ] = None,
    scheduler: Scheduler = None,
    anew: Annotated[bool, Option("--anew", help="Also repeat members that are done.")] = False,
    quantity: Annotated[
        list[str] | None, Option(metavar="NAME", help="Column of sweep.csv to draw. May be repeated.")
    ] = None,
    output: Output = Path("results"),
    title: PictureTitle = None,
    changes: Settings = None,
    name: Name = None,
) -> None:
    """Run or calibrate a case for many values of its keys.

    Values are given by --vary, or by sweep.vary in the case. Means are over members that differ only in seeds.

    Complete members are not repeated: the same command continues a sweep, and more values add members to it.
    """
    from dembound.accuracy.choice import parsed_options
    from dembound.studies.sweep.members import members_of, variations
    from dembound.studies.sweep.study import Options
    from dembound.studies.sweep.study import sweep as sweep_all

    require_one_place(scheduler, processes)
    loaded = load_case(case, changes, name)
    table = loaded.sweep
    chosen = action or table.action, method or table.method, processes or table.processes
    options = Options(*chosen, scheduler, anew)
    if method and options.action != "calibrate":
        raise CaseError(["--method: is for --action calibrate"])
    varied = variations(parsed_options(vary) if vary else table.vary, table.together if together is None else together)
    members, left_out = members_of(loaded, varied, options.action, options.method)
    for line in left_out:
        err.print(f"{loaded.name}: {line}")
    folder = output / f"{loaded.name}_sweep"
    said = f"{loaded.name}: stopped; the same command continues what is left"
    with ending_with(said), shown(loaded.name) as report:
        outcomes = sweep_all(members, options, folder, report)
    from dembound.studies.sweep.tables import Swept

    swept = Swept(loaded, options.action, members, outcomes, quantity or [])
    has_failed = _print(swept)
    _leave(swept, folder, title)
    if has_failed:
        raise typer.Exit(FAILED)


@contextmanager
def shown(
    name: str, members: str = "members", under_way: Callable[[Standing], str] = lambda standing: ""
) -> Iterator[Report]:
    """Shows the progress of a sweep: a line that changes on a terminal, else one every ten seconds.

    members : what they are called. under_way : more words on those under way.
    """
    began, is_due = time.monotonic(), seldom()

    def line(standing: Standing) -> str:
        return f"{name}: {_in_words(standing, time.monotonic() - began, members, under_way(standing))}"

    if not err.is_terminal:
        yield lambda standing: err.print(line(standing)) if is_due() else None
        return
    with err.status(f"{name}: preparing") as status:
        yield lambda standing: status.update(line(standing))


def _in_words(standing: Standing, elapsed: float, members: str = "members", more: str = "") -> str:
    """The progress of a sweep after a number of seconds, in one line; members, more : see `shown`."""
    now = standing.done + standing.failed - standing.kept
    left = standing.members - standing.done - standing.failed
    parts = [f"{standing.done} of {standing.members} {members} done"]
    parts += [f"{standing.failed} failed"] if standing.failed else []
    parts += [f"{standing.under_way} under way{more}"] if standing.under_way else []
    parts += [f"about {_duration(elapsed * left / now)} left"] if now and left else []
    return ", ".join(parts)


def _duration(seconds: float) -> str:
    """A time in s, min or h."""
    unit, size = next((each for each in (("h", 3600.0), ("min", 60.0)) if seconds >= 2.0 * each[1]), ("s", 1.0))
    return f"{seconds / size:.0f} {unit}"


def _print(swept: Swept) -> bool:
    """Print failed members, warnings, and means of the shown quantities; returns whether any has failed."""
    from dembound.studies.sweep.tables import statistics

    failed = print_failed(swept.case.name, swept.members, swept.states, swept.warnings)
    found = [each for each in statistics(swept.members, swept.outcomes) if each.quantity in swept.shown]
    if found:
        print_rows(swept.case.name, list(_rows(found[:MOST_ROWS])), left=2)
    if len(found) > MOST_ROWS:
        out.print(f"{len(found) - MOST_ROWS} more rows are in statistics.csv")
    out.print(f"{swept.case.name}: {len(swept.members) - failed} of {len(swept.members)} members done")
    return failed > 0


def print_failed(
    name: str, own: Sequence[Member], states: Sequence[str], warnings: Mapping[str, int], members: str = "members"
) -> int:
    """Print the members of a sweep that failed, and distinct warnings, each once with the number of those that have it.

    own : the members; members : as of `shown`. Returns how many have failed.
    """
    failed = [(member.name, state) for member, state in zip(own, states, strict=True) if state != "done"]
    for member, state in failed:
        err.print(f"{name}: {member}: failed, {state}")
    for text, having in list(warnings.items())[:MOST_WARNINGS]:
        err.print(f"{name}: warning: {text} ({having} of {len(own)} {members})")
    if len(warnings) > MOST_WARNINGS:
        left = len(warnings) - MOST_WARNINGS
        err.print(f"{name}: {left} more warnings are in summary.json of the {members}")
    return len(failed)


def _rows(statistics: Sequence[Statistic]) -> Iterator[Sequence[str]]:
    """A head, and a row for each group of members and quantity, with three digits; all digits are in the files."""
    from dembound.accuracy.choice import in_words, short_keys
    from dembound.studies.sweep.members import unit_of

    yield "members", "quantity", "n", "mean", "spread", "95 % ±", "unit"
    for each in statistics:
        pairs = zip(short_keys(each.group), each.group.values(), strict=True)
        group = ", ".join(f"{key} {in_words(value)}" for key, value in pairs)
        yield group or "all", each.quantity, *cells_of(each, unit_of(each.quantity))


def cells_of(statistic: Statistic, unit: str) -> Iterator[str]:
    """Count, mean, spread, interval and unit of a statistic as cells of a row."""
    numbers = statistic.mean, statistic.spread, statistic.interval
    texts = [f"{value:.3g}" for value in numbers]
    if unit in PREFIXED:
        texts, unit = in_one_unit(numbers, unit)
    yield str(statistic.count)
    yield from ("–" if value != value else text for value, text in zip(numbers, texts, strict=True))
    yield "" if unit == "1" else unit


def _leave(swept: Swept, folder: Path, title: str | None) -> None:
    """Write the results of a sweep, printing each file."""
    from dembound.files import remove
    from dembound.studies.sweep.tables import write_tables

    print_written(*write_tables(swept, folder))
    remove(folder / "sweep.png")
    if swept.shown:
        from dembound.plot.stability import plot_sweep

        leave(plot_sweep(folder / "sweep.h5"), folder / "sweep.png", title)


@app.command("library", rich_help_panel=MORE)
def library(
    path: Annotated[Path, Argument(metavar="CASE", help="Case file (TOML) of disks under the elastic law.")],
    spacing: Annotated[float, Option(help="Time between two values of the records (s).", min=1e-12)],
    duration: Annotated[
        float | None, Option(help="Length of the longest record (s); by default that of the case.", min=1e-12)
    ] = None,
    output: Output = Path("results"),
    changes: Settings = None,
    name: Name = None,
    threads: Threads = None,
) -> None:
    """Run each input of a case once, so that respond needs no run.

    Inputs are the waves of the case. Its folder is named after the case with "_library"; see `dembound respond`.
    """
    from dembound.cli.progress import progress_of
    from dembound.studies.library import Library, build_library

    case = load_disks(path, changes, name)
    prepare_computing(threads)
    folder = build_library(case, spacing, output, duration, progress_of)
    made = Library(folder)
    step = f"time step {made.case.run.time_step:.10g} s"
    out.print(f"{case.name}: library of {', '.join(made.inputs)}, {made.clock.duration:g} s, {step}, in {folder}")


@app.command("respond", rich_help_panel=MORE)
def respond(
    folder: Annotated[Path, Argument(metavar="LIBRARY", help="Folder written by `dembound library`.")],
    records: Annotated[
        list[str],
        Argument(
            metavar="RECORD...",
            help="Text files of time (s) and velocity (m/s); of several inputs INPUT=FILE,INPUT=FILE.",
        ),
    ],
    output: Output = Path("results"),
    contacts: Annotated[
        list[str] | None,
        Option(
            "--load-factor",
            metavar="MONITOR,MONITOR",
            help="Print load factors at the contact between the disks of two monitors. May be repeated.",
        ),
    ] = None,
) -> None:
    """Write histories under records from a library, without a run.

    They equal a direct run with a file wave (at an angle in layers within 5e-6); plot and compare take them as runs.
    """
    from dembound.results.folder import Folder
    from dembound.results.reader import understood
    from dembound.studies.library import (
        Library,
        load_factor,
        read_records,
        record_warnings,
        watched_contacts,
        write_response,
    )

    with understood(folder):
        made = Library(folder)
    given = read_records(records, made.inputs, made.clock)
    for record in given:
        Folder(output, record.name).check()
    watched = watched_contacts(made, contacts) if contacts else []
    for record, warning in record_warnings(made, given):
        err.print(f"{record.name}: warning: {warning}")
    for record in given:
        motion = write_response(made, record, output / record.name / "run.h5")
        out.print(f"{record.name}: histories in {output / record.name}")
        if watched:
            _print_load_factor(record.name, load_factor(made, watched, motion), len(watched))


def _print_load_factor(name: str, found: LoadFactor, count: int) -> None:
    """Print the load factor of a record, and the number of its contacts."""
    of = f"of {count} contact{'s' * (count > 1)} between monitors alone, not of all contacts"
    if found.factor == float("inf"):
        out.print(f"{name}: no limit at any multiple of the record; {of}")
        return
    where = f"{found.contact} {found.limit} at t = {found.time:.4g} s"
    out.print(f"{name}: load factor {found.factor:.6g}, where {where}; {of}")
