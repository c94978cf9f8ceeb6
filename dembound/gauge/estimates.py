"""Estimates from the signal of a gauge on a bar: wave speed, attenuation and spall strength (L section 3.3).

A compressive pulse enters a bar at x = 0 and runs to and fro between its free ends. A gauge in between measures it as
compression on the way out and as tension on the way back. Stresses are positive in tension, and may be strains or
voltages where the unit has no effect; positions are measured from the loaded end.
"""

from typing import Any, NamedTuple

import numpy as np

from dembound.errors import CaseError
from dembound.gauge.peaks import SMALLEST, Peaks, crest, denoised, first_fall, positive_peaks, width_of

ONSET = 0.01
"""Share of its largest compression at which a pulse begins."""

ENDED = 0.2
"""Share of its largest compression below which a pulse has ended when its reflection returns."""

LARGEST_OF_NOISE = 3.0
"""Expected largest of some tens of noise values, in standard deviations: a strength is the largest of so many
values.
"""

FEWEST = 3
"""Least number of samples of a history."""


class Estimate(NamedTuple):
    """A value from a line through `points` points, with a standard error for three or more.

    A value without points was given.
    """

    value: float
    error: float = np.nan
    points: int = 0


def tension_peaks(time: np.ndarray, stress: np.ndarray, count: int | None = None) -> Peaks:
    """Successive tension peaks at a gauge between free ends, 2L/c apart, found by `positive_peaks`.

    Tension below `SMALLEST` of the compression everywhere is an oscillation behind a pulse that has not returned,
    and not a peak.

    Parameters
    ----------
    time, stress : (k,) s, evenly spaced, and any unit.
    count : number of first peaks to use; all by default.
    """
    rings = stress.max() < SMALLEST * np.abs(stress).max()
    return positive_peaks(time, stress, 0 if rings else count)


def wave_speed(peak_times: np.ndarray, length: float, weights: np.ndarray | None = None) -> Estimate:
    """Speed c in m/s of a pulse that passes a gauge every 2L/c: from the straight line through the peaks' times.

    Parameters
    ----------
    peak_times : (k,) s.
    length : L, m.
    weights : (k,) of the times, equal by default. With noise they are the peaks' heights, as the time of a flat crest
    is less accurate.

    Raises CaseError for fewer than two times.
    """
    if len(peak_times) < 2:
        raise CaseError([f"--wave-speed: needs two tension peaks to be estimated, {len(peak_times)} found; give it"])
    weights = np.ones(len(peak_times)) if weights is None else weights
    spacing = _slope(np.arange(len(peak_times)), peak_times, weights)
    speed = 2.0 * length / spacing.value
    return Estimate(speed, speed * spacing.error / spacing.value, spacing.points)


def attenuation(peak_times: np.ndarray, peak_heights: np.ndarray, speed: float) -> Estimate:
    """Coefficient α in 1/m of σ = σ_0 e^(−αx), x = ct (L eq. 19, β there): the slope of the heights' logarithms.

    Logarithms are weighted by height, as noise changes those of small heights more.

    Parameters
    ----------
    peak_times : (k,) s, two or more.
    peak_heights : (k,) in any unit, positive.
    speed : c, m/s.

    """
    slope = _slope(speed * peak_times, np.log(peak_heights), peak_heights)
    return slope._replace(value=-slope.value)


def incident_pulse(
    time: np.ndarray, stress: np.ndarray, gauge: float, length: float, speed: float, end: float | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Times (p,) and stresses (p,) of the incident pulse without reflections: the smoothed history (k,) up to a time.

    Parameters
    ----------
    time, stress : (k,) s and any unit.
    gauge, length : place of the gauge and length of the bar, m.
    speed : c, m/s.
    end : time in s up to which the history is used; by default when the pulse's front comes back from the free end.

    Raises CaseError when there is no compression, the end comes before it, or, without an end, the pulse has not ended
    when its front comes back; and for fewer than three samples.
    """
    largest = -stress.min()
    if not largest > 0.0:
        raise CaseError(["--scale: gives no compression, which must be negative; try its other sign"])
    begun, risen = rise(-stress)
    if end is None:
        end = float(time[begun]) + 2.0 * (length - gauge) / speed
        if end < time[risen] or abs(np.interp(end, time, stress)) > ENDED * largest:
            said = "--pulse-end: give it, the pulse has not ended when its reflection is back at the gauge"
            raise CaseError([f"{said}; or bending follows it, which the mean of two gauges on opposite faces lacks"])
    elif not end > time[risen]:
        raise CaseError([f"--pulse-end: is {end:g} s, must be after {time[risen]:g} s, when the pulse is half risen"])
    count = int(np.searchsorted(time, end, side="right"))
    if count < FEWEST:
        raise CaseError([f"--pulse-end: leaves {count} samples of the incident pulse, must leave three or more"])
    return time[:count], denoised(stress[:count], LARGEST_OF_NOISE)


def near_free_end(
    time: np.ndarray,
    stress: np.ndarray,
    gauge: float,
    length: float,
    speed: float,
    positions: Any,
    at_times: np.ndarray,
) -> np.ndarray:
    """Stress (q, k) at q positions (m) and k times (s) near a free end, without attenuation: a pulse and its image.

    σ(x, t) = s(t − (x − x_g)/c) − s(t − (2L − x − x_g)/c) (L section 3.3, fig. 11).

    Parameters
    ----------
    time, stress : (p,) the incident pulse s at the gauge, zero before and after; s and any unit.
    gauge, length : place x_g of the gauge and length L of the bar, m.
    speed : c, m/s.
    positions, at_times : (q,) m and (k,) s.
    """
    delays = _delays(gauge, length, speed, np.asarray(positions, dtype=float)[:, None])
    direct, mirrored = (np.interp(at_times - delay, time, stress, left=0.0, right=0.0) for delay in delays)
    return np.asarray(direct - mirrored)


def nominal_strength(
    time: np.ndarray, stress: np.ndarray, gauge: float, length: float, speed: float, position: float, noise: float = 0.0
) -> tuple[float, float, float]:
    """Largest tension at the spall (`position`, m) at any time, without attenuation; its time in s; a standard error.

    Without noise it is exact for a pulse of straight lines between its samples: the largest sum occurs at one of them,
    or at one of the image, and the error is 0. With white noise of a standard deviation it is the `crest` of the sum,
    in which the noise of the pulse and that of its image add where both are. See `near_free_end` for other arguments.
    """
    bar, there = (gauge, length, speed), np.array([position])
    direct, mirrored = _delays(*bar, position)
    if noise == 0.0:
        moments = np.concatenate([time + direct, time + mirrored])
        (tension,) = near_free_end(time, stress, *bar, there, moments)
        return float(tension.max()), float(moments[tension.argmax()]), 0.0
    step, delay = float(time[1] - time[0]), mirrored - direct
    moments = time[0] + direct + step * np.arange(len(time) + int(np.ceil(delay / step)))
    (tension,) = near_free_end(time, stress, *bar, there, moments)
    width = width_of(tension)
    alone = crest(tension, noise, width)
    begin, end = time[0] + mirrored, time[-1] + direct
    when = float(moments[0] + step * alone.place)
    height, error, place = crest(tension, np.sqrt(2.0) * noise, width) if begin < when < end else alone
    return height, float(moments[0] + step * place), error


def path_via_free_end(gauge: float, length: float, position: Any) -> Any:
    """Path length (m) from a gauge to the free end and back to a position (any shape): (L − x_g) + (L − x)."""
    return 2.0 * length - gauge - position


def attenuated_strength(nominal: float, coefficient: float, distance: float) -> float:
    """Nominal strength in Pa, attenuated over a distance in m: σ_1 = σ_0 e^(−αx) (L section 3.3)."""
    return float(nominal * np.exp(-coefficient * distance))


def pull_back_strength(time: np.ndarray, velocity: np.ndarray, density: float, speed: float, length: float) -> float:
    """Spall strength ½ρcΔV in Pa, ΔV the fall of the free end's velocity from first maximum to minimum (Novikov).

    Only the first arrival of the pulse is used: the end of an unbroken bar comes to rest and moves again when the pulse
    returns, 2L/c later.

    Parameters
    ----------
    time, velocity : (k,) of the free end, s, evenly spaced, and m/s, positive outwards.
    density, speed, length : kg/m³, c in m/s, and L of the bar in m.

    The result is nan if the velocity has no maximum with a minimum after it.
    """
    if not velocity.max() > 0.0:
        return np.nan
    begun, _ = rise(velocity)
    end = int(np.searchsorted(time, time[begun] + 2.0 * length / speed))
    return 0.5 * density * speed * first_fall(velocity[begun:end]) if end - begun >= FEWEST else np.nan


def _slope(x: np.ndarray, y: np.ndarray, weights: np.ndarray) -> Estimate:
    """Slope of the straight line through points (k,) by least squares, each deviation times its weight."""
    if len(x) == 2:
        return Estimate(float((y[1] - y[0]) / (x[1] - x[0])), points=2)
    (slope, _), covariance = np.polyfit(x, y, 1, w=weights, cov=True)
    return Estimate(float(slope), float(np.sqrt(covariance[0, 0])), len(x))


def rise(values: np.ndarray) -> tuple[int, int]:
    """Indices at which a history (k,), positive somewhere, begins to rise, and reaches half its largest value."""
    largest = values.max()
    risen = int(np.argmax(values > 0.5 * largest))
    quiet = np.flatnonzero(values[:risen] < ONSET * largest)
    return (int(quiet[-1]) + 1 if len(quiet) else 0), risen


def _delays(gauge: float, length: float, speed: float, position: Any) -> tuple[Any, Any]:
    """Travel times in s from the gauge to a position (any shape): directly, and via the free end."""
    return (position - gauge) / speed, path_via_free_end(gauge, length, position) / speed
