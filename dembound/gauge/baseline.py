"""The baseline of a measured signal, an offset and a drift, and its removal together with filters.

Filters shift no phase: they run forwards and backwards, so that a wave stays where it is in time.

The baseline is fitted by least squares to the *quiet* samples, at which no wave passes the gauge. As these are known
only with the baseline, the first fit is one of least absolute deviations to all samples, which passages hardly change
if they take less than half of the time; then selection of quiet samples and fit alternate. In a record with longer
waves only an offset is fitted, to its beginning.
"""

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from dembound.errors import CaseError
from dembound.gauge.peaks import CREST, noise_left, smooth, white_noise, width_of
from dembound.gauge.reading.signal import Signal
from dembound.words import percent

ORDER = 4
"""Order of the Butterworth filters in one direction; both directions together have 6 dB at the corner."""

QUALITY = 10.0
"""Frequency of a notch over its width at 3 dB."""

PERIODS = 3.0
"""Least number of periods of every filter frequency in a record."""


@dataclass(frozen=True)
class Filters:
    """Corners in Hz of the filters of a signal; None and empty for none.

    low_pass, high_pass : of the lower and the upper range that remains. notches : frequencies that are taken out.
    order : of the Butterworth filters in one direction.
    """

    low_pass: float | None = None
    high_pass: float | None = None
    notches: tuple[float, ...] = ()
    order: int = ORDER

    def apply(self, time: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, list[str]]:
        """The filtered signal (k,) at even times (k,) s, and what was done.

        Raises CaseError for corners above the Nyquist frequency or of waves too long for the record.
        """
        from scipy.signal import butter, iirnotch, sosfiltfilt, tf2sos

        rate = (len(time) - 1) / float(time[-1] - time[0])
        self.require(rate, len(time))
        notes = []

        def both_ways(sections: np.ndarray, length: float) -> np.ndarray:
            """The signal, continued at its ends by its mirror images over the length of the response."""
            return np.asarray(sosfiltfilt(sections, values, padlen=min(len(values) - 1, int(3.0 * length))))

        for corner, kind in ((self.high_pass, "high"), (self.low_pass, "low")):
            if corner is not None:
                values = both_ways(butter(self.order, corner, kind, fs=rate, output="sos"), rate / corner)
                words = f"{kind} pass at {corner:g} Hz (6 dB), Butterworth of order {self.order}"
                notes.append(f"filter: {words} forwards and backwards")
        for notch in self.notches:
            values = both_ways(tf2sos(*iirnotch(notch, QUALITY, fs=rate)), QUALITY * rate / notch)
            notes.append(f"filter: notch at {notch:g} Hz, {notch / QUALITY:g} Hz wide, forwards and backwards")
        return values, notes

    def require(self, rate: float, count: int) -> None:
        """Raise CaseError for corners that a record of so many samples does not have; rate : of them, Hz."""
        low, high, least, most = self.low_pass, self.high_pass, PERIODS * rate / count, 0.5 * rate
        corners = [("--low-pass", low), ("--high-pass", high), *(("--notch", notch) for notch in self.notches)]
        must = f"must be from {least:.3g} to below {most:.3g} Hz in this record"
        problems = [
            f"{option}: is {corner:g} Hz, {must}"
            for option, corner in corners
            if corner is not None and not least <= corner < most
        ]
        if low is not None and high is not None and not high < low:
            problems.append(f"--high-pass: is {high:g} Hz, must be below the low pass, {low:g} Hz")
        if problems:
            raise CaseError(problems)


LEAST, SIGNIFICANT = 0.003, 5.0
"""Largest baseline that is not removed: over the largest value, where it changes α by some parts in a thousand, and in
standard errors."""

QUIET = 0.01
"""Largest deviation of quiet samples from the baseline, over the largest value; noise increases it."""

MOST_QUIET_NOISE = 5.0
"""The largest noise of a quiet part, in standard deviations of the smoothed noise."""

FEWEST_QUIET = 20
"""Least number of quiet samples for a baseline."""

SPREAD = 0.5
"""Part of the record that quiet samples must extend over for a drift to be fitted."""

ROUNDS = 4
"""Iterations of fit and selection of quiet samples; the second already changes little."""

BEGINNING = 20
"""Inverse of the part of the record whose median is the offset where it has no other quiet samples."""

TRIED = 4000
"""Number of samples of the first fit, enough for two terms."""


@dataclass(frozen=True)
class Treatment:
    """Removal of the baseline from a signal, with or without drift, and of frequencies by filters."""

    baseline: bool = True
    drift: bool = True
    filters: Filters = field(default_factory=Filters)


class Baseline(NamedTuple):
    """A baseline: its values (k,), whether it has a drift, where (k,) no wave passes, and whether to remove it."""

    values: np.ndarray
    drifts: bool
    quiet: np.ndarray
    worthwhile: bool


def treated(signal: Signal, treatment: Treatment | None = None) -> Signal:
    """The signal without its baseline, filtered, with notes on the treatment.

    A baseline below 0.3 % of the signal or below five of its standard errors is not removed. Raises CaseError for
    filters that the record does not allow.
    """
    treatment = treatment or Treatment()
    values, notes = signal.values, list(signal.notes)
    if treatment.baseline:
        found = find_baseline(values, drift=treatment.drift)
        notes.append(_in_words(found, signal))
        if found is not None and found.worthwhile:
            values = values - found.values
    values, filtered = treatment.filters.apply(signal.time, values)
    return replace(signal, values=values, notes=(*notes, *filtered))


def find_baseline(values: np.ndarray, *, drift: bool = True) -> Baseline | None:
    """The baseline of an evenly sampled signal (k,); None without quiet samples.

    drift : whether a drift may be fitted. A record that has no quiet samples before its first wave gives an offset.
    """
    count = len(values)
    terms = np.column_stack([np.ones(count), np.linspace(-1.0, 1.0, count)])[:, : 2 if drift else 1]
    found = _settled(values, terms, _absolute_fit(terms, values))
    if found is None or not found.quiet[0]:
        level = float(np.median(values[: max(FEWEST_QUIET, count // BEGINNING)]))
        found = _settled(values, terms[:, :1], np.full(count, level), only_before=True) or found
    return found


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


def _settled(values: np.ndarray, terms: np.ndarray, fit: np.ndarray, *, only_before: bool = False) -> Baseline | None:
    """The baseline of terms (k, m) from a first fit (k,); only_before: from the samples before the first wave."""
    for _ in range(ROUNDS):
        quiet = quiet_samples(values - fit)
        if only_before and not quiet.all():
            quiet[int(np.argmin(quiet)) :] = False
        if quiet.sum() < FEWEST_QUIET:
            return None
        used, fit = terms[:, :1], np.full(len(values), values[quiet].mean())
        places = np.flatnonzero(quiet)
        # over enough of the record, in its last part too, to show a drift
        if np.ptp(places) > SPREAD * len(quiet) and np.mean(places > 0.5 * len(quiet)) > 0.1:
            line = terms @ np.linalg.lstsq(terms[quiet], values[quiet], rcond=None)[0]
            least, most = (float(np.sum((values - each)[quiet] ** 2)) for each in (line, fit))
            if most - least > SIGNIFICANT**2 * least / quiet.sum():
                used, fit = terms, line
    rest = values - fit
    error = 2.0 * float(rest[quiet].std()) / np.sqrt(quiet.sum())  # at the ends of a drift
    worthwhile = np.abs(fit).max() > max(LEAST * np.abs(rest).max(), SIGNIFICANT * error)
    return Baseline(fit, used.shape[1] > 1, quiet, bool(worthwhile))


def _absolute_fit(terms: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The combination (k,) of terms (k, m) with the least sum of absolute deviations, by reweighted least squares."""
    step = max(1, len(values) // TRIED)
    few, tried = terms[::step], values[::step]
    weights = np.ones(len(tried))
    for _ in range(50):
        shares = np.linalg.lstsq(few * weights[:, None], tried * weights, rcond=None)[0]
        weights = 1.0 / np.sqrt(np.maximum(np.abs(tried - few @ shares), 1e-4 * np.ptp(values)))
    return terms @ shares


def _in_words(found: Baseline | None, signal: Signal) -> str:
    """The treatment of the baseline in words."""
    if found is None:
        return "baseline: not removed, as no part of the record is quiet"
    share = percent(np.abs(found.values).max() / np.abs(signal.values - found.values).max())
    if not found.worthwhile:
        return f"baseline: nothing to remove, {share} of the signal"
    what, lowest, highest = "offset and drift" * found.drifts or "offset", found.values.min(), found.values.max()
    return f"baseline: removed {what}, {lowest:.4g} to {highest:.4g} {signal.unit}, {share} of the signal"
