"""Differences between histories of runs and those of a reference run."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dembound.errors import CaseError
from dembound.results.histories import UNITS, History, Quantity, read_histories
from dembound.results.reader import COMPONENTS, record_names


@dataclass(frozen=True)
class Difference:
    """One monitor of a run compared with the reference, in the component with the largest motion there.

    rms : √(Σ(a − b)²/Σb²); peak : largest |a − b| over largest |b|; last, reference_last : the values at the end;
    unit : theirs; place, reference_place : the positions given for the monitor in both, as text.
    """

    run: str
    monitor: str
    component: str
    rms: float
    peak: float
    last: float
    reference_last: float
    unit: str
    place: str
    reference_place: str


def compare(reference: Path, runs: list[Path], quantity: Quantity) -> list[Difference]:
    """Differences of runs from a reference run at the monitors they share, over the time they share.

    The runs' histories are interpolated at the reference's times. Raises CaseError when nothing can be compared.
    """
    names = record_names([reference, *runs])[1:]
    wanted = read_histories(reference, quantity)
    found = [
        _difference(name, monitor, history, wanted[monitor], quantity)
        for name, path in zip(names, runs, strict=True)
        for monitor, history in read_histories(path, quantity).items()
        if monitor in wanted
    ]
    if not found:
        raise CaseError([f"{reference}: has no monitor in common with the runs to compare"])
    return found


def _difference(run: str, monitor: str, history: History, reference: History, quantity: Quantity) -> Difference:
    """One monitor's difference."""
    if len(history.time) == 0 or len(reference.time) == 0:
        raise CaseError([f"monitor {monitor}: has no samples, as a run was stopped at its start"])
    column = int(np.argmax(np.abs(reference.values[:, :2]).max(axis=0)))
    values, expected = on_common_clock(
        history.time, history.values[:, column], reference.time, reference.values[:, column]
    )
    if not expected.any():
        raise CaseError([f"monitor {monitor}: its {quantity} is zero in the reference"])
    rms, peak = relative_errors(values, expected)
    return Difference(
        run=run,
        monitor=monitor,
        component=COMPONENTS[column],
        rms=rms,
        peak=peak,
        last=float(values[-1]),
        reference_last=float(expected[-1]),
        unit=UNITS[quantity][column],
        place=history.wanted,
        reference_place=reference.wanted,
    )


def on_common_clock(
    time: np.ndarray, values: np.ndarray, wanted_time: np.ndarray, wanted: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Two histories at the same times (m,): those of the second one, up to the end of the shorter one.

    time (k,) s and values (k,) of the first one, which is interpolated; wanted_time (l,) and wanted (l,) of the second.
    """
    shared = wanted_time <= min(time[-1], wanted_time[-1])
    return np.interp(wanted_time[shared], time, values), wanted[shared]


def relative_errors(values: np.ndarray, wanted: np.ndarray) -> tuple[float, float]:
    """RMS of the difference over that of the wanted values (m,), and largest difference over their peak."""
    error = values - wanted
    rms = float(np.sqrt(np.sum(error**2) / np.sum(wanted**2)))
    return rms, float(np.abs(error).max() / np.abs(wanted).max())
