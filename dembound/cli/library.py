"""The commands library and respond."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dembound.cli.app import MORE, Name, Output, Settings, Threads, app, load_disks, prepare_computing
from dembound.cli.console import err, out

if TYPE_CHECKING:
    from dembound.studies.library import LoadFactor


@app.command("library", rich_help_panel=MORE)
def library(
    path: Annotated[Path, typer.Argument(metavar="CASE", help="Case file (TOML) of disks under the elastic law.")],
    spacing: Annotated[float, typer.Option(help="Time between two values of the records (s).", min=1e-12)],
    duration: Annotated[
        float | None, typer.Option(help="Length of the longest record (s); by default that of the case.", min=1e-12)
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
    folder: Annotated[Path, typer.Argument(metavar="LIBRARY", help="Folder written by `dembound library`.")],
    records: Annotated[
        list[str],
        typer.Argument(
            metavar="RECORD...",
            help="Text files of time (s) and velocity (m/s); of a library with several inputs INPUT=FILE,INPUT=FILE.",
        ),
    ],
    output: Output = Path("results"),
    contacts: Annotated[
        list[str] | None,
        typer.Option(
            "--load-factor",
            metavar="MONITOR,MONITOR",
            help="Print the load factor of each record at the contact between the disks of two monitors. May be "
            "repeated.",
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
