"""The command estimate."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dembound.cli.app import Threads, app, prepare_computing
from dembound.cli.console import err, out
from dembound.cli.results import results_file
from dembound.errors import CaseError, DemboundError, RecordError

if TYPE_CHECKING:
    from dembound.accuracy.budget import Estimate

Budget = Annotated[
    float | None,
    typer.Option(min=0.0, help="Share of the run's work that the estimate may take; by default 0.1.", metavar="SHARE"),
]


SecondSeed = Annotated[
    bool,
    typer.Option("--second-seed", help="Run once more with another random packing: how much depends on it."),
]


Repeat = Annotated[
    bool,
    typer.Option("--repeat", help="Run once more with 0.98 of the time step: how much of the cracks is chance."),
]


@app.command("estimate", rich_help_panel="Results")
def estimate(
    results: Annotated[list[Path], typer.Argument(metavar="RESULTS...", help="Folders of results of complete runs.")],
    budget: Budget = None,
    second_seed: SecondSeed = False,
    repeat: Repeat = False,
    threads: Threads = None,
) -> None:
    """Estimate how wrong runs are: by their sides, their grid and their time step, at every monitor.

    Writes estimate.h5 and the entry error_estimate of summary.json; see docs/estimates.md.
    """
    from dembound.accuracy.estimate import estimate_results
    from dembound.results.folder import with_name

    prepare_computing(threads)
    problems: list[str] = []
    failure: type[CaseError] = RecordError  # if all are errors of files
    for path in results:
        try:
            folder = with_name(results_file(path)).parent
            _show(folder, estimate_results(folder, budget, second_seed, repeat))
        except CaseError as error:
            problems += [line for line in str(error).splitlines() if line not in problems]
            failure = failure if isinstance(error, RecordError) else CaseError
    if problems:
        raise failure(problems)


def print_estimate(folder: Path, budget: float | None = None) -> None:
    """Print the estimate of a run that is over; if there can be none, why."""
    from dembound.accuracy.estimate import estimate_results

    try:
        _show(folder, estimate_results(folder, budget))
    except DemboundError as error:
        err.print(f"{folder.name}: errors are not estimated: {error}")


def _show(folder: Path, found: Estimate) -> None:
    """Print an estimate, and draw its band into the picture of the histories if the run has drawn one."""
    from dembound.plot.histories import plot_histories
    from dembound.plot.style import save

    for line in found.lines():
        out.print(f"{folder.name}: {line}")
    out.print(f"{folder.name}: estimated in {found.cpu_seconds:.2g} s of CPU time")
    picture = folder / "histories.png"
    if picture.is_file():
        save(plot_histories([folder / "run.h5"]), picture)
