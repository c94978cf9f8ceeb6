"""The command signals: spectra, sections and hodographs of the monitors."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dembound.cli.app import MORE, PICTURE, PictureTitle, app
from dembound.cli.console import out
from dembound.cli.plotted import Component, ComponentOfMotion, Monitors, Quantity, QuantityOfMonitors
from dembound.cli.results import results_file
from dembound.errors import CaseError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Shown(StrEnum):
    """What is shown of the monitors' signals."""

    fourier = "fourier"
    transfer = "transfer"
    response = "response"
    section = "section"
    hodograph = "hodograph"


@app.command("signals", rich_help_panel=MORE)
def signals(
    results: Annotated[list[Path], typer.Argument(metavar="RESULTS...", help="Result folders or HDF5 files.")],
    show: Annotated[
        Shown,
        typer.Option(
            metavar="WHAT",
            help="fourier: amplitude spectra; transfer: their ratios to --reference or to free-field twins; response: "
            "response spectra, 5 % damping; section: histories at their distances along a line of monitors; hodograph: "
            "motion in the plane.",
        ),
    ] = Shown.fourier,
    output: Annotated[Path, PICTURE] = Path("signals.png"),
    title: PictureTitle = None,
    quantity: QuantityOfMonitors = None,
    component: ComponentOfMotion = None,
    monitor: Monitors = None,
    reference: Annotated[
        str | None, typer.Option(metavar="NAME", help="With --show transfer: monitor that is the input.")
    ] = None,
) -> None:
    """Draw spectra, record sections or hodographs (PNG and CSV).

    The table has the name of the picture, with the ending .csv.
    """
    from dembound.plot.style import save
    from dembound.plot.table import write_lines
    from dembound.results.reader import understood

    _require_fitting(show, quantity, component, reference)
    files = [results_file(path) for path in results]
    with understood(*files):
        figure = _drawn(files, show, quantity, component, monitor, reference)
        save(figure, output, title)
    out.print(f"wrote {output}")
    table = output.with_suffix(".csv")
    write_lines(figure, table)
    out.print(f"wrote {table}")


def _require_fitting(
    show: Shown, quantity: Quantity | None, component: Component | None, reference: str | None
) -> None:
    """Raise CaseError for options that have no effect on what is shown."""
    unused = {
        "--quantity": (quantity, Shown.response, "a response spectrum is of the acceleration"),
        "--component": (component, Shown.hodograph, "a hodograph shows x and y"),
    }
    problems = [
        f"{option}: is not allowed with --show {kind}, {why}"
        for option, (value, kind, why) in unused.items()
        if value is not None and show == kind
    ]
    if reference is not None and show != Shown.transfer:
        problems.append("--reference: goes with --show transfer")
    if quantity == Quantity.stress and component is not None:
        problems.append("--component: is of motions; the stress of a bar is that along it")
    if problems:
        raise CaseError(problems)


def _drawn(
    files: Sequence[Path],
    show: Shown,
    quantity: Quantity | None,
    component: Component | None,
    monitor: list[str] | None,
    reference: str | None,
) -> Figure:
    """The picture."""
    from dembound.plot.hodograph import plot_hodograph
    from dembound.plot.section import plot_section
    from dembound.plot.spectra import plot_fourier, plot_response, plot_transfer

    names, of = monitor or None, quantity or Quantity.velocity
    if show == Shown.response:
        return plot_response(files, component.value if component else None, names)
    if show == Shown.hodograph:
        return plot_hodograph(files, of.value, names)
    if show == Shown.transfer:
        return plot_transfer(files, component.value if component else None, of.value, names, reference)
    draw = plot_section if show == Shown.section else plot_fourier
    return draw(files, component.value if component else None, of.value, names)
