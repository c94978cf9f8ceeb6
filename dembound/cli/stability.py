"""The command stability."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table
from rich.text import Text

from dembound.cli.app import MORE, PICTURE, PictureTitle, Settings, Threads, app, load_case, prepare_computing
from dembound.cli.calibration import OneCase
from dembound.cli.console import compact_table, err, out
from dembound.cli.options import CurveTable, leave
from dembound.errors import RunError

if TYPE_CHECKING:
    from dembound.plot.stability import Line
    from dembound.studies.stability import Stability


@app.command("stability", rich_help_panel=MORE)
def stability(
    case: OneCase,
    steps: Annotated[
        int | None,
        typer.Option(
            help="Steps of noise at the case's own time step; by default 5,000 to 100,000, by their cost.",
            min=1,
        ),
    ] = None,
    full: Annotated[
        bool, typer.Option("--full", help="Use the whole scene of disks instead of fewer copies of its brick.")
    ] = False,
    output: Annotated[Path, PICTURE] = Path("stability.png"),
    title: PictureTitle = None,
    table: CurveTable = None,
    changes: Settings = None,
    threads: Threads = None,
) -> None:
    """Measure the largest stable time step of a scene, by noise.

    Also checks whether the energy of noise grows at the case's own step.

    Loads and waves are left out. Ends with exit code 3 if the case's own step is not stable.
    """
    from dembound.plot.stability import plot_stability
    from dembound.studies.stability import measure

    prepare_computing(threads)
    loaded = load_case(case, changes)
    found, words = measure(loaded, steps=steps, full=full, report=lambda line: err.print(line))
    out.print(_overview(found, f"{loaded.name}: {words[0]}"))
    done = max(run.course.steps[-1] for each in found for run in each.long_runs)
    for line in [*words[1:], f"{done:,} steps at the case's own step"]:
        out.print(f"  {line}")
    short, long = _lines(found)
    figure = plot_stability(short, long, f"Noise in {loaded.name}: {words[0]}")
    leave(figure, output, title, table)
    _fail_if_unstable(found)


def _overview(found: Sequence[Stability], title: str) -> Table:
    """One line for each law or stage and part: limits, the case's own step, and how its energy changed."""
    from dembound.studies.noise import RESOLUTION

    overview = compact_table("", "limit (s)", "measured", "own step", "energy", "rise", "", title=title)
    for each in found:
        limit = each.trial.limit
        measured = f"> {each.below / limit:.4g}"
        if each.measured < float("inf"):
            measured = f"{each.measured / limit:.{4 if each.width < 2.0 * RESOLUTION else 2}f}"
        for run in each.long_runs:
            name = each.trial.name if len(each.long_runs) == 1 else f"{each.trial.name}, {run.part}"
            last = f"{run.shown[1][-1]:.4g}"
            own = f"{each.trial.step / limit:.4f}"
            state = "stable" if each.is_stable else "UNSTABLE"
            overview.add_row(name, f"{limit:.5g}", measured, own, last, f"{run.rise:.1e}", state)
    overview.caption = Text(
        "measured: largest stable step over the limit; own step: the case's over the limit;\n"
        "energy: at the end over the start, with energy taken by boundaries where contacts may\n"
        "open (if unstable: kinetic energy); rise: largest energy over the start, less 1"
    )
    overview.caption_justify = "left"
    return overview


def _lines(found: Sequence[Stability]) -> tuple[list[Line], list[Line]]:
    """The runs around the limit, and those at the case's own step, for the picture."""
    from dembound.plot.stability import Line

    short, long = [], []
    for group, each in enumerate(found):
        of_limit = each.below / each.trial.limit, each.above / each.trial.limit
        for share, course, dashed in zip(of_limit, (each.growing, each.calm)[::-1], (True, False), strict=True):
            if course.steps:
                name = f"{each.trial.name}: {share:.4f} of the limit"
                short.append(Line(name, group, course.steps, course.kinetic, dashed))
        for index, run in enumerate(each.long_runs):
            name = f"{each.trial.name}, {run.part}: {each.trial.step / each.trial.limit:.4f} of the limit"
            long.append(Line(name, group, *run.shown, index > 0))
    return short, long


def _fail_if_unstable(found: Sequence[Stability]) -> None:
    """Raise RunError, with a line for each law or stage that is not stable at the case's own step."""
    lines = [
        f"{each.trial.name}: not stable at the case's own step of {each.trial.step:.6g} s; the largest stable one is "
        f"{each.measured:.6g} s"
        for each in found
        if not each.is_stable
    ]
    if lines:
        raise RunError("\n".join(lines))
