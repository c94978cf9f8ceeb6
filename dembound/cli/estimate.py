"""The command estimate."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from dembound.cli.app import Threads, app, prepare_computing
from dembound.cli.console import err, out
from dembound.errors import DemboundError

Budget = Annotated[
    float | None,
    typer.Option(min=0.0, help="Share of the run's work that the estimate may take; by default 0.1.", metavar="SHARE"),
]


@app.command("estimate", rich_help_panel="Results")
def estimate(
    results: Annotated[list[Path], typer.Argument(metavar="RESULTS...", help="Folders of results of complete runs.")],
    budget: Budget = None,
    threads: Threads = None,
) -> None:
    """Estimate how wrong runs are: by their sides, their grid and their time step, at every monitor.

    Writes estimate.h5 and the entry error_estimate of summary.json; see docs/estimates.md.
    """
    from dembound.results.folder import Folder
    from dembound.studies.estimate import estimate_results

    prepare_computing(threads)
    for path in results:
        folder = Folder.of(path.parent if path.suffix == ".h5" else path).final
        _print(folder.name, estimate_results(folder, budget).lines())


def print_estimate(folder: Path, budget: float | None) -> None:
    """Print the estimate of a run that is over; if there can be none, why."""
    from dembound.studies.estimate import estimate_results

    try:
        _print(folder.name, estimate_results(folder, budget).lines())
    except DemboundError as error:
        err.print(f"{folder.name}: errors are not estimated: {error}")


def _print(name: str, lines: list[str]) -> None:
    """One line after the other, with the name of the run."""
    for line in lines:
        out.print(f"{name}: {line}")
