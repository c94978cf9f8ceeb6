"""What the samples of a file are, and signs of errors in a measured record."""

import math
import re
from collections.abc import Iterator

import numpy as np

from dembound.waves.unit_names import units_in
from dembound.waves.wave import amplitude_spectrum
from dembound.words import percent

FEWEST = 20
"""Samples below which a table is one of single points, joined by straight lines."""

EQUAL = 0.9
"""Share of equal steps from which a table was sampled, although samples may be lost."""

ROUNDED = 0.25
"""Deviation of times from even ones, in steps, that rounding in the file explains; a lost sample makes half a step."""

LOUD = 0.05
"""Share of the peak that is motion, no noise."""

FEWEST_TURNS = 6
"""Changes of sign from which a record oscillates."""

CUT = 0.02
"""Share of its peak by which a history may jump at its ends; of 0.02 the waves that the jump sends have 1/2500."""


def usual_step(times: np.ndarray) -> float:
    """The median time (s) between two samples at times (k,)."""
    return float(np.median(np.diff(times)))


def is_even(times: np.ndarray) -> bool:
    """Whether times (k,), which a file may have rounded, are evenly spaced."""
    even = np.linspace(times[0], times[-1], len(times))
    return bool(np.abs(times - even).max() < ROUNDED * (even[1] - even[0]))


def is_sampled(times: np.ndarray) -> bool:
    """Whether times (k,) are those of a measurement, from which samples may be lost, rather than of single points."""
    equal = np.isclose(np.diff(times), usual_step(times), rtol=0.01).mean()
    return len(times) >= FEWEST and bool(equal >= EQUAL or is_even(times))


def oscillates(values: np.ndarray) -> bool:
    """Whether values (k,) change their sign several times, noise left out."""
    loud = values[np.abs(values) > LOUD * np.abs(values).max()]
    return int(np.count_nonzero(np.diff(np.sign(loud)))) >= FEWEST_TURNS


def is_record(times: np.ndarray, values: np.ndarray) -> bool:
    """Whether samples are a record: evenly sampled, oscillating, with both ends near zero.

    The band-limited function through others, as of a one-sided pulse or a step, would ring beside their jumps.
    """
    ends = max(abs(values[0]), abs(values[-1]))
    rests = bool(ends <= CUT * np.abs(values).max())
    return len(times) >= FEWEST and is_even(times) and rests and oscillates(values)


LONGER = 3.0
"""Step over the usual step from which on it is a gap."""

FLAT = 3
"""Number of equal samples at the peak from which on it is clipped."""

RISE = (0.01, 0.5)
"""Last step before equal samples over the peak: smaller steps belong to a round crest, larger ones to square waves."""

LOST = 0.1
"""Largest loss at the mean frequency by straight lines between samples: 1 − sinc²(f Δt)."""

OUTSTANDING = 5.0
"""Ratio to other changes above which a change, or a drift, is not motion."""

WIDE = 0.6
"""Step over the peak above which it is not a change between two levels of a load in a record that does not
oscillate.
"""

TENTHS = 10
"""Number of parts of a record; its motion is over in the last one."""

NET = 0.25
"""Displacement by an offset of the last tenth over the whole record, over the largest displacement."""

WORDS = {"accelerations": r"acc|accel|accelerations?", "displacements": r"disp|displ|displacements?"}
"""Words of a header that say that its values are not velocities."""

READ_AS = {"m/s": "velocities", "Pa": "pressures", "N": "forces", "m/s²": "accelerations"}
"""Unit in which values are read -> their quantity."""


def doubts_of_header(header: str, read: str, factor: float) -> Iterator[str]:
    """Contradictions between the header of a file and its use, in words.

    header : the lines above the numbers. read : unit in which values are taken, one of `READ_AS`. factor : of the
    values; one other than ±1 is regarded as a conversion to this unit.
    """
    marked, bare, unknown = units_in(header, read)
    quantity, of_velocity, unchanged = READ_AS[read], read == "m/s", abs(factor) == 1.0
    times = (unit for unit in (*marked, *bare) if unit.quantity == "times")
    if unit := next((unit for unit in times if unit.size != 1.0), None):
        yield f"its header says {unit.spelled}, its times are read as s"
    named = [unit for unit in (*marked, *bare) if unit.quantity != "times"]
    if any(unit.quantity == quantity and math.isclose(unit.size, 1.0) for unit in named):
        return
    of_it = f"its values are read as {quantity} in {read}"
    if same := next((unit for unit in named if unit.quantity == quantity), None):
        if unchanged:
            says = f"its header says {same.spelled}, its values are read as {read}"
            yield f"{says}; for those write scale = {same.size:g}"
        return
    other = next(((unit.spelled, unit.quantity) for unit in named), None)
    other = other or (_quantity_in_words(header) if of_velocity else None)
    if other is not None and (unchanged or (of_velocity and other[1] in WORDS)):
        yield f'its header says "{other[0]}", likely {other[1]}; {of_it}'
    elif other is None and unchanged and unknown:
        yield f'its header says "{unknown[-1]}" in brackets, no unit that is known here; {of_it}, its times in s'


def _quantity_in_words(header: str) -> tuple[str, str] | None:
    """A word of a header that says what its values are, and what it says; None without one."""
    words = [word for word in re.split(r"[\s,;:\"'()\[\]_]+", header.lower()) if word]
    found = ((word, quantity) for quantity, pattern in WORDS.items() for word in words if re.fullmatch(pattern, word))
    return next(found, None)


def doubts_of_samples(times: np.ndarray, values: np.ndarray, *, by_lines: bool = True) -> Iterator[str]:
    """Signs of lost samples, a clipped peak and others in a record (k,) at times (k,) s, in words.

    by_lines : whether straight lines join the samples.
    """
    if not is_sampled(times):
        return
    steps, usual, peak = np.diff(times), usual_step(times), float(np.abs(values).max())
    loud = np.abs(values) > LOUD * peak
    gaps = (steps > LONGER * usual) & (loud[1:] | loud[:-1])
    if gaps.any():
        worst = int(np.argmax(np.where(gaps, steps, 0.0)))
        yield (
            f"has no sample from {times[worst]:.4g} to {times[worst + 1]:.4g} s, {steps[worst] / usual:.3g} times its "
            "usual step, while it moves; a straight line is taken"
        )
        return
    yield from _clipped(values, peak)
    spikes = list(_spike(times, values, peak))
    yield from spikes
    turns = oscillates(values)
    if not spikes:
        yield from _jump(times, values, peak, turns=turns)
    if not turns:
        return
    frequencies, amplitudes = amplitude_spectrum(values, usual)
    mean = float(frequencies @ amplitudes**2 / (amplitudes**2).sum())
    if by_lines:
        yield from _coarse(mean, usual)
    if mean * (times[-1] - times[0]) > TENTHS:  # else its last tenth is part of a period
        yield from _offset(times, values)


def _clipped(values: np.ndarray, peak: float) -> Iterator[str]:
    """A message about several flat crests at the peak."""
    at_peak = np.concatenate([[False], np.abs(values) >= (1.0 - 1e-9) * peak, [False]])
    begins, ends = np.flatnonzero(~at_peak[:-1] & at_peak[1:]), np.flatnonzero(at_peak[:-1] & ~at_peak[1:])
    rise = np.array([abs(values[b] - values[b - 1]) / peak if b > 0 else 1.0 for b in begins])
    flat = (ends - begins >= FLAT) & (rise > RISE[0]) & (rise < RISE[1])
    if np.count_nonzero(flat) > 1:
        yield f"is equal to ±{peak:.4g} for {FLAT} samples and more, {np.count_nonzero(flat)} times: is it clipped?"


def _coarse(mean: float, step: float) -> Iterator[str]:
    """A message if samples are too far apart (s) for straight lines at the mean frequency (Hz)."""
    loss = 1.0 - float(np.sinc(mean * step)) ** 2
    if loss > LOST:
        yield (
            f"has {1.0 / (mean * step):.2g} samples in a period of its mean frequency, {mean:.3g} Hz; straight lines "
            f"between them take {percent(loss)} of it: take a finer record, or even samples that begin and end near 0 "
            'with interpolation = "band_limited"'
        )


def _spike(times: np.ndarray, values: np.ndarray, peak: float) -> Iterator[str]:
    """A message about a sample far from its neighbours, which are close to each other and to theirs."""
    beside = np.abs(values[2:-2] - 0.5 * (values[3:-1] + values[1:-3]))
    others = [values[1:-3] - values[:-4], values[3:-1] - values[1:-3], values[4:] - values[3:-1]]
    worst = int(beside.argmax())
    usual = max(*(abs(each[worst]) for each in others), np.sort(beside)[-4])  # a spike is in three of these
    if beside[worst] > max(LOUD * peak, OUTSTANDING * usual):
        yield f"has one sample far from its neighbours, {values[worst + 2]:.4g} at {times[worst + 2]:.4g} s: a spike?"


def _jump(times: np.ndarray, values: np.ndarray, peak: float, *, turns: bool) -> Iterator[str]:
    """Steps far beyond all others: one of a record that oscillates, or one or two within the motion of any other.

    A pulse may begin or end with a step, from or to rest, and square waves have more than two steps.
    """
    changes = np.abs(np.diff(values))
    loud = np.abs(values) > LOUD * peak
    within, largest = loud[1:] & loud[:-1], np.sort(changes)
    anywhere = int(changes.argmax()), float(largest[-2]), LOUD
    for worst, others, least in (
        *([anywhere] if turns else []),
        (int(np.where(within, changes, 0.0).argmax()), largest[-3], WIDE),
    ):
        if others > 0.0 and changes[worst] > max(least * peak, OUTSTANDING * others):
            flips = within[worst] and 2.0 * abs(values[worst] + values[worst + 1]) < changes[worst]
            cause = "does its sign change there, or are samples lost?" if flips else "are samples lost?"
            size = f"{changes[worst]:.4g}, {changes[worst] / others:.2g} times any other step"
            yield f"jumps by {size}, at {times[worst]:.4g} s: {cause}"
            return


def _offset(times: np.ndarray, values: np.ndarray) -> Iterator[str]:
    """A message about a mean at the end that causes much of the displacement and is not due to oscillations."""
    displacement = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(times))])
    first = len(values) - max(FLAT, len(values) // TENTHS)
    mean, largest = float(values[first:].mean()), float(np.abs(displacement).max())
    own = displacement[first:] - mean * times[first:]
    drift, net = abs(mean) * (times[-1] - times[first]), mean * float(times[-1] - times[0])
    if abs(net) > NET * largest and drift > OUTSTANDING * own.std():
        yield (
            f"has a mean of {mean:.3g} in its last tenth, as an offset {net:.3g} m of displacement, of at most "
            f"{largest:.3g} m: correct its baseline"
        )
