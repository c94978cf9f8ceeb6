"""A spalling test on a bar: reading what its gauge has felt, and all that this tells (L section 3.3)."""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

from dembound.errors import CaseError
from dembound.gauges import (
    Estimate,
    attenuated_strength,
    attenuation,
    incident_pulse,
    nominal_strength,
    pull_back_strength,
    tension_peaks,
    wave_speed,
    way_by_the_end,
)
from dembound.peaks import Peaks
from dembound.results import open_record
from dembound.waves.record import read_samples


@dataclass(frozen=True)
class Gauge:
    """A gauge on a bar, and what it has felt.

    time, stress : (k,) s and Pa, tension positive; position : from the loaded end, m; length : the bar's, m;
    density : kg/m³, None where it is not known.
    """

    time: np.ndarray
    stress: np.ndarray
    position: float
    length: float
    density: float | None


class Known(NamedTuple):
    """What a record knows of a gauge: its position and the bar's length, m, and density, kg/m³; None is unknown."""

    position: float | None = None
    length: float | None = None
    density: float | None = None


@dataclass(frozen=True)
class Spall:
    """Where a bar has spalled, and its strength there.

    position : from the loaded end, m; nominal : largest tension there without attenuation, Pa, reached at `time`, s;
    way : from the gauge by the free end to there, m; attenuated : what the way leaves of it, Pa, None without a
    coefficient; pulse : times (p,) s and stresses (p,) Pa of the incident pulse alone.
    """

    position: float
    nominal: float
    time: float
    way: float
    attenuated: float | None
    pulse: tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Findings:
    """What a gauge tells: tension peaks, wave speed in m/s, attenuation in 1/m, strengths in Pa; None is unknown."""

    peaks: Peaks
    speed: Estimate
    attenuation: Estimate | None
    spall: Spall | None
    pull_back: float | None


def read_gauge(
    path: Path,
    monitor: str | None = None,
    position: float | None = None,
    length: float | None = None,
    density: float | None = None,
    scale: float = 1.0,
) -> Gauge:
    """Read a gauge from a text file of two columns, or a monitor's from the record of a run.

    Parameters
    ----------
    path : the file.
    monitor : its name in the record; may be left out where only one has felt stresses.
    position, length, density : as of `Gauge`; by default what the record says.
    scale : factor of the values.

    Raises CaseError for a file that cannot be read, an unknown monitor, and a gauge that is not on the bar.
    """
    if h5py.is_hdf5(path):
        time, stress, known = _recorded(path, monitor)
    else:
        (time, stress), known = _samples(path, "stress (Pa)"), Known()
    place, long, dense = (
        recorded if given is None else given for given, recorded in zip((position, length, density), known, strict=True)
    )
    if len(time) < 3:
        raise CaseError([f"{path}: holds {len(time)} samples, must hold three or more"])
    if place is None or long is None:
        missing = {"position": place, "length": long}
        raise CaseError([f"{name}: is not known, give it" for name, value in missing.items() if value is None])
    if not 0.0 < place < long:
        raise CaseError([f"position: is {place:g} m, must be between 0 and the length, {long:g} m"])
    if dense is not None and not dense > 0.0:
        raise CaseError([f"density: is {dense:g} kg/m³, must be above 0"])
    return Gauge(time, scale * stress, place, long, dense)


def read_free_end(path: Path, free_end: str) -> np.ndarray:
    """Velocity (k,) in m/s, positive outwards, of a monitor in a record; else from a text file of that name.

    Raises CaseError for an unknown monitor and a file that cannot be read.
    """
    if not h5py.is_hdf5(path):
        return _samples(Path(free_end), "velocity (m/s)")[1]
    with open_record(path) as file:
        return _monitor(file.get("histories", {}), free_end)["velocity"][:, 0]


def evaluate(
    gauge: Gauge,
    *,
    spall: float | None = None,
    free_end: np.ndarray | None = None,
    count: int | None = None,
    pulse_end: float | None = None,
    speed: float | None = None,
    coefficient: float | None = None,
) -> Findings:
    """All that a gauge tells with what is given beside it.

    Parameters
    ----------
    gauge : what it has felt.
    spall : where the bar has spalled, from the loaded end, m.
    free_end : (q,) velocity of the free end, m/s, positive outwards.
    count : use the first tension peaks only; all by default.
    pulse_end : time at which the incident pulse is over at the gauge, s; by default when its front comes back.
    speed, coefficient : wave speed in m/s and attenuation in 1/m of another test; by default this one's.

    Raises CaseError when what is given is not enough.
    """
    if speed is not None and not speed > 0.0:
        raise CaseError([f"wave_speed: is {speed:g} m/s, must be above 0"])
    peaks = tension_peaks(gauge.time, gauge.stress, count)
    found = Estimate(speed) if speed is not None else wave_speed(peaks.time, gauge.length, peaks.height)
    decay = None
    if coefficient is not None:
        decay = Estimate(coefficient)
    elif len(peaks.time) > 1:
        decay = attenuation(peaks.time, peaks.height, found.value)
    strength = None if spall is None else _spall(gauge, found.value, decay, spall, pulse_end)
    pull_back = None
    if free_end is not None:
        if gauge.density is None:
            raise CaseError(["density: is not known, give it"])
        pull_back = pull_back_strength(free_end, gauge.density, found.value)
    return Findings(peaks, found, decay, strength, pull_back)


def _spall(gauge: Gauge, speed: float, decay: Estimate | None, position: float, pulse_end: float | None) -> Spall:
    """Strengths at a position, m."""
    if not 0.0 < position < gauge.length:
        raise CaseError([f"spall: is {position:g} m, must be between 0 and the length, {gauge.length:g} m"])
    bar = gauge.position, gauge.length, speed
    pulse = incident_pulse(gauge.time, gauge.stress, *bar, pulse_end)
    nominal, time = nominal_strength(*pulse, *bar, position)
    way = way_by_the_end(gauge.position, gauge.length, position)
    attenuated = None if decay is None else attenuated_strength(nominal, decay.value, way)
    return Spall(position, nominal, time, way, attenuated, pulse)


def _recorded(path: Path, name: str | None) -> tuple[np.ndarray, np.ndarray, Known]:
    """Time, stress and what else is known of a monitor in a record."""
    with open_record(path) as file:
        felt = {name: group for name, group in file.get("histories", {}).items() if "stress" in group}
        if not felt:
            raise CaseError([f"{path}: holds no history of stress, which monitors on bars have"])
        if name is None and len(felt) > 1:
            raise CaseError([f"monitor: is not named, must be one of {', '.join(felt)}"])
        group = _monitor(felt, name or next(iter(felt)))
        density = file.attrs.get("density")
        known = Known(
            position=float(np.ravel(group.attrs["position"])[0]),
            length=float(np.ravel(file.attrs["size"])[0]),
            density=None if density is None else float(density),
        )
        return group["time"][:], group["stress"][:], known


def _monitor(groups: dict[str, h5py.Group], name: str) -> h5py.Group:
    """A monitor's history by its name."""
    if name not in groups:
        raise CaseError([f"monitor: is {name}, must be one of {', '.join(groups)}"])
    return groups[name]


def _samples(path: Path, quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Times and values of a text file."""
    try:
        time, values = read_samples(path, quantity).T
    except ValueError as error:
        raise CaseError([str(error).removeprefix("path: ")]) from None
    return time, values
