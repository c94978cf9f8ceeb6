"""Peaks of sampled histories with noise; times and heights of passages of one pulse from its shape: a matched filter.

Noise shifts the crest of a peak much more than its shape. Each passage is therefore fitted by a·g(t − τ), with g
the first tension peak of the smoothed history; noise σ then leaves an error σ/√(Σ ġ²)/a of a time and σ/√(Σ g²) of a
height, sums over all samples of the peak.
"""

from typing import NamedTuple

import numpy as np

SMALLEST = 0.01
"""Least height of a peak over the largest value."""

NOISE_FACTOR = 5.0
"""Least height of a peak in standard deviations of the noise: noise alone reaches it in one of some 10⁶ samples."""

LEVELS = 1.5
"""Least height of a peak in steps of the digitiser: rounding alone makes one step."""

FEW_LEVELS = 8
"""Samples per distinct value above which a history comes from a digitiser."""

CREST = 0.125
"""Range of the smoothing on either side, in widths of the largest peak at half its height.

The smoothing lowers a crest of two straight slopes by 3/16 of their mean fall over that range. With equal slopes this
is (3/16)(1/8) = 2.3 % of the crest, the same share for all peaks of a pulse.
"""

DIP = 0.05
"""Least height of a maximum, or depth of a minimum, over the whole range of a history."""


NARROWEST, WIDER, WIDE = 3, 1.2, 0.25
"""Reach (samples) of the first parabola of a crest, the factor from one reach to the next, and the reach of the
smoothing that finds its place, in widths: with a shorter one the place has a chance maximum of the noise."""

RAISED, SHORTER = 2.0, 1.5
"""Standard errors by which a crest must rise to be followed, and its last range over the one whose top is taken."""


class Crest(NamedTuple):
    """The largest value of a history without its noise, its standard error, and its place in samples."""

    height: float
    error: float
    place: float


class Peaks(NamedTuple):
    """Peaks in the order of time: time (k,) s and height (k,) in the history's unit."""

    time: np.ndarray
    height: np.ndarray


def positive_peaks(time: np.ndarray, values: np.ndarray, count: int | None = None) -> Peaks:
    """Peaks of a history above zero.

    The history is smoothed by parabolas over a quarter of its largest peak's width, and a peak is a maximum of the
    smoothed history, from a parabola through the three samples there. Its prominence must be at least `SMALLEST` of the
    largest peak, `NOISE_FACTOR` times the noise, and `LEVELS` steps of the digitiser. It must be at least half as wide
    as the largest peak, and its distance from a higher one must exceed that width. The
    position of a long flat crest depends on the noise.

    Parameters
    ----------
    time : (k,) s, evenly spaced.
    values : (k,) in any unit.
    count : number of first peaks to use; all by default.
    """
    from scipy.signal import find_peaks  # imported here, as it takes a second and other commands do not need it

    if not values.max() > 0.0:
        return Peaks(np.empty(0), np.empty(0))
    width = width_of(values)
    reach = max(1, round(CREST * width))
    smoothed = smooth(values, reach)
    noise = NOISE_FACTOR * white_noise(values) * noise_left(reach)
    least = max(SMALLEST * smoothed.max(), noise, LEVELS * digit(values))
    summits, _ = find_peaks(np.maximum(smoothed, 0.0), prominence=least, width=0.5 * width, distance=width)
    places = summits[:count]
    before, here, after = (smoothed[places + shift] for shift in (-1, 0, 1))
    bend = before - 2.0 * here + after
    offset = np.divide(0.5 * (before - after), bend, out=np.zeros(len(places)), where=bend != 0.0)
    times = np.interp(places + offset, np.arange(len(time)), time)
    return Peaks(times, here - 0.25 * (before - after) * offset)


def denoised(values: np.ndarray, deviations: float = 1.0) -> np.ndarray:
    """A history (k,) smoothed by parabolas over a range chosen by its noise; without noise it is not changed.

    deviations : loss of a crest by smoothing, in standard deviations of noise. For a largest value, which noise raises
    by more than that, a larger loss is allowed.
    """
    sizes = np.abs(values)
    return smooth(values, _worthwhile_reach(deviations * white_noise(values) / sizes.max(), width_of(sizes)))


def crest(values: np.ndarray, noise: float, width: int) -> Crest:
    """The crest of an evenly sampled history (k,) with white noise of a standard deviation > 0, by local polynomials.

    The largest sample is too high, by some standard deviations; a smoothed crest is too low. At the place of the crest
    smoothed over a quarter of its width, parabolas over longer and longer ranges agree within their standard errors
    until their bias grows as large as these (the intersection of confidence intervals). Over the last of these ranges a
    polynomial of the fourth degree has a top, at whose place all is repeated while this raises it by more than noise
    does: smoothing shifts crests with unlike sides. Over a range shorter by `SHORTER` this top has hardly any bias of
    smooth crests beside its standard error. Bias that grows as the range, as of corners, is 1/(`SHORTER` − 1) of the
    change between both ranges, which is added to the error. The top of a curve with a slope of variance s² and a
    curvature κ is too high by s²/2κ, which is subtracted.

    width : of the crest at half its height, samples; the range reaches up to half of it on either side.
    """
    found: list[tuple[Crest, int, int]] = []
    start = int(smooth(values, max(NARROWEST, round(WIDE * width))).argmax())
    while len(found) < 2 or found[-1][0].height > found[-2][0].height + RAISED * found[-1][0].error:
        reach = _agreeing_reach(values, start, noise, width)
        found.append((_top(values, start, reach, 4, noise, 0.5), start, reach))
        start = round(found[-1][0].place)
    longer, start, reach = found[-2]
    height, error, place = _top(values, start, round(reach / SHORTER), 4, noise, 0.5)
    return Crest(height, float(np.hypot(error, (longer.height - height) / (SHORTER - 1.0))), place)


def _agreeing_reach(values: np.ndarray, start: int, noise: float, width: int) -> int:
    """The longest reach, of up to half the width, at which parabolas agree with all shorter ones at a start."""
    low, high, best, reach = -np.inf, np.inf, NARROWEST, NARROWEST
    while reach <= width // 2:
        height, error, _ = _top(values, start, reach, 2, noise, 0.0)
        low, high = max(low, height - error), min(high, height + error)
        if low > high:
            break
        best, reach = reach, max(reach + 1, int(WIDER * reach))
    return best


def _top(values: np.ndarray, start: int, reach: int, degree: int, noise: float, within: float) -> Crest:
    """The top, within a share of the range, of the polynomial fitted to the samples up to `reach` away from a start."""
    first = max(0, start - reach)
    here = values[first : start + reach + 1]
    powers = np.arange(min(degree, len(here) - 1) + 1)
    x = (first - start + np.arange(len(here))) / reach
    matrix = x[:, None] ** powers
    covariance = np.linalg.inv(matrix.T @ matrix)
    shares = covariance @ (matrix.T @ here)
    at = np.linspace(max(x[0], -within), min(x[-1], within), 4 * reach + 1 if within > 0.0 else 1)
    curve = at[:, None] ** powers @ shares
    best = at[curve.argmax()]
    row, slope = best**powers, powers * best ** np.maximum(powers - 1, 0)
    bend = -float(powers * (powers - 1) * best ** np.maximum(powers - 2, 0) @ shares)
    error = noise * float(np.sqrt(row @ covariance @ row))
    raised = 0.5 * noise**2 * float(slope @ covariance @ slope)
    raised = 0.0 if within == 0.0 else raised / bend if raised < error * bend else error
    return Crest(float(curve.max()) - raised, error, start + reach * best)


def first_fall(values: np.ndarray) -> float:
    """Fall of an evenly sampled history (k,) from its first maximum to the minimum after it; nan without these.

    The prominence of both must be at least `DIP` of the range and twice `NOISE_FACTOR` times the noise. With noise both
    are a `crest`.
    """
    noise = white_noise(values)
    least = max(DIP * float(np.ptp(values)), 2.0 * NOISE_FACTOR * noise)
    turns = _turns(values, least) if least > 0.0 else []
    if len(turns) < 2:
        return np.nan
    top, bottom = turns[:2]
    fall, width = float(values[top] - values[bottom]), bottom - top
    if _worthwhile_reach(noise / fall, width) == 1:
        return fall
    middle = 0.5 * (values[top] + values[bottom])
    around = [slice(max(place - width, 0), place + width + 1) for place in (top, bottom)]
    highest, lowest = (sense * (values[each] - middle) for sense, each in zip((1.0, -1.0), around, strict=True))
    return crest(highest, noise, width).height + crest(lowest, noise, width).height


def _turns(values: np.ndarray, least: float) -> list[int]:
    """Samples of tops and bottoms in turn, beginning with a top, whose prominences are at least `least` > 0.

    A turn is found where the history has gone back by `least` from its extreme since the turn before.
    """
    found, sense, place, extreme = [], -1.0, 0, float(values[0])  # the first is the depth before the first top
    for here, value in enumerate(values.tolist()):
        ahead = sense * (value - extreme)
        if ahead <= -least:
            found.append(place)
            sense = -sense
        if ahead > 0.0 or ahead <= -least:
            place, extreme = here, value
    return found[1:]


def width_of(values: np.ndarray) -> int:
    """Number of samples around the largest that are above half of it."""
    crest = int(values.argmax())
    low = np.flatnonzero(values < 0.5 * values[crest])
    return int(low[low > crest].min(initial=len(values)) - low[low < crest].max(initial=-1)) - 1


def longest(there: np.ndarray) -> tuple[int, int] | None:
    """First sample, and the one after the last, of the longest run of true values (n,); None without any."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], there.astype(int), [0]])))
    if not len(edges):
        return None
    longest = int((edges[1::2] - edges[::2]).argmax())
    return int(edges[2 * longest]), int(edges[2 * longest + 1])


def white_noise(values: np.ndarray) -> float:
    """Standard deviation of white noise: from the median second difference, which is small for a smooth history."""
    return float(1.4826 * np.median(np.abs(np.diff(values, 2))) / np.sqrt(6.0))


def digit(values: np.ndarray) -> float:
    """The step of the digitiser of a history (k,); 0 where values are too many to be its levels."""
    levels = np.unique(values)
    return float(np.diff(levels).min()) if 1 < len(levels) * FEW_LEVELS <= len(values) else 0.0


def noise_worth(values: np.ndarray, deviations: float) -> float:
    """The white noise of a history (k,), a standard deviation; 0 if `denoised` would not change the history."""
    sizes, noise = np.abs(values), white_noise(values)
    return noise if _worthwhile_reach(deviations * noise / sizes.max(), width_of(sizes)) > 1 else 0.0


def _worthwhile_reach(noise: float, width: int) -> int:
    """Range r of the smoothing, in samples, at which the loss of a crest equals the remaining noise.

    A crest of two straight slopes, w samples wide at half its height, loses (3/16)(r/w) of its height, and 3/√(8r) of
    the noise remains.
    """
    return max(1, round((np.sqrt(32.0) * noise * width) ** (2.0 / 3.0)))


def smooth(values: np.ndarray, reach: int) -> np.ndarray:
    """Each value from a parabola fitted to all samples up to `reach` away; with a reach of one nothing changes.

    The reach is at most that of a parabola over the whole history.
    """
    reach = min(reach, (len(values) - 1) // 2)
    if reach <= 1:
        return values
    from scipy.signal import savgol_filter

    return savgol_filter(values, 2 * reach + 1, 2)


def noise_left(reach: int) -> float:
    """Share of white noise that remains after `smooth`: the root of its middle coefficient (least squares)."""
    return float(np.sqrt(3.0 * (3 * reach**2 + 3 * reach - 1) / ((2 * reach - 1) * (2 * reach + 1) * (2 * reach + 3))))


FOOT = 0.1
"""Height over the crest's at which the shape of a peak ends."""

RANGE = 0.5
"""Largest shift of a passage from its crest, in widths of the first one."""


def matched(time: np.ndarray, values: np.ndarray, peaks: Peaks) -> Peaks:
    """The peaks of a history with times and heights at which the shape of the first one fits them best.

    Parameters
    ----------
    time, values : (k,) s, evenly spaced, and any unit. peaks : of this history, by `peaks.positive_peaks`. A peak whose
    whole shape is not within the history does not change.
    """
    if len(peaks.time) < 2:
        return peaks
    width = width_of(values)
    reach = max(1, round(CREST * width))
    smoothed = smooth(values, reach)
    places = np.rint(np.interp(peaks.time, time, np.arange(len(time)))).astype(int)
    low = np.flatnonzero(smoothed < FOOT * smoothed[places[0]])
    first, last = int(low[low < places[0]].max(initial=-1)) + 1, int(low[low > places[0]].min(initial=len(values)))
    shape = smoothed[first:last]
    step = float(time[1] - time[0])
    times, heights = peaks.time.copy(), peaks.height.copy()
    for index, place in enumerate(places):
        shifts = np.arange(-round(RANGE * width) - 1, round(RANGE * width) + 2) + place - places[0]
        if first + shifts[0] < 0 or last + shifts[-1] > len(values):
            continue
        fits = np.array([smoothed[first + shift : last + shift] @ shape for shift in shifts]) / (shape @ shape)
        best = int(np.clip(fits.argmax(), 1, len(fits) - 2))
        before, here, after = fits[best - 1 : best + 2]
        bend = before - 2.0 * here + after
        offset = 0.5 * (before - after) / bend if bend < 0.0 else 0.0
        times[index] = peaks.time[0] + step * (shifts[best] + offset)
        heights[index] = peaks.height[0] * (here - 0.25 * (before - after) * offset)
    return Peaks(times, heights) if (heights > 0.0).all() else peaks
