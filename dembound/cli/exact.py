"""The command exact."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from dembound.cli.app import MORE, Name, Output, Settings, app, load_disks
from dembound.cli.console import out


@app.command("exact", rich_help_panel=MORE)
def exact(
    path: Annotated[Path, typer.Argument(metavar="CASE", help="Case file (TOML) of a problem with an exact solution.")],
    problem: Annotated[
        str | None, typer.Option(help="lamb, cavity, garvin or scattering; absent: the one that holds for longest.")
    ] = None,
    output: Output = Path("results"),
    changes: Settings = None,
    name: Name = None,
) -> None:
    """Write the exact solution at the monitors of a case, if known.

    Known are Lamb's and Garvin's problem, and a circular hole under a pressure or under a plane wave.

    The solution is plotted and compared like a run. Its folder is named after the case with "_exact", or by --name.
    """
    from dembound.accuracy.of_disks.exact import write_exact

    case = load_disks(path, changes, name or f"{path.stem}_exact")
    folder = output / case.name
    found = write_exact(case, folder / "run.h5", problem)
    for monitor, end in found.until.items():
        if end < case.run.duration:
            out.print(f"{case.name}: {monitor} up to {end:.4g} s, when scattered waves come back from the free surface")
    out.print(f"{case.name}: {found.sentence}, histories in {folder}")
