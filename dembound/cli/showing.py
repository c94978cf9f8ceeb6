"""Commands that show results: signals, report, movie."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from typer import Argument, Option

from dembound.cli.app import MORE, PICTURE, PictureTitle, app, at_most, ending_in, writable
from dembound.cli.console import err, out, print_written, seldom
from dembound.cli.options import (
    ComponentOfMotion,
    Exaggerated,
    Monitors,
    QuantityOfMonitors,
    SceneField,
    leave,
    with_tables,
)
from dembound.cli.results import results_file
from dembound.errors import CaseError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@app.command("report")
def report(
    results: Annotated[list[Path], Argument(metavar="RESULTS...", help="Result folders or HDF5 files.")],
    output: Annotated[Path, Option("--output", "-o", help="Page (HTML).", callback=ending_in(".html", ".htm"))] = Path(
        "report.html"
    ),
) -> None:
    """Write an HTML page of runs: scenes, histories, spectra, energy.

    The page is one file and loads nothing; pictures and tables are there without scripts and in print, too.
    """
    from dembound.report.page import write_report

    write_report([results_file(path) for path in results], output, err.print)
    out.print(f"wrote {output} ({output.stat().st_size / 1e6:.1f} MB)")


def _movie(path: Path) -> Path:
    """A movie to write, of a format that can be written here."""
    from dembound.report.pictures import require_movie

    require_movie(path)
    return (writable(path) if path.suffix else None) or path


@app.command("movie", rich_help_panel=MORE)
def movie(
    results: Annotated[Path, Argument(metavar="RESULTS", help="A run's result folder or HDF5 file.")],
    output: Annotated[
        Path, Option("--output", "-o", help="GIF, or a new folder of PNG files.", callback=_movie)
    ] = Path("movie.gif"),
    field: Annotated[
        SceneField | None, Option(metavar="FIELD", help="Field shown: velocity, of a bar also stress and damage.")
    ] = None,
    exaggerate: Exaggerated = None,
    monitor: Annotated[
        list[str] | None,
        Option(metavar="NAME", help="Show this monitor's history below. May be repeated; by default all."),
    ] = None,
    histories: Annotated[bool, Option(help="Histories below the scene.")] = True,
    fps: Annotated[float, Option(help="Frames per second.", min=0.1, callback=at_most(1000))] = 10.0,
    size: Annotated[int, Option(help="Width of the picture in pixels.", min=200, callback=at_most(8192))] = 960,
    every: Annotated[int, Option(help="Show only every N-th snapshot.", min=1)] = 1,
) -> None:
    """Write a movie of a run (GIF, or PNG frames).

    There is a frame for each snapshot: run the case with --set output.snapshots=100 or so.
    """
    from dembound.report.pictures import movie_of, write_movie
    from dembound.results.reader import understood

    file = results_file(results)
    names = (monitor or None) if histories else []
    with understood(file):
        shown = movie_of(file, field=field, exaggerate=exaggerate, monitors=names, every=every, pixels=size)
        with _counted(len(shown)) as progress:
            write_movie(shown, output, fps, progress)
    size_in_bytes = sum(path.stat().st_size for path in [output, *output.glob("*.png")])
    out.print(f"wrote {output} ({len(shown)} frames, {size_in_bytes / 1e6:.1f} MB)")


@contextmanager
def _counted(frames: int) -> Iterator[Callable[[int], None]]:
    """Print how many frames are drawn: on a terminal in one line, else every ten seconds."""
    is_due = seldom()

    def count(drawn: int) -> None:
        if err.is_terminal:
            status.update(f"frame {drawn} of {frames}")
        elif is_due():
            err.print(f"frame {drawn} of {frames}")

    with err.status("") as status:
        yield count


Shown = Literal["fourier", "transfer", "response", "section", "hodograph", "surface"]
"""What is shown of the monitors' signals."""


@dataclass(frozen=True)
class SignalsShown:
    """The signals of monitors that are shown."""

    quantity: QuantityOfMonitors = None
    component: ComponentOfMotion = None
    monitor: Monitors = None
    reference: Annotated[str | None, Option(metavar="NAME", help="Input of transfer or surface.")] = None

    def problems(self, show: Shown, count: int) -> Iterator[str]:
        """Options that have no effect on what is shown, for a number of results."""
        unused = (
            ("--quantity", self.quantity, "response", "a response spectrum is of the acceleration"),
            ("--quantity", self.quantity, "surface", "which shows velocity, acceleration and displacement"),
            ("--component", self.component, "hodograph", "a hodograph shows x and y"),
        )
        for option, value, kind, why in unused:
            if value is not None and show == kind:
                yield f"{option}: is not allowed with --show {kind}, {why}"
        if self.reference is not None and show not in ("transfer", "surface"):
            yield "--reference: goes with --show transfer or surface"
        if show == "surface" and self.component == "rotation":
            yield "--component: is rotation, must be x, y or both with --show surface"
        if show == "surface" and count > 1:
            yield "--show: surface shows one run, name one"
        if self.quantity == "stress" and self.component is not None:
            yield "--component: is of motions; the stress of a bar is that along it"

    def draw(self, files: Sequence[Path], show: Shown) -> Figure:
        """The picture."""
        from dembound.plot.histories import plot_hodograph, plot_section
        from dembound.plot.spectra import plot_fourier, plot_response, plot_transfer

        names, of = self.monitor or None, self.quantity or "velocity"
        if show == "response":
            return plot_response(files, self.component, names)
        if show == "hodograph":
            return plot_hodograph(files, of, names)
        if show == "transfer":
            return plot_transfer(files, self.component, of, names, self.reference)
        return (plot_section if show == "section" else plot_fourier)(files, self.component, of, names)

    def leave_surface(self, file: Path, output: Path, title: str | None) -> None:
        """Write picture and table of the amplification along the surface, and where its free field is."""
        from dembound.plot.surface import COMPONENTS, plot_surface
        from dembound.results.surface import amplification
        from dembound.results.text_files import write_csv

        found = amplification(file, self.monitor or None, self.reference)
        leave(plot_surface(file, found, self.component), output, title)
        write_csv(table := output.with_suffix(".csv"), found.rows())
        print_written(table)
        for line in found.notes(COMPONENTS[self.component or "both"]):
            out.print(line)


@app.command("signals", rich_help_panel=MORE)
@with_tables
def signals(
    results: Annotated[list[Path], Argument(metavar="RESULTS...", help="Result folders or HDF5 files.")],
    show: Annotated[
        Shown,
        Option(
            metavar="WHAT",
            help="fourier; transfer: ratios to --reference or to free-field twins; response: with 5 % damping; "
            "section: histories at their distances; hodograph; surface: motion along the surface over the free "
            "field's.",
        ),
    ] = "fourier",
    output: Annotated[Path, PICTURE] = Path("signals.png"),
    title: PictureTitle = None,
    *,
    of: SignalsShown,
) -> None:
    """Draw spectra, sections, hodographs or surfaces (PNG and CSV).

    The table has the name of the picture, with the ending .csv.
    """
    from dembound.results.reader import understood

    if problems := list(of.problems(show, len(results))):
        raise CaseError(problems)
    files = [results_file(path) for path in results]
    with understood(*files):
        if show == "surface":
            of.leave_surface(files[0], output, title)
            return
        leave(of.draw(files, show), output, title, output.with_suffix(".csv"))
