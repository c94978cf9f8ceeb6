"""The command paper."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Option

from dembound.cli.app import MORE, PictureTitle, Settings, Threads, app, prepare_computing, settings_of
from dembound.cli.console import err, out, print_rows
from dembound.cli.options import leave
from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.cli.progress import Shown
    from dembound.papers import Paper
    from dembound.studies.calibration import Calibration


@app.command("paper", rich_help_panel=MORE)
def paper(
    name: Annotated[str, Argument(metavar="PAPER", help="zhou2018 or lu2016.")],
    figures: Annotated[
        list[str] | None,
        Option("--figure", metavar="NUMBER", help="Figure to draw; may be repeated. Without it, all are listed."),
    ] = None,
    ratios: Annotated[
        list[float] | None,
        Option("--radius-ratio", metavar="λ", help="Ratio of radii λ of pattern B; may be repeated."),
    ] = None,
    changes: Settings = None,
    output: Annotated[
        Path | None, Option("--output", "-o", help="Folder for runs and pictures; by default results/PAPER.")
    ] = None,
    title: PictureTitle = None,
    threads: Threads = None,
) -> None:
    """List the figures of a paper, or draw some as printed.

    A figure makes its own runs, and its numbers are printed beside those of the paper.

    Writes figure_NUMBER.png and figure_NUMBER.md. --set changes a key of all cases of a figure, such as the length of
    the pulse, wave.pulse.period=0.25.
    """
    from dembound.papers import PAPERS, Work

    if name not in PAPERS:
        raise CaseError([f"PAPER: is {name}, must be one of {', '.join(PAPERS)}"])
    asked = {number: PAPERS[name].figure(number) for number in figures or ()}
    if not asked:
        _list(name, PAPERS[name])
        return
    if title is not None and len(asked) > 1:
        raise CaseError(["--title: names one picture, there are several here"])
    prepare_computing(threads)
    from dembound.files import make_folder, write_text
    from dembound.papers.figure import markdown

    folder = output or Path("results") / name
    make_folder(folder)
    work = Work(name, folder, settings_of(changes), tuple(ratios or ()), _watched, _print_pass)
    for number, figure in asked.items():
        picture, rows = work.draw(number, figure)
        said = [*(f"λ = {ratio:g}" for ratio in work.ratios), *(changes or ())]
        print_rows("; ".join([f"figure {number}: {figure.title}", *said]), [("number", "found", "printed"), *rows], 3)
        out.print("")
        leave(picture, folder / f"figure_{number}.png", title)
        write_text(folder / f"figure_{number}.md", markdown(("number", "found", "printed"), rows) + "\n")
        out.print(f"wrote {folder / f'figure_{number}.md'}")


def _list(name: str, paper: Paper) -> None:
    """Print the figures of a paper with the CPU time of their runs."""
    rows = [(number, f"{each.seconds:g}", each.title, each.chinese) for number, each in paper.figures.items()]
    print_rows(paper.citation, [("figure", "CPU (s)", "shows", "图名"), *rows], 4)
    out.print("")
    out.print(f"{paper.left_out}; draw one: dembound paper {name} --figure {next(iter(paper.figures))}")


def _watched(name: str) -> AbstractContextManager[Shown]:
    """The progress of a run."""
    from dembound.cli.progress import progress_of

    return progress_of(name)


def _print_pass(found: Calibration) -> None:
    """Print one pass of a calibration, as progress."""
    err.print(
        f"{found.case.name}: pass {len(found.beta)}, β = {found.beta[-1]:.4f}, M_out = {found.outgoing[-1]:.4f} m/s"
    )
