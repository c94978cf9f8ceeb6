"""The pulses of a split Hopkinson test: cut from the signals of gauges, and moved to the faces of the specimen.

The incident pulse passes its gauge, d_i before the specimen, at t_0; the reflected one 2d_i/c later; the transmitted
one passes its gauge, d_t behind the specimen, (d_i + d_t)/c later. Each is cut over the same time, which is over when
the reflected one begins: a longer pulse needs a second gauge on the incident bar.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dembound.errors import CaseError
from dembound.gauge.hopkinson.separation import LongBar, moved, separated
from dembound.gauge.peaks import CREST, noise_left, smooth, white_noise, width_of
from dembound.gauge.plausibility import implausible_modulus, implausible_size
from dembound.words import percent

ONSET = 0.02
"""Share of its largest value at which the incident pulse begins; at least five standard deviations of noise."""

MARGIN = 0.1
"""Time before this onset that still belongs to the pulse, over the pulse's width at half its height."""

FADE = 0.08
"""Time in which a pulse is faded out behind its window, over the window's length."""

ENDED = 0.05
"""Share of its largest value below which the incident pulse has ended when the reflected one begins."""

ROUNDING = 1e-6
"""Tolerance of the width of a specimen compared with the bars."""

Window = tuple[float, float]
"""First and last time of a pulse at its gauge, s."""


def circle_area(diameter: float) -> float:
    """Area of a circle, m², from its diameter, m."""
    return 0.25 * math.pi * diameter**2


@dataclass(frozen=True)
class Setup:
    """Bars, gauges and specimen of a test.

    bar : both bars; modulus : E, Pa; area : of the bars, m²; incident_gauge, transmitted_gauge : distances
    d_i and d_t of the gauges from the specimen, m; specimen_length : m; specimen_area : m²; second_gauge : distance of
    another gauge on the incident bar from the specimen, m, smaller than the first; bar_length : of each bar, m, if the
    pulses are to be cut before reflections from the bars' ends.
    """

    bar: LongBar
    modulus: float
    area: float
    incident_gauge: float
    transmitted_gauge: float
    specimen_length: float
    specimen_area: float
    second_gauge: float | None = None
    bar_length: float | None = None

    @classmethod
    def of_round_bars(
        cls,
        speed: float,
        density: float,
        diameter: float,
        incident_gauge: float,
        transmitted_gauge: float,
        specimen_length: float,
        specimen_area: float,
        *,
        attenuation: float = 0.0,
        poisson: float | None = None,
        modulus: float | None = None,
        disperse: bool = False,
        second_gauge: float | None = None,
        bar_length: float | None = None,
    ) -> "Setup":
        """The setup with two equal round bars.

        speed : of long waves, m/s; density : kg/m³; diameter : m; attenuation : α, 1/m; poisson : ν; modulus : E, Pa,
        by default ρc²; disperse : whether waves disperse as in a round bar, see `LongBar`, which needs ν; others :
        other attributes.

        Raises CaseError for lengths, areas or speeds that are not positive or have unlikely sizes, for a modulus that
        is not that of ρ and c, and for waves that disperse with ν not within 0 to 0.5.
        """
        sizes = [
            *implausible_size("--wave-speed", speed, "wave speed", "m/s"),
            *implausible_size("--density", density, "density", "kg/m³"),
        ]
        if problems := sizes or list(implausible_modulus(modulus, density, speed)):
            raise CaseError(problems)
        if disperse and (poisson is None or not 0.0 < poisson < 0.5):
            raise CaseError(["--poisson: is needed by --dispersion-correction, above 0 and below 0.5"])
        bar = LongBar(speed, attenuation, 0.5 * diameter, poisson) if disperse else LongBar(speed, attenuation)
        modulus = density * speed**2 if modulus is None else modulus
        lengths = incident_gauge, transmitted_gauge, specimen_length, specimen_area, second_gauge, bar_length
        return cls(bar, modulus, circle_area(diameter), *lengths)

    def __post_init__(self) -> None:
        if problems := list(self._problems()):
            raise CaseError(problems)

    def _problems(self) -> Iterator[str]:
        """Lengths, areas or speeds that are not positive."""
        values = {
            "--wave-speed": self.bar.speed,
            "--density": self.modulus,
            "--bar-diameter": self.area,
            "--incident-gauge": self.incident_gauge,
            "--transmitted-gauge": self.transmitted_gauge,
            "--specimen-length": self.specimen_length,
            "--specimen-diameter": self.specimen_area,
        }
        for option, value in values.items():
            if not 0.0 < value < np.inf:
                yield f"{option}: must be finite and above 0"
        for option, value in (
            ("--incident-gauge", self.incident_gauge),
            ("--transmitted-gauge", self.transmitted_gauge),
        ):
            if self.bar_length is not None and not value < self.bar_length:
                yield f"{option}: is {value:g} m, must be below the length of the bar, {self.bar_length:g} m"
            elif 50.0 < value < np.inf:
                yield f"{option}: is {value:g} m, must be at most 50 m; lengths are in m, not mm"
        if self.specimen_length > 1.0:
            yield f"--specimen-length: is {self.specimen_length:g} m, must be at most 1 m; lengths are in m, not mm"
        yield from self._too_thick()
        if self.second_gauge is not None and not 0.0 <= self.second_gauge < self.incident_gauge:
            yield "--second-gauge: must be between the first one and the specimen"

    def _too_thick(self) -> Iterator[str]:
        """A bar thicker than long, a specimen wider than the bars, and diameters of unlikely size."""
        if not (0.0 < self.area < np.inf and 0.0 < self.specimen_area < np.inf):
            return
        bar, specimen = (2.0 * math.sqrt(area / math.pi) for area in (self.area, self.specimen_area))
        farther = max(self.incident_gauge, self.transmitted_gauge)
        thick = list(implausible_size("--bar-diameter", bar, "thickness", "m"))
        if not thick and bar > farther:
            thick = [
                f"--bar-diameter: is {bar:g} m, more than a gauge is from the specimen, {farther:g} m; is it in m?"
            ]
        wide = list(implausible_size("--specimen-diameter", specimen, "thickness", "m"))
        if not wide and specimen > bar * (1.0 + ROUNDING):
            wide = [f"--specimen-diameter: is {specimen:g} m, must be at most that of the bars, {bar:g} m; is it in m?"]
        yield from (*thick, *wide)


class Signals(NamedTuple):
    """Strains at the gauges at the same even times (k,) s, loads positive; second : of the second gauge, or None.

    digits : steps of the digitisers, see `Faces`.
    """

    time: np.ndarray
    incident: np.ndarray
    transmitted: np.ndarray
    second: np.ndarray | None = None
    digits: tuple[float, float] = (0.0, 0.0)


class Faces(NamedTuple):
    """Strains (n,) of the pulses at the faces of the specimen, loads positive; time : s from when the pulse arrives.

    digits : steps of the digitisers of the incident and of the transmission bar, 0 where noise is larger.
    """

    time: np.ndarray
    incident: np.ndarray
    reflected: np.ndarray
    transmitted: np.ndarray
    digits: tuple[float, float] = (0.0, 0.0)


class Windows(NamedTuple):
    """Windows of the pulses at their gauges, s; None: computed."""

    incident: Window | None = None
    reflected: Window | None = None
    transmitted: Window | None = None


def at_faces(signals: Signals, setup: Setup, windows: Windows | None = None) -> Faces:
    """The pulses at the faces of the specimen.

    windows : times given for some of them; others follow from the first and from travel times.

    Raises CaseError for a signal without a load, a pulse that is not over when its reflection arrives and has no second
    gauge, and windows outside the record.
    """
    time, bar = signals.time, setup.bar
    cuts = found_windows(signals, setup, windows or Windows())
    if signals.second is not None and setup.second_gauge is not None:
        between = setup.incident_gauge - setup.second_gauge
        incident, reflected = separated(time, signals.incident, signals.second, between, bar)
    else:
        incident, reflected = _cut(time, signals.incident, cuts[0]), _cut(time, signals.incident, cuts[1])
    transmitted = _cut(time, signals.transmitted, cuts[2])
    begin = cuts[0][0] + setup.incident_gauge / bar.speed
    # windows that are given move their pulses to where travel times would have them
    late = (
        cuts[1][0] - begin - setup.incident_gauge / bar.speed,
        cuts[2][0] - begin - setup.transmitted_gauge / bar.speed,
    )
    length = min(last - first for first, last in cuts)
    step = float(time[-1] - time[0]) / (len(time) - 1)
    since = step * np.arange(int(length / step))
    pulses = [
        np.interp(begin + delay + since, time, moved(time, values, way, bar))
        for values, way, delay in (
            (incident, setup.incident_gauge, 0.0),
            (reflected, -setup.incident_gauge, late[0]),
            (transmitted, -setup.transmitted_gauge, late[1]),
        )
    ]
    return Faces(since, pulses[0], pulses[1], pulses[2], signals.digits)


def found_windows(signals: Signals, setup: Setup, given: Windows) -> tuple[Window, Window, Window]:
    """The windows of incident, reflected and transmitted pulse at their gauges, s; errors as of `at_faces`."""
    time, speed = signals.time, setup.bar.speed
    starts = starts_of(time, signals.incident, setup, given)
    begin = starts[0]
    length = recorded = min(time[-1] - start for start in starts)
    if signals.second is None:
        length = min(length, 2.0 * setup.incident_gauge / speed)
    if setup.bar_length is not None:
        ends = setup.bar_length - setup.incident_gauge, setup.bar_length - setup.transmitted_gauge
        length = min(length, 2.0 * min(ends) / speed)
    length = min([length, *(window[1] - window[0] for window in given if window is not None)])
    if not (min(starts) >= time[0] and length > 3.0 * (time[1] - time[0])):
        raise CaseError([f"--incident-window: {_outside(time, starts, length)}"])
    end = begin + length
    left = float(np.interp(end, time, signals.incident)) / float(np.abs(signals.incident).max())
    if signals.second is None and abs(left) > ENDED:
        raise CaseError([_broken_off(time, starts) if length == recorded else _not_ended(end, left)])
    return (begin, end), (starts[1], starts[1] + length), (starts[2], starts[2] + length)


def _not_ended(end: float, left: float) -> str:
    """Message about an incident signal with a share of its crest left at its end (s): a fault if of opposite sign."""
    there = f"at {end:.6g} s, when its reflection is back or the window ends"
    faults = "AC coupling, a baseline that jumps or drifts, lost samples, or a wrong --wave-speed"
    if left < 0.0:
        return (
            f"INCIDENT: the incident pulse has {percent(left)} of its crest {there}, the other sign: look for "
            f"{faults}; or give --incident-window"
        )
    return (
        f"--second-gauge: is needed, the incident pulse has not ended {there} ({percent(left)} of its crest); or "
        f"give --incident-window; or look for {faults}"
    )


def starts_of(time: np.ndarray, incident: np.ndarray, setup: Setup, given: Windows) -> list[float]:
    """Times (3,) s at which the pulses begin at their gauges.

    incident : (k,), loads positive. given : as of `found_windows`.

    Raises CaseError for a signal without a load, and a record that ends before a pulse begins.
    """
    begin = given.incident[0] if given.incident else _onset(time, incident)
    ways = 0.0, 2.0 * setup.incident_gauge, setup.incident_gauge + setup.transmitted_gauge
    places = zip(ways, given, strict=True)
    starts = [begin + way / setup.bar.speed if window is None else window[0] for way, window in places]
    last = time[-1] - max(3.0, 2.0 * MARGIN * width_of(incident)) * (time[1] - time[0])
    if late := [f"{name} at {at:.6g} s" for name, at in zip(PULSES, starts, strict=True) if at > last]:
        said = (
            f"the record is from {time[0]:.6g} to {time[-1]:.6g} s and ends before or as pulses begin at their gauges"
        )
        raise CaseError([f"--incident-window: {said}: the {', the '.join(late)}; record longer"])
    return starts


PULSES = "incident", "reflected", "transmitted"
"""Names of the pulses in the order of their windows."""


def _broken_off(time: np.ndarray, starts: Sequence[float]) -> str:
    """Message about a record (k,) s that ends within the last pulse; starts : (3,) s of all pulses."""
    last = max(range(len(starts)), key=lambda pulse: starts[pulse])
    return (
        f"{'TRANSMITTED' if last == 2 else 'INCIDENT'}: the record ends at {time[-1]:.6g} s, within the {PULSES[last]} "
        f"pulse, which begins at {starts[last]:.6g} s; record longer, or give an --incident-window that is shorter"
    )


def _outside(time: np.ndarray, starts: Sequence[float], length: float) -> str:
    """Problems of pulses that begin (times (3,) s) before a record, or have too few samples.

    length : s in which all pulses are there, and are apart.
    """
    begin = f"the pulses begin at {', '.join(f'{start:.6g}' for start in starts)} s"
    if min(starts) < time[0]:
        return f"{begin}, the record is from {time[0]:.6g} to {time[-1]:.6g} s: nothing of one is left"
    step = f"the record has a sample every {time[1] - time[0]:.3g} s"
    return f"{begin}, and are apart for {length:.3g} s, {step}: is the unit of its times right? --time-unit"


def _onset(time: np.ndarray, values: np.ndarray) -> float:
    """Time at which a load begins, s."""
    width = max(2, width_of(values))
    reach = max(1, round(0.5 * CREST * width))
    smoothed = smooth(values, reach)
    least = max(ONSET * float(smoothed.max()), 5.0 * white_noise(values) * noise_left(reach))
    if not smoothed.max() > least:
        raise CaseError(["--incident-window: is needed, the incident gauge shows no load above its noise"])
    crest = int(smoothed.argmax())
    before = np.flatnonzero(smoothed[: crest + 1] < least)
    first = int(before[-1]) if len(before) else 0
    return float(time[max(0, first - round(MARGIN * width))])


def _cut(time: np.ndarray, values: np.ndarray, window: Window) -> np.ndarray:
    """A signal (k,) within its window, 0 before it, and faded out after it, as dispersion would spread a step."""
    first, last = window
    behind = np.clip((time - last) / (FADE * (last - first)), 0.0, 1.0)
    return np.where(time >= first, values * np.cos(0.5 * np.pi * behind) ** 2, 0.0)
