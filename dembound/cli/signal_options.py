"""Options of commands that read measured signals: columns, units, bridges of strain gauges, baseline and filters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.gauge.signal import Reading
    from dembound.gauge.treatment import Treatment
    from dembound.gauge.units import Bridge

FILE, BRIDGE, CLEANING = "Text files", "Strain gauges", "Baseline and filters"
"""Panels of the help."""

TimeColumn = Annotated[
    str | None,
    typer.Option(metavar="NAME|NUMBER", help="Column of the times; by default the first.", rich_help_panel=FILE),
]
TimeUnit = Annotated[
    str | None, typer.Option(help="s, ms, µs (us) or ns; by default the header's, or s.", rich_help_panel=FILE)
]
ValueUnit = Annotated[
    str | None,
    typer.Option(
        help="Pa, kPa, MPa, GPa, V, mV, µV (uV), strain or µε (ue); by default the header's.", rich_help_panel=FILE
    ),
]
Scale = Annotated[
    float,
    typer.Option(help="Factor that makes values Pa, positive in tension; -1 changes the sign.", rich_help_panel=FILE),
]
Clipped = Annotated[bool, typer.Option("--clipped", help="Accept a signal that looks clipped.", rich_help_panel=FILE)]
GaugeFactor = Annotated[
    float | None, typer.Option(help="Gauge factor k; makes strains of voltages.", rich_help_panel=BRIDGE)
]
BridgeWiring = Annotated[
    str,
    typer.Option(
        "--bridge",
        help="quarter, half (two opposite gauges along the bar) or full (and two across).",
        rich_help_panel=BRIDGE,
    ),
]
Excitation = Annotated[float | None, typer.Option(help="Voltage that supplies the bridge (V).", rich_help_panel=BRIDGE)]
Gain = Annotated[float, typer.Option(help="Gain of its amplifier.", rich_help_panel=BRIDGE)]
Poisson = Annotated[
    float | None,
    typer.Option(help="Poisson's ratio of the bar, for a full bridge.", rich_help_panel=BRIDGE),
]
Modulus = Annotated[
    float | None,
    typer.Option("--youngs-modulus", help="E of the bar (Pa); by default ρc².", rich_help_panel=BRIDGE),
]
NoBaseline = Annotated[bool, typer.Option("--no-baseline", help="Remove no baseline at all.", rich_help_panel=CLEANING)]
NoDrift = Annotated[bool, typer.Option("--no-drift", help="Remove no drift.", rich_help_panel=CLEANING)]
NoHum = Annotated[bool, typer.Option("--no-hum", help="Remove no mains hum.", rich_help_panel=CLEANING)]
LowPass = Annotated[float | None, typer.Option(help="Keep what is below (Hz).", rich_help_panel=CLEANING)]
HighPass = Annotated[float | None, typer.Option(help="Keep what is above (Hz).", rich_help_panel=CLEANING)]
Band = Annotated[
    tuple[float, float] | None,
    typer.Option(metavar="LOW HIGH", help="Both: keep what is between (Hz).", rich_help_panel=CLEANING),
]
Notch = Annotated[
    list[float] | None, typer.Option(help="Take out this frequency (Hz). May be repeated.", rich_help_panel=CLEANING)
]


def bridge_of(
    gauge_factor: float | None, wiring: str, excitation: float | None, gain: float, poisson: float | None
) -> Bridge | None:
    """The bridge of these options; None without a gauge factor. Raises CaseError for options without meaning."""
    from typing import cast, get_args

    from dembound.gauge.units import Bridge, Wiring

    if wiring not in get_args(Wiring):
        raise CaseError([f"--bridge: is {wiring}, must be quarter, half or full"])
    if gauge_factor is None:
        if excitation is not None or gain != 1.0 or wiring != "quarter":
            raise CaseError(["--gauge-factor: is missing, --bridge, --excitation and --gain need it"])
        return None
    return Bridge(gauge_factor, cast("Wiring", wiring), excitation, gain, poisson)


def reading_of(
    column: str | None,
    time_column: str | None,
    time_unit: str | None,
    unit: str | None,
    bridge: Bridge | None,
    scale: float,
) -> Reading:
    """How a file is read, by these options."""
    from dembound.gauge.signal import Reading

    return Reading(column, time_column, time_unit, unit, bridge, scale)


def treatment_of(
    no_baseline: bool,
    no_drift: bool,
    no_hum: bool,
    low_pass: float | None,
    high_pass: float | None,
    band: tuple[float, float] | None,
    notches: list[float] | None,
) -> Treatment | None:
    """What these options remove from a signal; None if all are as by default.

    Raises CaseError for a band beside a low or high pass.
    """
    from dembound.gauge.filters import Filters
    from dembound.gauge.treatment import Treatment

    if band is not None:
        if low_pass is not None or high_pass is not None:
            raise CaseError(["--band: is a high and a low pass at once, it can have none beside it"])
        high_pass, low_pass = band
    filters = Filters(low_pass, high_pass, tuple(notches or ()))
    treatment = Treatment(not no_baseline, not no_drift, not no_hum, filters)
    return None if treatment == Treatment() else treatment
