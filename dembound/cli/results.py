"""Commands for results: plot, view, compare, cache."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from dembound.cli.app import MORE, PICTURE, PictureTitle, app
from dembound.cli.console import out, print_rows
from dembound.cli.options import CALIBRATIONS, Plotted, Quantity, leave, names_of, with_tables
from dembound.errors import CaseError, RecordError
from dembound.words import in_one_unit

ROUNDING = 1e-6
"""Relative error below which two runs differ by rounding only."""


@app.command("plot")
@with_tables
def plot(
    results: Annotated[list[Path], Argument(metavar="RESULTS...", help="Result folders or HDF5 files.")],
    output: Annotated[Path, PICTURE] = Path("plot.png"),
    title: PictureTitle = None,
    *,
    asked: Plotted,
) -> None:
    """Draw histories of runs, a field or energies (PNG).

    Histories of several runs, and passes of several calibrations, are drawn over each other.

    With free-field sides, a monitor's twin in the free-field column is drawn as a dashed line.
    """
    from dembound.results.reader import understood

    files = [results_file(path) for path in results]
    kind = _common_kind(files)
    if problems := list(asked.problems(kind, len(files))):
        raise CaseError(problems)
    with understood(*files):
        leave(asked.draw(files, kind), output, title, asked.table)


def _common_kind(files: Sequence[Path]) -> str:
    """The kind of results: of bars, of disks, or calibrations. Raises CaseError if they are of several kinds."""
    kinds = sorted({_kind(file) for file in files})
    if len(kinds) > 1:
        raise CaseError([f"RESULTS: holds {' and '.join(kinds)}, which cannot be drawn in one picture; name one kind"])
    return kinds[0]


def _kind(file: Path) -> str:
    """The kind of a result."""
    from dembound.kinds import kind_of_record

    return CALIBRATIONS if file.name == "calibration.h5" else f"runs of {kind_of_record(file).plural}"


@app.command("cache", rich_help_panel=MORE)
def cache(delete: Annotated[bool, Option("--clear", help="Delete all cached bricks.")] = False) -> None:
    """Show the folder of packed bricks, or empty it.

    The environment variable DEMBOUND_CACHE sets another folder.
    """
    from dembound.packings.brick import cache_folder, clear

    out.print(str(cache_folder()))
    if delete:
        out.print(f"deleted {clear()} bricks")


@app.command("compare", rich_help_panel=MORE)
def compare_histories(
    reference: Annotated[Path, Argument(metavar="REFERENCE", help="Results to measure against.")],
    results: Annotated[list[Path], Argument(metavar="RESULTS...", help="Result folders or HDF5 files.")],
    quantity: Annotated[
        Quantity, Option(metavar="QUANTITY", help=f"Quantity: {names_of(Quantity)}; the stress of bars alone.")
    ] = "velocity",
    as_recorded: Annotated[bool, Option("--as-recorded", help="No correction for later entry of waves.")] = False,
) -> None:
    """Print the errors of histories against those of a reference run.

    RMS and largest are those of the component along which the reference moves most, in % of its RMS and of its peak.

    This is the error that estimate, advise and chart give; across is that of the other component over its own RMS.

    End and reference are the values of the component in both at the end.

    All twins in a free-field column have one line, for the twin with the largest RMS.

    Monitors at which the reference does not move are left out.

    If waves enter a run later or earlier than the reference because of other disks or sides, the shift is subtracted.
    """
    from dembound.results.compare import compare
    from dembound.results.histories import SCALES
    from dembound.results.reader import understood

    files = [results_file(path) for path in (reference, *results)]
    still: list[str] = []
    with understood(*files):
        found = compare(files[0], files[1:], quantity, as_recorded, still.append)
    at_ends = [value * SCALES[quantity] for line in found for value in (line.last, line.reference_last)]
    ends, unit = in_one_unit(at_ends, found[0].unit.removeprefix("M"))
    has_across = any(line.across is not None for line in found)
    heads = ("RMS (%)", "largest (%)", *(["across (%)"] if has_across else []), f"end ({unit})", "reference")
    rows = [("run", "monitor", "along", *heads)]
    for k, line in enumerate(found):
        errors = (line.rms, line.peak, *([line.across] if has_across else []))
        rows.append((line.run, line.monitor, line.component, *map(_in_percent, errors), *ends[2 * k : 2 * k + 2]))
    print_rows(f"{quantity} beside {reference}", rows, left=3)
    for run, shift in {line.run: line.shift for line in found if line.shift}.items():
        how = "later" if shift > 0.0 else "earlier"
        out.print(f"{run}: waves enter {abs(shift):.2g} s {how} than in the reference; this shift is subtracted")
    if still:
        out.print(f"left out, as the reference has no {quantity} there: {', '.join(dict.fromkeys(still))}")
    for line in found:
        if line.apart > 0.0:
            places = f"{line.place} in {line.run}, {line.reference_place} in the reference"
            out.print(f"{line.monitor}: the places compared are {line.apart:.4g} m apart: {places}")


def _in_percent(error: float | None) -> str:
    """An error in per cent without the sign; a dash for none, and only a bound for one by rounding."""
    if error is None:
        return "–"
    return f"< {100.0 * ROUNDING:.4f}" if 0.0 < error < ROUNDING else f"{100.0 * error:.3g}"


def results_file(path: Path) -> Path:
    """The HDF5 file of a results argument; raises RecordError for a folder without one, CaseError for no folder."""
    for candidate in (path, path / "run.h5", path / "calibration.h5"):
        if candidate.is_file():
            return candidate
    if (path / "sweep.h5").is_file():
        from dembound.studies.sweep.perform import MEMBERS

        members = path / MEMBERS
        advice = f"name runs in {members}" if members.is_dir() else "its numbers are in sweep.csv"
        raise CaseError([f"{path}: is a sweep, not results of a single run; {advice}"])
    error = RecordError if path.exists() else CaseError  # a name that is mistyped is an argument
    raise error([f"{path}: contains no results, must be a folder with run.h5 or calibration.h5"])
