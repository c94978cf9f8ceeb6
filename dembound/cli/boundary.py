"""The command boundary."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from rich.table import Table
from typer import Option

from dembound.cli.app import MORE, PICTURE, PictureTitle, Settings, Side, app, load_disks, prepare_computing
from dembound.cli.calibration import OneCase
from dembound.cli.console import compact_table, err, out, seldom
from dembound.cli.options import CurveTable, leave
from dembound.errors import CaseError
from dembound.machine import one_thread_for_matrices
from dembound.words import percent

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from dembound.disks.reflection import Arrival, Measured, Reflections
    from dembound.plot.reflection import Curves

PRINTED = 15.0
"""Multiple of the angles (degrees) that are printed; the table of ``--table`` has all."""

LEAST = 1e-8
"""Share of energy below which numbers are rounding errors."""

LONGEST = 20.0
"""CPU seconds within which sides are measured by default."""

COMPARED = (0.0, 30.0)
"""Angles (degrees) at which types of a side are compared by default."""

NEAR_GAP = 1.25
"""Frequency of a gap of the packing over the highest measured one below which the gap is reported."""


@app.command("boundary", rich_help_panel=MORE)
def boundary(
    case: OneCase,
    sides: Annotated[
        list[Side] | None,
        Option(
            "--side",
            "-s",
            metavar="SIDE",
            help="left, right, bottom or top; by default all that absorb. May be repeated.",
        ),
    ] = None,
    angles: Annotated[
        list[float] | None,
        Option("--angle", help="Degrees from the side's normal. May be repeated."),
    ] = None,
    frequencies: Annotated[
        list[float] | None, Option("--frequency", help="Hz; by default those of the case's waves. May be repeated.")
    ] = None,
    types: Annotated[
        list[str] | None,
        Option(
            "--type",
            metavar="TYPE",
            help="Type of side to compare, or its table. May be repeated.",
        ),
    ] = None,
    output: Annotated[Path, PICTURE] = Path("boundary.png"),
    title: PictureTitle = None,
    quick: Annotated[bool, Option("--quick", help="Quick estimate with a continuum in place of the disks.")] = False,
    table: CurveTable = None,
    longest: Annotated[
        float,
        Option("--longest", min=0.0, metavar="SECONDS", help="CPU seconds within which frequencies are measured."),
    ] = LONGEST,
    changes: Settings = None,
) -> None:
    """Compute the energy that sides reflect, by angle and frequency.

    Nothing is run. With several sides, pictures and tables have their names.

    A left or right side beside layers has one of each for every layer.
    """
    one_thread_for_matrices()  # before numpy is imported
    from dembound.disks import reflection

    prepare_computing(None)
    if types and quick:
        raise CaseError(["--quick: is not possible with --type; leave it out"])
    loaded = load_disks(case, changes)
    chosen = [side.value for side in sides] if sides else reflection.measured_sides(loaded)
    nowhere: tuple[str | None, ...] = (None,)
    parts = [(side, layer) for side in chosen for layer in (*reflection.layers_beside(loaded, side),) or nowhere]
    given = sorted(set(angles or (COMPARED if types else reflection.ANGLES)))
    hertz, may_be_fewer = sorted(set(frequencies or ())), not (frequencies or types)
    each = 0.0 if quick else reflection.seconds_of(loaded, len(parts) * max(1, len(types or ())), len(given), 1)
    count = _within(longest, len(hertz) or reflection.FREQUENCIES, each, loaded.name, may_be_fewer=may_be_fewer)
    for side, layer in parts:
        report = _report(side if layer is None else f"{side}, in {layer}")
        if types:
            tables = [_table(text) for text in types]
            found = reflection.compare_types(loaded, side, tables, given, frequencies or (), report, layer)
            words = f"Energy that types of the {side} side of {loaded.name} send back"
            figure = _compared(*found, words if layer is None else f"{words} in {layer}")
        else:
            measured = reflection.measure_side(
                loaded, side, given, hertz or count, report=report, quick=quick, layer=layer
            )
            figure = _measured(measured, loaded.name, side, layer)
        ending = "" if len(parts) == 1 else f"_{side}" if layer is None else f"_{side}_{layer}"
        picture, lines = (path and path.with_stem(f"{path.stem}{ending}") for path in (output, table))
        leave(figure, picture or output, title, lines)


def _measured(found: Measured, name: str, side: str, layer: str | None) -> Figure:
    """Print what a side of the case of that name, or the part of it beside a layer, returns, and draw it."""
    from dembound.plot.reflection import plot_reflection

    out.print(_overview(found, f"{name}: {side if layer is None else f'{side}, in {layer}'}, {found.type}"))
    for line in _sentences(found):
        out.print(line)
    words = f"Energy that the {side} side ({found.type}) of {name} sends back"
    words += "" if layer is None else f" in {layer}"
    return plot_reflection(found.found.angles, found.found.frequencies, _curves(found), words)


def _table(text: str) -> dict[str, Any]:
    """The table of ``--type``: TOML, or the word of a type."""
    from dembound.casefile.reader import value_of

    value = value_of(text, "--type")
    return value if isinstance(value, dict) and "type" in value else {"type": text}


def _compared(found: dict[str, Reflections], arrivals: list[Arrival], title: str) -> Figure:
    """Print what types of a side return by waves and angle, and draw it against frequency."""
    from dembound.disks.reflection.arrivals import amplitudes, over_spectrum, returned_range, signal_for
    from dembound.plot.reflection import plot_types

    any_of = next(iter(found.values()))
    frequencies = any_of.frequencies
    words = f"{title}, {frequencies[0]:.3g} to {frequencies[-1]:.3g} Hz, weighted with the waves' spectra"
    overview = compact_table("type", "waves", "energy", "amplitude", "amplitude above 1 %", title=words)
    signals = {kind: signal for kind in any_of.kinds if (signal := signal_for(kind, arrivals)) is not None}
    for kind in any_of.kinds:
        for name, each in found.items():
            means = over_spectrum(each.total(kind), frequencies, signals.get(kind))
            for angle, mean, shares in zip(each.angles, means, each.total(kind).T, strict=True):
                if math.isfinite(mean):
                    row = _percent(mean), _percent(math.sqrt(mean)), returned_range(frequencies, shares)
                    overview.add_row(name, f"{kind.upper()} {angle:g}°", *row)
    out.print(overview)
    drawn = {
        kind.upper(): {name: (each.angles, each.total(kind)) for name, each in found.items()} for kind in any_of.kinds
    }
    spectra = {kind.upper(): amplitudes(signal, frequencies) for kind, signal in signals.items()}
    return plot_types(frequencies, drawn, spectra, title)


def _within(longest: float, count: int, each: float, name: str, *, may_be_fewer: bool) -> int:
    """Frequencies out of `count`, which take so many CPU seconds each, that are measured within a time (s).

    Says if they are fewer; CaseError where they may not be, or none is left.
    """
    if each * count <= longest:
        return count
    needed = math.ceil(each * count)  # rounded up, so that the option as said allows it
    fewer, all_of = int(longest / each), f"{count} frequencies take about {needed} s of CPU time"
    if fewer < 1 or not may_be_fewer:
        fit = f"at most {longest:g} s are allowed; --longest {needed} allows it"
        raise CaseError([f"boundary: {all_of}, {fit}, --quick takes less, --side measures one side"])
    err.print(f"{name}: {all_of}, so {fewer} are measured; --longest {needed} measures all")
    return fewer


def _report(side: str) -> Callable[[float], None]:
    """Prints the frequency that is being computed, at most every `INTERVAL` seconds."""
    is_due = seldom()

    def report(frequency: float) -> None:
        if is_due():
            err.print(f"{side}: {frequency:.3g} Hz")

    return report


def _overview(found: Measured, title: str) -> Table:
    """Shares of energy by angle, means over the frequencies."""
    import numpy as np

    values = found.found
    heads = [
        f"{kind.upper()} → {other.upper()}" for kind in values.kinds for other in (kind, "s" if kind == "p" else "p")
    ]
    low, high = values.frequencies.min(), values.frequencies.max()
    range_in_words = f"at {low:.3g} Hz" if low == high else f"means of {low:.3g} to {high:.3g} Hz"
    overview = compact_table("angle", *heads, title=f"{title}: energy sent back, {range_in_words}")
    for index, angle in enumerate(values.angles):
        if len(values.angles) > 7 and not math.isclose(angle % PRINTED, 0.0):
            continue
        row = [of[kind][:, index] for kind in values.kinds for of in (values.same, values.converted)]
        overview.add_row(
            f"{angle:g}°", *(_percent(float(np.nanmean(each))) if np.isfinite(each).any() else "–" for each in row)
        )
    return overview


def _percent(share: float) -> str:
    """A share in per cent with three digits; 0 for rounding errors."""
    return percent(share if share > LEAST else 0.0, 3)


def _sentences(found: Measured) -> list[str]:
    """The reflected share of each arrival, compared with matched factors and a continuum."""
    lines = []
    beside: dict[str, Reflections] = {}
    if found.matched is not None:
        beside["with matched β"] = found.matched
    if found.continuum is not None:
        nodes, values = found.continuum
        beside[f"an outside of {nodes:,} nodes"] = values
    for arrival in found.arrivals:
        if math.isfinite(share := arrival.sent_back(found.found)):
            name = arrival.name if arrival.signal is None else f"{arrival.name}, weighted with its spectrum"
            line = f"{name}: returns {_percent(share)} of the energy, {_percent(math.sqrt(share))} of the amplitude"
            others = [f"{other} {_percent(arrival.sent_back(each))}" for other, each in beside.items()]
            lines.append("; ".join([line, *others]))
    if found.rock:
        each = " and ".join(f"{_percent(share)} for {kind.upper()} waves" for kind, share in found.rock.items())
        alone = "dashpots stand for it there alone, and what rock returns at other angles is not predicted"
        lines.append(f"the rock itself returns of the amplitude along the normal {each}; {alone}")
    highest = found.found.frequencies.max()
    gaps = {kind: found.gaps[kind] for kind in found.found.kinds if found.gaps.get(kind, math.inf) < NEAR_GAP * highest}
    if gaps:
        where = " and ".join(f"{kind.upper()} waves of {frequency:.3g} Hz" for kind, frequency in gaps.items())
        lines.append(f"copies of the brick reflect {where} by themselves, which adds to the numbers near there")
    return lines


def _curves(found: Measured) -> list[Curves]:
    """The curves of each type of waves."""
    from dembound.plot.reflection import Curves

    beside: dict[str, Reflections] = {}
    if found.matched is not None:
        beside["in all, matched β"] = found.matched
    if found.continuum is not None and len(found.continuum[1].angles) == len(found.found.angles):
        beside["in all, an outside"] = found.continuum[1]
    curves = []
    for kind in found.found.kinds:
        totals = {name: each.total(kind) for name, each in beside.items() if kind in each.kinds}
        curves.append(Curves(kind.upper(), found.found.same[kind], found.found.converted[kind], totals))
    return curves
