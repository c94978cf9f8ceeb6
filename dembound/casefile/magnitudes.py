"""Warnings about times and stresses of unlikely size, which are probably in another unit."""

import math
from collections.abc import Iterator, Mapping
from itertools import chain

import numpy as np

from dembound.casefile import Case
from dembound.waves import Wave
from dembound.words import percent, with_unit

FAR = 1000.0
"""Ratio of two times above which one of them is probably in another unit.

ms for s, or mm for m in a travel time, change a ratio by this factor. Waves commonly last from a few hundredths of the
run to all of it.
"""

SLOW = 100.0
"""Ratio of period to travel time above which the scene moves as a rigid body and no wave is visible.

Common ratios are 0.01 to 10.
"""

FEWEST_STEPS = 10.0
"""Least number of steps in a period: samples half a step from the crest of a cosine are up to 2.4 % below it."""

SMALL_PART = 0.1
"""Share of its peak that a wave must reach within the run; below it only the first rise of the wave is simulated."""

MISSED = 0.05
"""Share of its peak by which a wave may vary before t = 0, which no run simulates; noise before a trigger is less."""

WEAK, STRONG = 1e-4, 1e3
"""Stresses over the strength, below and above which one of them is probably in another unit.

Pa for MPa shifts this ratio by 1e6, so that any ratio between 0.01 and 100 leaves the range between the two limits. At
the lower limit a strength is not needed; at the upper limit the stress in rock would be of the order of GPa.
"""

LARGE_STRAIN = 0.03
"""Strain, velocity over that of waves or stress over stiffness, above which no law of solids is valid.

The error of a linear law is of the order of the strain. Rock and soil break at a tenth of this, so larger ones are
mostly wrong units.
"""

FASTEST_GROUND = 5.0
"""Velocity (m/s) above those of the ground: the largest recorded in an earthquake are 3 to 4 m/s."""

OF_GROUND = 100.0
"""Frequency (Hz) up to which a wave is taken for ground motion; laboratory pulses and blasts nearby are higher.

The motion of an earthquake has up to some 20 Hz, that of a blast at a distance, at some cm/s, up to 100 Hz.
"""

SAMPLES_IN_PERIOD = 4.0
"""Samples of a history in a period of a wave: with fewer, peaks are more than 30 % too low and spectra have aliases."""

SAMPLES = 1001
"""Number of times at which a wave is sampled."""


def waves_used(case: Case) -> set[str]:
    """Names of the waves that enter from outside or are the time factor of loads."""
    return case.entering | case.moving | {load.wave for load in case.load if load.wave is not None}


def is_quasi_static(case: Case, name: str, travel: float) -> bool:
    """Whether a wave is only a constant velocity of grips, in a test, or far longer than a wave's travel time.

    The waves sent by its start, also those too short for the discretisation, then have a stress ρcv below 1/`SLOW`
    of the stress ρc²u/L that the grips reach at the end of the run, u = vt.

    travel : time (s) a wave takes through the scene.
    """
    driven = [case.boundary[side].type for side, waves in case.driving.items() if name in waves.values()]
    grips_only = set(driven) == {"velocity"} and all(load.wave != name for load in case.load)
    return case.wave[name].stays and grips_only and (case.run.is_test or case.run.duration > SLOW * travel)


def time_warnings(case: Case, time_step: float, travel: float) -> Iterator[str]:
    """Warnings about waves that begin before the run, then at most one for every wave with an unlikely duration.

    Unlikely is far longer or shorter than the run, the step or the travel time.

    time_step : s. travel : time (s) a wave takes through the scene; nan where no wave can run.
    """
    used = waves_used(case)
    yield from (f"wave.{name}: {early}" for name in case.wave if name in used for early in _too_early(case.wave[name]))
    for name, wave in case.wave.items():
        doubts = chain(
            _too_long(wave, case.run.duration, travel), _too_short(wave, case.run.duration, time_step, travel)
        )  # in this order: the length of a wave that starts very late is lost in rounding
        if name in used and (doubt := next(doubts, None)):
            yield f"wave.{name}: {doubt}; are all times in s and lengths in m?"


def _too_early(wave: Wave) -> Iterator[str]:
    """A warning about a record that varies before the run; none for a velocity that is steady until then."""
    begin = wave.begin()
    if not begin < 0.0:
        return
    before = np.union1d(np.linspace(begin, 0.0, SAMPLES), np.clip(wave.peak_time(), begin, 0.0))
    velocities = wave.velocity(before)
    if np.ptp(velocities) > MISSED * wave.peak():
        largest = int(np.abs(velocities).argmax())
        yield (
            f"reaches {percent(abs(velocities[largest]) / wave.peak(), 3)} of its peak at {before[largest]:.4g} s, "
            f"before the run begins at t = 0, and this part is left out; give start = {wave.start - begin:.6g}"
        )


def _too_long(wave: Wave, duration: float, travel: float) -> Iterator[str]:
    """Reasons why a wave is far too long, in words; times in s."""
    length, period = wave.duration() - wave.start, wave.dominant_period()
    reached = _share_reached(wave, duration)
    if reached < SMALL_PART:
        yield (
            f"reaches {percent(reached)} of its peak, which comes at {wave.peak_time():g} s, "
            f"within the run of {duration:g} s"
        )
    if FAR * duration < length < math.inf:
        yield f"lasts {length:g} s, {length / duration:,.0f} times the run of {duration:g} s"
    if period > SLOW * travel and not wave.stays:  # a slow grip strains a body uniformly
        yield f"has a period of {period:g} s, {period / travel:,.0f} times its way through the scene, {travel:.3g} s"


def _too_short(wave: Wave, duration: float, time_step: float, travel: float) -> Iterator[str]:
    """Reasons why a wave is far too short, in words; times in s. A constant may be a sudden load."""
    if wave.stays:
        return
    length = wave.duration() - wave.start
    period = wave.time_scale()
    if period < FEWEST_STEPS * time_step:
        yield f"has a period of {period:g} s, {period / time_step:.2g} time steps of {time_step:.4g} s"
    if FAR * length < duration:
        yield f"lasts {length:g} s, and the run of {duration:g} s is {duration / length:,.0f} times as long"
    if FAR * period < travel:
        yield f"has a period of {period:g} s, 1/{travel / period:,.0f} of its way through the scene, {travel:.3g} s"


def _share_reached(wave: Wave, duration: float) -> float:
    """Largest |velocity| within the run over the largest ever."""
    if wave.peak_time() <= duration:
        return 1.0
    return float(np.abs(wave.velocity(np.linspace(0.0, duration, SAMPLES))).max()) / wave.peak()


def grip_stress(
    wave: Wave, density: float, speed: float, length: float, duration: float, strength: float
) -> tuple[str, float]:
    """Largest stress of a grip moved by a wave, in words and in Pa.

    ρcv at the first arrival, or ρc²u/L once the body is strained uniformly, at most its strength.

    density : kg/m³. speed : of the waves the grip sends, m/s. length : of the body along their way, m. duration : of
    the run, s. strength : Pa.
    """
    moved = float(np.abs(wave.displacement(np.linspace(0.0, duration, SAMPLES))).max())
    sudden = density * speed * wave.peak()
    even = min(density * speed**2 * moved / length, strength)
    return ("its stress ρcv", sudden) if sudden >= even else ("its stress ρc²u/L", even)


def stress_warnings(stresses: Mapping[str, tuple[str, float]], strength: float, key: str) -> Iterator[str]:
    """Warnings about stresses many times the strength, or about a largest stress that is a tiny part of it.

    stresses : table -> description of the stress, and its value in Pa. strength : Pa. key : of the strength.
    """
    against = f"{key}, {with_unit(strength, 'Pa')}: Pa and MPa?"
    for place, (what, stress) in stresses.items():
        if stress > STRONG * strength:
            yield f"{place}: {what} is {with_unit(stress, 'Pa')}, {stress / strength:,.0f} times {against}"
    if stresses:
        place, (what, stress) = max(stresses.items(), key=lambda item: item[1][1])
        if stress < WEAK * strength:
            yield f"{place}: {what} is {with_unit(stress, 'Pa')}, {percent(stress / strength)} of {against}"


def large_velocity(place: str, velocity: float, speed: float, reason: str, waves: str = "waves") -> Iterator[str]:
    """A particle velocity (m/s) that is a large part of the speed (m/s) of waves; reason : why, and what to do."""
    if velocity > LARGE_STRAIN * speed:
        yield (
            f"{place}: particles move at up to {velocity:.3g} m/s, {waves} run at {speed:.4g} m/s, so strains are "
            f"v/c = {percent(velocity / speed)}; {reason}"
        )


def fast_ground(place: str, wave: Wave) -> Iterator[str]:
    """A warning about an entering wave with frequencies of ground motion and a velocity above all recorded ones."""
    frequency = wave.dominant_frequency()
    if wave.peak() > FASTEST_GROUND and 0.0 < frequency < OF_GROUND:
        yield (
            f"{place}: shakes the ground at up to {wave.peak():.3g} m/s, at {frequency:.3g} Hz, where the strongest "
            "earthquakes recorded reach 3 to 4 m/s; is it in m/s?"
        )


def large_stress(what: str, stress: float, modulus: float, reason: str) -> Iterator[str]:
    """A warning about a stress (Pa) that is a large part of the stiffness (Pa).

    what : the table and the stress in words, such as "load.blow: its pressure"; reason : words on the likely mistake.
    """
    if stress > LARGE_STRAIN * modulus:
        yield (
            f"{what} is {with_unit(stress, 'Pa')}, {percent(stress / modulus)} of the stiffness, "
            f"{with_unit(modulus, 'Pa')}, so strains reach {percent(stress / modulus)}; {reason}"
        )


def sampling_warnings(case: Case) -> Iterator[str]:
    """A warning about an interval of histories that is too long for the waves."""
    used, interval = waves_used(case), case.output.history_interval
    scales = {name: wave.time_scale() for name, wave in case.wave.items() if name in used and not wave.stays}
    if scales and interval * SAMPLES_IN_PERIOD > (shortest := min(scales.values())) > 0.0:
        name = min(scales, key=lambda each: scales[each])
        yield (
            f"output.history_interval: is {interval:g} s, {interval / shortest:.2g} of the period of wave.{name}, "
            f"{shortest:.3g} s; likely in ms, or write {shortest / 20.0:.2g} or less"
        )
