"""The command gauge."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from dembound.cli.app import PICTURE, PictureTitle, app
from dembound.cli.console import compact_table, err, out
from dembound.cli.results import results_file

if TYPE_CHECKING:
    from dembound.gauge.estimates import Estimate
    from dembound.gauge.spalling import Findings

MPA = 1e6
"""Pascals in a megapascal."""


@app.command("gauge", rich_help_panel="Results")
def gauge(
    record: Annotated[
        Path, typer.Argument(metavar="RECORD", help="Text file of time (s) and stress (Pa), or a run's results.")
    ],
    monitor: Annotated[str | None, typer.Option(metavar="NAME", help="Monitor of the results.")] = None,
    position: Annotated[float | None, typer.Option(help="Gauge from the loaded end (m).")] = None,
    length: Annotated[float | None, typer.Option(help="Length of the bar (m).")] = None,
    density: Annotated[float | None, typer.Option(help="Its density (kg/m³), for --free-end.")] = None,
    scale: Annotated[float, typer.Option(help="Factor that makes the values Pa, positive in tension.")] = 1.0,
    spall: Annotated[float | None, typer.Option(help="Where the bar spalled, from the loaded end (m).")] = None,
    free_end: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Monitor at the free end, or a text file of time (s) and velocity (m/s)."),
    ] = None,
    estimate: Annotated[
        bool,
        typer.Option("--estimate", help="Take speed and attenuation from tension peaks, though the results have them."),
    ] = False,
    peaks: Annotated[int | None, typer.Option(help="As --estimate, from this number of first peaks.", min=2)] = None,
    pulse_end: Annotated[
        float | None, typer.Option(help="Time at which the incident pulse has passed (s); by default when it returns.")
    ] = None,
    wave_speed: Annotated[
        float | None, typer.Option(help="Wave speed (m/s) of another test; else the results', or estimated from peaks.")
    ] = None,
    attenuation: Annotated[
        float | None, typer.Option(help="Attenuation (1/m) of another test; else as the speed.")
    ] = None,
    output: Annotated[Path | None, PICTURE] = None,
    title: PictureTitle = None,
) -> None:
    """Estimate from a gauge on a bar: wave speed, attenuation, and the stress at which the bar spalled.

    Results contain position, length, density, speed and attenuation. Strengths need --spall or --free-end.
    """
    from dembound.gauge.gauge_io import read_free_end, read_gauge
    from dembound.gauge.spalling import evaluate

    path = results_file(record) if record.is_dir() else record
    gauge = read_gauge(path, monitor, position, length, density, scale)
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
        err.print(f"--peaks: asks for {peaks} tension peaks, there are {len(found.peaks.time)}")
    out.print(_overview(found, *("results" if given is None else "given" for given in (wave_speed, attenuation))))
    if output is not None:
        from dembound.plot.gauge import plot_gauge
        from dembound.plot.style import save

        save(plot_gauge(gauge, found), output, title)
        out.print(f"wrote {output}")


def _overview(found: Findings, speed_from: str, attenuation_from: str) -> Table:
    """All estimates, one line each; speed_from, attenuation_from : the source if it is not the peaks."""
    overview = compact_table("", "value", "std. error", "from")
    overview.add_row("wave speed (m/s)", *_fitted(found.speed, "times", speed_from))
    if found.attenuation is not None:
        overview.add_row("attenuation α (1/m)", *_fitted(found.attenuation, "heights", attenuation_from))
    if (strength := found.strength) is not None:
        source = f"image at {strength.position:g} m"
        overview.add_row("nominal strength (MPa)", f"{strength.nominal / MPA:.4g}", "", source)
        if strength.attenuated is not None:
            source = f"way of {strength.way:.3g} m"
            overview.add_row("attenuated strength (MPa)", f"{strength.attenuated / MPA:.4g}", "", source)
    if found.pull_back is not None:
        overview.add_row("pull-back strength (MPa)", f"{found.pull_back / MPA:.4g}", "", "free end")
    return overview


def _fitted(estimate: Estimate, what: str, source: str) -> tuple[str, str, str]:
    """Value, standard error and source of an estimate; source : the one given if it was not fitted."""
    if not estimate.points:
        return f"{estimate.value:.5g}", "", source
    error = f"{estimate.error:.2g}" if estimate.points > 2 else ""
    return f"{estimate.value:.5g}", error, f"{what} of {estimate.points} peaks"
