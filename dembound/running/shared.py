"""What the runs of a batch share: stages before the run, and the request to stop."""

import hashlib
import json
import signal
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from filelock import FileLock, Timeout

from dembound.results.interrupts import Interrupts, Stopped


class StopFile(Interrupts):
    """Ends a run as SIGTERM does once a file exists, on any machine that sees it and in any thread."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._path = path

    @property
    def caught(self) -> int | None:
        """Number of the signal, also one received by this process; None before."""
        return self._signal if self._signal is not None or not self._path.exists() else signal.SIGTERM

    @caught.setter
    def caught(self, number: int | None) -> None:
        self._signal = number


@dataclass(frozen=True)
class Shared:
    """What a run shares with others; by default nothing.

    Attributes
    ----------
    settled : folder of the stages before the runs, in a folder for each set of keys on which they depend. The first run
    that needs a stage computes it, others wait for it.
    stop : a file; once it exists, all runs write a checkpoint and end.
    """

    settled: Path | None = None
    stop: Path | None = None

    def interrupts(self) -> Interrupts:
        """Notes requests to end."""
        return Interrupts() if self.stop is None else StopFile(self.stop)

    def stages(self, keys: Mapping[str, Any]) -> Path | None:
        """The folder of the stages that depend on these keys; None if they are not shared, or there are none."""
        if self.settled is None or not keys:
            return None
        text = json.dumps(keys, sort_keys=True)
        return self.settled / hashlib.sha256(text.encode()).hexdigest()[:16]

    @contextmanager
    def settling(self, keys: Mapping[str, Any], interrupts: Interrupts) -> Iterator[None]:
        """Inside, no other run computes the stages that depend on these keys; raises Stopped if it is to end before."""
        folder = self.stages(keys)
        if folder is None:
            yield
            return
        folder.parent.mkdir(parents=True, exist_ok=True)
        lock = FileLock(folder.with_suffix(".lock"))
        while not lock.is_locked:
            try:
                lock.acquire(timeout=1.0)
            except Timeout:
                if interrupts.caught is not None:
                    raise Stopped(interrupts.caught) from None
        try:
            yield
        finally:
            lock.release()
