"""Errors of choices: the histories of their monitors compared with those of a reference."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Generic, Literal, Protocol, TypeVar

import numpy as np

from dembound.accuracy.choice import Choice
from dembound.accuracy.runner import Run
from dembound.casefile import Case
from dembound.errors import CaseError
from dembound.formulas.cause import Truth
from dembound.formulas.history import LEAST, History, Motions, earlier, loud_of
from dembound.results.compare import distance, largest_component, on_common_clock, peak_error, relative_error
from dembound.results.histories import Quantity
from dembound.results.reader import COMPONENTS

Component = Literal["x", "y"]

MEASURED = {
    "extended": "sides, and in what choices differ",
    "finer": "in what choices differ, grid and time step",
    "finest": "in what choices differ",
}
"""Causes of errors that a comparison with a run measures, by the name of the reference."""

C = TypeVar("C", bound=Case)


@dataclass(frozen=True)
class Requested:
    """What is compared: a quantity, its component (None: the largest in the reference), a monitor (None: all)."""

    quantity: Quantity = "velocity"
    component: Component | None = None
    monitor: str | None = None


@dataclass(frozen=True)
class Reference:
    """A reference for errors.

    name : "exact", "extended", "finer" or "finest"; sentence : it in words. motions : its histories, given a choice and
    the run of the choice. until : s, time up to which histories are compared. findings : its findings by name. own :
    numbers of the choices that are the reference itself. cautions : lines on errors that the comparison does not
    include. rest : monitor -> quantity -> error of the reference itself by formula, RMS over RMS, relative to the truth
    `of`. late : delay (s) of its motion, see `Run.late`. added, unknown : names of the causes included in `rest`, and
    of those left out.
    """

    name: str
    sentence: str
    motions: Callable[[Choice, Run], Motions]
    until: float = math.inf
    findings: Mapping[str, float] = field(default_factory=dict)
    own: Sequence[int] = ()
    cautions: Sequence[str] = ()
    rest: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    of: Truth = "rock"
    late: float = 0.0
    added: Sequence[str] = ()
    unknown: Sequence[str] = ()

    @property
    def covered(self) -> str:
        """Which errors the compared ones include, in words: measured, added by formula, and left out."""
        measured = "all causes" if self.name == "exact" else MEASURED[self.name]
        added = [f"added by formula: {', '.join(self.added)}"] if self.added else []
        unknown = [f"not known: {', '.join(self.unknown)}"] if self.unknown else []
        return "; ".join([f"measured: {measured}", *added, *unknown])


class Exact(ABC, Generic[C]):
    """An exact solution of a case.

    Attributes
    ----------
    sentence : the solution in words, for pictures.
    until : s, time up to which it is valid. findings : exact numbers by name, see `Kind.findings`.
    """

    sentence: str
    until: float = math.inf
    findings: Mapping[str, float] = {}

    @abstractmethod
    def motions(self, case: C, recorded: Motions) -> dict[str, History]:
        """The exact motion at the recorded positions and times of a choice, whose case is `case`."""


class FinerRun(Protocol):
    """A run with a finer grid than those of all choices: its case, and its spacing, m."""

    @property
    def case(self) -> Case:
        """The case that is run."""

    @property
    def spacing(self) -> float:
        """Distance of its nodes, m."""

    def motions(self, run: Run, choice: Run) -> dict[str, History]:
        """Histories at the monitors of a choice, from a run of this case, which may have been extended."""


@dataclass(frozen=True)
class MonitorError:
    """The error at one monitor.

    rms : see `relative_error`; peak : see `peak_error`; apart : distance of the compared particles, m, 0 if
    it is rounding only. rest : RMS error of the reference itself, by formula.
    """

    monitor: str
    component: str
    rms: float
    peak: float
    apart: float
    rest: float = 0.0

    @property
    def total(self) -> float:
        """RMS error: root of the sum of squares of the measured error and of the reference's own error."""
        return math.hypot(self.rms, self.rest)


def errors(choice: Choice, outcome: Run, reference: Reference, requested: Requested) -> list[MonitorError]:
    """The errors of a choice at all monitors whose motion is not negligible, the largest total first.

    The two histories are first shifted by their delays at the sides where waves enter (`Run.late`).
    Raises CaseError for a monitor that does not exist and if the reference does not move until histories end.
    """
    recorded, expected = (
        {name: history.until(reference.until) for name, history in each.items()}
        for each in (earlier(outcome.motions, outcome.late - reference.late), reference.motions(choice, outcome))
    )
    names = _monitors(recorded, expected, requested)
    series = {name: expected[name].values[requested.quantity] for name in names}
    columns = {name: _column(values, requested) for name, values in series.items()}
    peaks = {name: float(np.abs(values[:, columns[name]]).max(initial=0.0)) for name, values in series.items()}
    if not max(peaks.values()) > 0.0:
        raise CaseError([f"monitor: the {requested.quantity} is zero in the reference ({reference.sentence})"])
    found = []
    for name in loud_of(peaks, LEAST[requested.quantity]):
        rest = reference.rest.get(name, {}).get(requested.quantity, 0.0)
        found.append(replace(_error(name, recorded[name], expected[name], columns[name], requested), rest=rest))
    return sorted(found, key=lambda error: -error.total)


def _monitors(found: Motions, expected: Motions, requested: Requested) -> list[str]:
    """The names of the monitors to compare."""
    names = [name for name in found if name in expected]
    if requested.monitor is not None and requested.monitor not in names:
        raise CaseError([f"--monitor: is {requested.monitor}, must be one of {', '.join(names)}"])
    return names if requested.monitor is None else [requested.monitor]


def _column(values: np.ndarray, requested: Requested) -> int:
    """The column to compare of values (k, c)."""
    if values.shape[1] == 1:
        return 0
    if requested.component is not None:
        return COMPONENTS.index(requested.component)
    return largest_component(values)


def _error(name: str, found: History, expected: History, column: int, requested: Requested) -> MonitorError:
    """The error at a monitor, at the times of the history with fewer samples, so that the finer one is interpolated."""
    mine, theirs = ((history.time, history.values[requested.quantity][:, column]) for history in (found, expected))
    if len(theirs[0]) > len(mine[0]):
        right, left = on_common_clock(*theirs, *mine)
    else:
        left, right = on_common_clock(*mine, *theirs)
    rms, peak = relative_error(left - right, right), peak_error(left - right, right)
    apart = distance(found.place, expected.place)
    component = "stress" if requested.quantity == "stress" else COMPONENTS[column]
    return MonitorError(name, component, rms, peak, apart)
