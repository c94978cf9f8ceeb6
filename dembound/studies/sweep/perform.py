"""One member of a sweep, in its own process or on a cluster: it is run or calibrated, and its outcome written."""

import logging
import math
import threading
import time
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import chdir, contextmanager, suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated

from pydantic import ConfigDict, Field

from dembound.accuracy.choice import digest
from dembound.accuracy.estimate import estimate_if_asked
from dembound.casefile import Case
from dembound.casefile.disks import DiskCase
from dembound.casefile.model import as_kind
from dembound.casefile.tables import Action, Method
from dembound.errors import CaseError, DemboundError, RecordError
from dembound.files import content_of, require_writable, write_text
from dembound.interrupts import Interrupts, Stopped, look
from dembound.kinds import loads
from dembound.motion.trackers import Run
from dembound.results.folder import Folder
from dembound.results.summary import read_summary
from dembound.results.text_files import read_json, write_json
from dembound.running import Progress, Shared, resume_case, run_case
from dembound.studies.asked import Calibrating
from dembound.studies.sweep.members import values_of_calibration, values_of_run

MEMBERS, OUTCOMES, SETTLED = "members", "outcomes", "settled"
"""Folders of a sweep: runs, outcomes by key, stages before runs."""

BETWEEN = 1.0
"""Seconds between two entries of the time of a run under way."""

LONGEST_TIME = 64
"""Bytes of a number in a file."""

ALONE = threading.Lock()
"""Lock held by a running member: workers of a cluster may have several threads, but the solver has its own."""


@dataclass(frozen=True)
class Task:
    """Data sent to a process: a case as text with the files it refers to, action, and folders.

    current : the folder from which ``static.from`` starts. folder : of the sweep.
    begun : a file that is made when the member is stepped, as its code is then compiled.
    stop : a file that requests all members to end.
    """

    name: str
    key: str
    text: str
    case_folder: Path
    files: Mapping[str, str]
    action: Action
    method: Method
    current: Path
    folder: Path
    begun: Path
    stop: Path


@dataclass
class Outcome:
    """The results of a member: values by name, or why there are none, and the wall time it took (s).

    folder : name of the folder of its run; empty for a calibration, which has none. warnings : of its run.
    """

    name: str
    folder: str = ""
    failure: str = ""
    values: dict[str, float] = field(default_factory=dict)
    seconds: Annotated[float, Field(ge=0.0)] = 0.0
    warnings: list[str] = field(default_factory=list)

    __pydantic_config__ = ConfigDict(extra="forbid", allow_inf_nan=False)

    def write(self, folder: Path, key: str) -> None:
        """Write the outcome into the folder of a sweep, completely or not at all."""
        finite = {name: value for name, value in self.values.items() if math.isfinite(value)}  # others count as absent
        write_json(folder / OUTCOMES / f"{key}.json", asdict(self) | {"values": finite})


def outcome_in(folder: Path, key: str) -> Outcome | None:
    """The outcome of the member with this key in the folder of a sweep; None without one that can be read.

    Raises RecordError for a link or what is no file.
    """
    path = folder / OUTCOMES / f"{key}.json"
    require_writable(path)
    try:
        return read_json(path, Outcome)
    except (OSError, RecordError):
        return None


def forget_replaced(folder: Path, names: Collection[str]) -> None:
    """Delete the outcomes in a sweep whose runs are in folders of these names, as other runs will replace them."""
    for path in (folder / OUTCOMES).glob("*.json"):
        outcome = outcome_in(folder, path.stem)
        if outcome is not None and outcome.folder in names:
            path.unlink(missing_ok=True)


def perform(task: Task) -> Outcome | None:
    """The outcome of a member, which is also written; None if it was asked to stop. One thread is used."""
    with ALONE:
        began, outcome = time.perf_counter(), Outcome(task.name, task.name if task.action == "run" else "")
        try:
            with chdir(task.current), Interrupts(task.stop), _one_thread():
                look()
                outcome.values, outcome.warnings = _ACTIONS[task.action](task)
        except Stopped:
            return None
        except (DemboundError, OSError, MemoryError) as error:
            outcome.failure = " ".join(str(error).split()) or type(error).__name__
        except Exception as error:  # a bug, which must not end the sweep; it is a line in its table
            logging.getLogger(__name__).exception("%s: a bug", task.name)
            outcome.failure = f"a bug: {type(error).__name__}: {' '.join(str(error).split())}"
        outcome.seconds = time.perf_counter() - began
        outcome.write(task.folder, task.key)
        return outcome


@contextmanager
def _one_thread() -> Iterator[None]:
    """Inside, the solver uses one thread."""
    import numba

    before = numba.get_num_threads()
    numba.set_num_threads(1)
    try:
        yield
    finally:
        numba.set_num_threads(before)


class Begun(Progress):
    """Makes a file when the first steps are done, and keeps the time of the run in one of its own; see `times_in`."""

    def __init__(self, path: Path, key: str = "") -> None:
        self._path, self._is_made = path, False
        self._own, self._written = path.with_name(f"{path.name}-{key}"), -math.inf

    def make(self) -> None:
        """Make the file, once."""
        if not self._is_made:
            self._is_made = True
            write_text(self._path, "")

    def settling(self, steps: int, ratio: float, stage: str) -> None:
        """Report the progress of a static stage."""
        self.make()

    def running(self, run: Run, steps: int) -> None:
        """Report the progress of the run itself."""
        self.make()
        if (now := time.monotonic()) - self._written >= BETWEEN:
            self._written = now
            write_text(self._own, f"{run.time!r}")

    def end(self) -> None:
        """The run is over."""
        self._own.unlink(missing_ok=True)


def times_in(folder: Path) -> dict[str, float]:
    """The time (s) that the run of each member under way has come to, by key; members not yet stepped have none."""
    found = {}
    for path in folder.glob("begun-*-*"):
        with suppress(OSError, ValueError, RecordError):  # it is being written, or the run is over
            found[path.name.rsplit("-", 1)[-1]] = float(content_of(path, LONGEST_TIME))
    return found


def _run(task: Task) -> tuple[dict[str, float], list[str]]:
    """Run the member, or continue it if it was left unfinished; returns its values and warnings."""
    case, results = _case_of(task), task.folder / MEMBERS
    partial = Folder(results, case.name).partial
    shared, progress = Shared(task.folder / SETTLED), Begun(task.begun, task.key)
    folder = None
    try:
        if _is_unfinished(case, partial):
            with suppress(CaseError):  # such as a checkpoint with another time step, of another machine
                folder = resume_case(partial, progress=progress, shared=shared)
        if folder is None:
            folder = run_case(case, results, progress, shared=shared)
    finally:
        progress.end()
    failed = estimate_if_asked(case, folder)
    summary = read_summary(folder)
    return values_of_run(folder, summary), [*summary["warnings"], *([failed] if failed else [])]


def _is_unfinished(case: Case, partial: Path) -> bool:
    """Whether a partial folder has a checkpoint of a run with the same results as that of a case."""
    from dembound.running.unfinished import find_unfinished

    try:
        return partial.is_dir() and digest(find_unfinished(partial).case) == digest(case)
    except CaseError:  # no checkpoint, or a damaged one
        return False


def _calibrate(task: Task) -> tuple[dict[str, float], list[str]]:
    """Calibrate all sides of the member that have dashpots; returns the factors, and no warnings."""
    from dembound.studies.all_sides import calibrate_all

    case = as_kind(_case_of(task), DiskCase, "is the case of a bar; β of disks is calibrated")
    begun = Begun(task.begun)
    found = calibrate_all(case, Calibrating(method=task.method), report=lambda _: begun.make())
    return values_of_calibration(found), []


def _case_of(task: Task) -> Case:
    return loads(task.text, task.case_folder, task.name, task.files)


_ACTIONS: Mapping[Action, Callable[[Task], tuple[dict[str, float], list[str]]]] = {"run": _run, "calibrate": _calibrate}
