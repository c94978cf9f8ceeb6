"""The command sweep."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from dembound.cli.app import (
    Name,
    Output,
    PictureTitle,
    Scheduler,
    Settings,
    Vary,
    app,
    load_case,
    require_one_place,
)
from dembound.cli.console import INTERVAL, err, out, print_rows
from dembound.errors import CaseError
from dembound.interrupts import exit_code_of
from dembound.studies.asked import Method
from dembound.words import in_one_unit

if TYPE_CHECKING:
    from dembound.studies.sweep.study import Report, Standing
    from dembound.studies.sweep.tables import Statistic, Swept

FAILED = 3
"""Exit code of a sweep with members that failed."""


PREFIXED = ("m/s", "m", "s", "Pa")
"""Units that are printed with the prefix that suits the number."""

MOST_ROWS = 40
"""Largest number of rows of the printed table."""

MOST_WARNINGS = 10
"""Largest number of distinct warnings of members that are printed."""


SweepAction = Literal["run", "calibrate"]
"""The action for every member."""


@app.command("sweep")
def sweep(
    case: Annotated[Path, typer.Argument(metavar="CASE", help="A case file (TOML).")],
    vary: Vary = None,
    together: Annotated[
        bool | None,
        typer.Option(
            "--together/--product", help="First values of all keys together, then the second ones, and so on."
        ),
    ] = None,
    action: Annotated[
        SweepAction | None, typer.Option(metavar="ACTION", help="run or calibrate (all sides with dashpots).")
    ] = None,
    method: Annotated[
        Method | None,
        typer.Option(metavar="METHOD", help="Method of calibration, see `dembound calibrate`."),
    ] = None,
    processes: Annotated[
        int | None, typer.Option("--processes", "-p", min=1, help="Members at once; as many as cores by default.")
    ] = None,
    scheduler: Scheduler = None,
    anew: Annotated[bool, typer.Option("--anew", help="Also repeat members that are done.")] = False,
    quantity: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Column of sweep.csv to draw. May be repeated.")
    ] = None,
    output: Output = Path("results"),
    title: PictureTitle = None,
    changes: Settings = None,
    name: Name = None,
) -> None:
    """Run or calibrate a case for many values of its keys.

    Values are given by --vary, or by sweep.vary in the case. Means are over members that differ only in seeds.

    Complete members are not repeated: the same command continues a sweep, and more values add members to it.
    """
    from dembound.accuracy.choice import parsed_options
    from dembound.studies.sweep.members import members_of, variations
    from dembound.studies.sweep.study import Options
    from dembound.studies.sweep.study import sweep as sweep_all

    require_one_place(scheduler, processes)
    loaded = load_case(case, changes, name)
    table = loaded.sweep
    options = Options(
        action=action or table.action,
        method=method or table.method,
        processes=processes or table.processes,
        scheduler=scheduler,
        anew=anew,
    )
    if method and options.action != "calibrate":
        raise CaseError(["--method: is for --action calibrate"])
    varied = variations(parsed_options(vary) if vary else table.vary, table.together if together is None else together)
    members, left_out = members_of(loaded, varied, options.action, options.method)
    for line in left_out:
        err.print(f"{loaded.name}: {line}")
    folder = output / f"{loaded.name}_sweep"
    try:
        with shown(loaded.name) as report:
            outcomes = sweep_all(members, options, folder, report)
    except KeyboardInterrupt as stop:
        err.print(f"{loaded.name}: stopped; the same command continues what is left")
        raise typer.Exit(exit_code_of(stop)) from None
    from dembound.studies.sweep.tables import Swept

    swept = Swept(loaded, options.action, members, outcomes, quantity or [])
    has_failed = _print(swept)
    for path in _leave(swept, folder, title):
        out.print(f"wrote {path}")
    if has_failed:
        raise typer.Exit(FAILED)


@contextmanager
def shown(
    name: str, members: str = "members", under_way: Callable[[Standing], str] = lambda standing: ""
) -> Iterator[Report]:
    """Shows the progress of a sweep: a line that changes on a terminal, else one every ten seconds.

    members : what they are called. under_way : more words on those under way.
    """
    began = said = time.monotonic()

    def line(standing: Standing) -> str:
        return f"{name}: {_in_words(standing, time.monotonic() - began, members, under_way(standing))}"

    def say(standing: Standing) -> None:
        nonlocal said
        if (now := time.monotonic()) - said >= INTERVAL:
            said = now
            err.print(line(standing))

    if not err.is_terminal:
        yield say
        return
    with err.status(f"{name}: preparing") as status:
        yield lambda standing: status.update(line(standing))


def _in_words(standing: Standing, elapsed: float, members: str = "members", more: str = "") -> str:
    """The progress of a sweep after a number of seconds, in one line; members, more : see `shown`."""
    now = standing.done + standing.failed - standing.kept
    left = standing.members - standing.done - standing.failed
    parts = [f"{standing.done} of {standing.members} {members} done"]
    parts += [f"{standing.failed} failed"] if standing.failed else []
    parts += [f"{standing.under_way} under way{more}"] if standing.under_way else []
    parts += [f"about {_duration(elapsed * left / now)} left"] if now and left else []
    return ", ".join(parts)


def _duration(seconds: float) -> str:
    """A time in s, min or h."""
    for unit, size in (("h", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds:.0f} s"


def _print(swept: Swept) -> bool:
    """Print failed members, warnings, and means of the shown quantities; returns whether any has failed."""
    from dembound.studies.sweep.tables import statistics

    failed = [(m.name, state) for m, state in zip(swept.members, swept.states, strict=True) if state != "done"]
    for member, state in failed:
        err.print(f"{swept.case.name}: {member}: failed, {state}")
    print_warnings(swept.case.name, swept.warnings, len(swept.members))
    found = [each for each in statistics(swept.members, swept.outcomes) if each.quantity in swept.shown]
    if found:
        print_rows(swept.case.name, list(_rows(found[:MOST_ROWS])), left=2)
    if len(found) > MOST_ROWS:
        out.print(f"{len(found) - MOST_ROWS} more rows are in statistics.csv")
    out.print(f"{swept.case.name}: {len(swept.members) - len(failed)} of {len(swept.members)} members done")
    return bool(failed)


def print_warnings(name: str, warnings: Mapping[str, int], count: int, members: str = "members") -> None:
    """Print distinct warnings of a number of members, each once with the number of those that have it.

    members : as of `shown`.
    """
    for text, having in list(warnings.items())[:MOST_WARNINGS]:
        err.print(f"{name}: warning: {text} ({having} of {count} {members})")
    if len(warnings) > MOST_WARNINGS:
        left = len(warnings) - MOST_WARNINGS
        err.print(f"{name}: {left} more warnings are in summary.json of the {members}")


def _rows(statistics: Sequence[Statistic]) -> Iterator[Sequence[str]]:
    """A head, and a row for each group of members and quantity, with three digits; all digits are in the files."""
    from dembound.accuracy.choice import in_words, short_keys
    from dembound.studies.sweep.members import unit_of

    yield "members", "quantity", "n", "mean", "spread", "95 % ±", "unit"
    for each in statistics:
        pairs = zip(short_keys(each.group), each.group.values(), strict=True)
        group = ", ".join(f"{key} {in_words(value)}" for key, value in pairs)
        numbers, unit = (each.mean, each.spread, each.interval), unit_of(each.quantity)
        texts = [f"{value:.3g}" for value in numbers]
        if unit in PREFIXED:
            texts, unit = in_one_unit(numbers, unit)
        shown = ("–" if value != value else text for value, text in zip(numbers, texts, strict=True))
        yield group or "all", each.quantity, str(each.count), *shown, "" if unit == "1" else unit


def _leave(swept: Swept, folder: Path, title: str | None) -> Iterator[Path]:
    """Write the results of a sweep, yielding each file."""
    from dembound.files import remove
    from dembound.studies.sweep.tables import write_tables

    yield from write_tables(swept, folder)
    remove(folder / "sweep.png")
    if swept.shown:
        from dembound.plot.style import save
        from dembound.plot.sweep import plot_sweep

        save(plot_sweep(folder / "sweep.h5"), folder / "sweep.png", title)
        yield folder / "sweep.png"
