"""The baseline of a signal, recorded where no wave passes the gauge: an offset, a drift, and mains hum.

It is fitted by least squares to the *quiet* samples: those before the trigger and between passages of the pulse. As
these are known only with the baseline, the first fit is one of least absolute deviations to all samples, which passages
hardly change if they take less than half of the time; then selection of quiet samples and fit alternate. In a record
with longer waves only an offset is fitted, to its beginning.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dembound.gauge.peaks import CREST, noise_left, smooth, white_noise, width_of

MAINS = (50.0, 60.0)
"""Frequencies of hum, Hz; each is fitted with the harmonics below."""

HARMONICS = (1, 2, 3)
"""Harmonics of the mains that are fitted to records longer than a period."""

SHORTEST = 0.05
"""Periods of the mains in a record below which hum is a drift in it."""

LEAST = 0.003
"""Largest baseline, over the largest value, that is not removed: it changes α by some parts in a thousand."""

SIGNIFICANT = 5.0
"""Least size of a baseline over its standard error."""

QUIET = 0.01
"""Largest deviation of quiet samples from the baseline, over the largest value; noise increases it."""

MOST_QUIET_NOISE = 5.0
"""The largest noise of a quiet part, in standard deviations of the smoothed noise."""

FEWEST_QUIET = 20
"""Least number of quiet samples for a baseline."""

SPREAD = 0.5
"""Part of the record that quiet samples must extend over for a drift or hum to be fitted."""

ROUNDS = 4
"""Iterations of fit and selection of quiet samples; the second already changes little."""

BEGINNING = 20
"""Inverse of the part of the record whose median is the offset where it has no other quiet samples."""

TRIED = 4000
"""Number of samples of the first fit, enough for a few terms."""


class Terms(NamedTuple):
    """Terms of a baseline: their name, and the functions (k, m) of time."""

    name: str
    functions: np.ndarray


@dataclass(frozen=True)
class Baseline:
    """The baseline of a signal (k,).

    quiet : (k,) where no wave passes. before : number of quiet samples before the first wave. values : (k,) the fit.
    worthwhile : whether it is large enough to be removed. names : of its terms. functions : (k, m) and covariance : (m,
    m) of its uncertainty.
    """

    quiet: np.ndarray
    before: int
    values: np.ndarray
    worthwhile: bool
    names: tuple[str, ...]
    functions: np.ndarray
    covariance: np.ndarray


def find_baseline(
    time: np.ndarray, values: np.ndarray, *, drift: bool = True, mains: tuple[float, ...] = MAINS
) -> Baseline | None:
    """The baseline of a signal; None without quiet samples.

    Of offset, drift and hum only significant terms are fitted, of five standard errors or more. A record whose
    quiet samples are only at its beginning gives an offset only.

    Parameters
    ----------
    time, values : (k,) s, evenly spaced, and any unit. drift : whether a drift may be fitted. mains : frequencies, Hz.
    """
    offset = Terms("offset", np.ones((len(time), 1)))
    possible = [Terms("drift", np.linspace(-1.0, 1.0, len(time))[:, None])] if drift else []
    hums = _hums(time, mains)
    candidates = [[offset, *possible, each] for each in hums] or [[offset, *possible]]
    fits = [_absolute_fit(_joined(terms), values) for terms in candidates]
    best = int(np.argmin([float(np.abs(values - fitted).sum()) for fitted in fits]))
    found = _settled(fits[best], offset, candidates[best][1:], values)
    if found is None or not found.before:
        level = float(np.median(values[: max(FEWEST_QUIET, len(values) // BEGINNING)]))
        found = _settled(np.full(len(values), level), offset, [], values, only_before=True) or found
    return found


def _settled(
    fit: np.ndarray, offset: Terms, possible: list[Terms], values: np.ndarray, *, only_before: bool = False
) -> Baseline | None:
    """The baseline of a signal (k,) from a first fit (k,); only_before: from its beginning only."""
    for _ in range(ROUNDS):
        quiet = quiet_samples(values - fit)
        before = int(np.argmin(quiet)) if not quiet.all() else len(quiet)
        if only_before:
            quiet[before:] = False
        if quiet.sum() < FEWEST_QUIET:
            return None
        chosen = _significant(offset, possible if _is_spread(quiet) else [], quiet, values)
        fit, functions, covariance = _fit(chosen, quiet, values)
    size = float(np.abs(fit).max())
    error = float(np.sqrt(np.einsum("km,mn,kn->k", functions, covariance, functions).max()))
    worthwhile = size > max(LEAST * np.abs(values - fit).max(), SIGNIFICANT * error)
    return Baseline(quiet, before, fit, bool(worthwhile), tuple(terms.name for terms in chosen), functions, covariance)


def quiet_samples(values: np.ndarray) -> np.ndarray:
    """Mask (k,) of samples at which a signal without baseline is within noise, a quarter width from any passage."""
    sizes = np.abs(values)
    width = max(2, width_of(sizes))
    reach = max(1, round(CREST * width))
    smoothed = np.abs(smooth(values, reach)) if 2 * reach + 1 < len(values) else sizes
    noise = white_noise(values) * noise_left(reach)
    loud = smoothed > max(QUIET * smoothed.max(), MOST_QUIET_NOISE * noise)
    around = np.convolve(loud, np.ones(max(1, width // 2)), mode="same") > 0.5
    return ~around


def _hums(time: np.ndarray, mains: tuple[float, ...]) -> list[Terms]:
    """Sines and cosines of the mains and of their harmonics of which the record has a period.

    In a record of less than a period all mains are the same slow curve, and only the first is used; in a record of less
    than a twentieth of a period none is used.
    """
    length, found = float(time[-1] - time[0]), []
    for frequency in mains if max(mains, default=0.0) * length > 1.0 else mains[:1]:
        orders = [order for order in HARMONICS if order == 1 or frequency * length > 1.0]
        phases = 2.0 * np.pi * frequency * np.outer(time - time[0], orders)
        name = f"{frequency:g} Hz hum" if frequency * length > 1.0 else f"slow curve as of {frequency:g} Hz hum"
        if frequency * length > SHORTEST:
            found.append(Terms(name, np.hstack([np.sin(phases), np.cos(phases)])))
    return found


def _joined(terms: list[Terms]) -> np.ndarray:
    """All functions (k, m) of terms."""
    return np.hstack([each.functions for each in terms])


def _absolute_fit(functions: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The combination (k,) of functions with the least sum of absolute deviations, by reweighted least squares."""
    step = max(1, len(values) // TRIED)
    few, tried = functions[::step], values[::step]
    smallest = 1e-4 * float(np.ptp(values))
    weights = np.ones(len(tried))
    for _ in range(50):
        shares = np.linalg.lstsq(few * weights[:, None], tried * weights, rcond=None)[0]
        weights = 1.0 / np.sqrt(np.maximum(np.abs(tried - few @ shares), smallest))
    return functions @ shares


def _is_spread(quiet: np.ndarray) -> bool:
    """Whether quiet samples extend over enough of the record, in its last part too, to show a drift."""
    places = np.flatnonzero(quiet)
    return bool(np.ptp(places) > SPREAD * len(quiet) and np.mean(places > 0.5 * len(quiet)) > 0.1)


def _significant(offset: Terms, possible: list[Terms], quiet: np.ndarray, values: np.ndarray) -> list[Terms]:
    """The offset and the possible terms that reduce the deviations of quiet samples by more than noise does."""
    chosen, left = [offset], list(possible)
    while left:
        now = _sum_of_squares(chosen, quiet, values)
        sums = [_sum_of_squares([*chosen, each], quiet, values) for each in left]
        best = int(np.argmin(sums))
        freedom = quiet.sum() - _joined([*chosen, left[best]]).shape[1]
        gain = (now - sums[best]) / max(sums[best] / max(freedom, 1), 1e-300) / left[best].functions.shape[1]
        if gain < SIGNIFICANT**2:
            break
        chosen.append(left.pop(best))
    return chosen


def _sum_of_squares(terms: list[Terms], quiet: np.ndarray, values: np.ndarray) -> float:
    """Sum of squared deviations of quiet samples from their fit."""
    functions = _joined(terms)[quiet]
    shares = np.linalg.lstsq(functions, values[quiet], rcond=None)[0]
    return float(np.sum((values[quiet] - functions @ shares) ** 2))


def _fit(terms: list[Terms], quiet: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The fit (k,) to quiet samples, its functions (k, m) and the covariance (m, m) of their shares."""
    functions = _joined(terms)
    shares = np.linalg.lstsq(functions[quiet], values[quiet], rcond=None)[0]
    fit = functions @ shares
    freedom = max(int(quiet.sum()) - functions.shape[1], 1)
    variance = float(np.sum((values - fit)[quiet] ** 2)) / freedom
    return fit, functions, variance * np.linalg.pinv(functions[quiet].T @ functions[quiet])
