"""What the samples of a file are: an evenly sampled record that oscillates, or a table of points or a pulse."""

import numpy as np

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
