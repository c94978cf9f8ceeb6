"""Results shared by the runs of a batch: stages before the run."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from filelock import Timeout

from dembound.files import lock_of, make_folder
from dembound.interrupts import look

LOOK = 0.5
"""Seconds between two checks for a request to end, while another run computes a stage."""


@dataclass(frozen=True)
class Shared:
    """Results that a run shares with others; by default none.

    Attributes
    ----------
    settled : folder of the stages before the runs, in a folder for each set of keys on which they depend. The first run
    that needs a stage computes it, others wait for it.
    """

    settled: Path | None = None

    def stages(self, keys: Mapping[str, Any]) -> Path | None:
        """The folder of the stages that depend on these keys; None if they are not shared, or there are none."""
        if self.settled is None or not keys:
            return None
        text = json.dumps(keys, sort_keys=True)
        return self.settled / hashlib.sha256(text.encode()).hexdigest()[:16]

    @contextmanager
    def settling(self, keys: Mapping[str, Any]) -> Iterator[None]:
        """Inside, no other run computes the stages that depend on these keys.

        Raises Stopped if this run is requested to end.
        """
        folder = self.stages(keys)
        if folder is None:
            yield
            return
        make_folder(folder.parent)
        lock = lock_of(folder.with_suffix(".lock"))
        while not lock.is_locked:
            look()
            with suppress(Timeout):
                lock.acquire(timeout=LOOK)
        try:
            yield
        finally:
            lock.release()
