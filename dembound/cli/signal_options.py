"""Options of commands that read measured signals: columns, units, bridges of strain gauges, baseline and filters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.gauge.baseline import Treatment
    from dembound.gauge.reading.signal import Reading
    from dembound.gauge.reading.units import Bridge

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
        from dembound.gauge.baseline import Treatment
        from dembound.gauge.filters import Filters

        low_pass, high_pass = self.low_pass, self.high_pass
        if self.band is not None:
            if low_pass is not None or high_pass is not None:
                raise CaseError(["--band: is a high and a low pass at once, it can have none beside it"])
            high_pass, low_pass = self.band
        filters = Filters(low_pass, high_pass, tuple(self.notch or ()))
        treatment = Treatment(not self.no_baseline, not self.no_drift, filters)
        return None if treatment == Treatment() else treatment
