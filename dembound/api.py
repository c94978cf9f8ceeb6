"""dembound from Python: cases made of tables, runs, and their results as arrays. See docs/start/python.md."""

import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import takewhile
from pathlib import Path
from traceback import walk_stack
from typing import Any

import numba
import numpy as np
import tomli_w

from dembound import kinds
from dembound.accuracy.budget import Budget
from dembound.accuracy.estimate import BOUNDS, estimate_if_asked, estimate_results
from dembound.accuracy.estimate import advise as find_advice
from dembound.accuracy.proposal import Advice
from dembound.boundaries import Motion
from dembound.casefile import Case
from dembound.casefile.disks import DiskCase
from dembound.casefile.model import as_kind
from dembound.errors import CaseError, CaseWarning, DemboundError, NameMissingError, PackingError, RecordError, RunError
from dembound.formulas.cause import Truth
from dembound.results.folder import Folder
from dembound.results.results import Arrays, Results
from dembound.running import Progress, resume_case, run_case
from dembound.running.recorded import recorded_case
from dembound.running.unfinished import left_of
from dembound.studies import all_sides, calibration
from dembound.studies.asked import Calibrating, Ends, Loading
from dembound.studies.calibration import Calibration
from dembound.studies.laboratory.sample import sample_of
from dembound.studies.laboratory.study import SHARES, Tested, perform, specimens_of
from dembound.studies.laboratory.tables import ratios_of, write_tables
from dembound.studies.sweep.study import Options, Report
from dembound.table import Table, as_toml

__all__ = [
    "Advice",
    "Arrays",
    "Budget",
    "Calibration",
    "Case",
    "CaseError",
    "CaseWarning",
    "DemboundError",
    "NameMissingError",
    "PackingError",
    "Progress",
    "RecordError",
    "Results",
    "RunError",
    "advise",
    "calibrate",
    "calibrate_all",
    "case",
    "change",
    "estimate",
    "laboratory_test",
    "load",
    "loads",
    "resume",
    "run",
]

warnings.simplefilter("always", CaseWarning, append=True)  # at every run, not only at the first one from a line


def load(path: Path | str) -> Case:
    """Read a case file; raises CaseError with one line per mistake."""
    if isinstance(path, str) and "\n" in path:
        raise CaseError(["path: is the text of a case, must be the path of a case file; give dembound.loads(text)"])
    return kinds.load(Path(path))


def loads(text: str, folder: Path | str = ".", name: str = "case") -> Case:
    """Read a case from TOML text; relative paths in it start in the folder. Errors as `load`."""
    return kinds.loads(text, Path(folder), name)


def case(name: str = "case", folder: Path | str = ".", **tables: Any) -> Case:
    """Make a case from its tables, with the keys of a case file (docs/reference/case_file.md).

    Keys that are left out have their defaults. The tables are checked like those of a file.

    Parameters
    ----------
    name : of the results folder.
    folder : where relative paths in the case start.
    tables : table -> keys, such as ``packing={"pattern": "A", "size": (100.0, 10.0), "radius": 0.25}``; sides and
        waves are given as name -> table; loads, holes and monitors as a list of tables. Values may also be numpy
        values, paths, tables of another case, and None for a key that is left out.

    Raises CaseError with one line per mistake.
    """
    return kinds.loads(tomli_w.dumps(_in_toml_words(tables, "")), Path(folder), name)


def change(case: Case, changes: Mapping[str, Any], name: str | None = None) -> Case:
    """A copy of the case with some keys changed, and another name if one is given; the case itself is not changed.

    changes : dotted key -> value, as of ``--set``: ``{"boundary.right.beta_p": 0.81, "monitor.P4.position": (1, 2)}``.

    Raises CaseError for keys that do not exist, and for the same mistakes as `load`.
    """
    plain = {key: _in_toml_words(value, key) for key, value in changes.items()}
    changed = kinds.with_changes(case, plain)
    return changed if name is None else replace(changed, name=name)


def run(
    case: Case | Path | str,
    results: Path | str = "results",
    *,
    progress: Progress | None = None,
    threads: int | None = None,
) -> Results:
    """Run a case, or a case file, and write ``results/<case name>/``, as ``dembound run`` does; returns the results.

    Parameters
    ----------
    progress : receives progress and warnings; by default warnings are issued as Python warnings, of the category
    CaseWarning. threads : cores to
    use, by default all; results do not depend on it.

    Raises CaseError if the case cannot be run, PackingError if its brick cannot be packed, RunError if the run fails.
    A KeyboardInterrupt names the results so far and how to continue the run.
    """
    chosen, told = case if isinstance(case, Case) else load(case), progress or _Warns()
    with _threads(threads), _saying_what_is_left(Folder(Path(results), chosen.name)):
        return _finished(chosen, run_case(chosen, Path(results), told), told)


def _finished(case: Case, folder: Path, progress: Progress) -> Results:
    """The results of a run, after the estimate of its errors if its case requests it."""
    if failed := estimate_if_asked(case, folder):
        _warn(f"{case.name}: {failed}")
    found = Results(folder)
    if note := found.summary.get("spalls_note"):
        progress.warned(note)
    return found


@contextmanager
def _saying_what_is_left(folder: Folder) -> Iterator[None]:
    """Inside, an interrupt has a message on the results so far and how to continue the run."""
    try:
        yield
    except KeyboardInterrupt as stop:
        left = left_of(folder.partial, f'dembound.resume("{folder.partial}")')
        stop.args = (f"{folder.name}: stopped; {'; '.join(left) or 'the run had not begun'}",)
        raise


def estimate(
    results: Path | str, *, repeat: bool = False, longest: float | None = None, threads: int | None = None
) -> Budget:
    """Estimate the errors of a complete run, as ``dembound estimate`` does; see docs/tasks/trust_a_result.md.

    Parameters
    ----------
    results : folder of the results, to which the estimate is added. repeat : whether a run with cracks is repeated with
    0.98 of its time step. longest : CPU seconds that companions may take; by default 20, or as long as the run.
    threads : as for `run`.

    Raises CaseError for a run with neither monitors nor more than ten cracks, or that is not complete, and a repetition
    of a run without cracks.
    """
    with _threads(threads):
        return estimate_results(Path(results), repeat, longest=longest)


def advise(
    case: Case,
    bounds: Sequence[float] = BOUNDS,
    *,
    of: Truth | None = None,
    keep: Sequence[str] = (),
    seeds: int = 1,
    longest: float | None = None,
    threads: int | None = None,
) -> Advice:
    """The errors of a case, and the cheapest choices for error bounds, see docs/tasks/trust_a_result.md.

    Parameters
    ----------
    case : with monitors. bounds : errors, RMS over RMS. of : "disks" or "rock". keep : keys that are not changed.
    seeds : random packings with which the case is run. longest : CPU seconds that the steps of a choice may take.
    threads : as for `run`.

    Raises CaseError for cases without monitors, whose errors are not known, and for an invalid bound or key.
    """
    with _threads(threads):
        return find_advice(case, bounds, of, keep, seeds, longest)


def resume(
    results: Path | str, until: float | None = None, *, progress: Progress | None = None, threads: int | None = None
) -> Results:
    """Continue a run from its last checkpoint, as ``dembound resume`` does; returns the results.

    Parameters
    ----------
    results : folder of the results, the partial one of a run that was interrupted, or a complete one.
    until : s, another duration; without it a complete run cannot be continued. progress, threads : as for `run`.

    Raises CaseError if there is nothing to continue, or a checkpoint of another version or case; else as `run`.
    """
    told = progress or _Warns()
    with _threads(threads), _saying_what_is_left(Folder.of(Path(results))):
        folder = resume_case(Path(results), until, told)
        return _finished(recorded_case(folder / "run.h5"), folder, told)


@contextmanager
def _threads(threads: int | None) -> Iterator[None]:
    """Use at most a number of threads inside; None: all."""
    before = numba.get_num_threads()
    numba.set_num_threads(before if threads is None else max(1, min(threads, before)))
    try:
        yield
    finally:
        numba.set_num_threads(before)


def laboratory_test(
    case: Case,
    test: str,
    results: Path | str = "results",
    *,
    seeds: int = 4,
    width: float | None = None,
    height: float | None = None,
    ends: Ends = Loading.ends,
    damp: float = Loading.damp,
    rate: float | None = None,
    pressures: Sequence[float] | None = None,
    shares: Sequence[float] = SHARES,
    processes: int = 0,
    anew: bool = False,
    report: Report | None = None,
) -> Tested:
    """Test samples of a material to failure, and write ``results/<case name>_<test>/``, as ``dembound test`` does.

    Parameters
    ----------
    case : of disks, whose packing and material count. test : "ucs", "tension", "brazilian" or "biaxial".
    seeds : samples. width, height : m. ends : "smooth" or "grips". damp : local damping. rate : 1/s.
    pressures : Pa at the sides, of "biaxial". shares : of the peak, between which E and ν are taken.
    processes : samples at once, each in a process of its own; 0: one after the other in this one. Scripts need
    ``if __name__ == "__main__":`` for others.
    anew : whether samples that are done are repeated. report : called with the numbers of samples done and under way.

    Pictures are not drawn. What makes numbers doubtful is issued as warnings of the category CaseWarning.

    Raises CaseError for a case or numbers that are not valid, RunError if all samples have failed. After an interrupt
    the same call continues what is left.
    """
    sample = sample_of(_of_disks(case, "samples have disks"), test, Loading(width, height, ends, damp, rate))
    specimens = specimens_of(sample, seeds, pressures)
    options, told = Options(processes=processes, anew=anew), report or (lambda standing: None)
    try:
        found = perform(sample, specimens, options, Path(results) / f"{case.name}_{test}", told, shares)
    except KeyboardInterrupt as stop:
        stop.args = (f"{case.name}: stopped; the same call continues what is left",)
        raise
    failed = [
        f"{each.member.name}: {state}" for each, state in zip(specimens, found.states, strict=True) if state != "done"
    ]
    if len(failed) == len(specimens):
        raise RunError(failed[0])
    write_tables(found, list(ratios_of(found, Path(results))))
    for line in (*failed, *found.warnings_of_runs, *found.warnings):
        _warn(f"{case.name}: {line}")
    return found


def calibrate(
    case: Case, side: str, *, motion: Motion | None = None, report: calibration.Report | None = None, **options: Any
) -> tuple[Case, Calibration]:
    """Find the factor β of one side for P or S waves; returns the case with this β, and the record of the calibration.

    options : method, start, tolerance, full, see `dembound.studies.calibration.calibrate`, as for motion and report.

    Raises CaseError when the side has no dashpots or its motion is held, RunError when β does not converge.
    """
    found = calibration.calibrate(_of_disks(case), side, Calibrating(**options), motion=motion, report=report)
    return change(case, {f"boundary.{side}.{found.factor}": found.result}), found


def calibrate_all(
    case: Case, *, report: calibration.Report | None = None, **options: Any
) -> tuple[Case, list[Calibration]]:
    """Find all factors β of all sides with dashpots, for the waves whose motion is not held; see `calibrate`.

    report, options : as for `calibrate`.
    """
    found = all_sides.calibrate_all(_of_disks(case), Calibrating(**options), report=report)
    return change(case, all_sides.changes_of(found)), found


def _of_disks(case: Case, why: str = "β of disks is calibrated") -> DiskCase:
    """The case, checked; raises CaseError for the case of a bar."""
    return as_kind(kinds.checked(case), DiskCase, f"is the case of a bar; {why}")


class _Warns(Progress):
    """Issues the warnings of a run as Python warnings."""

    def warned(self, message: str) -> None:
        """Warn."""
        _warn(message)


def _warn(message: str) -> None:
    """Issue a Python warning at the line outside this package that called it."""
    frames = (frame for frame, _ in walk_stack(sys._getframe()))
    inside = takewhile(lambda frame: str(frame.f_globals.get("__name__")).startswith("dembound."), frames)
    warnings.warn(message, CaseWarning, stacklevel=1 + sum(1 for _ in inside))


def _in_toml_words(value: Any, place: str) -> Any:
    """A value in TOML's types; raises CaseError for a type that TOML does not have. place : its key."""
    if isinstance(value, Table):
        return as_toml(value)
    if isinstance(value, Mapping):
        inner = {str(key): _in_toml_words(each, f"{place}.{key}".lstrip(".")) for key, each in value.items()}
        return {key: each for key, each in inner.items() if each is not None}
    if isinstance(value, np.ndarray | np.generic):
        return _in_toml_words(value.tolist(), place)
    if isinstance(value, tuple | list):
        return [_in_toml_words(each, place) for each in value]
    if isinstance(value, Path):
        return str(value)
    if value is None or isinstance(value, str | bool | int | float):
        return value
    raise CaseError(
        [f"{place}: is of the Python type {type(value).__name__}, must be numbers, text, or tables of them"]
    )
