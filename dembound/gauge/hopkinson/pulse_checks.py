"""Checks that the pulses of a split Hopkinson test are consistent in their impulses and in their travel time.

The impulse of both faces, ∫(F_1 − F_2) dt, is the momentum m v of the moving specimen. A gauge whose baseline jumps,
whose gain is wrong or whose record lacks samples makes it larger, or negative. The reflected pulse begins 2d_i/c after
the incident one at their gauge.
"""

from collections.abc import Iterator

import numpy as np

from dembound.gauge.estimates import Estimate
from dembound.gauge.hopkinson.pulses import Faces, Setup, Signals, Windows, found_windows
from dembound.gauge.hopkinson.slope_error import unbalanced
from dembound.gauge.hopkinson.specimen import Specimen
from dembound.gauge.peaks import denoised, white_noise
from dembound.gauge.plausibility import differing_modulus
from dembound.meanings import fading
from dembound.words import percent

BALANCED = 0.015
"""Difference of the impulses of both faces over their mean, beyond inertia, above which a warning is given."""

LOWEST, LEVELS = 0.02, 3
"""Share of its largest value at which the onset of a pulse is first sought, and number of such levels, each twice the
one before."""

NOISES = 8.0
"""Lowest level in standard deviations of noise."""

DIFFERING = 0.01
"""Relative difference of wave speeds that causes a warning, if it also exceeds the error of the measured one."""


CAUSES = (
    "look for a baseline that jumps or drifts, gains or times of the gauges that differ, or a signal that is cut",
    ", or look for lost samples",
)
"""Possible causes of inconsistent impulses or times in measured signals."""

OF_A_RUN = "check the options for bars, gauges and windows: the signals are those of a run"
"""Possible causes of inconsistent impulses or times in the signals of a run."""


def travel_speed(signals: Signals, setup: Setup, windows: Windows) -> Estimate | None:
    """Wave speed by the onsets of the incident and the reflected pulse at their gauge, 2d_i/c apart.

    As both pulses have different shapes, the time between them is taken at some low levels and extrapolated over the
    root of the level to level zero, for a smooth onset. The error is the difference from the time at the lowest level,
    and half a sample. None where the pulses overlap, or noise hides the onsets.
    """
    (first, last), (_, end), _ = found_windows(signals, setup, windows)
    time, values = signals.time, denoised(signals.incident)
    out = (time >= first) & (time <= last)
    back = (time > last - 0.1 * (last - first)) & (time <= end)
    levels = np.array(
        max(LOWEST, NOISES * white_noise(signals.incident) / float(np.abs(values[back]).max(initial=1e-300)))
        * 2.0 ** np.arange(LEVELS)
    )
    if levels[-1] > 0.5:
        return None
    leaves, returns = (_onsets(time[part], np.abs(values[part]), levels) for part in (out, back))
    if leaves is None or returns is None:
        return None
    delays = returns - leaves
    delay = float(np.polyfit(np.sqrt(levels), delays, 1)[1])
    error = abs(delay - float(delays[0])) + 0.5 * float(time[1] - time[0])
    if not delay > 0.0:
        return None
    speed = 2.0 * setup.incident_gauge / delay
    return Estimate(speed, speed * error / delay, 2)


def doubts_of_bars(setup: Setup, density: float) -> Iterator[str]:
    """Doubts about bars with a density (kg/m³): a modulus other than ρc², an attenuation that leaves no wave."""
    yield from differing_modulus(setup.modulus, density, setup.bar.speed)
    way = setup.incident_gauge + setup.transmitted_gauge
    yield from fading("--attenuation", setup.bar.attenuation * way, way)


def doubts_of_pulses(
    signals: Signals, faces: Faces, setup: Setup, windows: Windows, found: Specimen, *, measured: bool = True
) -> Iterator[str]:
    """Doubts about inconsistent pulses; measured : False for the signals of a run."""
    causes, lost = CAUSES if measured else (OF_A_RUN, "")
    off = max((unbalanced(faces, setup, found, end) for end in (found.largest + 1, len(faces.time))), key=abs)
    if abs(off) > BALANCED:
        yield (
            f"the impulses of both faces of the specimen differ by {percent(abs(off), 3)}, beyond its inertia: {causes}"
        )
    travelled = None if signals.second is not None else travel_speed(signals, setup, windows)
    if travelled is not None:
        apart = travelled.value / setup.bar.speed - 1.0
        if abs(apart) > max(DIFFERING, travelled.error / setup.bar.speed):
            yield (
                f"the reflected pulse begins at its gauge as with a wave speed of {travelled.value:.5g} ± "
                f"{travelled.error:.2g} m/s, {'+' * (apart > 0.0)}{percent(apart)} from --wave-speed: check it "
                f"and --incident-gauge{lost}"
            )


def _onsets(time: np.ndarray, sizes: np.ndarray, levels: np.ndarray) -> np.ndarray | None:
    """Times (n,) from which on a rising pulse (k,) exceeds shares (n,) of its largest value; None if it does not.

    The rise ends where half of the largest value is first reached: a reflected pulse may have its largest value as the
    load ends.
    """
    largest = float(sizes.max(initial=0.0))
    risen = int(np.argmax(sizes >= 0.5 * largest))
    found = []
    for level in levels * largest:
        below = np.flatnonzero(sizes[: risen + 1] < level)
        if not len(below):
            return None
        last = int(below[-1])
        share = (level - sizes[last]) / (sizes[last + 1] - sizes[last])
        found.append(float(time[last] + share * (time[last + 1] - time[last])))
    return np.array(found)
