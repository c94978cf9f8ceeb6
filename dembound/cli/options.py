"""Options that several commands share, as fields of dataclasses, and those of commands that draw histories."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import MISSING, dataclass, fields, is_dataclass
from functools import wraps
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_args, get_type_hints

from typer import Option

from dembound.cli.app import Side, writable
from dembound.cli.console import print_written
from dembound.studies.asked import Asked

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def with_tables(command: Callable[..., None]) -> Callable[..., None]:
    """A command for typer in which the fields of every dataclass parameter are options.

    The fields are annotated as options of typer, or as `Asked` where they are those of a study. The command gets one
    object of the class.
    """
    hints = get_type_hints(command, include_extras=True)
    tables: dict[str, type] = {
        name: hint for name, hint in hints.items() if isinstance(hint, type) and is_dataclass(hint)
    }

    @wraps(command)
    def flat(**given: Any) -> None:
        for name, table in tables.items():
            given[name] = table(**{field.name: given.pop(field.name) for field in fields(table)})
        command(**given)

    def parameters() -> Iterator[Parameter]:
        for name, parameter in signature(command).parameters.items():
            if name in tables:
                yield from _options(tables[name])
            else:
                yield parameter.replace(annotation=hints[name])

    flat.__signature__ = Signature(list(parameters()))  # type: ignore[attr-defined]  # what typer reads
    return flat


def _options(table: type) -> Iterator[Parameter]:
    """The fields of a dataclass as parameters by name."""
    types = get_type_hints(table, include_extras=True)
    for field in fields(table):
        default = Parameter.empty if field.default is MISSING else field.default
        annotation = types[field.name]
        kind, option = get_args(annotation)
        if isinstance(option, Asked):
            annotation = Annotated[kind, _as_option(field.name, option, is_flag=kind is bool)]
        yield Parameter(field.name, Parameter.KEYWORD_ONLY, default=default, annotation=annotation)


def _as_option(name: str, asked: Asked, *, is_flag: bool) -> Any:
    """The option of a field of a study; a flag has no opposite."""
    names = (f"--{name.replace('_', '-')}",) if is_flag else ()
    return Option(*names, help=asked.help, metavar=asked.metavar, min=asked.least, rich_help_panel=asked.panel)


def leave(figure: Figure, picture: Path, title: str | None = None, table: Path | None = None) -> None:
    """Write a picture, and a table of its curves if one is requested, printing each file."""
    from dembound.plot.style import save

    save(figure, picture, title)
    print_written(picture)
    if table is not None:
        from dembound.plot.table import write_lines

        write_lines(figure, table)
        print_written(table)


def names_of(choices: Any) -> str:
    """The values of a Literal type, with commas between."""
    return ", ".join(get_args(choices))


CALIBRATIONS = "calibrations"
"""Name of results that do not belong to a run."""

RUNS_OF_DISKS = "runs of disks"
"""Name of results that may have fragments."""

SINGLE = ("--field", "--energy")
"""Options whose pictures show one run."""


Quantity = Literal["velocity", "displacement", "acceleration", "stress"]
"""Quantities of the monitors."""


Component = Literal["x", "y", "both", "rotation"]
"""Components of the monitors' motion."""


CurveTable = Annotated[Path | None, Option("--table", help="Curves (CSV).", callback=writable)]
QuantityOfMonitors = Annotated[
    Quantity | None,
    Option(
        "--quantity",
        metavar="QUANTITY",
        help=f"Quantity: {names_of(Quantity)}; by default velocity; stress of bars alone.",
    ),
]
ComponentOfMotion = Annotated[
    Component | None, Option("--component", help="Component of the motion; by default x or y, whichever is larger.")
]
Monitors = Annotated[
    list[str] | None, Option("--monitor", metavar="NAME", help="Show this monitor only. May be repeated.")
]


Exaggerated = Annotated[
    float | None,
    Option(
        "--exaggerate",
        help="Factor of the displacements shown; 0: undeformed. By default 1 once disks have moved by a tenth of a "
        "diameter.",
    ),
]
SceneField = Literal[
    "velocity",
    "displacement",
    "stress",
    "damage",
    "stress_xx",
    "stress_yy",
    "stress_xy",
    "forces",
    "peak",
    "unbalanced",
    "layer",
    "fragments",
]
"""Fields of a whole scene; each kind of scene accepts some of them."""


@dataclass(frozen=True)
class Plotted:
    """What a plot shows by its options; without options the histories of all monitors."""

    quantity: QuantityOfMonitors = None
    component: ComponentOfMotion = None
    monitor: Monitors = None
    boundary: Annotated[
        Side | None,
        Option(help="This side's peak velocities, with --quantity stress or displacement its mean."),
    ] = None
    energy: Annotated[bool, Option("--energy", help="The energy ledger of one run.")] = False
    field: Annotated[
        SceneField | None,
        Option(
            metavar="FIELD",
            help=f"The scene of one run, coloured by {names_of(SceneField)}; of a bar over place and time.",
        ),
    ] = None
    snapshot: Annotated[
        int | None,
        Option(help="Number of the snapshot, −1 the last; by default that of the largest values."),
    ] = None
    exaggerate: Exaggerated = None
    cracks: Annotated[
        Literal["kind", "time"], Option(metavar="BY", help="Colours of broken bonds of disks: by kind or time.")
    ] = "kind"
    sieve: Annotated[
        bool, Option("--sieve", help="Sieve curves of fragments: share of their mass not larger than a diameter.")
    ] = False
    table: Annotated[Path | None, Option(help="Table of the lines drawn (CSV).", callback=writable)] = None

    def problems(self, kind: str, count: int) -> Iterator[str]:
        """Options that exclude each other, for a number of results of a kind."""
        pictures = {"--field": self.field, "--energy": self.energy, "--sieve": self.sieve, "--boundary": self.boundary}
        choices = {"--component": self.component, "--monitor": self.monitor}
        asked = [option for option, value in pictures.items() if value]
        chosen = [option for option, value in choices.items() if value]
        if self.quantity and not self.boundary:  # a side has quantities, too
            chosen = ["--quantity", *chosen]
        if kind == CALIBRATIONS:
            yield from (f"{option}: is for runs, not for calibrations" for option in asked + chosen)
        else:
            yield from (f"{option}: is not allowed together with {asked[0]}" for option in asked[1:] + chosen if asked)
        yield from (f"{option}: shows one run, name one" for option in asked if option in SINGLE and count > 1)
        if self.snapshot is not None and self.field is None and not self.sieve:
            yield "--snapshot: goes with --field or --sieve"
        if self.cracks != "kind" and (self.field is None or kind != RUNS_OF_DISKS):
            yield "--cracks: goes with --field of runs of disks"
        if self.sieve and kind not in (RUNS_OF_DISKS, CALIBRATIONS):
            yield "--sieve: is of runs of disks"
        if self.exaggerate is not None and self.field is None:
            yield "--exaggerate: goes with --field"
        if self.table is not None and self.field is not None:
            yield "--table: is of lines, a field has none; run.h5 and the files for ParaView have its values"

    def draw(self, files: Sequence[Path], kind: str) -> Figure:
        """The picture of results of a kind."""
        if kind == CALIBRATIONS:
            from dembound.plot.stability import plot_convergence

            return plot_convergence(files)
        if self.field is not None:
            from dembound.kinds import kind_of_record

            asked = self.snapshot, self.exaggerate, self.cracks
            return kind_of_record(files[0]).field_picture(files[0], self.field, *asked)
        if self.sieve:
            from dembound.plot.pieces import plot_sieve

            return plot_sieve(files, self.snapshot)
        if self.energy:
            from dembound.plot.energy import plot_energy

            return plot_energy(files[0])
        return self._side(files, self.boundary.value) if self.boundary else self._histories(files)

    def _side(self, files: Sequence[Path], side: str) -> Figure:
        """A side: its particles, or a quantity of the side as a whole."""
        from dembound.plot.side import plot_boundary, plot_side

        return plot_boundary(files, side) if self.quantity is None else plot_side(files, side, self.quantity)

    def _histories(self, files: Sequence[Path]) -> Figure:
        """The histories of monitors."""
        from dembound.plot.histories import plot_histories

        return plot_histories(
            files, component=self.component, quantity=self.quantity or "velocity", monitors=self.monitor or None
        )
