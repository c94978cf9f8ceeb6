"""The command estimate."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dembound.cli.app import MORE, Threads, app, prepare_computing
from dembound.cli.console import err, out
from dembound.cli.results import results_file
from dembound.errors import CaseError, DemboundError, RecordError

if TYPE_CHECKING:
    from dembound.accuracy.budget import Budget

Repeat = Annotated[
    bool,
    typer.Option(
        "--repeat", help="Repeat the run with 0.98 of its time step, to see how much of the cracks is chance."
    ),
]


@app.command("estimate", rich_help_panel=MORE)
def estimate(
    results: Annotated[list[Path], typer.Argument(metavar="RESULTS...", help="Folders of results of complete runs.")],
    repeat: Repeat = False,
    threads: Threads = None,
) -> None:
    """Estimate the errors of runs by sides, grid and time step.

    Writes estimate.h5 and the entry error_estimate of summary.json; see docs/tasks/trust_a_result.md.
    """
    from dembound.accuracy.estimate import estimate_results
    from dembound.cli.progress import watched
    from dembound.results.folder import with_name

    prepare_computing(threads)
    problems: list[str] = []
    failure: type[CaseError] = RecordError  # if all are errors of files
    for path in results:
        try:
            folder = with_name(results_file(path)).parent
            with watched(folder.name) as watching:
                found = estimate_results(folder, repeat, watching)
            _show(folder, found)
        except CaseError as error:
            problems += [line for line in str(error).splitlines() if line not in problems]
            failure = failure if isinstance(error, RecordError) else CaseError
    if problems:
        raise failure(problems)


def print_estimate(folder: Path) -> None:
    """Print the error estimate of a completed run, or why there is none."""
    from dembound.accuracy.estimate import estimate_results
    from dembound.cli.progress import watched

    try:
        with watched(folder.name) as watching:
            found = estimate_results(folder, watch=watching)
        _show(folder, found)
    except DemboundError as error:
        err.print(f"{folder.name}: errors are not estimated: {error}")


def _show(folder: Path, found: Budget) -> None:
    """Print an estimate, and draw its band into the run's picture of the histories, if there is one."""
    from dembound.accuracy.table import lines_of, next_step
    from dembound.plot.histories import plot_histories
    from dembound.plot.style import save
    from dembound.running.recorded import file_of_record

    out.print(f"{folder.name}: errors, estimated in {found.cpu_seconds:.2g} s of CPU time", markup=False)
    for line in [*lines_of(found), next_step(found, folder, file_of_record(folder / "run.h5"))]:
        out.print(line, markup=False, soft_wrap=True)
    picture = folder / "histories.png"
    if picture.is_file():
        save(plot_histories([folder / "run.h5"]), picture)
