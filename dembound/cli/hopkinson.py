"""The command hopkinson."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from dembound.cli.app import MORE, PICTURE, PictureTitle, app, writable
from dembound.cli.console import compact_table, err, out
from dembound.cli.option_tables import with_tables
from dembound.cli.results import results_file
from dembound.cli.signal_options import FILE, SignalOptions
from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.gauge.hopkinson.pulses import Faces, Setup, Windows
    from dembound.gauge.hopkinson.slope_error import SlopeError
    from dembound.gauge.hopkinson.specimen import Specimen
    from dembound.gauge.reading.signal import Signal

BARS, PULSES = "Bars and specimen", "Pulses"
"""Panels of the help."""

Window = Annotated[
    tuple[float, float] | None,
    typer.Option(metavar="FROM TO", help="Of this pulse at its gauge (s); by default found.", rich_help_panel=PULSES),
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
    dispersion: Annotated[
        bool,
        typer.Option("--dispersion-correction", help="Of round bars, with --poisson.", rich_help_panel=BARS),
    ] = False

    def setup(self, signal: SignalOptions, second_gauge: float | None) -> Setup:
        """The setup of the test; raises CaseError for impossible data, and unless the specimen has exactly one size."""
        from dembound.gauge.hopkinson.pulses import Setup, circle_area

        areas = [self.specimen_area] if self.specimen_area is not None else []
        areas += [circle_area(self.specimen_diameter)] if self.specimen_diameter is not None else []
        if len(areas) != 1:
            raise CaseError(["--specimen-diameter: is needed, or --specimen-area, but not both"])
        return Setup.of_round_bars(
            *(self.wave_speed, self.density, self.bar_diameter, self.incident_gauge, self.transmitted_gauge),
            *(self.specimen_length, *areas),
            attenuation=self.attenuation,
            poisson=signal.poisson,
            modulus=signal.youngs_modulus,
            disperse=self.dispersion,
            second_gauge=second_gauge,
            bar_length=self.bar_length,
        )

    def given(self, signal: SignalOptions, pulses: PulseOptions) -> dict[str, float | None]:
        """The values of options by name, None where they are left out, to compare with those of results."""
        tables: tuple[object, ...] = (self, signal, pulses)
        values = {f"--{name.replace('_', '-')}": value for table in tables for name, value in vars(table).items()}
        return {option: value for option, value in values.items() if value is None or isinstance(value, float)}


@dataclass(frozen=True)
class PulseOptions:
    """The times of the pulses in the signals, and a second gauge that separates them."""

    second: Annotated[
        Path | None,
        typer.Option(help="Signal of another gauge on the incident bar, if pulses overlap.", rich_help_panel=PULSES),
    ] = None
    second_column: Annotated[
        str | None, typer.Option(metavar="NAME|NUMBER", help="Its column or monitor.", rich_help_panel=PULSES)
    ] = None
    second_gauge: Annotated[
        float | None, typer.Option(help="From the second gauge to the specimen (m).", rich_help_panel=PULSES)
    ] = None
    incident_window: Window = None
    reflected_window: Window = None
    transmitted_window: Window = None
    opposite: Annotated[
        bool,
        typer.Option("--opposite", help="The transmission bar's gauge has the opposite sign.", rich_help_panel=PULSES),
    ] = False


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
    incident_column: Annotated[
        str | None,
        typer.Option(metavar="NAME|NUMBER", help="Its column, or monitor of results.", rich_help_panel=FILE),
    ] = None,
    transmitted_column: Annotated[
        str | None, typer.Option(metavar="NAME|NUMBER", help="The same.", rich_help_panel=FILE)
    ] = None,
    pulses: PulseOptions,
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
    from dembound.gauge.hopkinson.pulse_checks import doubts_of_bars, doubts_of_pulses
    from dembound.gauge.hopkinson.pulses import Windows, at_faces
    from dembound.gauge.hopkinson.recorded_test import contradictions
    from dembound.gauge.hopkinson.records import combined
    from dembound.gauge.hopkinson.slope_error import doubts_of_slope, slope_error
    from dembound.gauge.hopkinson.specimen import specimen
    from dembound.gauge.reading.recorded import is_record

    has_second = pulses.second_gauge is not None
    if has_second == (pulses.second is None and pulses.second_column is None):
        raise CaseError(["--second-gauge: needs --second or --second-column, and the other way round"])
    setup = bars.setup(signal, pulses.second_gauge)
    sources = [(incident, incident_column), (transmitted or incident, transmitted_column)]
    if has_second:
        sources.append((pulses.second or incident, pulses.second_column))
    files = [(results_file(path) if path.is_dir() else path, column) for path, column in sources]
    windows = Windows(pulses.incident_window, pulses.reflected_window, pulses.transmitted_window)
    strains = _strains(files, signal, setup, windows)
    for warning in contradictions(files, bars.given(signal, pulses)):
        err.print(f"warning: {warning}")
    signals = combined(*strains, opposite=pulses.opposite)
    faces = at_faces(signals, setup, windows)
    found = specimen(faces, setup, equilibrium)
    if found.equilibrium is None:
        said = f"the forces on the specimen never agree to {100.0 * equilibrium:g} %"
        err.print(f"warning: {said}: stress over strain is no law of it")
    error = slope_error(faces, setup, equilibrium, found)
    doubts = doubts_of_bars(setup, bars.density)
    measured = not all(is_record(path) for path, _ in files)
    of_pulses = doubts_of_pulses(signals, faces, setup, windows, found, measured=measured)
    for warning in (*doubts, *doubts_of_slope(found, error), *of_pulses):
        err.print(f"warning: {warning}")
    out.print(_overview(found, equilibrium, error))
    _write(faces, found, output, title, table)


def _strains(
    files: Sequence[tuple[Path, str | None]], options: SignalOptions, setup: Setup, windows: Windows
) -> list[Signal]:
    """The strains of gauges from files and columns, the incident bar's first; prints the notes on them."""
    from dembound.gauge.hopkinson.records import read_strain, require_pulses

    strains, treatment = [], options.treatment()
    for path, column in files:
        reading = options.reading(column)
        strains.append(read_strain(path, reading, treatment, setup.modulus, may_be_clipped=options.clipped))
        for note in strains[-1].notes:
            out.print(note)
        if len(strains) == 1:  # the other ones may be without a wave where it ends too early
            require_pulses(strains[0], setup, windows)
    return strains


def _write(faces: Faces, found: Specimen, picture: Path | None, title: str | None, table: Path | None) -> None:
    """Write the picture and the table, where there are names for them."""
    if picture is not None:
        from dembound.plot.hopkinson import plot_hopkinson
        from dembound.plot.style import save

        save(plot_hopkinson(faces, found), picture, title)
        out.print(f"wrote {picture}")
    if table is not None:
        from dembound.gauge.hopkinson.specimen_table import write_specimen

        write_specimen(found, table)
        out.print(f"wrote {table}")


def _overview(found: Specimen, tolerance: float, error: SlopeError | None) -> Table:
    """Largest values by one, two and three waves, and the time in equilibrium; error : of the slope."""
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
    rising = slice(there.start, found.largest + 1)
    rates = [f"{rate[rising].mean():.4g}" for rate in (found.rate, found.one_wave_rate)]
    overview.add_row("until the largest stress there:", "", "", "")
    overview.add_row("mean strain rate (1/s)", rates[0], "", rates[1])
    if error is not None:
        overview.add_row("stress over strain (GPa)", f"{found.slope / 1e9:.4g} ± {error.half_width / 1e9:.2g}", "", "")
        parts = error.inertia, error.time, error.line, error.noise, error.balance
        shares = ", ".join(f"{100.0 * each / found.slope:.2g}" for each in parts)
        overview.add_row("± by inertia, time, line, noise, balance (%)", shares, "", "")
    return overview
