"""Differences between histories of runs and those of a reference run."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from dembound.errors import CaseError
from dembound.results.histories import FREE_FIELD, UNITS, MonitorRecord, Quantity, delay_of, read_histories
from dembound.results.reader import COMPONENTS, record_names
from dembound.results.relative_error import largest_component, peak_error, relative_error
from dembound.results.resample import at_times

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
        raise CaseError(
            [f"{reference}: its {quantity} is zero at the monitors, and over the time, that the runs share"]
        )
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
