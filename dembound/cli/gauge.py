"""The commands gauge and hopkinson."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from rich.table import Table
from typer import Argument, Option

from dembound.cli.app import MORE, PICTURE, PictureTitle, app, writable
from dembound.cli.console import compact_table, err, out, print_written
from dembound.cli.options import leave, with_tables
from dembound.cli.results import results_file
from dembound.cli.signal_options import SignalOptions, of_file
from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.gauge.estimates import Estimate
    from dembound.gauge.gauge_io import Gauge
    from dembound.gauge.hopkinson import Setup, Specimen
    from dembound.gauge.spalling import Findings


_of_bars = partial(Option, rich_help_panel="Bars and specimen")
_of_pulses = partial(Option, rich_help_panel="Pulses")

MPA = 1e6
"""Pascals in a megapascal."""


@dataclass(frozen=True)
class EvaluationOptions:
    """What is known of a test on a bar, and what is estimated."""

    spall: Annotated[float | None, Option(help="Where the bar spalled, from the loaded end (m).")] = None
    free_end: Annotated[
        str | None,
        Option(metavar="NAME", help="Monitor at the free end, or a text file of s and m/s."),
    ] = None
    estimate: Annotated[
        bool, Option("--estimate", help="Speed and attenuation from tension peaks, also of results.")
    ] = False
    peaks: Annotated[int | None, Option(help="Tension peaks for speed and attenuation.", min=2)] = None
    pulse_end: Annotated[float | None, Option(help="When the incident pulse has passed (s).")] = None
    wave_speed: Annotated[float | None, Option(help="Wave speed (m/s) of another test.")] = None
    attenuation: Annotated[float | None, Option(help="Attenuation (1/m) of another test.")] = None

    def of(self, gauge: Gauge, path: Path) -> Findings:
        """All estimates from a gauge in a file; raises CaseError as `evaluate` and `read_free_end`."""
        from dembound.gauge.gauge_io import read_free_end
        from dembound.gauge.spalling import evaluate

        free_end = None if self.free_end is None else read_free_end(path, self.free_end)
        known = {"speed": self.wave_speed, "coefficient": self.attenuation, "pulse_end": self.pulse_end}
        return evaluate(gauge, spall=self.spall, free_end=free_end, estimate=self.estimate, count=self.peaks, **known)


@app.command("gauge", rich_help_panel=MORE)
@with_tables
def gauge(
    record: Annotated[Path, Argument(metavar="RECORD", help="Text file of time and signal, or a run's results.")],
    monitor: Annotated[str | None, Option(metavar="NAME", help="Monitor of the results.")] = None,
    position: Annotated[float | None, Option(help="From the loaded end to the gauge (m).")] = None,
    length: Annotated[float | None, Option(help="Length of the bar (m).")] = None,
    density: Annotated[float | None, Option(help="Density of the bar (kg/m³), for --free-end and for E = ρc².")] = None,
    *,
    evaluation: EvaluationOptions,
    output: Annotated[Path | None, PICTURE] = None,
    title: PictureTitle = None,
    column: Annotated[str | None, of_file(metavar="NAME|NUMBER", help="Column of the signal.")] = None,
    signal: SignalOptions,
) -> None:
    """Evaluate a gauge on a bar: wave speed, attenuation, strength.

    Results contain position, length, density, speed and attenuation. Strengths need --spall or --free-end.
    """
    from dembound.gauge.gauge_io import read_gauge
    from dembound.results.reader import understood

    path = results_file(record) if record.is_dir() else record
    bar, reading, treatment = (position, length, density), signal.reading(column), signal.treatment()
    with understood(path):
        gauge = read_gauge(
            path, monitor, *bar, reading, treatment, signal.youngs_modulus, may_be_clipped=signal.clipped
        )
        found = evaluation.of(gauge, path)
    peaks = evaluation.peaks
    if peaks is not None and found.peaks is not None and len(found.peaks.time) < peaks:
        err.print(f"--peaks: requests {peaks} tension peaks, there are {len(found.peaks.time)}")
    for note in gauge.notes:
        out.print(note)
    known = gauge.metadata
    sources = ["results" if given is None else "given" for given in (evaluation.wave_speed, evaluation.attenuation)]
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


Window = Annotated[
    tuple[float, float] | None, _of_pulses(metavar="FROM TO", help="Of this pulse (s); by default found.")
]
Column = Annotated[str | None, of_file(metavar="NAME|NUMBER", help="Its column, or monitor of results.")]


@dataclass(frozen=True, kw_only=True)
class BarOptions:
    """The two bars and the specimen between them."""

    wave_speed: Annotated[float, _of_bars(help="Of the bars (m/s).")]
    density: Annotated[float, _of_bars(help="Of the bars (kg/m³).")]
    bar_diameter: Annotated[float, _of_bars(help="Of both bars (m).")]
    incident_gauge: Annotated[float, _of_bars(help="From the gauge to the specimen (m).")]
    transmitted_gauge: Annotated[float, _of_bars(help="From the specimen to the gauge (m).")]
    specimen_length: Annotated[float, _of_bars(help="Length of the specimen (m).")]
    specimen_diameter: Annotated[float | None, _of_bars(help="Diameter of the specimen (m).")] = None
    specimen_area: Annotated[float | None, _of_bars(help="Or its area (m²).")] = None
    bar_length: Annotated[float | None, _of_bars(help="Length of each bar (m), whose end reflects waves.")] = None
    attenuation: Annotated[float, _of_bars(help="Of the bars (1/m).")] = 0.0

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
        Path, Argument(metavar="INCIDENT", help="Signal on the incident bar: text file, or a run's results.")
    ],
    transmitted: Annotated[
        Path | None, Argument(metavar="[TRANSMITTED]", help="Signal on the transmission bar; by default the same file.")
    ] = None,
    *,
    bars: BarOptions,
    incident_column: Column = None,
    transmitted_column: Column = None,
    incident_window: Window = None,
    reflected_window: Window = None,
    transmitted_window: Window = None,
    opposite: Annotated[
        bool, _of_pulses("--opposite", help="The transmission bar's gauge has the opposite sign.")
    ] = False,
    equilibrium: Annotated[float, Option(help="Largest difference of the forces over their mean.")] = 0.05,
    output: Annotated[Path | None, PICTURE] = None,
    title: PictureTitle = None,
    table: Annotated[Path | None, Option(help="Table of the histories (CSV).", callback=writable)] = None,
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
        print_written(table)


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
