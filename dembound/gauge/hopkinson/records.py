"""Signals of a split Hopkinson test: read from text files or records, as strains that are positive under the load."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from dembound.errors import CaseError
from dembound.gauge.hopkinson.pulses import Setup, Signals, Windows, starts_of
from dembound.gauge.noise import undithered
from dembound.gauge.plausibility import LARGEST_STRAIN, implausible_signal
from dembound.gauge.reading.recorded import is_record, require_for_results
from dembound.gauge.reading.signal import Reading, Signal, read_signal
from dembound.gauge.treatment import Treatment, treated
from dembound.results.reader import history_of, open_record
from dembound.words import percent

RISEN = 0.2
"""Share of the largest value at which the sign of the incident pulse, the first wave at its gauge, is taken."""


def read_strain(
    path: Path, reading: Reading, treatment: Treatment | None, modulus: float, *, may_be_clipped: bool = False
) -> Signal:
    """A gauge's strain from a text file, by default without its baseline, or from a monitor in the record of a run.

    Parameters
    ----------
    path : the file. reading : how it is read; its column is the monitor of a record. treatment : what is removed.
    modulus : E of the bar, Pa, to convert stresses to strains. may_be_clipped : accept a signal with a plateau.

    Raises CaseError for a file that cannot be read, signals that are neither strains nor stresses, and clipped ones.
    """
    recorded = is_record(path)
    signal = _recorded(path, reading) if recorded else read_signal(path, reading, usual="strain")
    if signal.unit not in ("strain", "Pa"):
        said = (
            f"are in {signal.unit}"
            if signal.unit
            else "have no unit in the header that is read (Pa, MPa, V, mV, strain, %, µε)"
        )
        raise CaseError([f"{path}: the values {said}, needs strains or stresses: --gauge-factor, --unit or --scale"])
    if not recorded and (problems := list(implausible_signal(signal.values, may_be_clipped=may_be_clipped))):
        raise CaseError([f"{path}: {problem}" for problem in problems])
    if not recorded:
        signal, _ = treated(signal, treatment)
        scale = 1.0 if signal.unit == "strain" else modulus
        if not (largest := float(np.abs(signal.values).max()) / scale) < LARGEST_STRAIN:
            said = f"the largest strain is {percent(largest, 3)}, of a bar below {100.0 * LARGEST_STRAIN:g} %"
            raise CaseError([f"{path}: {said}: check --unit, --gain, --gauge-factor or --scale"])
    elif treatment is not None:
        signal, _ = treated(signal, replace(treatment, baseline=False))
    values = signal.values if signal.unit == "strain" else signal.values / modulus
    return Signal(signal.time, values, "strain", signal.notes)


def combined(incident: Signal, transmitted: Signal, second: Signal | None = None, *, opposite: bool = False) -> Signals:
    """The signals at the times of the first within all, with the sign by which the incident pulse is positive.

    opposite : whether the transmission bar's gauge has the other sign.

    Raises CaseError for records that do not overlap, and a transmitted pulse of the other sign.
    """
    others = [each for each in (transmitted, second) if each is not None]
    first, last = (max(each.time[0] for each in others), min(each.time[-1] for each in others))
    within = (incident.time >= first) & (incident.time <= last)
    if within.sum() < 10:
        raise CaseError(["TRANSMITTED: has no times in common with the incident signal"])
    time, values = incident.time[within], incident.values[within]
    sign = _sign(values)
    behind = (-sign if opposite else sign) * np.interp(time, transmitted.time, transmitted.values)
    if not behind.max() > -behind.min():
        raise CaseError(
            ["TRANSMITTED: its sign is opposite to that of the incident pulse; if it is wired so, --opposite"]
        )
    extra = None if second is None else sign * np.interp(time, second.time, second.values)
    digits = (undithered(incident.values)[1], undithered(transmitted.values)[1])
    return Signals(time, sign * values, behind, extra, digits)


def require_pulses(incident: Signal, setup: Setup, windows: Windows) -> None:
    """Raise CaseError for an incident signal that ends before all pulses have begun; windows : as `found_windows`."""
    starts_of(incident.time, _sign(incident.values) * incident.values, setup, windows)


def _sign(values: np.ndarray) -> float:
    """The sign of the first wave in a signal (k,)."""
    return float(np.sign(values[np.argmax(np.abs(values) > RISEN * np.abs(values).max())]))


def _recorded(path: Path, reading: Reading) -> Signal:
    """The stress at a monitor of a record."""
    require_for_results(path, reading)
    with open_record(path) as file:
        monitors = {name: group for name, group in file.get("histories", {}).items() if "stress" in group}
        if reading.column not in monitors:
            said = "is missing" if reading.column is None else f"is {reading.column}"
            raise CaseError([f"--column: {said}, must be one of {', '.join(monitors)} in {path}"])
        time, stress = history_of(monitors[reading.column], "stress")
    return Signal(time, stress, "Pa", (f"{reading.column}: {len(time)} samples of a run",))
