"""One figure of a paper, and the runs and calibrations that it needs."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from matplotlib.figure import Figure as Picture

from dembound import shipped
from dembound.casefile.disks import DiskCase
from dembound.casefile.model import Case, as_kind
from dembound.errors import CaseError
from dembound.results.results import Results
from dembound.running import Progress, run_case
from dembound.schemas import load, with_changes
from dembound.studies.asked import Calibrating
from dembound.studies.calibration import Calibration, calibrate

LEAN = {"output.pictures": False, "output.snapshots": 0}
"""Changes of every run: only its histories are drawn."""

Watched = Callable[[str], AbstractContextManager[Progress]]
"""Gives the progress of what begins, by its name."""


class Row(NamedTuple):
    """A number of a figure, and what the paper prints for it."""

    what: str
    found: str
    printed: str


@dataclass(frozen=True)
class Figure:
    """A figure, or a table, of a paper.

    Attributes
    ----------
    title : what it shows; chinese : the same in the paper's language.
    seconds : CPU time of the command for it alone, s on one core, once kernels are compiled.
    draw : its picture, and the rows of its numbers.
    ratios : the ratios of radii λ of its packings of pattern B, as printed; none if it has no such packing.
    adjustable : whether keys of its cases can be changed; not those of a figure without cases.
    """

    title: str
    chinese: str
    seconds: float
    draw: Callable[["Work"], tuple[Picture, Sequence[Row]]]
    ratios: tuple[float, ...] = ()
    adjustable: bool = True


@dataclass(frozen=True)
class Paper:
    """A paper: its citation, and its figures by their numbers; left_out : which others it has, in words."""

    citation: str
    figures: Mapping[str, Figure]
    left_out: str

    def figure(self, number: str) -> Figure:
        """A figure by its number; raises CaseError with all numbers if it is not drawn."""
        if number not in self.figures:
            there = ", ".join(self.figures)
            raise CaseError([f"--figure: is {number}, must be one of {there}; {self.left_out}"])
        return self.figures[number]


@dataclass
class Work:
    """Runs and calibrations of a paper's cases, each made once for all figures drawn.

    Attributes
    ----------
    paper : name of its group of cases. folder : where the results are written.
    changes : keys of all cases with other values than in the paper.
    ratios : ratios of radii λ in place of those of the figure that is drawn; none : as printed.
    watched, passed : receive progress, and every pass of a calibration.
    """

    paper: str
    folder: Path
    changes: Mapping[str, Any] = field(default_factory=dict)
    ratios: tuple[float, ...] = ()
    watched: Watched = lambda _: nullcontext(Progress())
    passed: Callable[[Calibration], None] = lambda _: None
    _runs: dict[str, Results] = field(default_factory=dict)
    _calibrations: dict[str, Calibration] = field(default_factory=dict)

    def draw(self, number: str, figure: Figure) -> tuple[Picture, Sequence[Row]]:
        """The picture of a figure, and its rows.

        Raises CaseError where it has nothing that the changes or the ratios could change, and the errors of `run_case`
        and `calibrate`.
        """
        if self.ratios and not figure.ratios:
            raise CaseError([f"--radius-ratio: figure {number} has no packing of pattern B"])
        if self.changes and not figure.adjustable:
            raise CaseError([f"--set: figure {number} has no case whose keys could be changed"])
        return figure.draw(replace(self, ratios=self.ratios or figure.ratios))

    def case(self, name: str, changes: Mapping[str, Any], label: str) -> Case:
        """A shipped case of the paper under a name of its own: with changes of the figure, then those of the user."""
        case = load(shipped.folder() / self.paper / f"{name}.toml")
        return replace(with_changes(case, {**LEAN, **changes, **self.changes}), name=label)

    def disks(self, name: str, changes: Mapping[str, Any], label: str) -> DiskCase:
        """The case of disks of a name, changed as by `case`; raises CaseError for another kind of body."""
        return as_kind(self.case(name, changes, label), DiskCase, "must be of disks", name)

    def run(self, name: str, label: str, **changes: Any) -> Results:
        """The results of a run of a case, in a folder of the name `label`; in changes ``__`` stands for a dot."""
        if label not in self._runs:
            case = self.case(name, dotted(changes), label)
            with self.watched(label) as progress:
                self._runs[label] = Results(run_case(case, self.folder, progress))
        return self._runs[label]

    def calibration(self, name: str, label: str, start: float, **changes: Any) -> Calibration:
        """The ratio iteration (Z fig. 5) of a case's right side under P waves, from a first β."""
        key = f"{label} from {start:g}"
        if key not in self._calibrations:
            case = self.disks(name, dotted(changes), key)
            how = Calibrating(method="ratio", start=start)
            self._calibrations[key] = calibrate(case, "right", how, motion="p", report=self.passed)
        return self._calibrations[key]


def dotted(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Changes of a case by its keys: ``run__duration`` for run.duration."""
    return {key.replace("__", "."): value for key, value in changes.items()}


def markdown(heads: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A table in Markdown."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(str(cell) for cell in line)} |" for line in lines)
