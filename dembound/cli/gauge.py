"""The commands gauge and hopkinson, and their options for measured signals.

Signals have columns, units, bridges of strain gauges, a baseline and filters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from dembound.cli.app import MORE, PICTURE, PictureTitle, app, writable
from dembound.cli.console import compact_table, err, out
from dembound.cli.options import leave, with_tables
from dembound.cli.results import results_file
from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.gauge.baseline import Treatment
    from dembound.gauge.estimates import Estimate
    from dembound.gauge.hopkinson import Setup, Specimen
    from dembound.gauge.reading.signal import Reading
    from dembound.gauge.reading.units import Bridge
    from dembound.gauge.spalling import Findings


FILE, BRIDGE, CLEANING = "Text files", "Strain gauges", "Baseline and filters"
"""Panels of the help."""


@dataclass(frozen=True)
class SignalOptions:
    """How signals are read from text files, converted to strains or stresses, and cleaned."""

    time_column: Annotated[
        str | None,
        typer.Option(metavar="NAME|NUMBER", help="Column of the times; by default the first.", rich_help_panel=FILE),
    ] = None
    time_unit: Annotated[
        str | None, typer.Option(help="s, ms, µs (us) or ns; by default the header's, or s.", rich_help_panel=FILE)
    ] = None
    unit: Annotated[
        str | None,
        typer.Option(
            help="Pa, kPa, MPa, GPa, V, mV, µV (uV), strain or µε (ue); by default the header's.", rich_help_panel=FILE
        ),
    ] = None
    scale: Annotated[
        float,
        typer.Option(
            help="Factor that makes values Pa, positive in tension; -1 changes the sign.", rich_help_panel=FILE
        ),
    ] = 1.0
    clipped: Annotated[
        bool, typer.Option("--clipped", help="Accept a signal that looks clipped.", rich_help_panel=FILE)
    ] = False
    gauge_factor: Annotated[
        float | None, typer.Option(help="Gauge factor k, which converts voltages to strains.", rich_help_panel=BRIDGE)
    ] = None
    bridge: Annotated[
        str,
        typer.Option(
            "--bridge",
            help="quarter, half (two opposite gauges along the bar) or full (and two across).",
            rich_help_panel=BRIDGE,
        ),
    ] = "quarter"
    excitation: Annotated[
        float | None, typer.Option(help="Voltage that supplies the bridge (V).", rich_help_panel=BRIDGE)
    ] = None
    gain: Annotated[float, typer.Option(help="Gain of its amplifier.", rich_help_panel=BRIDGE)] = 1.0
    poisson: Annotated[
        float | None, typer.Option(help="Poisson's ratio of the bar, for a full bridge.", rich_help_panel=BRIDGE)
    ] = None
    youngs_modulus: Annotated[
        float | None,
        typer.Option("--youngs-modulus", help="E of the bar (Pa); by default ρc².", rich_help_panel=BRIDGE),
    ] = None
    no_baseline: Annotated[
        bool, typer.Option("--no-baseline", help="Remove no baseline at all.", rich_help_panel=CLEANING)
    ] = False
    no_drift: Annotated[bool, typer.Option("--no-drift", help="Remove no drift.", rich_help_panel=CLEANING)] = False
    low_pass: Annotated[float | None, typer.Option(help="Keep what is below (Hz).", rich_help_panel=CLEANING)] = None
    high_pass: Annotated[float | None, typer.Option(help="Keep what is above (Hz).", rich_help_panel=CLEANING)] = None
    band: Annotated[
        tuple[float, float] | None,
        typer.Option(
            metavar="LOW HIGH", help="Low and high pass in one: the band that remains (Hz).", rich_help_panel=CLEANING
        ),
    ] = None
    notch: Annotated[
        list[float] | None,
        typer.Option(help="Remove this frequency (Hz). May be repeated.", rich_help_panel=CLEANING),
    ] = None

    def reading(self, column: str | None = None) -> Reading:
        """How a column of a file is read; raises CaseError for impossible options of a bridge."""
        from dembound.gauge.reading.signal import Reading

        return Reading(column, self.time_column, self.time_unit, self.unit, self._bridge(), self.scale)

    def _bridge(self) -> Bridge | None:
        """The bridge of strain gauges; None without a gauge factor."""
        from typing import cast, get_args

        from dembound.gauge.reading.units import Bridge, Wiring

        if self.bridge not in get_args(Wiring):
            raise CaseError([f"--bridge: is {self.bridge}, must be quarter, half or full"])
        if self.gauge_factor is None:
            if self.excitation is not None or self.gain != 1.0 or self.bridge != "quarter":
                raise CaseError(["--gauge-factor: is missing, --bridge, --excitation and --gain need it"])
            return None
        return Bridge(self.gauge_factor, cast("Wiring", self.bridge), self.excitation, self.gain, self.poisson)

    def treatment(self) -> Treatment | None:
        """Baseline and frequencies to remove from a signal; None for the defaults.

        Raises CaseError for a band beside a low or high pass.
        """
        from dembound.gauge.baseline import Filters, Treatment

        low_pass, high_pass = self.low_pass, self.high_pass
        if self.band is not None:
            if low_pass is not None or high_pass is not None:
                raise CaseError(["--band: is a high and a low pass at once, it can have none beside it"])
            high_pass, low_pass = self.band
        filters = Filters(low_pass, high_pass, tuple(self.notch or ()))
        treatment = Treatment(not self.no_baseline, not self.no_drift, filters)
        return None if treatment == Treatment() else treatment


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
        from dembound.plot.laboratory import plot_gauge

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


BARS, PULSES = "Bars and specimen", "Pulses"
"""Panels of the help."""

Window = Annotated[
    tuple[float, float] | None,
    typer.Option(metavar="FROM TO", help="Of this pulse at its gauge (s); by default found.", rich_help_panel=PULSES),
]
Column = Annotated[
    str | None, typer.Option(metavar="NAME|NUMBER", help="Its column, or monitor of results.", rich_help_panel=FILE)
]


def _of_bars(words: str) -> typer.models.OptionInfo:
    """An option about bars and specimen."""
    return typer.Option(help=words, rich_help_panel=BARS)


@dataclass(frozen=True, kw_only=True)
class BarOptions:
    """The two bars and the specimen between them."""

    wave_speed: Annotated[float, _of_bars("Of the bars (m/s).")]
    density: Annotated[float, _of_bars("Of the bars (kg/m³).")]
    bar_diameter: Annotated[float, _of_bars("Of both bars (m).")]
    incident_gauge: Annotated[float, _of_bars("From the gauge to the specimen (m).")]
    transmitted_gauge: Annotated[float, _of_bars("From the specimen to the gauge (m).")]
    specimen_length: Annotated[float, _of_bars("Length of the specimen (m).")]
    specimen_diameter: Annotated[float | None, _of_bars("Diameter of the specimen (m).")] = None
    specimen_area: Annotated[float | None, _of_bars("Or its area (m²).")] = None
    bar_length: Annotated[float | None, _of_bars("Length of each bar (m), to stop before its end reflects waves.")] = (
        None
    )
    attenuation: Annotated[float, _of_bars("Of the bars (1/m).")] = 0.0

    def setup(self, modulus: float | None) -> Setup:
        """The setup; raises CaseError for impossible data, and unless the specimen has exactly one size."""
        from dembound.gauge.hopkinson import Setup, circle_area

        if (self.specimen_area is None) == (self.specimen_diameter is None):
            raise CaseError(["--specimen-diameter: is needed, or --specimen-area, but not both"])
        area = self.specimen_area if self.specimen_diameter is None else circle_area(self.specimen_diameter)
        bars = self.wave_speed, self.density, self.bar_diameter, self.incident_gauge, self.transmitted_gauge
        return Setup(*bars, self.specimen_length, area or 0.0, self.attenuation, modulus, self.bar_length)


@app.command("hopkinson", rich_help_panel=MORE)
@with_tables
def hopkinson(
    incident: Annotated[
        Path, typer.Argument(metavar="INCIDENT", help="Signal on the incident bar: text file, or a run's results.")
    ],
    transmitted: Annotated[
        Path | None,
        typer.Argument(metavar="[TRANSMITTED]", help="Signal on the transmission bar; by default the same file."),
    ] = None,
    *,
    bars: BarOptions,
    incident_column: Column = None,
    transmitted_column: Column = None,
    incident_window: Window = None,
    reflected_window: Window = None,
    transmitted_window: Window = None,
    opposite: Annotated[
        bool,
        typer.Option("--opposite", help="The transmission bar's gauge has the opposite sign.", rich_help_panel=PULSES),
    ] = False,
    equilibrium: Annotated[float, typer.Option(help="Largest difference of the forces over their mean.")] = 0.05,
    output: Annotated[Path | None, PICTURE] = None,
    title: PictureTitle = None,
    table: Annotated[
        Path | None, typer.Option(help="Table of the histories to write (CSV).", callback=writable)
    ] = None,
    signal: SignalOptions,
) -> None:
    """Evaluate a split Hopkinson test: stress, strain, strain rate.

    By one, two and three waves, with the time in which the specimen is in equilibrium.
    """
    from dembound.gauge.hopkinson import Windows, at_faces, combined, read_strain, specimen

    setup, strains = bars.setup(signal.youngs_modulus), []
    for path, column in ((incident, incident_column), (transmitted or incident, transmitted_column)):
        file, reading = results_file(path) if path.is_dir() else path, signal.reading(column)
        strains.append(read_strain(file, reading, signal.treatment(), setup.modulus, may_be_clipped=signal.clipped))
        for note in strains[-1].notes:
            out.print(note)
    signals = combined(*strains, opposite=opposite)
    faces = at_faces(signals, setup, Windows(incident_window, reflected_window, transmitted_window))
    found = specimen(faces, setup, equilibrium)
    if found.equilibrium is None:
        said = f"the forces on the specimen never agree to {100.0 * equilibrium:g} %"
        err.print(f"warning: {said}: stress over strain is no law of it")
    out.print(_specimen_overview(found, equilibrium))
    if output is not None:
        from dembound.plot.laboratory import plot_hopkinson

        leave(plot_hopkinson(faces, found), output, title)
    if table is not None:
        found.write(table)
        out.print(f"wrote {table}")


def _specimen_overview(found: Specimen, tolerance: float) -> Table:
    """Largest values by one, two and three waves, and the time in equilibrium."""
    overview = compact_table("", "three waves", "two waves", "one wave")
    largest = [f"{stress.max() / 1e6:.5g}" for stress in (found.stress, found.front, found.back)]
    overview.add_row("largest stress (MPa)", *largest)
    strains = [f"{100.0 * strain.max():.4g}" for strain in (found.strain, found.one_wave_strain)]
    overview.add_row("largest strain (%)", strains[0], "", strains[1])
    if found.equilibrium is None:
        overview.add_row(f"forces equal to {100.0 * tolerance:g} %", "never", "", "")
        return overview
    there = slice(*found.equilibrium)
    begin, end = 1e6 * found.time[there][[0, -1]]
    overview.add_row(f"forces equal to {100.0 * tolerance:g} % (µs)", f"{begin:.4g} to {end:.4g}", "", "")
    overview.add_row("strain there (%)", " to ".join(f"{100.0 * s:.3g}" for s in found.strain[there][[0, -1]]), "", "")
    rates = [f"{rate[there.start : found.largest + 1].mean():.4g}" for rate in (found.rate, found.one_wave_rate)]
    overview.add_row("until the largest stress there:", "", "", "")
    overview.add_row("mean strain rate (1/s)", rates[0], "", rates[1])
    overview.add_row("stress over strain (GPa)", f"{found.slope / 1e9:.4g}", "", "")
    return overview
