"""A spalling test on a bar: estimates from its gauge and the velocity of its free end (L section 3.3)."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from dembound.errors import CaseError
from dembound.gauge import estimates
from dembound.gauge.estimates import Estimate
from dembound.gauge.gauge_io import FREE, Gauge, implausible_size, not_on_bar
from dembound.gauge.peaks import Peaks, matched, noise_worth, positive_peaks

AGREEMENT = 0.05
"""Largest relative difference between estimated and recorded wave speed; coarse nodes change it less."""

SLOWEST, FASTEST = 100.0, 10_000.0
"""Wave speeds of solids, m/s: rubber is slower, and only diamond and beryllium are faster."""


APART = 0.1
"""Largest relative difference of wave speeds by the returns and by the first compression with its return."""


@dataclass(frozen=True)
class Strength:
    """The strength of a bar where it has spalled.

    position : from the loaded end, m; nominal : largest tension there without attenuation, Pa, reached at `time`, s;
    way : path length from the gauge via the free end to there, m; attenuated : nominal strength attenuated over this
    path, Pa, None without a coefficient; pulse : times (p,) s and stresses (p,) Pa of the incident pulse without
    reflections; nominal_error, attenuated_error : standard errors by noise and by the estimated attenuation, Pa.
    """

    position: float
    nominal: float
    time: float
    way: float
    attenuated: float | None
    pulse: tuple[np.ndarray, np.ndarray]
    nominal_error: float
    attenuated_error: float


@dataclass(frozen=True)
class Findings:
    """Estimates from a gauge: wave speed in m/s, attenuation in 1/m, strengths in Pa; None where not estimated.

    `peaks` are the tension peaks from which speed or attenuation are estimated, None if both were given.
    """

    peaks: Peaks | None
    speed: Estimate
    attenuation: Estimate | None
    strength: Strength | None
    pull_back: float | None


def evaluate(
    gauge: Gauge,
    *,
    spall: float | None = None,
    free_end: tuple[np.ndarray, np.ndarray] | None = None,
    estimate: bool = False,
    count: int | None = None,
    pulse_end: float | None = None,
    speed: float | None = None,
    coefficient: float | None = None,
) -> Findings:
    """All estimates from a gauge and from further data.

    Parameters
    ----------
    gauge : the gauge with its signal.
    spall : position at which the bar has spalled, from the loaded end, m.
    free_end : times (q,) in s and velocities (q,) in m/s of the free end, positive outwards.
    estimate : take wave speed and attenuation from the tension peaks even if a record has them.
    count : use this number of first peaks, also if a record has speed and attenuation.
    pulse_end : time at which the incident pulse is over at the gauge, s; by default when its front comes back.
    speed, coefficient : wave speed in m/s and attenuation in 1/m of another test; by default those of a record,
        else estimates.

    Raises CaseError when data are missing, and when a record contradicts the assumptions of an estimate.
    """
    metadata = gauge.metadata
    if metadata is not None and not estimate and count is None:
        speed = metadata.speed if speed is None else speed
        coefficient = metadata.attenuation if coefficient is None else coefficient
    problems = list(_problems_with_options(gauge, spall, speed, coefficient))
    if free_end is not None and gauge.density is None:
        problems.append("--density: is missing, must be that of the bar (kg/m³)")
    if problems:
        raise CaseError(problems)
    peaks, passing, decay = _waves(gauge, speed, coefficient, count)
    strength = pull_back = None
    if spall is not None:
        strength = _strength(gauge.in_pascals(passing.value), passing.value, decay, spall, pulse_end)
    if free_end is not None and gauge.density is not None:
        pull_back = estimates.pull_back_strength(*free_end, gauge.density, passing.value, gauge.length)
        if np.isnan(pull_back):
            must = "must fall and rise again before the pulse is back there, as where a bar spalls"
            raise CaseError([f"--free-end: {must}"])
    return Findings(peaks, passing, decay, strength, pull_back)


def _problems_with_options(
    gauge: Gauge, spall: float | None, speed: float | None, coefficient: float | None
) -> Iterator[str]:
    """Mistakes in the data given with a gauge."""
    if spall is not None:
        yield from not_on_bar("--spall", spall, gauge.length)
        if gauge.metadata is not None and gauge.metadata.ends[1] != FREE:
            end = gauge.metadata.ends[1]
            yield f"--spall: assumes a pulse reflected by a free end, the end opposite the load is {end}"
    yield from implausible_size("--wave-speed", speed, "wave speed", "m/s")
    if coefficient is not None and not 0.0 <= coefficient < np.inf:
        yield f"--attenuation: is {coefficient:g} 1/m, must be finite and not below 0"
    if gauge.metadata is not None and (speed is None or coefficient is None):
        for which, kind in zip(("the loaded end", "the end opposite the load"), gauge.metadata.ends, strict=True):
            if kind != FREE:
                yield f"--estimate: assumes a pulse between free ends, {which} is {kind}"


def _waves(
    gauge: Gauge, speed: float | None, coefficient: float | None, count: int | None
) -> tuple[Peaks | None, Estimate, Estimate | None]:
    """Wave speed and attenuation, given or estimated from tension peaks, and the peaks."""
    if speed is not None and coefficient is not None:
        return None, Estimate(speed), Estimate(coefficient)
    peaks = matched(gauge.time, gauge.stress, estimates.tension_peaks(gauge.time, gauge.stress, count))
    _hold_against_break(gauge, peaks)
    decay = None if coefficient is None else Estimate(coefficient)
    if speed is not None and len(peaks.time) < 2:
        return peaks, Estimate(speed), decay
    passing = estimates.wave_speed(peaks.time, gauge.length, peaks.height)
    _hold_against_speed(gauge, passing.value, speed)
    _hold_against_first_return(gauge, passing.value, float(peaks.time[0]))
    found = passing if speed is None else Estimate(speed)
    return peaks, found, estimates.attenuation(*peaks, found.value) if decay is None else decay


def _hold_against_break(gauge: Gauge, peaks: Peaks) -> None:
    """Raise CaseError if a record shows that the bar broke before the last of the tension peaks."""
    broken = np.inf if gauge.metadata is None else gauge.metadata.broken
    whole, count = int(np.sum(peaks.time <= broken)), len(peaks.time)
    if whole < count:
        said = f"this one broke at {broken:.4g} s, before {count - whole} of its {count}"
        advice = f"use --peaks {whole}" if whole > 1 else "it gives neither speed nor attenuation"
        raise CaseError([f"--estimate: needs tension peaks of an unbroken bar, {said}; {advice}"])


def _hold_against_speed(gauge: Gauge, passing: float, given: float | None) -> None:
    """Raise CaseError if the tension peaks' wave speed, m/s, is not the recorded or given one, or of no solid."""
    known = given if gauge.metadata is None else gauge.metadata.speed
    if known is not None and abs(passing / known - 1.0) > AGREEMENT:
        option = "--attenuation: give it," if gauge.metadata is None else "--estimate:"
        said = f"give a wave speed of {passing:.4g} m/s, must be within {100.0 * AGREEMENT:g} % of {known:.4g} m/s"
        raise CaseError([f"{option} the tension peaks {said}"])
    if not SLOWEST <= passing <= FASTEST:
        said = f"the tension peaks give {passing:.4g} m/s, must be {SLOWEST:g} to {FASTEST:g} m/s"
        raise CaseError([f"RECORD: {said}; check --length (m) and --time-unit, or give --wave-speed and --attenuation"])


def _hold_against_first_return(gauge: Gauge, passing: float, returned: float) -> None:
    """Raise CaseError for a measured signal in which the first compression does not return, at `returned` s, as fast.

    passing : wave speed by the returns, m/s.
    """
    out = positive_peaks(gauge.time, -gauge.stress, 1).time
    first = 2.0 * (gauge.length - gauge.position) / (returned - float(out[0])) if len(out) else np.inf
    if gauge.metadata is None and not abs(passing / first - 1.0) < APART:
        said = f"the tension peaks give {passing:.4g} m/s, the first compression and its return {first:.4g} m/s"
        causes = "look for hum, oscillations or another impact (--high-pass, --peaks 2), check --position and --scale"
        raise CaseError([f"RECORD: {said}: these are not returns of one pulse; {causes}"])


def _strength(gauge: Gauge, speed: float, decay: Estimate | None, position: float, pulse_end: float | None) -> Strength:
    """Strengths at a position, m."""
    bar = gauge.position, gauge.length, speed
    pulse = estimates.incident_pulse(gauge.time, gauge.stress, *bar, pulse_end)
    measured = gauge.stress[: len(pulse[0])]
    noise = noise_worth(measured, estimates.LARGEST_OF_NOISE)
    nominal, time, error = estimates.nominal_strength(pulse[0], measured, *bar, position, noise)
    way = estimates.path_via_free_end(gauge.position, gauge.length, position)
    if decay is None:
        return Strength(position, nominal, time, way, None, pulse, error, np.nan)
    attenuated = estimates.attenuated_strength(nominal, decay.value, way)
    by_decay = attenuated * way * decay.error if decay.points else 0.0
    both = float(np.hypot(estimates.attenuated_strength(error, decay.value, way), by_decay))
    return Strength(position, nominal, time, way, attenuated, pulse, error, both)
