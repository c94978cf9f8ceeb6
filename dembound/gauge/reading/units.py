"""Units of measured signals, and the strain that a Wheatstone bridge of strain gauges measures as a voltage."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from dembound.errors import CaseError
from dembound.words import percent

Wiring = Literal["quarter", "half", "full"]


class Unit(NamedTuple):
    """A unit of values: its name, what it measures (Pa, V, strain, m/s), and its size in that."""

    name: str
    of: str
    size: float


MICRO = ("µ", "μ", "u")
"""The micro sign, the Greek letter, and u."""

TIMES = {
    **dict.fromkeys(("s", "sec", "second", "seconds"), 1.0),
    **dict.fromkeys(("ms", "msec", "milliseconds"), 1e-3),
    **dict.fromkeys((*(f"{micro}s" for micro in MICRO), "usec", "microseconds"), 1e-6),
    **dict.fromkeys(("ns", "nsec", "nanoseconds"), 1e-9),
}
"""Sizes of units of time in seconds, by name in lower case."""

STRESSES = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/mm²": 1e6}
VOLTAGES = dict.fromkeys(("V", "volt", "volts", "Volt", "Volts"), 1.0) | {"mV": 1e-3, "millivolt": 1e-3}
VOLTAGES |= {f"{micro}V": 1e-6 for micro in MICRO}
STRAINS = dict.fromkeys(("strain", "Strain", "ε", "m/m", "mm/mm"), 1.0) | {"mm/m": 1e-3, "%": 1e-2}
STRAINS |= {f"{micro}{name}": 1e-6 for micro in MICRO for name in ("ε", "m/m", "strain")}
STRAINS |= {"ue": 1e-6, "microstrain": 1e-6}
SPEEDS = {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3, "km/s": 1e3}
"""Sizes of units by name, in Pa, V, of strains, and in m/s."""

VALUES = {
    unit: (of, size)
    for of, units in {"Pa": STRESSES, "V": VOLTAGES, "strain": STRAINS, "m/s": SPEEDS}.items()
    for unit, size in units.items()
}
"""Unit -> base unit of its quantity, and its size in that."""

AS_THEY_ARE = Unit("", "", 1.0)
"""Values without a known unit."""


def time_unit(name: str) -> float | None:
    """Size in seconds of a unit of time; None for other texts."""
    return TIMES.get(name.strip().lower())


def value_unit(name: str) -> Unit | None:
    """The unit of values of this name; None for other texts."""
    found = VALUES.get(name.strip())
    return None if found is None else Unit(name.strip(), *found)


def required_time_unit(name: str) -> float:
    """A unit of time by `time_unit`; raises CaseError for a text that is none."""
    if (found := time_unit(name)) is None:
        raise CaseError([f"--time-unit: is {name}, must be s, ms, µs (us) or ns"])
    return found


def required_value_unit(name: str) -> Unit:
    """A unit of values by `value_unit`; raises CaseError for a text that is none."""
    if (found := value_unit(name)) is None:
        known = "Pa, kPa, MPa, GPa, V, mV, µV (uV), strain, % (of strain) or µε (ue)"
        raise CaseError([f"--unit: is {name}, must be {known}"])
    return found


@dataclass(frozen=True)
class Bridge:
    """Strain gauges in a Wheatstone bridge.

    gauge_factor : k, relative change of resistance per strain. wiring : *quarter*, one gauge along the bar; *half*, two
    along the bar at opposite places of its circumference, in opposite arms, so that bending cancels; *full*, as *half*
    with two gauges across the bar in the other arms. excitation : V. gain : of the amplifier. poisson : ν of the bar,
    for the gauges across it.

    Raises CaseError for impossible values, and for a full bridge without ν.
    """

    gauge_factor: float
    wiring: Wiring = "quarter"
    excitation: float | None = None
    gain: float = 1.0
    poisson: float | None = None

    def __post_init__(self) -> None:
        if problems := list(self._problems()):
            raise CaseError(problems)

    def _problems(self) -> Iterator[str]:
        """Impossible data."""
        for option, value in (("--gauge-factor", self.gauge_factor), ("--gain", self.gain)):
            if not np.isfinite(value) or value == 0.0:
                yield f"{option}: is {value:g}, must be finite and not 0"
        if self.excitation is None:
            yield "--excitation: is missing, must be the voltage (V) that supplies the bridge"
        elif not np.isfinite(self.excitation) or self.excitation == 0.0:
            yield f"--excitation: is {self.excitation:g} V, must be finite and not 0"
        if self.wiring == "full" and self.poisson is None:
            yield "--poisson: is missing, a full bridge has gauges across the bar"

    def strain(self, voltage: np.ndarray) -> np.ndarray:
        """Strain (k,) from the amplified voltage (k,) V of the bridge, without linearisation.

        With v = U/(U_e gain) and resistances R(1 + kε), across the bar R(1 − kνε), the bridge gives v = kε/(4 + 2kε)
        (quarter), v = kε/(2 + kε) (half), and v = kε(1 + ν)/(2 + kε(1 − ν)) (full).

        Raises CaseError for voltages of half the excitation and more, which no strain causes.
        """
        assert self.excitation is not None
        ratio = voltage / (self.excitation * self.gain)
        if not np.abs(ratio).max(initial=0.0) < 0.25:
            most = f"is up to {percent(np.abs(ratio).max(), 3)} of the excitation"
            raise CaseError([f"--excitation: the signal {most}, which no strain gives; check --gain and units"])
        nu = self.poisson or 0.0
        full = 2.0 / (1.0 + nu), (1.0 - nu) / (1.0 + nu)
        factor, bend = {"quarter": (4.0, 2.0), "half": (2.0, 1.0), "full": full}[self.wiring]
        return factor * ratio / (self.gauge_factor * (1.0 - bend * ratio))
