"""A spalling test on a bar: estimates from its gauge and the velocity of its free end (L section 3.3)."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from dembound.errors import CaseError
from dembound.gauge.estimates import (
    LARGEST_OF_NOISE,
    Estimate,
    attenuated_strength,
    attenuation,
    incident_pulse,
    nominal_strength,
    path_via_free_end,
    pull_back_strength,
    tension_peaks,
    wave_speed,
)
from dembound.gauge.findings import Findings, Strength
from dembound.gauge.gauge_io import FREE, Gauge, not_above_zero, not_on_bar
from dembound.gauge.matching import matched
from dembound.gauge.noise import Noise
from dembound.gauge.passages import PartialFit, first_return, parts
from dembound.gauge.peaks import Peaks, noise_worth, width_of
from dembound.gauge.plausibility import (
    FAR,
    FEW,
    as_doubtful,
    contradicting_speeds,
    few_returns,
    implausible_size,
    misfit,
    raised_by_noise,
    uncertain_decay,
    uncertain_speed,
    unlikely_speed,
)
from dembound.gauge.strength_checks import doubts_of_signals, doubts_of_strengths
from dembound.gauge.uncertainty import with_errors

FILTERED = "filter: "
"""Beginning of a note on a filter, see `Filters.apply`."""

OF_SHAPE = ("RECORD:", "--pulse-end: give it", "--wave-speed: needs", "--attenuation: give it")
"""Beginnings of messages about a signal that is not one pulse running to and fro."""

AGREEMENT = 0.05
"""Largest relative difference between estimated and recorded wave speed; coarse nodes change it less."""


class Given(NamedTuple):
    """Data given with a gauge, see `evaluate`; first : the argument `count`."""

    spall: float | None
    pulse_end: float | None
    speed: float | None
    coefficient: float | None
    first: int | None


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
    given = Given(spall, pulse_end, speed, coefficient, count)
    with _filters_named(gauge):
        found = _estimated(gauge, given)
    if free_end is not None:
        found = replace(found, pull_back=_pull_back(gauge, found.speed.value, free_end))
    doubts = tuple(doubts_of_strengths(gauge, found, free_end))
    if gauge.metadata is not None:
        return replace(found, warnings=doubts)
    doubts = (*doubts, *doubts_of_signals(gauge, found, free_end))
    same = given if found.peaks is None else given._replace(first=len(found.peaks.time))
    found = with_errors(found, [] if gauge.noise is None else list(_replicates(gauge, gauge.noise, same)))
    with _filters_named(gauge):
        return replace(found, warnings=(*_doubts(gauge, found), *doubts))


@contextmanager
def _filters_named(gauge: Gauge) -> Iterator[None]:
    """Adds to messages about the shape of a signal that filters have changed it."""
    try:
        yield
    except CaseError as error:
        filters = [note.removeprefix(FILTERED).partition(",")[0] for note in gauge.notes if note.startswith(FILTERED)]
        if not filters:
            raise
        cause = f"; or it is due to the {' and the '.join(filters)}: try without"
        raise CaseError([f"{each}{cause * each.startswith(OF_SHAPE)}" for each in error.problems]) from None


def _estimated(gauge: Gauge, given: Given) -> Findings:
    """All estimates from one signal."""
    peaks, speed, decay = _waves(gauge, given.speed, given.coefficient, given.first)
    found: list[PartialFit] = []
    if gauge.metadata is None and peaks is not None and len(peaks.time) > 1:
        found = parts(gauge.time, gauge.stress, (gauge.position, gauge.length), peaks, speed.value)
    strength = None
    if given.spall is not None:
        strength = _strength(gauge.in_pascals(speed.value), speed.value, decay, given.spall, given.pulse_end)
    return Findings(peaks, speed, decay, strength, None, tuple(found))


def _replicates(gauge: Gauge, noise: Noise, given: Given) -> Iterator[Findings]:
    """Estimates from the signal with drawn noise and baselines added, where they succeed."""
    for error in noise.draws():
        with suppress(CaseError):
            yield _estimated(replace(gauge, stress=gauge.stress + error), given)


def _doubts(gauge: Gauge, found: Findings) -> Iterator[str]:
    """Doubts about estimates from a measured signal; raises CaseError for an impossible speed."""
    about_speed = list(_doubts_of_speed(gauge, found))
    yield from about_speed
    if (width := width_of(np.abs(gauge.stress))) < FEW:
        yield f"the sampling is coarse: {width} samples above half the height of the largest wave"
    if about_speed:
        yield from as_doubtful(found)
    elif doubts := list(misfit(found, "attenuation")) or list(uncertain_decay(found.attenuation)):
        yield from doubts
        if found.strength is not None and found.strength.attenuated is not None:
            yield "also doubtful, by this attenuation: the attenuated strength"
    if found.strength is not None and gauge.noise is not None:
        yield from raised_by_noise(float(gauge.noise.residuals.std()), float(np.abs(gauge.stress).max()))


def _doubts_of_speed(gauge: Gauge, found: Findings) -> Iterator[str]:
    """Doubts about an estimated wave speed; raises CaseError for an impossible one."""
    if not found.speed.points:
        return
    if problems := list(unlikely_speed(found.speed.value)):
        raise CaseError(problems)
    first = first_return(gauge.time, gauge.stress, gauge.position, gauge.length)
    doubts = list(contradicting_speeds(found.speed, first))
    if first is not None and doubts and abs(found.speed.value / first.value - 1.0) > FAR:
        raise CaseError([f"RECORD: {doubts[0]}"])
    yield from doubts
    misfits = list(misfit(found, "wave speed"))
    yield from misfits or uncertain_speed(found.speed)


def _problems_with_options(
    gauge: Gauge, spall: float | None, speed: float | None, coefficient: float | None
) -> Iterator[str]:
    """Mistakes in the data given with a gauge."""
    if spall is not None:
        yield from not_on_bar("--spall", spall, gauge.length)
        if gauge.metadata is not None and gauge.metadata.ends[1] != FREE:
            end = gauge.metadata.ends[1]
            yield f"--spall: assumes a pulse reflected by a free end, the end opposite the load is {end}"
    unfit = list(not_above_zero("--wave-speed", speed, "m/s"))
    yield from unfit or implausible_size("--wave-speed", speed, "wave speed", "m/s")
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
    peaks = matched(gauge.time, gauge.stress, tension_peaks(gauge.time, gauge.stress, count))
    _hold_against_break(gauge, peaks)
    decay = None if coefficient is None else Estimate(coefficient)
    if speed is not None and len(peaks.time) < 2:
        return peaks, Estimate(speed), decay
    if len(peaks.time) < 2 and (count is None or count > 1):
        why = few_returns(gauge.time, gauge.stress, gauge.position, gauge.length)
        said = f"needs two tension peaks to be estimated, {len(peaks.time)} found in the record"
        raise CaseError([f"--wave-speed: {said}: {why}; give it"])
    passing = wave_speed(peaks.time, gauge.length, peaks.height)
    _hold_against_speed(gauge, passing.value, speed)
    found = passing if speed is None else Estimate(speed)
    return peaks, found, attenuation(*peaks, found.value) if decay is None else decay


def _hold_against_break(gauge: Gauge, peaks: Peaks) -> None:
    """Raise CaseError if a record shows that the bar broke before the last of the tension peaks."""
    broken = np.inf if gauge.metadata is None else gauge.metadata.broken
    whole, count = int(np.sum(peaks.time <= broken)), len(peaks.time)
    if whole < count:
        said = f"this one broke at {broken:.4g} s, before {count - whole} of its {count}"
        advice = f"use --peaks {whole}" if whole > 1 else "it gives neither speed nor attenuation"
        raise CaseError([f"--estimate: needs tension peaks of an unbroken bar, {said}; {advice}"])


def _hold_against_speed(gauge: Gauge, passing: float, given: float | None) -> None:
    """Raise CaseError if the tension peaks' wave speed, m/s, differs from the recorded or given one."""
    known = given if gauge.metadata is None else gauge.metadata.speed
    if known is not None and abs(passing / known - 1.0) > AGREEMENT:
        option = "--attenuation: give it," if gauge.metadata is None else "--estimate:"
        said = f"give a wave speed of {passing:.4g} m/s, must be within {100.0 * AGREEMENT:g} % of {known:.4g} m/s"
        raise CaseError([f"{option} the tension peaks {said}"])


def _strength(gauge: Gauge, speed: float, decay: Estimate | None, position: float, pulse_end: float | None) -> Strength:
    """Strengths at a position, m."""
    bar = gauge.position, gauge.length, speed
    pulse = incident_pulse(gauge.time, gauge.stress, *bar, pulse_end)
    measured = gauge.stress[: len(pulse[0])]
    noise = noise_worth(measured, LARGEST_OF_NOISE)
    nominal, time, error = nominal_strength(pulse[0], measured, *bar, position, noise)
    way = path_via_free_end(gauge.position, gauge.length, position)
    attenuated = None if decay is None else attenuated_strength(nominal, decay.value, way)
    return Strength(position, nominal, time, way, attenuated, pulse, error)


def _pull_back(gauge: Gauge, speed: float, free_end: tuple[np.ndarray, np.ndarray]) -> float:
    """Strength in Pa from the velocity of the free end, m/s."""
    assert gauge.density is not None
    found = pull_back_strength(*free_end, gauge.density, speed, gauge.length)
    if np.isnan(found):
        raise CaseError(["--free-end: must fall and rise again before the pulse is back there, as where a bar spalls"])
    return found
