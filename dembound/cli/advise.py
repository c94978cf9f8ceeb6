"""The commands advise and estimate, and the option --error of run: errors, and the cheapest choice that keeps them."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from typer import Argument, Option

from dembound.cli.app import MORE, Cases, Settings, Threads, app, load_case, prepare_computing, text_for
from dembound.cli.console import err, out, print_lines
from dembound.cli.results import results_file
from dembound.errors import CaseError, DemboundError, NotAccurateError, RecordError
from dembound.machine import one_thread_for_matrices
from dembound.words import percent, with_unit

if TYPE_CHECKING:
    from dembound.accuracy.budget import Budget
    from dembound.accuracy.proposal import Advice, Proposal
    from dembound.casefile import Case

LOWERED = {
    "sides": 'wider ground, or sides of type = "outside"',
    "grid": "smaller disks or cells",
    "walls of holes": "smaller disks",
    "time step": "a smaller time step",
}
"""What lowers the error by a cause by hand."""


Truth = Literal["disks", "rock"]
"""The motion with which a case is compared."""


Error = Annotated[
    str | None,
    Option(
        "--error",
        metavar="ERROR",
        help="Largest error of velocity and displacement at all monitors, as 1%. "
        "Sides, box, disks, elements, law, step and end are chosen as cheaply as this allows.",
    ),
]
Keep = Annotated[
    list[str] | None,
    Option(
        "--keep",
        metavar="KEY",
        help="A key or table that is not changed, e.g. packing.radius or boundary. May be repeated; keys given by "
        "--set are not changed either.",
    ),
]
Of = Annotated[
    Truth | None,
    Option(
        "--of",
        help="Errors of these disks, or of the rock for which they are a grid; by default disks where the packing is "
        "random or bonds may break.",
    ),
]
Seeds = Annotated[int, Option(min=1, help="Random packings, to see how results scatter.", metavar="N")]
Longest = Annotated[
    float | None,
    Option(
        "--longest",
        min=0.0,
        metavar="SECONDS",
        help="CPU seconds of the steps of a choice, by default 60, or 64 times those of the case.",
    ),
]


@app.command("advise")
def advise_cases(
    cases: Cases,
    error: Error = None,
    of: Of = None,
    keep: Keep = None,
    seeds: Seeds = 1,
    longest: Longest = None,
    changes: Settings = None,
    threads: Threads = None,
) -> None:
    """Predict the error of a case, and find the cheapest accurate one.

    Prints the cause of each error at every monitor, and the cheapest cases for errors of 10, 3, 1 and 0.3 %.

    With --error it writes the cheapest case for this error as CASE_1pct.toml, without replacing a file.

    All other lines of the case remain, comments too.

    Only small scenes with larger disks are run; see docs/tasks/trust_a_result.md.
    """
    one_thread_for_matrices()  # before numpy is imported
    from dembound.accuracy.estimate import BOUNDS, advise
    from dembound.cli.progress import Table, watched

    bound = bound_of(error)
    targets = [] if bound is None else [path.with_name(f"{name_within(path.stem, bound)}.toml") for path in cases]
    if there := [target for target in targets if target.exists()]:
        raise CaseError([f"{target}: exists already; remove or rename it" for target in there])
    prepare_computing(threads)
    bounds = BOUNDS if bound is None else (bound,)
    kept = _kept(keep, changes)
    missed = []
    for number, path in enumerate(cases):
        case = load_case(path, changes)
        with watched(case.name, partial(Table, bounds)) as table:
            found = advise(case, bounds, of, kept, seeds, longest, table)
        print_lines(f"advice took {with_unit(found.cpu_seconds, 's', 2)} of CPU time")
        if bound is None:
            print_lines(f"write one: dembound advise {path} --error 3%")
        elif not found.best[bound].holds(bound):
            missed.append(_missed(case, found, bound))
        elif found.best[bound].choice.changes:
            target = targets[number]
            _write(found.best[bound], text_for(target, path, case, changes), target)
    if missed:
        raise NotAccurateError("\n".join(missed))


def bound_of(error: str | None) -> float | None:
    """The error bound given by ``--error``, None without it; raises CaseError unless it is a share from 0 to 1."""
    if error is None:
        return None
    text = error.strip()
    try:
        bound = 0.01 * float(text[:-1]) if text.endswith("%") else float(text)
    except ValueError:
        bound = 0.0
    if not 0.0 < bound < 1.0:
        raise CaseError([f"--error: is {error}, must be above 0 and below 1, such as 1% or 0.01"])
    return bound


def name_within(name: str, bound: float) -> str:
    """The name of a case within an error bound, and of its results: ``bar_1pct``, ``bar_0_3pct``."""
    number = f"{Decimal(f'{100.0 * bound:.6g}'):f}"
    return f"{name}_{number.replace('.', '_')}pct"


def chosen(
    case: Case, bound: float, keep: Sequence[str] | None, changes: Sequence[str] | None, longest: float | None = None
) -> Case:
    """The case with the cheapest choice that keeps an error bound; prints the choice.

    keep, longest : values of the options; changes : of ``--set``, whose keys are also kept.

    Raises NotAccurateError if no choice keeps the bound, with the best one; and the errors of `advise`.
    """
    from dembound.accuracy.estimate import advise
    from dembound.cli.progress import watched

    with watched(case.name) as watching:
        watching.missing = f"the cheapest choice within {percent(bound, 3)}; nothing has been run"
        found = advise(case, (bound,), kept=_kept(keep, changes), longest=longest, watch=watching)
    best = found.best[bound]
    if not best.holds(bound):
        raise NotAccurateError(_missed(case, found, bound))
    print_lines(*(f"{case.name}: {line}" for line in (_line(best), *(best.choice.toml or ["the case as it is"]))))
    return best.case


def _kept(keep: Sequence[str] | None, changes: Sequence[str] | None) -> list[str]:
    """Keys that are not changed."""
    return [*(keep or ()), *(text.partition("=")[0].strip() for text in changes or ())]


def _line(best: Proposal) -> str:
    """The choice in words, with its error and cost."""
    from dembound.results.histories import split_in_words

    worst = best.budget.worst()
    return (
        f"{best.choice.name}; predicted error {worst.share.expected}, at most {worst.share.most} "
        f"({split_in_words(worst.by)}), steps take about {with_unit(best.cost, 's', 2)}"
    )


def _missed(case: Case, found: Advice, bound: float) -> str:
    """A message that no choice keeps a bound, with the best one."""
    best = found.best[bound]
    worst = best.budget.worst()
    said = [f"{case.name}: no choice keeps {percent(bound, 3)}; the best of {found.tried} is: {_line(best)}"]
    unknown = [cause for cause in best.budget.causes.unknown if cause.counts(best.budget.of)]
    if worst.share.at_least:  # no choice with this cause would do
        said += [f"not estimated, so that no bound is kept: {each.name}, {each.words}" for each in unknown]
    else:
        said.append("next: --longest SECONDS tries choices that take longer, and searches for a fifth of it")
    if worst.by:
        cause = max(worst.by, key=lambda name: worst.by[name])
        by_hand = f"; less with {LOWERED[cause]}" if cause in LOWERED else ""
        said.append(f"next: most is by {cause}, at {worst.monitor}{by_hand}")
    return "\n".join([*said, *best.choice.toml])


def _write(best: Proposal, text: str, target: Path) -> None:
    """Write the text of a case with the changes of the best choice, after reading and planning it."""
    from dembound.accuracy.choice import digest
    from dembound.casefile.edit import edited
    from dembound.files import write_text
    from dembound.running import plan
    from dembound.schemas import loads

    choice = best.choice
    text = edited(text, choice.changes)
    again = loads(text, target.parent, target.stem)
    if digest(again) != digest(choice.case) and again.keys != choice.case.keys:  # digests of 80 and 80.0 differ
        raise RuntimeError(f"{target}: the text is not that of the choice")
    plan(again)
    write_text(target, text)
    print_lines(*(f"  {line}" for line in choice.toml), f"wrote {target}")


Repeat = Annotated[
    bool, Option("--repeat", help="Repeat the run with 0.98 of its step, to see what of the cracks is chance.")
]

Spent = Annotated[
    float | None,
    Option(
        "--longest",
        min=0.0,
        metavar="SECONDS",
        help="CPU seconds for companions; by default 20, or as long as the run.",
    ),
]


@app.command("estimate", rich_help_panel=MORE)
def estimate(
    results: Annotated[list[Path], Argument(metavar="RESULTS...", help="Folders of results of complete runs.")],
    repeat: Repeat = False,
    longest: Spent = None,
    threads: Threads = None,
) -> None:
    """Estimate the errors of runs by sides, grid and time step.

    Writes estimate.h5 and the entry error_estimate of summary.json; see docs/tasks/trust_a_result.md.
    """
    one_thread_for_matrices()  # before numpy is imported
    from dembound.accuracy.estimate import estimate_results
    from dembound.cli.progress import watched
    from dembound.results.folder import with_name

    prepare_computing(threads)
    problems: list[str] = []
    failure: type[CaseError] = RecordError  # if all are errors of files
    for path in results:
        try:
            folder = with_name(results_file(path)).parent
            with watched(folder.name) as watching:
                found = estimate_results(folder, repeat, watching, longest)
            _show(folder, found)
        except CaseError as error:
            problems += [line for line in str(error).splitlines() if line not in problems]
            failure = failure if isinstance(error, RecordError) else CaseError
    if problems:
        raise failure(problems)


def print_estimate(folder: Path) -> None:
    """Print the error estimate of a completed run, or why there is none."""
    from dembound.accuracy.estimate import estimate_results
    from dembound.cli.progress import watched

    try:
        with watched(folder.name) as watching:
            found = estimate_results(folder, watch=watching)
        _show(folder, found)
    except DemboundError as error:
        err.print(f"{folder.name}: errors are not estimated: {error}")


def _show(folder: Path, found: Budget) -> None:
    """Print an estimate, and draw its band into the run's picture of the histories, if there is one."""
    from dembound.accuracy.table import lines_of, next_step
    from dembound.plot.histories import plot_histories
    from dembound.plot.style import save
    from dembound.running.recorded import file_of_record

    out.print(f"{folder.name}: errors, estimated in {found.cpu_seconds:.2g} s of CPU time")
    print_lines(*lines_of(found), next_step(found, folder, file_of_record(folder / "run.h5")))
    picture = folder / "histories.png"
    if picture.is_file():
        save(plot_histories([folder / "run.h5"]), picture)
