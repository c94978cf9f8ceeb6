"""Checks that strengths from a gauge can be those of the bar: spall, end of the pulse, speed, and size."""

from collections.abc import Iterator

import numpy as np

from dembound.gauge.estimates import ENDED, FEWEST, near_free_end, rise
from dembound.gauge.findings import Findings, Strength
from dembound.gauge.gauge_io import Gauge
from dembound.gauge.passages import speed_of_fronts
from dembound.gauge.plausibility import LARGEST_STRAIN, differing_modulus
from dembound.gauge.pulse_faults import ac_coupling, faults
from dembound.meanings import MEANINGS, fading
from dembound.words import percent, with_unit

SAME, NEARER = 0.99, 0.9
"""Share of the tension at the spall, and of its distance from the free end, that give a warning if reached earlier.

The tension grows with the distance until the pulse has its full length there, so a bar that breaks when it reaches its
strength does so where it still grows: over the last tenth by a tenth under a straight fall. With 0.99 an exponential
fall gives a warning from 0.98 of the crest on, where the place hardly determines the strength. Under a rectangular
pulse the full tension first occurs where the pulse has its full length, and nearer to the end later.
"""

PLACES = 20
"""Number of even distances from the free end to the spall at which the tension is compared."""

AWAY = 0.1
"""Distance of the spall from the first crack of results, over its distance from the free end: the relative error of the
strength.
"""

FRONTS = 0.05
"""Largest relative difference of a given speed from that of the fronts, taken at a fifth of their crests: for a
return that a spall has cut at half its height to a tenth, a tenth of a rise earlier. Pulses that have ended when
they return have rises of less than half that time."""


def doubts_of_strengths(gauge: Gauge, found: Findings, free_end: tuple[np.ndarray, np.ndarray] | None) -> Iterator[str]:
    """Doubts about strengths, also of results; free_end : times (q,) s and velocities (q,) m/s."""
    speed, strength = found.speed.value, found.strength
    known = None if gauge.metadata is None else gauge.metadata.attenuation
    if found.attenuation is not None and not found.attenuation.points and found.attenuation.value != known:
        yield from fading("--attenuation", found.attenuation.value * gauge.length, gauge.length)
    if strength is not None:
        yield from list(_cut_off(strength)) or _spalled_nearer(gauge, strength, speed)
        yield from _cracked_elsewhere(gauge, strength)
        if gauge.unit == "strain":
            yield from differing_modulus(gauge.modulus, gauge.density, speed)
    yield from _implausible_strengths(found)
    if free_end is not None and not (most := float(np.abs(free_end[1]).max()) / (2.0 * speed)) < LARGEST_STRAIN:
        yield (
            f"--free-end: its largest velocity, {2.0 * speed * most:.4g} m/s, is of a wave of {percent(most, 3)} "
            f"strain, v/2c, of a bar below {100.0 * LARGEST_STRAIN:g} %: is it in m/s?"
        )


def doubts_of_signals(gauge: Gauge, found: Findings, free_end: tuple[np.ndarray, np.ndarray] | None) -> Iterator[str]:
    """Doubts from a measured signal itself about a given speed, and about strengths."""
    strength, speed = found.strength, found.speed.value
    coupled: list[str] = []
    if strength is not None:
        end = len(strength.pulse[0])
        if gauge.recorded is not None:
            coupled = list(ac_coupling(gauge.time[:end], -gauge.recorded[:end], rise(-gauge.stress)[0]))
        cure = "use --low-pass or mend the file"
        yield from coupled or faults(gauge.time[:end], -gauge.stress[:end], "the pulse", cure)
    if not found.speed.points and not coupled:
        fronts = speed_of_fronts(gauge.time, gauge.stress, gauge.position, gauge.length)
        if fronts is not None and abs(speed / fronts - 1.0) > FRONTS:
            yield (
                f"--wave-speed: is {speed:.5g} m/s, the front of the pulse is back at the gauge as with {fronts:.5g} "
                f"m/s, {percent(abs(speed / fronts - 1.0))} apart: check it, --position and --length"
            )
    if free_end is not None:
        time, velocity = free_end
        begun = rise(velocity)[0]
        end = int(np.searchsorted(time, time[begun] + 2.0 * gauge.length / speed))
        if end > FEWEST:
            said = faults(time[:end], velocity[:end], "the velocity", "mend the file")
            yield from (f"--free-end: {each}" for each in said)


def _spalled_nearer(gauge: Gauge, strength: Strength, speed: float) -> Iterator[str]:
    """Message if the tension at the spall occurred earlier nearer to the free end, where the bar did not break."""
    time, stress = strength.pulse
    shares = np.array([share for share in np.arange(1, PLACES) / PLACES if share <= NEARER] + [1.0])
    places = gauge.length - shares * (gauge.length - strength.position)
    begin = float(time[0]) + (strength.position - gauge.position) / speed
    step, last = float(time[1] - time[0]), float(time[-1]) + strength.way / speed
    moments = begin + step * np.arange(int((last - begin) / step) + 2)
    tension = near_free_end(time, stress, gauge.position, gauge.length, speed, places, moments)
    there = tension >= SAME * tension[-1].max()
    first = np.where(there.any(axis=1), there.argmax(axis=1), len(moments))
    if tension[-1].max() > 0.0 and len(before := np.flatnonzero(first < first[-1])):
        yield (
            f"--spall: all of the tension at {strength.position:g} m, {with_unit(strength.nominal, 'Pa')}, was at "
            f"{places[before[0]]:.4g} m before, nearer to the free end, where the bar should have broken: check "
            "--spall (it is from the loaded end), --length, --wave-speed and --pulse-end"
        )


def _cut_off(strength: Strength) -> Iterator[str]:
    """Message if the pulse has not ended when it is cut."""
    time, stress = strength.pulse
    left = abs(float(stress[-1])) / float(np.abs(stress).max())
    if left > ENDED:
        yield (
            f"--pulse-end: cuts the pulse at {time[-1]:.6g} s, where it has {percent(left)} of its crest, must be "
            f"below {100.0 * ENDED:g} %: what is cut off would lessen the tension"
        )


def _cracked_elsewhere(gauge: Gauge, strength: Strength) -> Iterator[str]:
    """Message if the results have their first crack at another place than the spall."""
    first = None if gauge.metadata is None else gauge.metadata.first_crack
    if first is not None and abs(first - strength.position) > AWAY * (gauge.length - first):
        yield (
            f"--spall: is {strength.position:g} m from the loaded end, the results have their first crack at "
            f"{first:.4g} m, from where the strength follows"
        )


def _implausible_strengths(found: Findings) -> Iterator[str]:
    """Messages about strengths of unlikely sizes."""
    strength = found.strength
    nominal, attenuated = (None, None) if strength is None else (strength.nominal, strength.attenuated)
    for name, value in (("nominal", nominal), ("attenuated", attenuated), ("pull-back", found.pull_back)):
        if value is not None and (doubt := MEANINGS["strength"].doubt(value, "Pa", given=False)):
            cause = "--free-end in m/s and --density" if name == "pull-back" else "--unit, --scale and --attenuation"
            yield f"the {name} strength {doubt}: check {cause}"
