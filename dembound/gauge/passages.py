"""Checks that one pulse that runs to and fro explains all passages at a gauge on a bar.

Wave speed and attenuation follow from the tension peaks, and once more from parts of the record: the first two of these
peaks, those behind the first, the compressions between them, and the path from the first compression to its reflection.
For one pulse all are equal but for noise. A second impact, lost samples, an amplifier at its limit, a baseline that
jumps, or ends that absorb energy or delay waves, change one part more than another.
"""

from typing import NamedTuple

import numpy as np

from dembound.gauge.estimates import Estimate, attenuation, rise, tension_peaks, wave_speed
from dembound.gauge.matching import matched
from dembound.gauge.peaks import Peaks, positive_peaks, white_noise

ENDED = 0.05
"""Share of the largest value below which a pulse has ended between two passages."""

RISEN, FREE_OF_WAVES = 0.2, 0.1
"""Share of its crest at which a front counts as arrived, and part of the way back in which the signal must be quiet
before it."""

STRONG = 10.0
"""Least height of a passage in standard deviations of noise: lower ones are overestimated."""


class PartialFit(NamedTuple):
    """Result from a part of the passages: its name, wave speed in m/s and attenuation in 1/m, nan where it has none."""

    name: str
    speed: float
    decay: float


def parts(
    time: np.ndarray, stress: np.ndarray, bar: tuple[float, float], peaks: Peaks, speed: float
) -> list[PartialFit]:
    """Estimates from parts of the passages.

    Parameters
    ----------
    time, stress : (k,) s, evenly spaced, and any unit. bar : position of the gauge and length, m.
    peaks : tension peaks from which everything is estimated. speed : c in m/s for attenuations.
    """
    position, length = bar
    least, lines = STRONG * white_noise(stress), {}
    if len(peaks.time) > 2:
        lines["the first two returns"] = _some(peaks, peaks.height[:2] > least)
        lines["the returns behind the first"] = _some(peaks, (peaks.height > least) & (peaks.time > peaks.time[0]))
    first = first_passages(time, stress)
    way = 2.0 * (length - position)
    found = [PartialFit("the first passages", np.nan, float(-np.diff(np.log(first.height))[0]) / way)] if first else []
    out = tension_peaks(time, -stress, len(peaks.time) + 1)
    if first is not None and len(out.time) > 1 and _ends_between(time, stress, first.time[1], out.time[1]):
        passed = matched(time, -stress, out)
        lines["the compressions"] = _some(passed, passed.height > least)
    for name, some in lines.items():
        if len(some.time) < 2:
            continue
        passing = wave_speed(some.time, length, some.height).value
        found.append(PartialFit(name, passing, attenuation(*some, speed).value))
    return found


def first_passages(time: np.ndarray, stress: np.ndarray) -> Peaks | None:
    """The first compression and its reflection, fitted by shape; None where the pulse does not end in between.

    time, stress : (k,) s, evenly spaced, and any unit.
    """
    out, back = positive_peaks(time, -stress, 1), positive_peaks(time, stress, 1)
    if not len(out.time) or not len(back.time) or not _ends_between(time, stress, out.time[0], back.time[0]):
        return None
    between = 0.5 * (out.time[0] + back.time[0])
    upright = np.where(time < between, -stress, stress)
    return matched(time, upright, Peaks(*(np.concatenate(each) for each in zip(out, back, strict=True))))


def first_return(time: np.ndarray, stress: np.ndarray, position: float, length: float) -> Estimate | None:
    """Wave speed from the first passages, 2(L − x_g)/Δt; None where the first wave is not followed by its reflection.

    time, stress : (k,) s and any unit; position, length : m. The error corresponds to a quarter of a sample at either
    passage, and to half a sample at the crests of a pulse that has not ended when it comes back.
    """
    first, share = first_passages(time, stress), 0.25
    if first is None:
        share = 0.5
        out, back = positive_peaks(time, -stress, 1), positive_peaks(time, stress, 1)
        if not len(out.time) or not len(back.time):
            return None
        first = Peaks(np.array([out.time[0], back.time[0]]), np.ones(2))
    way, between = 2.0 * (length - position), float(np.diff(first.time)[0])
    if not between > 0.0:
        return None
    return Estimate(way / between, way / between * share * np.sqrt(2.0) * float(time[1] - time[0]) / between, 2)


def speed_of_fronts(time: np.ndarray, stress: np.ndarray, position: float, length: float) -> float | None:
    """Wave speed, m/s, from when the first compression and its reflection have risen to a fifth of their crests.

    A spall changes the reflection behind its front. None without a reflection of a fifth of the compression, or where
    the signal is not quiet before it for a tenth of the way back.

    time, stress : (k,) s and any unit; position, length : m.
    """
    if not stress.max() > RISEN * -stress.min():
        return None
    out, back = (_front(time, values) for values in (-stress, stress))
    if out is None or back is None or not back > out:
        return None
    before = (time < back) & (time > back - FREE_OF_WAVES * (back - out))
    quiet = float(np.abs(stress[before]).max(initial=0.0)) <= RISEN * -float(stress.min())
    return 2.0 * (length - position) / (back - out) if quiet else None


def _front(time: np.ndarray, values: np.ndarray) -> float | None:
    """Time at which a history (k,) last rises above a fifth of its largest value before it first reaches half of it."""
    below = np.flatnonzero(values[: rise(values)[1]] < RISEN * values.max())
    return float(time[below[-1]]) if len(below) else None


def _some(peaks: Peaks, chosen: np.ndarray) -> Peaks:
    """The peaks selected by a mask (k,), which may be shorter."""
    places = np.flatnonzero(chosen)
    return Peaks(peaks.time[places], peaks.height[places])


def _ends_between(time: np.ndarray, stress: np.ndarray, first: float, last: float) -> bool:
    """Whether a signal is small somewhere between two times."""
    between = np.abs(stress[(time > first) & (time < last)])
    return bool(len(between)) and float(between.min()) < ENDED * float(np.abs(stress).max())
