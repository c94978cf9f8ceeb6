"""Commands for results: plot, view, compare, cache."""

from collections.abc import Mapping, Sequence
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer
from rich.table import Column

from dembound.cli.app import PICTURE, PictureTitle, Side, app, png, writable
from dembound.cli.console import compact_table, out
from dembound.errors import CaseError

CALIBRATIONS = "calibrations"
"""Name of results that do not belong to a run."""


class Field(StrEnum):
    """Fields of the motion that colour the disks."""

    velocity = "velocity"
    displacement = "displacement"


class Quantity(StrEnum):
    """Quantities of the monitors."""

    velocity = "velocity"
    displacement = "displacement"
    acceleration = "acceleration"
    stress = "stress"


class Component(StrEnum):
    """Components of the monitors' motion."""

    x = "x"
    y = "y"
    both = "both"
    rotation = "rotation"


class SceneField(StrEnum):
    """Fields of a whole scene; each kind of scene accepts some of them."""

    velocity = "velocity"
    displacement = "displacement"
    stress = "stress"
    damage = "damage"
    stress_xx = "stress_xx"
    stress_yy = "stress_yy"
    stress_xy = "stress_xy"
    forces = "forces"
    peak = "peak"
    unbalanced = "unbalanced"


@app.command("plot", rich_help_panel="Results")
def plot(
    results: Annotated[list[Path], typer.Argument(metavar="RESULTS...", help="Result folders or HDF5 files.")],
    output: Annotated[Path, PICTURE] = Path("plot.png"),
    title: PictureTitle = None,
    quantity: Annotated[
        Quantity | None,
        typer.Option(
            metavar="QUANTITY",
            help=f"Quantity of the monitors: {', '.join(Quantity)}; by default velocity; acceleration is that of "
            "central differences of the velocity, stress of bars alone.",
        ),
    ] = None,
    component: Annotated[
        Component | None,
        typer.Option(help="Component of the motion, by default x or y, whichever is larger; both: side by side."),
    ] = None,
    monitor: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Show this monitor only. May be repeated.")
    ] = None,
    boundary: Annotated[
        Side | None,
        typer.Option(
            help="Show this side's diameters and peak velocities instead; with --quantity stress or displacement that "
            "of the side as a whole."
        ),
    ] = None,
    energy: Annotated[bool, typer.Option("--energy", help="Show the energy ledger of one run instead.")] = False,
    field: Annotated[
        SceneField | None,
        typer.Option(
            metavar="FIELD",
            help=f"Show the scene of one run instead, its disks coloured by this: {', '.join(SceneField)}; forces: "
            "force chains, contacts as lines; of a bar it over place and time, stress, damage and motion.",
        ),
    ] = None,
    snapshot: Annotated[
        int | None,
        typer.Option(
            help="With --field: number of the snapshot, −1 the last; by default the one where the field is largest, of "
            "a bar all."
        ),
    ] = None,
    table: Annotated[
        Path | None,
        typer.Option(help="Table of the lines drawn to write as well (CSV), in their units.", callback=writable),
    ] = None,
) -> None:
    """Overlay the histories of several runs, or the passes of several calibrations, in one picture.

    With free-field sides, a monitor's twin in the free-field column is drawn as a dashed line.
    """
    from dembound.kinds import kind_of_record
    from dembound.plot.boundary import plot_boundary
    from dembound.plot.convergence import plot_convergence
    from dembound.plot.energy import plot_energy
    from dembound.plot.histories import plot_histories
    from dembound.plot.side import plot_side
    from dembound.plot.style import save
    from dembound.plot.table import write_lines

    files = [results_file(path) for path in results]
    kind = _common_kind(files)
    pictures = {"--field": field, "--energy": energy, "--boundary": boundary}
    choices = {"--quantity": None if boundary else quantity, "--component": component, "--monitor": monitor}
    _one_picture(pictures, choices, kind)
    for option in ("--field", "--energy"):
        if pictures[option] and len(files) > 1:
            raise CaseError([f"{option}: shows one run, name one"])
    if snapshot is not None and field is None:
        raise CaseError(["--snapshot: goes with --field"])
    if table is not None and field is not None:
        raise CaseError(["--table: is of lines, a field has none; run.h5 and the files for ParaView have its values"])
    if kind == CALIBRATIONS:
        figure = plot_convergence(files)
    elif field is not None:
        figure = kind_of_record(files[0]).field_picture(files[0], field.value, snapshot)
    elif energy:
        figure = plot_energy(files[0])
    elif boundary is not None and quantity is not None:
        figure = plot_side(files, boundary.value, quantity.value)
    elif boundary is not None:
        figure = plot_boundary(files, boundary.value)
    else:
        figure = plot_histories(
            files,
            component=component.value if component else None,
            quantity=(quantity or Quantity.velocity).value,
            monitors=monitor or None,
        )
    save(figure, output, title)
    out.print(f"wrote {output}")
    if table is not None:
        write_lines(figure, table)
        out.print(f"wrote {table}")


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


def _one_picture(pictures: Mapping[str, object], choices: Mapping[str, object], kind: str) -> None:
    """Raise CaseError if options select several pictures, or a choice that the selected picture does not have.

    pictures : options that select another picture than histories; choices : options that only histories have.
    """
    asked = [option for option, value in pictures.items() if value]
    chosen = [option for option, value in choices.items() if value]
    if kind == CALIBRATIONS:
        problems = [f"{option}: is for runs, not for calibrations" for option in asked + chosen]
    else:
        problems = [f"{option}: is not allowed together with {asked[0]}" for option in (asked[1:] + chosen) if asked]
    if problems:
        raise CaseError(problems)


@app.command("view", rich_help_panel="Results")
def view_disks(
    results: Annotated[Path, typer.Argument(metavar="RESULTS", help="A run's result folder or HDF5 file.")],
    snapshot: Annotated[
        int | None,
        typer.Option(help="Number of the first snapshot, −1 the last; by default the one with the largest motion."),
    ] = None,
    field: Annotated[Field, typer.Option(help="What colours the disks.")] = Field.velocity,
    picture: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", "--picture", help="Picture to write (PNG) instead of opening a window.", callback=png
        ),
    ] = None,
    exaggerate: Annotated[
        float, typer.Option(help="Show disks moved by this many times their displacement; 0: where they began.")
    ] = 0.0,
) -> None:
    """Show the disks of a run in a window to zoom into, with a slider over its snapshots.

    A window needs a display; without one, --output draws a picture.
    """
    from dembound.results.view import view

    view(results_file(results), snapshot, field.value, picture, exaggerate)
    if picture is not None:
        out.print(f"wrote {picture}")


@app.command("cache", rich_help_panel="Results")
def cache(
    delete: Annotated[bool, typer.Option("--clear", help="Delete all cached bricks.")] = False,
) -> None:
    """Show where packed bricks are kept (DEMBOUND_CACHE moves it), or delete them."""
    from dembound.packings.cache import cache_folder, clear

    out.print(str(cache_folder()))
    if delete:
        out.print(f"deleted {clear()} bricks")


@app.command("compare", rich_help_panel="Results")
def compare_histories(
    reference: Annotated[Path, typer.Argument(metavar="REFERENCE", help="Results to measure against.")],
    results: Annotated[list[Path], typer.Argument(metavar="RESULTS...", help="Result folders or HDF5 files.")],
    quantity: Annotated[
        Quantity,
        typer.Option(
            metavar="QUANTITY",
            help=f"Quantity of the monitors: {', '.join(Quantity)}; the stress of bars alone.",
        ),
    ] = Quantity.velocity,
) -> None:
    """Print the differences between the histories of runs and those of a reference, monitor by monitor.

    RMS is that of the difference in % of the reference's, largest the largest difference in % of its peak.

    End and reference are the values of both at the end.
    """
    from dembound.results.compare import compare

    found = compare(results_file(reference), [results_file(path) for path in results], quantity.value)
    unit = found[0].unit
    heads = ("along", "RMS (%)", "largest (%)", f"end ({unit})", "reference")
    names = (Column(head, overflow="fold") for head in ("run", "monitor"))
    numbers = (Column(head, no_wrap=True) for head in heads)
    table = compact_table(*names, *numbers, title=f"{quantity.value} beside {reference}")
    for line in found:
        percents = f"{100.0 * line.rms:.3f}", f"{100.0 * line.peak:.3f}"
        table.add_row(
            line.run, line.monitor, line.component, *percents, f"{line.last:.4g}", f"{line.reference_last:.4g}"
        )
    out.print(table)
    for line in found:
        if line.place != line.reference_place:
            places = f"at {line.place} in {line.run}, at {line.reference_place} in the reference"
            out.print(f"{line.monitor} is {places}")


def results_file(path: Path) -> Path:
    """The HDF5 file of a results argument."""
    for candidate in (path, path / "run.h5", path / "calibration.h5"):
        if candidate.is_file():
            return candidate
    raise CaseError([f"{path}: contains no results, must be a folder with run.h5 or calibration.h5"])
