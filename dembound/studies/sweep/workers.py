"""Workers that perform the members of a sweep: processes of this machine, this one, or an existing Dask cluster."""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Iterator
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor
from concurrent.futures import wait as wait_for
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from dembound.errors import CaseError, RunError
from dembound.files import write_text
from dembound.interrupts import ENDING, look, look_at_imports
from dembound.studies.sweep.perform import ALONE, Outcome, Task, perform

if TYPE_CHECKING:
    from distributed import Client

LOGGER = logging.getLogger(__name__)

CONNECTING = 30.0
"""Seconds to wait for a cluster, and for its first worker until that is said."""

ASKING = 1.0
"""Seconds between two questions for the workers of a cluster."""

Performing = Future[Outcome | None]


class Workers(ABC):
    """Perform tasks.

    Attributes
    ----------
    lost : errors of a future whose process has ended before its task. tries : number of submissions of such a task.
    are_elsewhere : whether they continue when this process has ended.
    """

    lost: tuple[type[Exception], ...]
    tries: int
    are_elsewhere = False

    @abstractmethod
    def has_room(self, under_way: int) -> bool:
        """Whether another task may be submitted while `under_way` tasks run."""

    @abstractmethod
    def submit(self, task: Task) -> Performing:
        """Begin a task."""

    def dismiss(self) -> None:  # noqa: B027  # those of a cluster are not ours
        """End the workers that have not begun a task."""

    def require_connected(self, error: Exception) -> None:  # noqa: B027  # only those of a cluster may be out of reach
        """Raise RunError if an error of a task says that its workers are out of reach."""

    @abstractmethod
    def kill(self) -> None:
        """End all running tasks at once."""


class Process(NamedTuple):
    """A process of this machine: the pool with this single worker, and its number, known once it has begun."""

    child: BaseProcess
    pool: ProcessPoolExecutor
    number: Future[int]


class Processes(Workers):
    """Processes of this machine, each in its own pool, so that a killed process does not end others.

    Parameters
    ----------
    count : of processes. stop : file that they make if this process is killed.
    """

    lost = (BrokenProcessPool,)
    tries = 2

    def __init__(self, count: int, stop: Path) -> None:
        self._count, self._stop = count, stop
        self._waiting = [self._new() for _ in range(count)]
        self._working: list[tuple[Process, Performing]] = []

    def _new(self) -> Process:
        """A new process; not forked, as this one may have threads. Raises RunError for one that ends at once."""
        pool = ProcessPoolExecutor(1, multiprocessing.get_context("spawn"), _prepare, (self._stop,))
        others = multiprocessing.active_children()
        with _signals_blocked():
            number = pool.submit(os.getpid)
        children = [each for each in multiprocessing.active_children() if each not in others]
        if not children:
            why = "as where memory, or the right to begin it, is short"
            raise RunError(f"a process for members ended as it began, {why}")
        return Process(children[0], pool, number)

    def has_room(self, under_way: int) -> bool:
        """Up to the number of processes."""
        return under_way < self._count

    def submit(self, task: Task) -> Performing:
        """Begin a task in an idle process; a process that has ended is replaced."""
        for process, performed in [each for each in self._working if each[1].done()]:
            self._working.remove((process, performed))
            is_lost = isinstance(performed.exception(), self.lost)
            self._waiting.append(self._new() if is_lost else process)
        process = self._waiting.pop()
        try:
            performing = process.pool.submit(perform, task)
        except BrokenProcessPool:  # killed while it waited
            process = self._new()
            performing = process.pool.submit(perform, task)
        self._working.append((process, performing))
        return performing

    def kill(self) -> None:
        """End all processes at once."""
        for process in self._all():
            process.child.kill()

    def dismiss(self) -> None:
        """End the processes without a task, and those that are still importing modules."""
        busy = [process for process, performed in self._working if process.number.done() and not performed.done()]
        for process in self._all():
            if process not in busy:
                process.child.kill()

    def close(self) -> None:
        """Wait for running tasks, then end all processes at once, as a regular exit of Python takes a second."""
        wait_for([performing for _, performing in self._working])
        self.dismiss()
        for process in self._all():
            process.pool.shutdown()

    def _all(self) -> list[Process]:
        return [*self._waiting, *(process for process, _ in self._working)]


@contextmanager
def _signals_blocked() -> Iterator[None]:
    """Blocks the signals that end a run, also in a process that is started inside, until it ignores them."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _prepare(stop: Path) -> None:
    """Leave signals to the parent process; if it is killed, end as on its request."""
    for number in ENDING:
        signal.signal(number, signal.SIG_IGN)
    look_at_imports()
    threading.Thread(target=_end_with_parent, args=(stop,), daemon=True).start()


def _end_with_parent(stop: Path) -> None:
    parent = multiprocessing.parent_process()
    assert parent is not None
    wait([parent.sentinel])
    with suppress(OSError, CaseError):
        write_text(stop, "")
    with ALONE:  # the member under way has written its checkpoint
        os._exit(1)


class Here(Workers):
    """The present process, which performs one task at a time: for scripts that others cannot be begun from."""

    lost = ()
    tries = 1

    def has_room(self, under_way: int) -> bool:
        """Whether none is under way."""
        return under_way == 0

    def submit(self, task: Task) -> Performing:
        """Perform a task; raises KeyboardInterrupt if it was asked to stop."""
        performed: Performing = Future()
        if (outcome := perform(task)) is None:
            raise KeyboardInterrupt
        performed.set_result(outcome)
        return performed

    def kill(self) -> None:
        """Nothing runs."""


class Cluster(Workers):
    """The workers of a Dask cluster, whose scheduler gives a task to another worker if one is lost."""

    tries = 1
    are_elsewhere = True

    def __init__(self, client: Client, address: str) -> None:
        from distributed.scheduler import KilledWorker

        self.lost = (KilledWorker,)
        self._client, self._address = client, address
        self._executor = client.get_executor(pure=False)

    def has_room(self, under_way: int) -> bool:
        """True: the scheduler queues tasks."""
        return True

    def submit(self, task: Task) -> Performing:
        """Send a task to the scheduler."""
        try:
            performing: Performing = self._executor.submit(perform, task)
        except Exception as error:  # of a client that has lost its scheduler
            performing = Future()
            performing.set_exception(error)
        return performing

    def require_connected(self, error: Exception) -> None:
        """Raise RunError if the scheduler has been lost, which cancels all tasks."""
        if isinstance(error, CancelledError) or self._client.status != "running":
            raise RunError(f"--scheduler: {self._address} was lost; the same command continues what is left") from None

    def require_workers(self) -> None:
        """Wait for a worker, with a line in the log if there is none for long.

        Raises CaseError unless all workers there have the version of dembound that is here.
        """
        began, is_said = time.monotonic(), False
        while not self._client.scheduler_info()["workers"]:
            self.require_connected(RuntimeError())
            if not is_said and time.monotonic() - began >= CONNECTING:
                is_said = True
                LOGGER.info("--scheduler: %s has no worker yet, which is waited for", self._address)
            look()
            time.sleep(ASKING)
        found: Any = self._client.get_versions(packages=["dembound"])
        here = found["client"]["packages"]["dembound"]
        for worker, versions in sorted(found["workers"].items()):
            there = versions["packages"]["dembound"]
            if there != here:
                said = f"dembound {there}" if there else "no dembound"
                raise CaseError([f"--scheduler: its worker {worker} has {said}, must have {here} as here"])

    def kill(self) -> None:
        """Running members continue until they find the file that requests them to stop."""
        self._executor.shutdown(wait=False)


@contextmanager
def processes(count: int, stop: Path) -> Iterator[Processes]:
    """`count` processes of this machine; stop : as of `Processes`."""
    workers = Processes(count, stop)
    try:
        yield workers
    finally:
        workers.close()


@contextmanager
def cluster(address: str) -> Iterator[Cluster]:
    """The cluster whose scheduler has this address, such as tcp://10.0.0.1:8786.

    Raises CaseError if Dask is not installed, no scheduler answers, or workers have another version of this package.
    """
    try:
        from distributed import Client
    except ImportError:
        raise CaseError(["--scheduler: needs Dask; install dembound[cluster]"]) from None
    try:
        client = Client(address, timeout=CONNECTING)
    except (OSError, ValueError) as error:
        raise CaseError([f"--scheduler: {address} does not answer: {' '.join(str(error).split())}"]) from None
    for name in list(logging.root.manager.loggerDict):  # lost connections are said here
        if name.partition(".")[0] == "distributed":
            logging.getLogger(name).setLevel(logging.CRITICAL)
    with client:
        workers = Cluster(client, address)
        workers.require_workers()
        yield workers
