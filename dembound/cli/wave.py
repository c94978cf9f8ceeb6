"""The command wave."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from rich.table import Table
from rich.text import Text
from typer import Argument, Option

from dembound.cli.app import MORE, app, ending_in, png
from dembound.cli.console import compact_table, err, out
from dembound.cli.options import leave, with_tables
from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.records.channel import Channel, Record
    from dembound.records.formats import Reading
    from dembound.records.processing import Motion, Processing

_step = partial(Option, rich_help_panel="Processing")
_given = partial(Option, rich_help_panel="Files that state too little")

HEADS = (
    *("com-\nponent", "sam-\nples", "rate\n(Hz)", "PGA\n(m/s²)", "PGA\n(g)", "PGV\n(m/s)", "PGD\n(m)"),
    *("Arias\n(m/s)", "D5-95\n(s)", "v end\n(m/s)", "d end\n(m)", "usable\n(Hz)"),
)
"""Heads of the table."""


class Kind(StrEnum):
    """Kinds of waves; an enumeration, as lists of options need one."""

    s, p = "s", "p"


Damping = Literal["as_run", "hysteretic", "constant_q"]
"""How damped layers are taken."""


Baseline = Literal["mean", "linear", "zero-velocity", "none"]
"""What is removed as the baseline."""


@dataclass(frozen=True)
class ProcessingOptions:
    """How a record becomes a wave, in the order of the steps; None: as usual, or with --raw nothing."""

    raw: Annotated[bool, _step("--raw", help="Process nothing but what other options name.")] = False
    begin: Annotated[float | None, _step("--from", help="Keep what is from this time on (s).")] = None
    end: Annotated[float | None, _step("--to", help="Keep what is up to this time (s).")] = None
    baseline: Annotated[
        Baseline | None,
        _step(
            metavar="KIND",
            help="mean, before the motion; linear; zero-velocity: the mean, then the velocity left at the end; none. "
            "By default mean.",
        ),
    ] = None
    taper: Annotated[
        float | None, _step(help="Cosine tapers at both ends (s); by default 2, at most 5 % of the record.")
    ] = None
    high_pass: Annotated[
        float | None, _step(help="Keep what is above (Hz); by default 0.1, in short records more.")
    ] = None
    low_pass: Annotated[float | None, _step(help="Keep what is below (Hz); by default all.")] = None
    order: Annotated[int, _step(help="Order of the Butterworth filters, in each direction.", min=1)] = 4
    pga: Annotated[float | None, _step(help="Peak acceleration (m/s²) of each component.")] = None
    scale: Annotated[float, _step(help="Multiply by this factor.")] = 1.0

    def of(self, channel: Channel) -> Processing:
        """What is done to a channel; raises CaseError for a scale beside a PGA, or one without meaning."""
        from dembound.records.processing import Processing, usual, windowed

        if self.pga is not None and self.scale != 1.0:
            raise CaseError(["--scale: is not allowed together with --pga"])
        if self.scale == 0.0 or (self.pga is not None and not self.pga > 0.0):
            raise CaseError(["--pga, --scale: must not be zero, and a PGA is positive"])
        kept = windowed(channel, self.begin, self.end)
        base = Processing() if self.raw else usual(kept.time_step * len(kept.values))
        high = base.filters.high_pass if self.high_pass is None else self.high_pass or None
        filters = replace(base.filters, high_pass=high, low_pass=self.low_pass, order=self.order)
        baseline, taper = self.baseline or base.baseline, base.taper if self.taper is None else self.taper
        return Processing(self.begin, self.end, baseline, taper, filters, self.pga, self.scale)


@dataclass(frozen=True)
class ReadingOptions:
    """What is known about a file beside its header."""

    unit: Annotated[str | None, _given(help="Unit of the values, e.g. g, cm/s² or m/s.")] = None
    time_step: Annotated[float | None, _given("--dt", metavar="X", help="Time step (s).")] = None
    columns: Annotated[
        str | None,
        _given(metavar="NAME,NAME,…", help='Columns of a text, as time,NS,EW; "-" leaves one out.'),
    ] = None
    series: Annotated[bool, _given("--series", help="All numbers, line by line, are one channel.")] = False
    skip: Annotated[int, _given(metavar="N", min=0, help="Leave out lines at the beginning.")] = 0

    def given(self) -> Reading:
        """These options as the readers of formats take them."""
        from dembound.records.formats import Reading

        names = tuple(name.strip() for name in self.columns.split(",")) if self.columns else ()
        return Reading(self.unit, self.time_step, names, self.series, self.skip)


@dataclass(frozen=True)
class GroundOptions:
    """The ground of a case, to whose surface a record belongs."""

    deconvolve: Annotated[
        Path | None,
        Option(metavar="CASE", help="Write the incident wave below the surface of this case."),
    ] = None
    kinds: Annotated[
        list[Kind] | None,
        Option("--as", help="Wave of each component in --deconvolve."),
    ] = None
    damping: Annotated[
        Damping,
        Option(
            metavar="DAMPING",
            help="Q in --deconvolve: as_run; hysteretic, G(1 + i/Q); or constant_q, causal.",
        ),
    ] = "as_run"
    transfer: Annotated[
        Path | None,
        Option(metavar="NAME.png", help="Transfer functions of the ground (PNG and CSV).", callback=png),
    ] = None

    def require_kinds(self, channels: Sequence[Channel]) -> None:
        """Raise CaseError for kinds of waves without a case, or fewer or more than channels."""
        if self.kinds and (self.deconvolve is None or len(self.kinds) != len(channels)):
            names = ", ".join(channel.component or "-" for channel in channels)
            raise CaseError([f"--as: must be given with --deconvolve once for each component, in their order: {names}"])

    def below(self, motions: list[Motion]) -> list[Motion]:
        """The incident motions of these kinds below the ground whose surface moves so; writes its transfer functions.

        Without a case the motions themselves.
        """
        if self.deconvolve is None:
            if self.transfer is not None or self.damping != "as_run":
                raise CaseError(["--transfer, --damping: go with --deconvolve"])
            return motions
        from dembound.plot.record import plot_transfers
        from dembound.plot.style import save
        from dembound.plot.table import write_lines
        from dembound.studies.deconvolution import below, ground_of_file, transfers

        if not self.deconvolve.is_file():
            raise CaseError([f"--deconvolve: no file {self.deconvolve}"])
        case = ground_of_file(self.deconvolve)
        names: Sequence[Literal["s", "p"] | None] = [each.value for each in self.kinds or ()] or [None] * len(motions)
        found = below(case, motions, names, self.damping)
        if self.transfer is not None:
            figure = plot_transfers(transfers(case, motions, names), f"Ground of {case.name}")
            table = self.transfer.with_suffix(".csv")
            save(figure, self.transfer)
            write_lines(figure, table)
            out.print(f"wrote {self.transfer} and {table}")
        return found


_csv = ending_in(".csv")


@app.command("wave", rich_help_panel=MORE)
@with_tables
def wave(
    file: Annotated[Path, Argument(metavar="FILE", help="Record: AT2, V1, V2, K-NET, CSV and others.")],
    component: Annotated[list[str] | None, Option(metavar="NAME", help="This component only. May be repeated.")] = None,
    output: Annotated[
        Path | None,
        Option(
            "--output",
            "-o",
            metavar="NAME.csv",
            help="Wave; names of components are appended; by default FILE_velocity.csv.",
            callback=_csv,
        ),
    ] = None,
    picture: Annotated[Path | None, Option(help="Picture (PNG); by default that of the wave.", callback=png)] = None,
    *,
    ground: GroundOptions,
    table: Annotated[
        Path | None, Option(metavar="NAME.csv", help="Curves of the picture (CSV).", callback=_csv)
    ] = None,
    reading: ReadingOptions,
    processing: ProcessingOptions,
) -> None:
    """Make a wave of a measured ground motion (CSV and PNG).

    It is processed, measured and drawn, and its velocity is written as a wave that a case names.

    By default the mean and what is below 0.1 Hz are removed and both ends are tapered; with --raw nothing is done.
    """
    from dembound.plot.record import plot_motions
    from dembound.records.formats import read_record
    from dembound.records.processing import processed, write_wave

    record = read_record(file, reading.given())
    channels = _chosen(record, component)
    target = output or Path(f"{file.stem}_velocity.csv")
    paths = _paths(target, channels)
    if same := next((path for path in paths if path.exists() and path.samefile(file)), None):
        raise CaseError([f"--output: {same} is the record"])
    ground.require_kinds(channels)
    out.print(f"{file}: {record.format}, {record.title or 'no title'}")
    for remark in record.remarks:
        err.print(f"warning: {remark}")
    for line in record.chosen:
        out.print(f"  {line}")
    motions = ground.below([processed(channel, processing.of(channel)) for channel in channels])
    for line in _lines(motions):
        out.print(f"  {line}")
    out.print(_table(channels, motions, processing))
    for motion in motions:
        for warning in motion.warnings():
            err.print(f"warning: {motion.component or file.stem}: {warning}")
    made = f"made by dembound wave of {file.name}, {record.format}"
    for path, motion in zip(paths, motions, strict=True):
        origin = (made, record.title, *record.chosen, *record.remarks, f"component: {motion.component}")
        write_wave(path, motion, [line for line in origin if line])
        out.print(f"wrote {path}")
    leave(plot_motions(motions, record.title or file.name), picture or target.with_suffix(".png"), table=table)


def _chosen(record: Record, names: Sequence[str] | None) -> list[Channel]:
    """The channels of components, in the order of names in any case of letters; all without names.

    Raises CaseError for unknown ones.
    """
    known = [channel.component for channel in record.channels]
    if unknown := [name for name in names or () if name.casefold() not in {each.casefold() for each in known}]:
        raise CaseError([f"--component: is {name}, must be one of {', '.join(known)}" for name in unknown])
    if not names:
        return list(record.channels)
    chosen = dict.fromkeys(name.casefold() for name in names)
    return [channel for name in chosen for channel in record.channels if channel.component.casefold() == name]


def _lines(motions: Sequence[Motion]) -> Iterator[str]:
    """What was done, in one line for all components where it is the same."""
    for steps in zip(*(motion.steps for motion in motions), strict=True):
        if len(set(steps)) == 1:
            yield steps[0]
        else:
            yield from (f"{step} ({motion.component})" for step, motion in zip(steps, motions, strict=True))


def _table(channels: Sequence[Channel], motions: Sequence[Motion], options: ProcessingOptions) -> Table:
    """The measures of all components, a row each."""
    from dembound.records.processing import measures_of, usable_band
    from dembound.waves.unit_names import STANDARD_GRAVITY

    table = compact_table(show_edge=False)
    table.padding = 0  # twelve columns fit into 80 characters
    for head in HEADS:
        table.add_column(Text(head), justify="left" if head == HEADS[0] else "right")
    for channel, motion in zip(channels, motions, strict=True):
        found, (low, high) = measures_of(motion), usable_band(channel, options.of(channel))
        sampling = f"{len(motion.time)}", f"{1.0 / motion.time_step:.4g}"
        sizes = found.pga, found.pga / STANDARD_GRAVITY, found.pgv, found.pgd, found.arias, found.duration
        left = (f"{value + 0.0:.1g}" for value in (found.final_velocity, found.final_displacement))
        band = f"{low:.2g}-{high:.2g}" if low < high else "none"
        table.add_row(motion.component or "-", *sampling, *(f"{value:.3g}" for value in sizes), *left, band)
    return table


def _paths(target: Path, channels: Sequence[Channel]) -> list[Path]:
    """A file for each channel: that which is named, or with the names of components, or their numbers, appended."""
    if len(channels) == 1:
        return [target]
    names = [re.sub(r"[^\w-]+", "_", channel.component) for channel in channels]
    unique = len(set(map(str.casefold, names))) == len(names) and all(names)
    return [target.with_stem(f"{target.stem}_{name if unique else k}") for k, name in enumerate(names, start=1)]
