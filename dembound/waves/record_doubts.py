"""What is wrong with a measured record: units in its header, lost samples, clipping, coarse sampling, an offset.

Only records of evenly sampled, smooth motion show it; tables of a few points, joined by lines, are as they are meant.
"""

import re
from collections.abc import Iterator

import numpy as np

from dembound.waves.spectrum import amplitude_spectrum
from dembound.words import percent

FEWEST = 20
"""Samples below which a table is one of single points, joined by straight lines."""

EVEN = 0.9
"""Share of equal steps from which a table is a record that was sampled."""

LONGER = 3.0
"""Times the usual step from which a step is a gap."""

LOUD = 0.05
"""Share of the peak that is motion, no noise."""

FEWEST_TURNS = 6
"""Changes of sign from which a record oscillates."""

FLAT = 3
"""Equal samples at the peak from which it is cut off."""

RISE = (0.01, 0.5)
"""Last step before such samples over the peak: smaller ones round a crest off, larger ones are of square waves."""

LOST = 0.1
"""Largest loss of the mean frequency by straight lines between samples: sinc²(f Δt)."""

OUTSTANDING = 5.0
"""Times the others from which a change, or a drift, is no motion."""

TENTHS = 10
"""Parts of a record in the last of which its motion is over."""

NET = 0.25
"""Displacement that an offset of the last tenth makes over the record, over the largest displacement."""

QUANTITIES = {
    "accelerations": r"acc|accel|accelerations?|gal|(?:m|cm|mm)/s(?:2|\^2|²|/s)|\((?:g)\)",
    "displacements": r"disp|displ|displacements?|\((?:mm|cm|m)\)",
}
"""Words of a header that say that its values are no velocities; those in parentheses if they stand as a unit alone."""

SIZES = {"mm/s": 1e-3, "cm/s": 1e-2, "km/s": 1e3, "in/s": 0.0254, "ft/s": 0.3048}
PRESSURES = {"kpa": 1e3, "mpa": 1e6, "gpa": 1e9, "bar": 1e5, "psi": 6895.0, "n/mm2": 1e6, "n/mm²": 1e6}
TIMES = ("(ms)", "msec", "(µs)", "(μs)", "(us)", "(ns)", "(min)")


def doubts_of_header(header: str, *, of_velocity: bool, factor: float) -> Iterator[str]:
    """What the header of a file says against its use, in words.

    header : the words above the numbers, those of the time first. of_velocity : whether the values are velocities, else
    they are factors of a load. factor : by which the values are multiplied to m/s, or to Pa; one other than 1 is taken
    for the change of units.
    """
    text = re.sub(r"[\[(]\s*([^\])]*?)\s*[\])]|_([a-zµμ/²^2]+)(?=[\s,;]|$)", r" (\1\2) ", header.lower())
    alone = [word for word in re.split(r"[\s,;:\"']+", text) if word]
    words = [*alone, *(word.strip("()") for word in alone if len(word) > len("(mm)"))]
    if unit := next((word.strip("()") for word in words if word in TIMES), None):
        yield f"its header says {unit}, its times are read as s"
    known = SIZES if of_velocity else PRESSURES
    named = next((word.strip("()") for word in words if word.strip("()") in known), None)
    if named is not None:
        if abs(factor) == 1.0:
            read = "m/s" if of_velocity else "Pa"
            yield f"its header says {named}, its values are read as {read}; for those write scale = {known[named]:g}"
    elif of_velocity:
        for quantity, pattern in QUANTITIES.items():
            if unit := next((word.strip("()") for word in words if re.fullmatch(pattern, word)), None):
                yield f'its header says "{unit}", likely {quantity}; its values are read as velocities in m/s'
                return


def doubts_of_samples(times: np.ndarray, values: np.ndarray) -> Iterator[str]:
    """What the samples of a record (k,), at times (k,) s, show of lost ones, a clipped peak and others, in words."""
    steps = np.diff(times)
    usual, peak = float(np.median(steps)), float(np.abs(values).max())
    if len(times) < FEWEST or np.isclose(steps, usual, rtol=0.01).mean() < EVEN:
        return
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
    yield from _spike(times, values, peak)
    turns = np.count_nonzero(np.diff(np.sign(values[np.abs(values) > LOUD * peak])))
    if turns < FEWEST_TURNS:
        return
    frequencies, amplitudes = amplitude_spectrum(values, usual)
    mean = float(frequencies @ amplitudes**2 / (amplitudes**2).sum())
    yield from _coarse(mean, usual)
    yield from _jump(times, values, peak)
    if mean * (times[-1] - times[0]) > TENTHS:  # else its last tenth is part of a period
        yield from _offset(times, values)


def _clipped(values: np.ndarray, peak: float) -> Iterator[str]:
    """Several flat crests at the peak."""
    at_peak = np.concatenate([[False], np.abs(values) >= (1.0 - 1e-9) * peak, [False]])
    begins, ends = np.flatnonzero(~at_peak[:-1] & at_peak[1:]), np.flatnonzero(at_peak[:-1] & ~at_peak[1:])
    rise = np.array([abs(values[b] - values[b - 1]) / peak if b > 0 else 1.0 for b in begins])
    flat = (ends - begins >= FLAT) & (rise > RISE[0]) & (rise < RISE[1])
    if np.count_nonzero(flat) > 1:
        yield f"is equal to ±{peak:.4g} for {FLAT} samples and more, {np.count_nonzero(flat)} times: is it clipped?"


def _coarse(mean: float, step: float) -> Iterator[str]:
    """Samples too far apart (s) for straight lines between them, by the mean frequency, Hz."""
    loss = 1.0 - float(np.sinc(mean * step)) ** 2
    if loss > LOST:
        yield (
            f"has {1.0 / (mean * step):.2g} samples in a period of its mean frequency, {mean:.3g} Hz; straight lines "
            f"between them take {percent(loss)} of it: take a finer record, or interpolate it"
        )


def _spike(times: np.ndarray, values: np.ndarray, peak: float) -> Iterator[str]:
    """One sample far from its neighbours, which are close to each other and to theirs."""
    beside = np.abs(values[2:-2] - 0.5 * (values[3:-1] + values[1:-3]))
    others = [values[1:-3] - values[:-4], values[3:-1] - values[1:-3], values[4:] - values[3:-1]]
    worst = int(beside.argmax())
    usual = max(*(abs(each[worst]) for each in others), np.sort(beside)[-4])  # a spike is in three of these
    if beside[worst] > max(LOUD * peak, OUTSTANDING * usual):
        yield f"has one sample far from its neighbours, {values[worst + 2]:.4g} at {times[worst + 2]:.4g} s: a spike?"


def _jump(times: np.ndarray, values: np.ndarray, peak: float) -> Iterator[str]:
    """One step far beyond all others."""
    changes = np.abs(np.diff(values))
    worst, others = int(changes.argmax()), np.sort(changes)[-2]
    if changes[worst] > max(LOUD * peak, OUTSTANDING * others):
        size = f"{changes[worst]:.4g}, {changes[worst] / others:.2g} times any other step"
        yield f"jumps by {size}, at {times[worst]:.4g} s: are samples lost?"


def _offset(times: np.ndarray, values: np.ndarray) -> Iterator[str]:
    """A mean at the end that makes up much of the displacement, and of which oscillations are no cause."""
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
