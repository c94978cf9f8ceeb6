"""The command chart."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from typer import Option

from dembound.cli.advise import Of
from dembound.cli.app import Name, Output, PictureTitle, Settings, Vary, app, few, load_case, prepare_computing
from dembound.cli.calibration import OneCase
from dembound.cli.console import ending_with, err, out, print_rows, print_written
from dembound.cli.options import leave, names_of

if TYPE_CHECKING:
    from dembound.accuracy.chart.study import Charted, Line


ChartQuantity = Literal["velocity", "displacement", "stress"]
"""Quantities of the monitors that are compared."""


ChartComponent = Literal["x", "y"]
"""Components of the monitors' motion that are compared."""


ChartReference = Literal["exact", "extended", "finer", "finest"]
"""What errors are measured against."""


@app.command("chart")
def chart(
    case: OneCase,
    vary: Vary = None,
    reference: Annotated[
        ChartReference | None,
        Option(
            metavar="REFERENCE",
            help="exact; extended, a scene so large that nothing returns; finer, of bars; finest, the choice with "
            "the most nodes times steps. By default the first that the case allows.",
        ),
    ] = None,
    quantity: Annotated[
        ChartQuantity, Option(metavar="QUANTITY", help=f"Quantity compared: {names_of(ChartQuantity)} (bars).")
    ] = "velocity",
    component: Annotated[ChartComponent | None, Option(help="By default the largest in the reference.")] = None,
    monitor: Annotated[str | None, Option(metavar="NAME", help="By default that with the largest error.")] = None,
    of: Of = None,
    repeats: Annotated[
        int | None, Option(min=1, callback=few, help="Timed runs of every choice; by default 3, or the case's.")
    ] = None,
    resume: Annotated[bool, Option("--resume", help="Only choices that the chart does not have.")] = False,
    output: Output = Path("results"),
    title: PictureTitle = None,
    changes: Settings = None,
    name: Name = None,
    threads: Annotated[int, Option(min=1, help="CPU times vary least with one.")] = 1,
) -> None:
    """Chart the errors of many choices of keys against their cost.

    Choices are given by --vary, by the table chart of the case, or else chosen: radii, steps, sides, methods.

    Writes chart.png, chart.csv and chart.h5, and prints the cheapest choice within 1 % and within 0.1 %.
    """
    from dembound.accuracy.chart.study import Options
    from dembound.accuracy.chart.study import chart as make
    from dembound.accuracy.choice import combinations, parsed_options
    from dembound.accuracy.reference import Requested
    from dembound.cli.progress import progress_of

    prepare_computing(threads)
    loaded = load_case(case, changes, name)
    named = combinations(loaded, parsed_options(vary)) if vary else None
    options = Options(named, repeats, reference, of, Requested(quantity, component, monitor))
    folder = output / f"{loaded.name}_chart"

    with ending_with(f"{loaded.name}: stopped; `dembound chart --resume` with the same options continues"):
        charted = make(loaded, options, folder, resume, lambda run: progress_of(f"{loaded.name}, {run}"))
    _print(charted)
    _leave(charted, folder, title)


def _print(charted: Charted) -> None:
    """Print a line for every choice, the choices left out, and the cheapest ones."""
    failures = [f"{line.choice.name}: failed, {line.outcome.failure}" for line in charted.lines if line.outcome.failure]
    for text in (*charted.left_out, *failures):
        err.print(f"{charted.case.name}: {text}")
    has_rest = bool(charted.reference.rest)
    errors = ("measured (%)", "total (%)", "peak (%)") if has_rest else ("RMS (%)", "peak (%)")
    rows: list[Sequence[str]] = [("choice", *errors, "cost (s)", "run (s)", "work", "")]
    by_cost = sorted(enumerate(charted.lines), key=lambda each: (bool(each[1].outcome.failure), each[1].point.cost))
    for number, line in by_cost:
        found = charted.found(line)
        name = f"{line.choice.name}: {found}" if found else line.choice.name
        cells = _cells(charted, number, line, has_rest)
        rows.append((name, *cells, *[""] * (len(rows[0]) - 1 - len(cells))))
    print_rows(f"{charted.case.name}: {charted.quantity} beside {charted.reference.sentence}", rows)
    out.print("")
    out.print(charted.reference.covered)
    out.print("* no other choice is more accurate and as cheap (Pareto front)")
    out.print("cost: least CPU time of the steps; those within a quarter of each other count as equal")
    out.print(f"run: median time of the whole run without files; work: {charted.work_unit}")
    if farthest := max(line.apart for line in charted.lines):
        out.print(f"† monitors record elsewhere than in the reference, up to {farthest:.3g} m away")
    out.print(f"{charted.case.name}: {charted.sentence}")


def _cells(charted: Charted, number: int, line: Line, has_rest: bool) -> list[str]:
    """Numbers of a choice as text, with its total error if references have one; rounding errors are 0."""
    from dembound.accuracy.chart.study import NONE

    if line.outcome.failure:
        return ["failed"]
    worst = line.errors[0]
    mark = "ref." if number in charted.reference.own else "*" if number in charted.front else ""
    mark += "†" if line.apart > 0.0 else ""
    shares = (
        100.0 * error if error > NONE else 0.0
        for error in (worst.rms, *([worst.total] if has_rest else []), worst.peak)
    )
    return [*(f"{number:.3g}" for number in (*shares, line.point.cost, line.wall, line.outcome.work)), mark]


def _leave(charted: Charted, folder: Path, title: str | None) -> None:
    """Write the results of a chart, printing each file."""
    from dembound.accuracy.chart.tables import write_results, write_table
    from dembound.plot.chart import plot_chart

    for path, write in ((folder / "chart.h5", write_results), (folder / "chart.csv", write_table)):
        write(charted, path)
        print_written(path)
    leave(plot_chart(folder / "chart.h5", title), folder / "chart.png")
