"""A sweep: every member is run or calibrated once, and outcomes are kept, so that a sweep can be continued."""

import errno
import os
import uuid
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from filelock import Timeout

from dembound.casefile.tables import Action, Method
from dembound.errors import CaseError, RunError
from dembound.files import lock_of, make_folder, remove, require_no_link, write_text
from dembound.interrupts import look
from dembound.machine import cores_here
from dembound.results.folder import Folder
from dembound.studies.sweep.members import Member
from dembound.studies.sweep.perform import MEMBERS, OUTCOMES, Outcome, Task, forget_replaced, outcome_in
from dembound.studies.sweep.workers import Here, Performing, Workers, cluster, processes

LOOK = 0.2
"""Seconds between two checks of running members."""

LOCK = "sweep.lock"


@dataclass(frozen=True)
class Options:
    """Options of a sweep: action and method as in the table ``[sweep]``.

    processes : on this machine; None: as many as it has cores; 0: in this process, one member after the other.
    scheduler : address of a Dask cluster used instead. anew : whether members that are done are repeated.
    """

    action: Action = "run"
    method: Method = "impedance"
    processes: int | None = None
    scheduler: str | None = None
    anew: bool = False


class Standing(NamedTuple):
    """Progress of a sweep as numbers of members; kept : done in an earlier sweep, also counted as done."""

    members: int
    done: int
    failed: int
    under_way: int
    kept: int


class Marks(NamedTuple):
    """Files of a sweep under way: begun, made by the first member that is stepped; stop, which ends all members.

    Members whose run is stepped have a file each beside begun, see `times_in`.
    """

    begun: Path
    stop: Path


Report = Callable[[Standing], None]


def sweep(members: Sequence[Member], options: Options, folder: Path, report: Report) -> list[Outcome | None]:
    """The outcomes of members, in their order; only failed ones and those not in the folder are computed.

    The second and later members begin when the first one is stepped, as its code is compiled then. A member whose
    process ends without an outcome is repeated once. After Ctrl-C or SIGTERM all members write a checkpoint;
    KeyboardInterrupt is raised when they have ended; a second one kills them.

    Raises CaseError for a folder that another sweep uses, or that has other contents, RecordError for links in it, and
    RunError for workers out of reach.
    """
    with _marks_in(folder) as marks:
        found = {m.key: None if options.anew else outcome_in(folder, m.key) for m in members}
        missing = [member for member in members if (kept := found[member.key]) is None or kept.failure]
        if missing:
            if options.action == "run":
                for member in missing:
                    Folder(folder / MEMBERS, member.name).require_own()
                forget_replaced(folder, {member.name for member in missing})
            with _workers(options, len(missing), marks.stop) as workers:
                work = _Work(members, missing, options, folder, marks, report)
                found |= work.done_by(workers)
    return [found[member.key] for member in members]


def _workers(options: Options, most: int, stop: Path) -> AbstractContextManager[Workers]:
    """The workers for a number of members; stop : as of `Processes`."""
    if options.scheduler:
        return cluster(options.scheduler)
    if options.processes == 0:
        return nullcontext(Here())
    return processes(min(options.processes or cores_here(), most), stop)


@contextmanager
def _marks_in(folder: Path) -> Iterator[Marks]:
    """The marks of a sweep in its folder, which no other one uses inside; errors as of `sweep`."""
    require_no_link(folder, folder / OUTCOMES, folder / MEMBERS)
    if folder.is_dir() and any(folder.iterdir()) and not (folder / OUTCOMES).is_dir():
        raise CaseError([f"{folder}: exists and holds no sweep, give another --output or --name"])
    if folder.exists() and not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(folder))
    make_folder(folder / OUTCOMES)
    lock, name = lock_of(folder / LOCK), uuid.uuid4().hex[:8]
    try:
        lock.acquire(blocking=False)
    except Timeout:
        raise CaseError([f"{folder}: is being written by another sweep; wait for its end"]) from None
    try:
        yield Marks(folder / f"begun-{name}", folder / f"stop-{name}")
        for mark in (*folder.glob("begun-*"), *folder.glob("stop-*")):  # also of sweeps that were killed
            remove(mark)
    finally:
        lock.release()


class _Work:
    """The missing and the running members of a sweep."""

    def __init__(
        self,
        members: Sequence[Member],
        missing: Sequence[Member],
        options: Options,
        folder: Path,
        marks: Marks,
        report: Report,
    ) -> None:
        self._options, self._folder, self._marks, self._report = options, folder.resolve(), marks, report
        self._count, self._kept = len(members), len(members) - len(missing)
        self._waiting = list(missing)
        self._under_way: dict[Performing, Member] = {}
        self._tried: Counter[str] = Counter()
        self._found: dict[str, Outcome | None] = {}

    def done_by(self, workers: Workers) -> dict[str, Outcome | None]:
        """The outcomes of all missing members by key."""
        try:
            while self._waiting or self._under_way:
                look()
                self._submit(workers)
                self._report(self._standing)
                done, _ = wait(self._under_way, timeout=LOOK, return_when=FIRST_COMPLETED)
                for performed in done:
                    self._take(performed, workers)
            self._report(self._standing)
        except (KeyboardInterrupt, RunError):
            self._end(workers)
            raise
        return self._found

    def _submit(self, workers: Workers) -> None:
        """Begin members while there is room; only one until code is compiled."""
        while self._waiting and workers.has_room(len(self._under_way)):
            if self._under_way and not self._found and not self._marks.begun.exists():
                return
            member = self._waiting.pop(0)
            self._tried[member.key] += 1
            self._under_way[workers.submit(self._task(member))] = member

    def _task(self, member: Member) -> Task:
        case, options, marks = member.case, self._options, self._marks
        places = Path.cwd(), self._folder, marks.begun.resolve(), marks.stop.resolve()
        text = case.text, case.folder.resolve(), case.files
        return Task(member.name, member.key, *text, options.action, options.method, *places)

    def _take(self, performed: Performing, workers: Workers) -> None:
        """Keep the outcome of a member; a member whose process was lost is repeated once, then counted as failed."""
        member = self._under_way.pop(performed)
        try:
            self._found[member.key] = performed.result()
        except workers.lost as error:
            if self._tried[member.key] < workers.tries:
                self._waiting.insert(0, member)
                return
            reason = f"its process was killed, as where memory is short ({type(error).__name__})"
            outcome = Outcome(member.name, failure=reason)
            outcome.write(self._folder, member.key)
            self._found[member.key] = outcome
        except Exception as error:  # of a cluster
            workers.require_connected(error)
            self._found[member.key] = Outcome(member.name, failure=f"{type(error).__name__}: {error}")

    def _end(self, workers: Workers) -> None:
        """Request all members to end, and wait for running ones; kill them if another signal arrives."""
        try:
            write_text(self._marks.stop, "")
            workers.dismiss()
            wait([each for each in self._under_way if not each.cancel()])
        except KeyboardInterrupt:
            workers.kill()
            raise
        if not workers.are_elsewhere:  # else members that still have to see it may be under way
            for mark in (self._marks.stop, *self._folder.glob(f"{self._marks.begun.name}*")):
                remove(mark)

    @property
    def _standing(self) -> Standing:
        failed = sum(outcome is None or bool(outcome.failure) for outcome in self._found.values())
        done = self._kept + len(self._found) - failed
        return Standing(self._count, done, failed, len(self._under_way), self._kept)
