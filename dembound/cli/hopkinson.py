"""The command hopkinson."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from dembound.cli.app import MORE, PICTURE, PictureTitle, app, writable
from dembound.cli.console import compact_table, err, out
from dembound.cli.options import leave, with_tables
from dembound.cli.results import results_file
from dembound.cli.signal_options import FILE, SignalOptions
from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.gauge.hopkinson import Setup, Specimen

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
    out.print(_overview(found, equilibrium))
    if output is not None:
        from dembound.plot.hopkinson import plot_hopkinson

        leave(plot_hopkinson(faces, found), output, title)
    if table is not None:
        found.write(table)
        out.print(f"wrote {table}")


def _overview(found: Specimen, tolerance: float) -> Table:
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
