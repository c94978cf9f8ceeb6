"""Options of commands that read measured signals: columns, units, bridges of strain gauges, baseline and filters."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated

from typer import Option

from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.gauge.baseline import Treatment
    from dembound.gauge.reading.signal import Reading
    from dembound.gauge.reading.units import Bridge

of_file = partial(Option, rich_help_panel="Text files")
_of_bridge = partial(Option, rich_help_panel="Strain gauges")
_cleaning = partial(Option, rich_help_panel="Baseline and filters")


@dataclass(frozen=True)
class SignalOptions:
    """How signals are read from text files, converted to strains or stresses, and cleaned."""

    time_column: Annotated[
        str | None, of_file(metavar="NAME|NUMBER", help="Column of the times; by default the first.")
    ] = None
    time_unit: Annotated[str | None, of_file(help="s, ms, µs (us) or ns; by default the header's, or s.")] = None
    unit: Annotated[
        str | None, of_file(help="Pa, kPa, MPa, GPa, V, mV, µV (uV), strain or µε (ue); by default the header's.")
    ] = None
    scale: Annotated[float, of_file(help="Factor to Pa, positive in tension; -1 changes the sign.")] = 1.0
    clipped: Annotated[bool, of_file("--clipped", help="Accept a signal that looks clipped.")] = False
    gauge_factor: Annotated[float | None, _of_bridge(help="Gauge factor k.")] = None
    bridge: Annotated[
        str, _of_bridge("--bridge", help="quarter, half (two gauges along the bar) or full (and two across).")
    ] = "quarter"
    excitation: Annotated[float | None, _of_bridge(help="Voltage of the bridge (V).")] = None
    gain: Annotated[float, _of_bridge(help="Gain of its amplifier.")] = 1.0
    poisson: Annotated[float | None, _of_bridge(help="Poisson's ratio of the bar, for a full bridge.")] = None
    youngs_modulus: Annotated[
        float | None, _of_bridge("--youngs-modulus", help="E of the bar (Pa); by default ρc².")
    ] = None
    no_baseline: Annotated[bool, _cleaning("--no-baseline", help="Remove no baseline.")] = False
    no_drift: Annotated[bool, _cleaning("--no-drift", help="Remove no drift.")] = False
    low_pass: Annotated[float | None, _cleaning(help="Keep what is below (Hz).")] = None
    high_pass: Annotated[float | None, _cleaning(help="Keep what is above (Hz).")] = None
    band: Annotated[tuple[float, float] | None, _cleaning(metavar="LOW HIGH", help="The band that remains (Hz).")] = (
        None
    )
    notch: Annotated[list[float] | None, _cleaning(help="Remove this frequency (Hz). May be repeated.")] = None

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
