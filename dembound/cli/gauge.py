"""The command gauge."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from dembound.cli.app import MORE, PICTURE, PictureTitle, app
from dembound.cli.console import compact_table, err, out
from dembound.cli.options import leave, with_tables
from dembound.cli.results import results_file
from dembound.cli.signal_options import FILE, SignalOptions

if TYPE_CHECKING:
    from dembound.gauge.estimates import Estimate
    from dembound.gauge.spalling import Findings

MPA = 1e6
"""Pascals in a megapascal."""


@app.command("gauge", rich_help_panel=MORE)
@with_tables
def gauge(
    record: Annotated[
        Path, typer.Argument(metavar="RECORD", help="Text file with columns of time and signal, or a run's results.")
    ],
    monitor: Annotated[str | None, typer.Option(metavar="NAME", help="Monitor of the results.")] = None,
    position: Annotated[float | None, typer.Option(help="Position of the gauge from the loaded end (m).")] = None,
    length: Annotated[float | None, typer.Option(help="Length of the bar (m).")] = None,
    density: Annotated[
        float | None, typer.Option(help="Density of the bar (kg/m³), for --free-end and for E = ρc².")
    ] = None,
    spall: Annotated[float | None, typer.Option(help="Where the bar spalled, from the loaded end (m).")] = None,
    free_end: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Monitor at the free end, or a text file of time (s) and velocity (m/s)."),
    ] = None,
    estimate: Annotated[
        bool,
        typer.Option("--estimate", help="Take speed and attenuation from tension peaks, though the results have them."),
    ] = False,
    peaks: Annotated[
        int | None, typer.Option(help="Take speed and attenuation from this number of first tension peaks.", min=2)
    ] = None,
    pulse_end: Annotated[
        float | None, typer.Option(help="Time at which the incident pulse has passed (s); by default when it returns.")
    ] = None,
    wave_speed: Annotated[
        float | None, typer.Option(help="Wave speed (m/s) of another test; else the results', or estimated from peaks.")
    ] = None,
    attenuation: Annotated[
        float | None,
        typer.Option(help="Attenuation (1/m) of another test; else the results', or estimated from peaks."),
    ] = None,
    output: Annotated[Path | None, PICTURE] = None,
    title: PictureTitle = None,
    column: Annotated[
        str | None,
        typer.Option(metavar="NAME|NUMBER", help="Column of the signal, if there are several.", rich_help_panel=FILE),
    ] = None,
    *,
    signal: SignalOptions,
) -> None:
    """Evaluate a gauge on a bar: wave speed, attenuation, strength.

    Results contain position, length, density, speed and attenuation. Strengths need --spall or --free-end.
    """
    from dembound.gauge.gauge_io import read_free_end, read_gauge
    from dembound.gauge.spalling import evaluate
    from dembound.results.reader import understood

    path = results_file(record) if record.is_dir() else record
    bar, reading, treatment = (position, length, density), signal.reading(column), signal.treatment()
    with understood(path):
        gauge = read_gauge(
            path, monitor, *bar, reading, treatment, signal.youngs_modulus, may_be_clipped=signal.clipped
        )
        found = evaluate(
            gauge,
            spall=spall,
            free_end=None if free_end is None else read_free_end(path, free_end),
            estimate=estimate,
            count=peaks,
            pulse_end=pulse_end,
            speed=wave_speed,
            coefficient=attenuation,
        )
    if peaks is not None and found.peaks is not None and len(found.peaks.time) < peaks:
        err.print(f"--peaks: requests {peaks} tension peaks, there are {len(found.peaks.time)}")
    for note in gauge.notes:
        out.print(note)
    known = gauge.metadata
    sources = ["results" if given is None else "given" for given in (wave_speed, attenuation)]
    out.print(_overview(found, sources, None if known is None else known.strength))
    if output is not None:
        from dembound.plot.gauge import plot_gauge

        leave(plot_gauge(gauge, found), output, title)


def _overview(found: Findings, sources: Sequence[str], known: tuple[float, float] | None) -> Table:
    """All estimates, one line each; sources : of speed and attenuation if these are not from the peaks.

    known : strength of a bar that was computed, Pa, at the slowest and at the fastest strain rate, printed beside the
    strengths that are found.
    """
    overview = compact_table("", "value", "std. error", "from")
    overview.add_row("wave speed (m/s)", *_fitted(found.speed, "times", sources[0]))
    if found.attenuation is not None:
        overview.add_row("attenuation α (1/m)", *_fitted(found.attenuation, "heights", sources[1]))
    if (strength := found.strength) is not None:
        source = f"image at {strength.position:g} m"
        error = _error(strength.nominal_error / MPA)
        overview.add_row("nominal strength (MPa)", f"{strength.nominal / MPA:.4g}", error, source)
        if strength.attenuated is not None:
            source = f"way of {strength.way:.3g} m"
            error = _error(strength.attenuated_error / MPA)
            overview.add_row("attenuated strength (MPa)", f"{strength.attenuated / MPA:.4g}", error, source)
    if found.pull_back is not None:
        overview.add_row("pull-back strength (MPa)", f"{found.pull_back / MPA:.4g}", "", "free end")
    if known is not None and (found.strength is not None or found.pull_back is not None):
        both = " to ".join(f"{value / MPA:.4g}" for value in dict.fromkeys(known))
        overview.add_row("strength of the bar (MPa)", both if known[0] < float("inf") else "none", "", "case")
    return overview


def _fitted(estimate: Estimate, what: str, source: str) -> tuple[str, str, str]:
    """Value, standard error and source of an estimate; source : the one given if it was not fitted."""
    if not estimate.points:
        return f"{estimate.value:.5g}", "", source
    return f"{estimate.value:.5g}", _error(estimate.error), f"{what} of {estimate.points} peaks"


def _error(error: float) -> str:
    """A standard error; empty if it is not known."""
    return "" if error != error else f"{error:.2g}"
