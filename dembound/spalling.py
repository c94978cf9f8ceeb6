"""A spalling test on a bar: all that its gauge tells, and the velocity of its free end (L section 3.3)."""

from collections.abc import Iterator
from dataclasses import dataclass

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
from dembound.readings import Gauge, not_above_zero, not_on_bar


@dataclass(frozen=True)
class Strength:
    """The strength of a bar where it has spalled.

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
    strength: Strength | None
    pull_back: float | None


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
    problems = list(_problems_with_options(gauge, spall, speed, coefficient))
    if free_end is not None and gauge.density is None:
        problems.append("--density: is not known, give it")
    if problems:
        raise CaseError(problems)
    peaks = tension_peaks(gauge.time, gauge.stress, count)
    found = Estimate(speed) if speed is not None else wave_speed(peaks.time, gauge.length, peaks.height)
    decay = None
    if coefficient is not None:
        decay = Estimate(coefficient)
    elif len(peaks.time) > 1:
        decay = attenuation(peaks.time, peaks.height, found.value)
    strength = None if spall is None else _strength(gauge, found.value, decay, spall, pulse_end)
    pull_back = None if free_end is None else _pull_back(gauge, found.value, free_end)
    return Findings(peaks, found, decay, strength, pull_back)


def _problems_with_options(
    gauge: Gauge, spall: float | None, speed: float | None, coefficient: float | None
) -> Iterator[str]:
    """What is wrong with what is given beside a gauge."""
    if spall is not None:
        yield from not_on_bar("--spall", spall, gauge.length)
    yield from not_above_zero("--wave-speed", speed, "m/s")
    if coefficient is not None and not 0.0 <= coefficient < np.inf:
        yield f"--attenuation: is {coefficient:g} 1/m, must be finite and not below 0"


def _strength(gauge: Gauge, speed: float, decay: Estimate | None, position: float, pulse_end: float | None) -> Strength:
    """Strengths at a position, m."""
    bar = gauge.position, gauge.length, speed
    pulse = incident_pulse(gauge.time, gauge.stress, *bar, pulse_end)
    nominal, time = nominal_strength(*pulse, *bar, position)
    way = way_by_the_end(gauge.position, gauge.length, position)
    attenuated = None if decay is None else attenuated_strength(nominal, decay.value, way)
    return Strength(position, nominal, time, way, attenuated, pulse)


def _pull_back(gauge: Gauge, speed: float, free_end: np.ndarray) -> float:
    """Strength in Pa from the velocity of the free end, m/s."""
    assert gauge.density is not None
    found = pull_back_strength(free_end, gauge.density, speed)
    if np.isnan(found):
        raise CaseError(["--free-end: has no largest velocity with a smallest after it, as where a bar spalls"])
    return found
