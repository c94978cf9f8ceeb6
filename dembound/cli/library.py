"""The commands library and respond."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from dembound.cli.app import Name, Output, Settings, Threads, app, load_disks, prepare_computing
from dembound.cli.console import out


@app.command("library", rich_help_panel="Cases")
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
    """Run each input of a case once, so that histories under any record follow without a run.

    Inputs are the waves of the case. Its folder is named after the case with "_library"; see `dembound respond`.
    """
    from dembound.cli.progress import progress_of
    from dembound.studies.library import Library, build_library

    case = load_disks(path, changes, name)
    prepare_computing(threads)
    with progress_of(case.name) as progress:
        folder = build_library(case, spacing, output, duration, progress)
    made = Library(folder)
    step = f"time step {made.case.run.time_step:.10g} s"
    out.print(f"{case.name}: library of {', '.join(made.inputs)}, {made.duration:g} s, {step}, in {folder}")


@app.command("respond", rich_help_panel="Cases")
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
) -> None:
    """Write the histories of all monitors under records, from a library, without a run.

    They are those of a direct run with the record as a file wave, to rounding, and are plotted and compared like it.
    """
    from dembound.results.folder import Folder
    from dembound.studies.library import Library, read_records, write_response

    made = Library(folder)
    given = read_records(records, made.inputs, made.spacing, made.duration)
    for record in given:
        Folder(output, record.name).check()
    for record in given:
        write_response(made, record, output / record.name / "run.h5")
        out.print(f"{record.name}: histories in {output / record.name}")
