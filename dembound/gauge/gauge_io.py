"""The signal of a gauge on a bar, and the velocity of its free end: read from text and from records of runs."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from dembound.errors import CaseError
from dembound.gauge.noise import Noise
from dembound.gauge.plausibility import (
    implausible_length,
    implausible_modulus,
    implausible_signal,
    implausible_size,
)
from dembound.gauge.reading.recorded import (
    BarMetadata,
    GaugeMetadata,
    bar_length,
    bar_metadata,
    is_at,
    is_record,
    loaded_end,
    recorded_gauge,
    require_for_results,
)
from dembound.gauge.reading.signal import Reading, Signal, read_signal
from dembound.gauge.treatment import Treatment, treated
from dembound.results.reader import history_of, open_record

FREE = "free"
"""The type of a free end."""

DIFFERENT = 0.01
"""Relative difference above which a given value differs from that of the results."""


@dataclass(frozen=True)
class Gauge:
    """A gauge on a bar, and its signal.

    time, stress : (k,) s and Pa, or the unit measured, tension positive; position : from the loaded end, m; length :
    the bar's, m; density : kg/m³, or None; metadata : data of the bar from a record, None for a text file; unit : Pa,
    V, strain, or empty if unknown; modulus : E in Pa of strains, None for ρc²; noise : of a measured signal; notes :
    what was done to it; recorded : (k,) the measured signal before treatment, in any unit.
    """

    time: np.ndarray
    stress: np.ndarray
    position: float
    length: float
    density: float | None
    metadata: BarMetadata | None = None
    unit: str = "Pa"
    modulus: float | None = None
    noise: Noise | None = None
    notes: tuple[str, ...] = ()
    recorded: np.ndarray | None = None

    def in_pascals(self, speed: float) -> "Gauge":
        """The gauge with stresses in Pa: strains times E, by default ρc² with c = speed, m/s.

        Raises CaseError where they cannot be computed, and for a modulus that contradicts density and speed.
        """
        if self.unit == "Pa":
            return self
        if self.unit != "strain":
            said = f"the values are in {self.unit}" if self.unit else "the file does not say what its values are"
            raise CaseError([f"--unit: {said}, strengths need stresses: give --unit, --scale or --gauge-factor"])
        modulus = self.modulus
        if modulus is None and self.density is not None:
            modulus = self.density * speed**2
        if modulus is None:
            raise CaseError(["--youngs-modulus: is missing, or --density for E = ρc², to make stresses of strains"])
        if problems := list(implausible_modulus(modulus, self.density, speed)):
            raise CaseError(problems)
        return replace(self, stress=modulus * self.stress, unit="Pa", modulus=modulus)


def read_gauge(
    path: Path,
    monitor: str | None = None,
    position: float | None = None,
    length: float | None = None,
    density: float | None = None,
    reading: Reading | None = None,
    treatment: Treatment | None = None,
    modulus: float | None = None,
    *,
    may_be_clipped: bool = False,
) -> Gauge:
    """Read a gauge from a text file, or from a monitor in the record of a run.

    Parameters
    ----------
    path : the file.
    monitor : its name in the record; may be left out if there is only one between the ends. position, length, density,
    modulus : attributes of `Gauge`; the first three by default from the record. reading : how a text file is read.
    treatment : baseline and filters to remove from its signal, by default the baseline; from a record only filters
    apply.
    may_be_clipped : accept a text file's signal with a plateau.

    Raises CaseError for a file that cannot be read, an unknown monitor, a bar that is not loaded at one end, a gauge
    that is not on the bar, and a signal that is clipped or too coarse.
    """
    reading = reading or Reading()
    if is_record(path):
        require_for_results(path, reading, column=reading.column, modulus=modulus)
        time, stress, known = recorded_gauge(path, monitor)
        signal = Signal(time, stress, "Pa")
    else:
        signal, known = read_signal(path, reading), GaugeMetadata()
        if monitor is not None:
            raise CaseError([f"--monitor: is for results of a run, {path} is a text file"])
    options = (("--position", position, "m"), ("--length", length, "m"), ("--density", density, "kg/m³"))
    replaced = tuple(
        f"{name}: {given:.5g} {unit} given, results have {there:.5g}"
        for (name, given, unit), there in zip(options, known[:3], strict=True)
        if differs(given, there)
    )
    place, long, dense = (
        recorded if given is None else given
        for given, recorded in zip((position, length, density), known[:3], strict=True)
    )
    problems = list(_problems_with_bar(place, long, dense))
    problems += not_above_zero("--youngs-modulus", modulus, "Pa")
    if not is_record(path):
        problems += implausible_length(long or 0.0)
        problems += implausible_size("--density", density, "density", "kg/m³") if not problems else []
        problems += implausible_size("--youngs-modulus", modulus, "modulus", "Pa") if not problems else []
        problems += implausible_signal(signal.values, may_be_clipped=may_be_clipped) if not problems else []
    if problems:
        raise CaseError(problems)
    assert place is not None
    assert long is not None
    noise, as_recorded = None, None
    if not is_record(path):
        as_recorded = signal.values
        signal, noise = treated(signal, treatment)
    elif treatment is not None:
        signal, _ = treated(signal, replace(treatment, baseline=False))
    known_bar = (place, long, dense, known.metadata)
    notes = (*signal.notes, *replaced)
    return Gauge(signal.time, signal.values, *known_bar, signal.unit, modulus, noise, notes, as_recorded)


def differs(given: float | None, recorded: float | None) -> bool:
    """Whether a given value differs from the one in the results."""
    return given is not None and recorded is not None and abs(given - recorded) > DIFFERENT * abs(recorded)


def read_free_end(path: Path, free_end: str) -> tuple[np.ndarray, np.ndarray]:
    """Times (k,) in s and velocities (k,) in m/s, positive outwards, of a bar's free end.

    Parameters
    ----------
    path : the gauge's file.
    free_end : a monitor in it if it is a record, which must be at the end opposite the loaded one, and this end must be
    free; else the path of a text file of two columns.

    Raises CaseError if `free_end` is neither.
    """
    if not is_record(path):
        if not Path(free_end).is_file():
            raise CaseError([f"--free-end: is {free_end}, must be a text file of time (s) and velocity (m/s)"])
        signal = read_signal(Path(free_end), usual="m/s")
        if signal.unit not in ("m/s", ""):
            raise CaseError([f"--free-end: has values in {signal.unit}, must be velocities"])
        return signal.time, signal.values
    with open_record(path) as file:
        histories = file.get("histories", {}).items()
        there = {name: group for name, group in histories if is_at(file, group, bar_length(file))}
        if free_end not in there:
            allowed = f"which is {' or '.join(there)}" if there else "but the results have none there"
            raise CaseError([f"--free-end: is {free_end}, must be a monitor at the end opposite the load, {allowed}"])
        metadata = bar_metadata(file)
        if metadata is not None and metadata.ends[1] != FREE:
            raise CaseError([f"--free-end: is {free_end}, where the bar's end is {metadata.ends[1]}, must be free"])
        outwards = 1.0 if loaded_end(file) == "left" else -1.0
        time, velocity = history_of(there[free_end], "velocity")
        return time, outwards * velocity[:, 0]


def not_above_zero(option: str, value: float | None, unit: str) -> Iterator[str]:
    """Message about an option's value, in its unit, if it is not a positive number."""
    if value is not None and not 0.0 < value < np.inf:
        yield f"{option}: is {value:g} {unit}, must be finite and above 0"


def not_on_bar(option: str, place: float, length: float) -> Iterator[str]:
    """Message about an option's position, m from the loaded end, if it is not between the ends of a bar."""
    if not 0.0 < place < length:
        yield f"{option}: is {place:g} m, must be above 0 and below the length, {length:g} m"


def _problems_with_bar(position: float | None, length: float | None, density: float | None) -> Iterator[str]:
    """Missing or impossible data of a gauge on a bar."""
    if position is None:
        yield "--position: is missing, must be the gauge's place (m) from the loaded end"
    if length is None:
        yield "--length: is missing, must be that of the bar (m)"
    unfit = list(not_above_zero("--length", length, "m"))
    yield from unfit
    if position is not None and length is not None and not unfit:
        yield from not_on_bar("--position", position, length)
    yield from not_above_zero("--density", density, "kg/m³")
