"""A measured signal: its columns read from a text file, at even times, in known units."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dembound.errors import CaseError
from dembound.gauge.estimates import FEWEST
from dembound.gauge.reading.scope import Columns, read_columns
from dembound.gauge.reading.units import (
    AS_THEY_ARE,
    Bridge,
    Unit,
    required_time_unit,
    required_value_unit,
    time_unit,
    value_unit,
)

EVEN = 1e-6
"""Largest deviation of times from even ones, in steps, for times that are used as given."""

ROUNDED, COARSE = 1e-2, 0.75
"""Deviations of times from even ones, in steps, that are always taken for rounding, as of single precision, and that
the last digit may explain: with few digits two times may be equal."""

DIGITS = 9
"""Digits behind the point, of times in s, up to which they are looked at."""

REGULAR = 0.8
"""Share of equal steps from which on the others are no uneven sampling: lines are missing, or there twice."""

LARGEST_GAP = 3.0
"""Largest step over the median step of times that are resampled."""


@dataclass(frozen=True)
class Reading:
    """How a text file is read: its columns by name or number, and units where the header lacks them or is wrong."""

    column: str | None = None
    time_column: str | None = None
    time_unit: str | None = None
    unit: str | None = None
    bridge: Bridge | None = None
    scale: float = 1.0


@dataclass(frozen=True)
class Signal:
    """A signal at even times.

    time : (k,) s; values : (k,) in `unit` (Pa, V, strain, m/s; empty if unknown); notes : on conversions.
    """

    time: np.ndarray
    values: np.ndarray
    unit: str
    notes: tuple[str, ...] = ()


def read_signal(path: Path, reading: Reading | None = None, usual: str = "Pa") -> Signal:
    """Read a column of a text file with its times.

    Parameters
    ----------
    path : the file, see `scope.read_columns`. reading : how to read it. usual : the unit of values in a file without
    names.

    With a bridge, voltages become strains. A scale other than ±1 makes the values Pa. Times are those of the file if
    they are even. If they are rounded they are replaced by even ones, and else the signal is resampled at the median
    step, by straight lines.

    Raises CaseError for a file that cannot be read, missing columns, unknown units, values that are not finite, times
    that do not increase or have gaps, and fewer than three samples.
    """
    reading = reading or Reading()
    if not np.isfinite(reading.scale) or reading.scale == 0.0:
        raise CaseError([f"--scale: is {reading.scale:g}, must be finite and not 0"])
    columns = read_columns(path)
    at, of = _chosen(columns, reading)
    seconds = required_time_unit(reading.time_unit) if reading.time_unit else _unit_of_time(columns, at)
    unit = required_value_unit(reading.unit) if reading.unit else _unit_of_values(columns, of, usual)
    time = seconds * np.array(columns.values(at))
    values = unit.size * np.array(columns.values(of))
    _require_sound(columns, time, values)
    time, values, even = evenly(path, time, values)
    values, measured, notes = _converted(values, unit, reading)
    name = f"column {of + 1}" + (f", {columns.names[of]}" if columns.names[of] else "")
    step = float(time[-1] - time[0]) / (len(time) - 1)
    every = f"{1e6 * step:.4g} µs" if step < 1e-3 else f"{step:.4g} s"
    read = f"{name}{f' ({unit.name})' if unit.name else ''}: {len(time)} samples, one every {every}"
    return Signal(time, values, measured, (read, *even, *notes))


def _chosen(columns: Columns, reading: Reading) -> tuple[int, int]:
    """Indices of the columns of times and of values; the first, and the other one of two, by default."""
    at = 0 if reading.time_column is None else columns.find("--time-column", reading.time_column)
    if reading.column is not None:
        return at, columns.find("--column", reading.column)
    others = [index for index in range(len(columns.places)) if index != at]
    if len(others) > 1:
        known = [name for name in (columns.names[index] for index in others) if name]
        allowed = ", ".join(known) if known else f"a number from 1 to {len(columns.places)}"
        has = f"{columns.path} has {len(columns.places)} columns"
        raise CaseError([f"--column: is missing, {has}; must be {allowed}"])
    return at, others[0]


def _unit_of_time(columns: Columns, column: int) -> float:
    """Size in s of the unit of times in the header, which must be known; 1 by default."""
    found = next((size for size in map(time_unit, columns.units(column)) if size is not None), None)
    if found is None and (text := columns.bracketed(column)):
        raise CaseError([f"{columns.path}: the header has times in {text}, must be s, ms, µs or ns; or --time-unit"])
    return found or 1.0


def _unit_of_values(columns: Columns, column: int, usual: str) -> Unit:
    """The unit of values in the header; the usual one in a file without names, or by a name that says the quantity."""
    for unit in map(value_unit, columns.units(column)):
        if unit is not None:
            return unit
    name = columns.names[column].lower()
    if text := columns.bracketed(column):
        if usual == "m/s":
            raise CaseError([f"{columns.path}: the header has values in {text}, must be m/s, cm/s, mm/s or km/s"])
        return AS_THEY_ARE
    assumed = not any(columns.names) or (usual == "Pa" and "stress" in name) or (usual == "m/s" and "velocity" in name)
    return Unit(usual, usual, 1.0) if assumed else AS_THEY_ARE


def _require_sound(columns: Columns, time: np.ndarray, values: np.ndarray) -> None:
    """Raise CaseError for too few samples, values that are not finite, constant values, and times that go back."""
    if len(time) < FEWEST:
        raise CaseError([f"{columns.path}: contains {len(time)} samples, must contain three or more"])
    for what, numbers in (("time", time), ("value", values)):
        if not np.isfinite(numbers).all():
            line = columns.numbers[int(np.argmin(np.isfinite(numbers)))]
            said = "an overdriven channel?" if what == "value" else "must be a number"
            raise CaseError([f"{columns.path}: the {what} of line {line} is not finite: {said}"])
    if (np.diff(time) < 0.0).any() or time[0] == time[-1]:
        line = columns.numbers[int(np.argmax(np.diff(time) <= 0.0)) + 1]
        where = f"that of line {line} does not follow the one before"
        raise CaseError([f"{columns.path}: must have increasing times; {where}"])
    if np.ptp(values) == 0.0:
        raise CaseError([f"{columns.path}: has no signal, all values are {values[0]:g}"])


def evenly(path: Path, time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Times and values (k,) at even times, and notes on changes.

    Parameters
    ----------
    path : the file, for errors. time, values : (k,), finite, the times not decreasing and not all equal.

    Raises CaseError for equal times that rounding does not explain, and for gaps.
    """
    even = np.linspace(time[0], time[-1], len(time))
    step, steps = float(even[1] - even[0]), np.diff(time)
    off = float(np.abs(time - even).max()) / step
    if off < EVEN:
        return time, values, []
    unit = _last_digit(time)
    irregular = np.flatnonzero(np.abs(steps - np.median(steps)) > max(0.5 * unit, ROUNDED * step))
    are_few = len(irregular) <= (1.0 - REGULAR) * len(steps)
    if not are_few and (steps == 0.0).any():  # times as of a slower clock
        unit = max(unit, float(steps[steps > 0.0].min()))
    is_rounded = len(irregular) > 2 and off * step <= min(unit, COARSE * step) and np.abs(steps - step).max() < unit
    if is_rounded or off < ROUNDED:
        return even, values, [f"times: rounded by up to {off:.2g} steps, replaced by even ones"]
    if are_few:
        at = int(irregular[0])
        said = f"{time[at + 1]:.6g} s is behind {time[at]:.6g} s, most steps are {np.median(steps):.4g} s"
        raise CaseError([f"{path}: must have even times: {said}; is a line missing, or there twice?"])
    if not (steps > 0.0).all():
        raise CaseError([f"{path}: must have increasing times, two are {time[int(steps.argmin())]:.6g} s"])
    step = float(np.median(steps))
    worst = int(steps.argmax())
    if not steps[worst] <= LARGEST_GAP * step:
        said = f"there is a gap of {steps[worst]:.4g} s at {time[worst]:.6g} s, others are {step:.4g} s"
        raise CaseError([f"{path}: must have even times, {said}; keep the lines before or behind it alone"])
    even = time[0] + step * np.arange(int((time[-1] - time[0]) / step) + 1)
    return even, np.interp(even, time, values), [f"times: uneven, resampled every {step:.4g} s by straight lines"]


def _last_digit(time: np.ndarray) -> float:
    """What one unit of the last digit of rounded times (k,) is, s: errors of rounding are half of it at most."""
    for unit in 10.0 ** -np.arange(DIGITS):
        if (np.abs(time / unit - np.round(time / unit)) <= 1e-6 * np.maximum(1.0, np.abs(time / unit))).all():
            return float(unit)
    return 0.0


def _converted(values: np.ndarray, unit: Unit, reading: Reading) -> tuple[np.ndarray, str, list[str]]:
    """Values in Pa, strain or their own unit, the new unit, and notes on conversions."""
    measured, notes = unit.of, []
    if reading.bridge is not None:
        if unit.of not in ("V", ""):
            raise CaseError([f"--gauge-factor: is for voltages, the values are in {unit.name}; if in volts: --unit V"])
        values, measured = reading.bridge.strain(values), "strain"
        notes.append(f"strain: {reading.bridge.wiring} bridge, gauge factor {reading.bridge.gauge_factor:g}")
    if abs(reading.scale) != 1.0:
        notes.append(f"stress: 1 {measured or 'unit'} is {reading.scale:g} Pa")
        measured = "Pa"
    return reading.scale * values, measured, notes
