"""A split Hopkinson test: pulses cut from the signals of both bars; stress, strain and rate of the specimen.

The incident pulse passes its gauge, d_i before the specimen, at t_0, the reflected one 2d_i/c later; the transmitted
one passes its gauge, d_t behind the specimen, (d_i + d_t)/c after t_0. Each is cut over the same time, which is over
when the reflected one begins, and moved to the faces of the specimen. With the strains e_i, e_r and e_t there, in the
sense of the load, and c, E, A of the bars and L_s, A_s of the specimen, the faces move and are loaded by (Kolsky 1949)

    v_1 = c(e_i − e_r),  v_2 = c e_t,      F_1 = EA(e_i + e_r),  F_2 = EA e_t .

One wave gives the stress F_2/A_s and the rate −2c e_r/L_s, two the stress F_1/A_s, three (F_1 + F_2)/2A_s and
(v_1 − v_2)/L_s. They agree where the specimen is in equilibrium, F_1 = F_2; only there they are the law of the
material.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from dembound.errors import CaseError
from dembound.files import replacing
from dembound.gauge.baseline import Treatment, treated
from dembound.gauge.estimates import FEWEST
from dembound.gauge.gauge_io import implausible_size, is_record, not_above_zero, require_for_results, unfit_signal
from dembound.gauge.peaks import CREST, denoised, longest, noise_left, smooth, white_noise, width_of
from dembound.gauge.reading.signal import Reading, Signal, read_signal
from dembound.results.reader import history_of, open_record
from dembound.words import percent

ONSET = 0.02
"""Share of its largest value at which the incident pulse begins; at least five standard deviations of noise."""

MARGIN = 0.1
"""Time before this onset that still belongs to the pulse, over the pulse's width at half its height."""

ENDED = 0.05
"""Share of its largest value below which the incident pulse has ended when the reflected one begins."""

RISEN = 0.2
"""Share of the largest value at which the sign of the incident pulse, the first wave at its gauge, is taken."""

LARGEST_STRAIN = 0.05
"""Strain that no bar reaches in a test: steel bars yield at 1 %."""

EQUILIBRIUM = 0.05
"""Largest |F_1 − F_2| over their mean in equilibrium."""

LOADED = 0.1
"""Least force, over the largest one, at which equilibrium is checked."""

Window = tuple[float, float]
"""First and last time of a pulse at its gauge, s."""

COLUMNS = {
    "time (s)": "time",
    "stress 3 waves (Pa)": "stress",
    "stress 2 waves (Pa)": "front",
    "stress 1 wave (Pa)": "back",
    "strain 3 waves": "strain",
    "strain 1 wave": "one_wave_strain",
    "strain rate 3 waves (1/s)": "rate",
    "strain rate 1 wave (1/s)": "one_wave_rate",
    "front over back force": "ratio",
    "in equilibrium": "in_equilibrium",
}
"""Columns of a table -> attributes of `Specimen`."""


def circle_area(diameter: float) -> float:
    """Area of a circle, m², from its diameter, m."""
    return 0.25 * math.pi * diameter**2


@dataclass(frozen=True)
class Setup:
    """Two equal round bars, their gauges and the specimen.

    speed : c, m/s; density : kg/m³; diameter : of the bars, m; incident_gauge, transmitted_gauge : distances d_i and
    d_t of the gauges from the specimen, m; specimen_length : m; specimen_area : m²; attenuation : of the bars, 1/m;
    given_modulus : E, Pa, None for ρc²; bar_length : of each bar, m, if the pulses are to be cut before reflections
    from the bars' ends.

    Raises CaseError for values that are not positive or of unlikely sizes.
    """

    speed: float
    density: float
    diameter: float
    incident_gauge: float
    transmitted_gauge: float
    specimen_length: float
    specimen_area: float
    attenuation: float = 0.0
    given_modulus: float | None = None
    bar_length: float | None = None

    def __post_init__(self) -> None:
        if problems := list(self._problems()):
            raise CaseError(problems)

    def _problems(self) -> Iterator[str]:
        """Values that are not positive or of unlikely sizes."""
        yield from implausible_size("--wave-speed", self.speed, "wave speed", "m/s")
        yield from implausible_size("--density", self.density, "density", "kg/m³")
        yield from implausible_size("--youngs-modulus", self.given_modulus, "modulus", "Pa")
        yield from implausible_size("--bar-diameter", self.diameter, "thickness", "m")
        yield from not_above_zero("--specimen-area", self.specimen_area, "m²")
        yield from implausible_size("--specimen-length", self.specimen_length, "thickness", "m")
        if not 0.0 <= self.attenuation < np.inf:
            yield f"--attenuation: is {self.attenuation:g} 1/m, must be finite and not below 0"
        for name in ("incident_gauge", "transmitted_gauge"):
            option, value = f"--{name.replace('_', '-')}", getattr(self, name)
            yield from not_above_zero(option, value, "m")
            if self.bar_length is not None and not value < self.bar_length:
                yield f"{option}: is {value:g} m, must be below the length of the bar, {self.bar_length:g} m"
        if self.specimen_area > circle_area(self.diameter) * (1.0 + 1e-6):
            yield "--specimen-diameter: must be at most that of the bars; lengths are in m"

    @property
    def modulus(self) -> float:
        """E of the bars, Pa."""
        return self.density * self.speed**2 if self.given_modulus is None else self.given_modulus


class Signals(NamedTuple):
    """Strains at the gauges of both bars at the same even times (k,) s, loads positive."""

    time: np.ndarray
    incident: np.ndarray
    transmitted: np.ndarray


class Faces(NamedTuple):
    """Strains (n,) of the pulses at the faces of the specimen, loads positive; time : s from when the pulse arrives."""

    time: np.ndarray
    incident: np.ndarray
    reflected: np.ndarray
    transmitted: np.ndarray


class Windows(NamedTuple):
    """Windows of the pulses at their gauges, s; None: computed."""

    incident: Window | None = None
    reflected: Window | None = None
    transmitted: Window | None = None


@dataclass(frozen=True)
class Specimen:
    """Stresses, strains and rates of a specimen.

    time : (n,) s from when the pulse has reached it; front, back : stresses F_1/A_s and F_2/A_s (n,) Pa; rate : (n,)
    1/s by three waves, one_wave_rate by the reflected one; strain, one_wave_strain : their integrals (n,); ratio :
    F_1/F_2 (n,), smoothed, nan below a tenth of the largest force; equilibrium : (first, behind last) sample of the
    longest time in equilibrium, None without any; slope : of stress over strain in equilibrium until the
    `largest` stress there, a single sample, Pa, nan where it cannot be fitted.
    """

    time: np.ndarray
    front: np.ndarray
    back: np.ndarray
    rate: np.ndarray
    one_wave_rate: np.ndarray
    strain: np.ndarray
    one_wave_strain: np.ndarray
    ratio: np.ndarray
    equilibrium: tuple[int, int] | None
    largest: int
    slope: float

    @property
    def stress(self) -> np.ndarray:
        """Stress (n,) Pa by three waves."""
        return 0.5 * (self.front + self.back)

    @property
    def in_equilibrium(self) -> np.ndarray:
        """Whether each sample (n,) is within the longest time in equilibrium."""
        first, end = self.equilibrium or (0, 0)
        samples = np.arange(len(self.time))
        return (samples >= first) & (samples < end)

    def write(self, path: Path) -> None:
        """Write a table (CSV) with one line per sample; the last column is 1 in equilibrium."""
        columns = np.column_stack([getattr(self, name) for name in COLUMNS.values()])
        with replacing(path) as file:
            np.savetxt(file, columns, delimiter=",", header=",".join(COLUMNS), comments="", fmt="%.9g")


def read_strain(
    path: Path, reading: Reading, treatment: Treatment | None, modulus: float, *, may_be_clipped: bool = False
) -> Signal:
    """A gauge's strain from a text file, by default without its baseline, or from a monitor in the record of a run.

    Parameters
    ----------
    path : the file. reading : how it is read; its column is the monitor of a record. treatment : what is removed.
    modulus : E of the bar, Pa, to convert stresses to strains. may_be_clipped : accept a signal with a plateau.

    Raises CaseError for a file that cannot be read, signals that are neither strains nor stresses, and unfit ones.
    """
    recorded = is_record(path)
    signal = _recorded(path, reading) if recorded else read_signal(path, reading, usual="strain")
    if signal.unit not in ("strain", "Pa"):
        said = f"are in {signal.unit}" if signal.unit else "have no known unit in the header"
        raise CaseError([f"{path}: the values {said}, needs strains or stresses: --gauge-factor, --unit or --scale"])
    if not recorded:
        if problems := list(unfit_signal(signal.values, may_be_clipped=may_be_clipped)):
            raise CaseError([f"{path}: {problem}" for problem in problems])
        signal = treated(signal, treatment)
    elif treatment is not None:
        signal = treated(signal, replace(treatment, baseline=False))
    values = signal.values if signal.unit == "strain" else signal.values / modulus
    if not recorded and not (largest := float(np.abs(values).max())) < LARGEST_STRAIN:
        said = f"the largest strain is {percent(largest, 3)}, of a bar below {100.0 * LARGEST_STRAIN:g} %"
        raise CaseError([f"{path}: {said}: check --unit, --gain, --gauge-factor or --scale"])
    return Signal(signal.time, values, "strain", signal.notes)


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


def combined(incident: Signal, transmitted: Signal, *, opposite: bool = False) -> Signals:
    """The signals at the times of the first within both, with the sign by which the incident pulse is positive.

    opposite : whether the transmission bar's gauge has the other sign.

    Raises CaseError for records that do not overlap, and a transmitted pulse of the other sign.
    """
    within = (incident.time >= transmitted.time[0]) & (incident.time <= transmitted.time[-1])
    if within.sum() < 10:
        raise CaseError(["TRANSMITTED: has no times in common with the incident signal"])
    time, values = incident.time[within], incident.values[within]
    sign = float(np.sign(values[np.argmax(np.abs(values) > RISEN * np.abs(values).max())]))
    behind = (-sign if opposite else sign) * np.interp(time, transmitted.time, transmitted.values)
    if not behind.max() > -behind.min():
        said = "its sign is opposite to that of the incident pulse"
        raise CaseError([f"TRANSMITTED: {said}; if it is wired so, --opposite"])
    return Signals(time, sign * values, behind)


def at_faces(signals: Signals, setup: Setup, windows: Windows | None = None) -> Faces:
    """The pulses at the faces of the specimen.

    windows : times given for some of them; others follow from the first and from travel times.

    Raises CaseError for a signal without a load, a pulse that is not over when its reflection arrives, and windows
    outside the record.
    """
    time, step = signals.time, float(signals.time[-1] - signals.time[0]) / (len(signals.time) - 1)
    windows = windows or Windows()
    near, far = setup.incident_gauge, setup.transmitted_gauge
    begin = windows.incident[0] if windows.incident else _onset(time, signals.incident)
    starts = [
        begin + way / setup.speed if window is None else window[0]
        for way, window in zip((0.0, 2.0 * near, near + far), windows, strict=True)
    ]
    free = np.inf if setup.bar_length is None else setup.bar_length - max(near, far)  # of reflections of the bars' ends
    length = min(2.0 * min(near, free) / setup.speed, time[-1] - max(starts))
    length = min([length, *(window[1] - window[0] for window in windows if window is not None)])
    if not (min(starts) >= time[0] and length > FEWEST * step):
        begins = ", ".join(f"{start:.6g}" for start in starts)
        said = f"incident, reflected and transmitted pulse begin at {begins} s at their gauges"
        raise CaseError([f"--incident-window: {said}, the record is from {time[0]:.6g} to {time[-1]:.6g} s"])
    left = float(np.interp(starts[0] + length, time, signals.incident)) / float(np.abs(signals.incident).max())
    if abs(left) > ENDED:
        said = f"the incident pulse has not ended at {starts[0] + length:.6g} s, when its reflection is back"
        raise CaseError([f"--incident-window: {said}, or the window or the record ends ({percent(left)} of its crest)"])
    since = step * np.arange(int(length / step))
    pulses = zip((signals.incident, signals.incident, signals.transmitted), starts, (near, -near, -far), strict=True)
    moved = [math.exp(-setup.attenuation * way) * np.interp(at + since, time, values) for values, at, way in pulses]
    return Faces(since, moved[0], moved[1], moved[2])


def _onset(time: np.ndarray, values: np.ndarray) -> float:
    """Time at which a load begins, s."""
    width = max(2, width_of(values))
    reach = max(1, round(0.5 * CREST * width))
    smoothed = smooth(values, reach)
    least = max(ONSET * float(smoothed.max()), 5.0 * white_noise(values) * noise_left(reach))
    if not smoothed.max() > least:
        raise CaseError(["--incident-window: is needed, the incident gauge shows no load above its noise"])
    before = np.flatnonzero(smoothed[: int(smoothed.argmax()) + 1] < least)
    first = int(before[-1]) if len(before) else 0
    return float(time[max(0, first - round(MARGIN * width))])


def specimen(faces: Faces, setup: Setup, tolerance: float = EQUILIBRIUM) -> Specimen:
    """Stresses and strains of the specimen from the waves at its faces.

    tolerance : largest difference of the forces over their mean in equilibrium.
    """
    speed, scale = setup.speed, setup.modulus * circle_area(setup.diameter) / setup.specimen_area
    front, back = scale * (faces.incident + faces.reflected), scale * faces.transmitted
    rate = speed / setup.specimen_length * (faces.incident - faces.reflected - faces.transmitted)
    one_wave_rate = -2.0 * speed / setup.specimen_length * faces.reflected
    strain, one_wave_strain = (
        np.concatenate([[0.0], np.cumsum(0.5 * (each[1:] + each[:-1]) * np.diff(faces.time))])
        for each in (rate, one_wave_rate)
    )
    first_force, second_force = denoised(front), denoised(back)
    least = LOADED * max(float(first_force.max()), float(second_force.max()))
    loaded = (first_force > least) & (second_force > least)
    ratio = np.divide(first_force, second_force, out=np.full(len(front), np.nan), where=loaded)
    # |F_1 − F_2| ≤ tolerance · (F_1 + F_2)/2 in terms of R = F_1/F_2
    equilibrium = longest(np.abs(ratio - 1.0) <= 0.5 * tolerance * (ratio + 1.0))
    first, end = equilibrium or (0, len(rate))
    stress = 0.5 * (front + back)
    largest = first + int(np.argmax(denoised(stress)[first:end]))
    there, slope = slice(first, largest + 1), np.nan
    if equilibrium is not None and largest + 1 - first >= FEWEST and np.ptp(strain[there]) > 0.0:
        slope = float(np.polyfit(strain[there], stress[there], 1)[0])
    strains = strain, one_wave_strain
    return Specimen(faces.time, front, back, rate, one_wave_rate, *strains, ratio, equilibrium, largest, slope)
