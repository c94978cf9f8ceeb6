"""Commands that show results to people without dembound: report, movie."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from dembound.cli.app import app, writable
from dembound.cli.console import err, out
from dembound.cli.results import results_file
from dembound.errors import CaseError


def _page(path: Path) -> Path:
    """A page to write. Raises CaseError if its name does not end in ``.html``."""
    if path.suffix.lower() not in (".html", ".htm"):
        raise CaseError([f"--output: is {path}, must end in .html"])
    writable(path)
    return path


@app.command("report", rich_help_panel="Results")
def report(
    results: Annotated[list[Path], typer.Argument(metavar="RESULTS...", help="Result folders or HDF5 files.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Page to write (HTML).", callback=_page)] = Path(
        "report.html"
    ),
) -> None:
    """Write a page of one or several runs for any browser: scenes, histories and spectra to zoom, energies, cases.

    The page is one file and loads nothing; pictures and tables are there without scripts and in print, too.
    """
    from dembound.report.page import write_report

    write_report([results_file(path) for path in results], output, err.print)
    out.print(f"wrote {output} ({output.stat().st_size / 1e6:.1f} MB)")
