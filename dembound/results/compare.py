"""Differences between histories of runs and those of a reference run, resampled where their times differ."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from dembound.casefile.disks.load import FREE_FIELD
from dembound.errors import CaseError
from dembound.results.histories import UNITS, MonitorRecord, Quantity, delay_of, read_histories
from dembound.results.reader import COMPONENTS, record_names


def largest_component(motion: np.ndarray) -> int:
    """The column of a motion (k, c), 0 along x or 1 along y, with the largest value; 0 without samples."""
    return int(np.argmax(np.abs(motion[:, :2]).max(axis=0, initial=0.0)))


def relative_error(error: np.ndarray, motion: np.ndarray) -> float:
    """RMS of an error (k,) over the RMS of the motion (k,) along the same axis; nan at rest."""
    size = float(np.linalg.norm(motion))
    return float(np.linalg.norm(error)) / size if size > 0.0 else np.nan


def peak_error(error: np.ndarray, motion: np.ndarray) -> float:
    """Largest value of an error (k,) over that of the motion (k,) along the same axis; nan at rest."""
    size = float(np.abs(motion).max(initial=0.0))
    return float(np.abs(error).max()) / size if size > 0.0 else np.nan


ABRUPT = 4.0
"""Change between two samples, over the larger of the changes before and after, above which motion jumps.

In a sine with n samples a period this ratio is at most 1/cos(2π/n): 3.2 with 5 samples, 1.05 with 20.
"""

JUMP = 0.01
"""Change between two samples, over the largest value, up to which it is not a jump: splines ring by a quarter of it."""

FEWEST = 4
"""Number of samples of the shortest smooth piece that is interpolated by a cubic spline."""


def at_times(time: np.ndarray, values: np.ndarray, requested: np.ndarray) -> np.ndarray:
    """Values (m,) or (m, c) of a history at requested times (m,) s; constant before its first and after its last.

    time (k,) s, ascending, and values (k,) or (k, c) of the history. The error in a sine with 20 samples a period is
    0.002 %, with straight lines 0.9 %. A spline through a jump would overshoot for some samples on both sides.
    """
    if np.array_equal(time, requested):
        return values
    inside = np.clip(requested, time[0], time[-1])
    columns = [_column(time, column, inside) for column in np.atleast_2d(values.T)]
    return np.array(columns).T.reshape(-1, *values.shape[1:])


def _column(time: np.ndarray, values: np.ndarray, requested: np.ndarray) -> np.ndarray:
    """Values of one column at other times; requested : between the first and the last sample."""
    from scipy.interpolate import CubicSpline

    jumps = _jumps(values)
    found = np.interp(requested, time, values)
    ends = np.flatnonzero(np.diff(np.concatenate([[True], jumps, [True]]).astype(int)))
    for first, last in zip(ends[::2], ends[1::2], strict=True):  # without a jump between them
        if last - first + 1 >= FEWEST:
            own = (requested >= time[first]) & (requested <= time[last])
            found[own] = CubicSpline(time[first : last + 1], values[first : last + 1])(requested[own])
    return found


def _jumps(values: np.ndarray) -> np.ndarray:
    """Whether a motion (k,) jumps between two samples, for each of the intervals (k − 1,)."""
    change = np.abs(np.diff(values))
    if len(change) < FEWEST - 1:
        return np.zeros(len(change), dtype=bool)
    around = np.concatenate([[change[2]], change, [change[-3]]])
    beside = np.maximum(around[:-2], around[2:])
    return np.asarray(change > np.maximum(ABRUPT * beside, JUMP * np.abs(values).max()))


SAME_PLACE = 1e-9
"""Distance of two places over their distance from the origin up to which they are equal but for rounding."""

STILL = 1e-9
"""Motion over the largest at any monitor of the reference up to which a monitor is still, but for rounding."""

SMALL = 0.01
"""Share of the motion in the reference below which a component, as a small residual, has no own error."""


FAINT = 1e-6
"""Shift over the duration that is neglected."""


@dataclass(frozen=True)
class Difference:
    """One monitor of a run compared with the reference.

    component : the one with the largest motion in the reference; rms, peak : its `relative_error` and `peak_error`.
    across : relative error of the other component, None if that is `SMALL` in the reference. last, reference_last :
    values of the component at the end; unit : of these. shift : s, by which the run was made earlier, as waves enter it
    so much later than the reference; 0 without. apart : m, distance of the places whose motions are compared, 0 if it
    is rounding only; place, reference_place : these places, as text.
    """

    run: str
    monitor: str
    component: str
    rms: float
    peak: float
    across: float | None
    last: float
    reference_last: float
    unit: str
    shift: float
    apart: float
    place: str
    reference_place: str


def compare(
    reference: Path,
    runs: list[Path],
    quantity: Quantity,
    as_recorded: bool = False,
    leave_out: Callable[[str], None] = lambda monitor: None,
) -> list[Difference]:
    """Differences of runs from a reference run at the monitors they share, over the time they share.

    Waves enter disks a little later or earlier than through the plane of a side, depending on disks and side. If both
    records have this delay, the difference of the delays is subtracted, unless they are compared as_recorded. The runs'
    histories are interpolated at the reference's times. All twins in a free-field column have one line for each run,
    with the largest error. Monitors at which the reference is still are left out, by name. Raises CaseError when
    nothing can be compared.
    """
    names = record_names([reference, *runs])[1:]
    expected, late = read_histories(reference, quantity), delay_of(reference)
    least = STILL * max((float(np.abs(each.values[:, :2]).max(initial=0.0)) for each in expected.values()), default=0.0)
    found, is_shared = [], False
    for name, path in zip(names, runs, strict=True):
        own = read_histories(path, quantity).items()
        delays = () if as_recorded else (delay_of(path), late)
        shift = _shift(*delays, reference=expected)
        shared = [(key, history) for key, history in own if key in expected]
        is_shared |= bool(shared)
        lines = []
        for key, history in shared:
            if (line := _difference(name, key, history, expected[key], quantity, shift, least)) is None:
                leave_out(key)
            else:
                lines.append(line)
        found += _with_one_twin(lines)
    if not found and is_shared:
        still = f"its {quantity} is zero at the monitors, and over the time, that the runs share"
        raise CaseError([f"{reference}: {still}"])
    if not found:
        raise CaseError([f"{reference}: has no monitor in common with the runs to compare"])
    return found


def _shift(*delays: float | None, reference: Mapping[str, MonitorRecord]) -> float:
    """Time (s) by which waves enter a run later than the reference; 0 if unknown or negligible."""
    known = [delay for delay in delays if delay is not None]
    longest = max((float(each.time[-1]) for each in reference.values() if len(each.time)), default=0.0)
    shift = known[0] - known[1] if len(known) == 2 else 0.0
    return shift if abs(shift) > FAINT * longest else 0.0


def _with_one_twin(lines: list[Difference]) -> list[Difference]:
    """The lines of a run, with a single one for all twins."""
    twins = [line for line in lines if line.monitor.endswith(FREE_FIELD)]
    if not twins:
        return lines
    worst = max(twins, key=lambda line: line.rms)
    name = worst.monitor if len(twins) == 1 else f"*{FREE_FIELD} ({len(twins)})"
    return [line for line in lines if line not in twins] + [replace(worst, monitor=name)]


def _difference(
    run: str,
    monitor: str,
    history: MonitorRecord,
    reference: MonitorRecord,
    quantity: Quantity,
    shift: float,
    least: float,
) -> Difference | None:
    """A monitor's difference, the history made earlier by a shift, s; None if the reference moves by at most least."""
    if len(history.time) == 0 or len(reference.time) == 0:
        raise CaseError([f"monitor {monitor}: has no samples, as a run was stopped at its start"])
    values, expected = on_common_clock(
        history.time - shift, history.values[:, :2], reference.time, reference.values[:, :2]
    )
    if np.abs(expected).max(initial=0.0) <= least:
        return None
    errors, sizes, column = values - expected, np.linalg.norm(expected, axis=0), largest_component(expected)
    across = [k for k, size in enumerate(sizes) if k != column and size >= SMALL * np.hypot.reduce(sizes)]
    of_twin = monitor.endswith(FREE_FIELD)  # columns beside different boxes begin elsewhere, only heights count
    places = [each.position * [not of_twin, 1.0] for each in (history, reference)]
    return Difference(
        run=run,
        monitor=monitor,
        component=COMPONENTS[column],
        rms=relative_error(errors[:, column], expected[:, column]),
        peak=peak_error(errors[:, column], expected[:, column]),
        across=relative_error(errors[:, across[0]], expected[:, across[0]]) if across else None,
        last=float(values[-1, column]),
        reference_last=float(expected[-1, column]),
        unit=UNITS[quantity][column],
        shift=shift,
        apart=distance(*places),
        place=history.place,
        reference_place=reference.place,
    )


def on_common_clock(
    time: np.ndarray, values: np.ndarray, expected_time: np.ndarray, expected: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Values of two histories at the sample times (m,) of the second, up to the end of the shorter one.

    time : (k,) s, values : (k,) or (k, c) of the first history, which is interpolated. expected_time : (l,) s, expected
    : (l,) or (l, c) of the second.
    """
    shared = expected_time <= min(time[-1], expected_time[-1])
    return at_times(time, values, expected_time[shared]), expected[shared]


def distance(place: Sequence[float] | np.ndarray, other: Sequence[float] | np.ndarray) -> float:
    """Distance (m) of two places (2,) m; 0 if it is only rounding."""
    apart = float(np.hypot(*np.subtract(place, other)))
    return apart if apart > SAME_PLACE * float(np.hypot(*other)) else 0.0
