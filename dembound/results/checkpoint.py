"""Checkpoints, from which another process continues a run, and the stages before a run in files."""

from __future__ import annotations

import json
import os
import time
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.errors import CaseError, RecordError
from dembound.files import DAMAGED, arrays_of, make_folder, opened, replacing, require_plain
from dembound.interrupts import Stopped, caught
from dembound.motion.kind import Stages
from dembound.motion.state import Arrays
from dembound.motion.trackers import Run, Tracker
from dembound.results.reader import understood
from dembound.results.text_files import checked
from dembound.version import __version__
from dembound.words import with_unit

if TYPE_CHECKING:
    from dembound.casefile.model import Case
    from dembound.motion.simulation import Simulation

FILE = "checkpoint.npz"

FACTS = "facts"
"""Name of the facts in the archive."""


@dataclass(frozen=True)
class Checkpoint:
    """A state of a run, or of a stage before it.

    facts : JSON values by name; arrays : by name, see `State.arrays`.
    """

    facts: Mapping[str, Any]
    arrays: Arrays

    def write(self, path: Path, *, durable: bool = True) -> None:
        """Write to a temporary file and rename it; durable : wait until it is on the disk; errors as of `replacing`."""
        text = np.frombuffer(json.dumps(dict(self.facts)).encode(), dtype=np.uint8)
        with replacing(path) as file:
            np.savez(file, allow_pickle=False, **{FACTS: text, **self.arrays})  # type: ignore[arg-type]
            if durable:
                file.flush()
                os.fsync(file.fileno())

    @classmethod
    def read(cls, path: Path) -> Checkpoint:
        """Read a checkpoint.

        Raises RecordError for a file that is damaged, a link, or no file, CaseError for one of another version.
        """
        with opened(path) as file:
            try:
                arrays = arrays_of(file, os.fstat(file.fileno()).st_size)
                facts = json.loads(arrays.pop(FACTS).tobytes())
                version = facts["version"]
            except (KeyError, zipfile.BadZipFile) as error:
                raise RecordError([f"{path}: is damaged: {error}"]) from None
            except DAMAGED:  # whose messages are about numpy's options
                raise RecordError([f"{path}: is damaged, no archive of arrays"]) from None
        if version != __version__:
            raise CaseError([f"{path}: is of dembound {version}, this is {__version__}; run the case anew"])
        return cls(facts, arrays)


class Checkpoints(Tracker):
    """Writes a checkpoint at intervals of wall time, and when a run is requested to end; the last tracker of a run.

    Parameters
    ----------
    path : file of the checkpoint. None: none are written.
    interval : s of wall time from one to the next.
    facts : returns the facts of the present state, after everything before it has been recorded; its second argument is
    whether to wait until the record is on the disk.
    """

    name = "checkpoints"

    def __init__(self, path: Path | None, interval: float, facts: Callable[[Run, bool], dict[str, Any]]) -> None:
        self._path, self._interval, self._facts = path, interval, facts
        self._written = time.monotonic()

    def handle(self, run: Run) -> None:
        """Do nothing: a checkpoint is never due at a step."""

    def observe(self, run: Run, record: np.ndarray) -> None:
        """Write a checkpoint if the last one is old; raises Stopped, after a checkpoint, if the process is to end."""
        if (number := caught()) is not None:
            self.write(run)
            raise Stopped(number)
        if time.monotonic() - self._written >= self._interval:
            self.write(run)

    def write(self, run: Run, *, durable: bool = True) -> None:
        """Write a checkpoint now."""
        if self._path is not None:
            Checkpoint(self._facts(run, durable), run.state.arrays(copies=False)).write(self._path, durable=durable)
            self._written = time.monotonic()


def facts_of(case: Case) -> dict[str, Any]:
    """The facts of any checkpoint of a case."""
    return {"version": __version__, "name": case.name, "case": case.text, "files": case.files, "keys": case.keys}


def differences(first: Any, second: Any, key: str = "") -> list[str]:
    """The keys in which two nested tables differ, a line each with both values.

    A key that is not given has the value None, which TOML does not have.
    """
    if isinstance(first, Mapping) and isinstance(second, Mapping):
        names = dict.fromkeys([*first, *second])
        pairs = [(f"{key}.{name}" if key else name, first.get(name), second.get(name)) for name in names]
        return [line for name, one, two in pairs for line in differences(one, two, name)]
    if first == second:
        return []
    here, there = ("not given" if value is None else json.dumps(value) for value in (first, second))
    return [f"{key}: is {here} here, and {there} there"]


FOLDER = "settled"
"""Name of the folder of stages within that of a run."""


def settled_state(folder: Path, name: str, keys: Mapping[str, Any]) -> Arrays:
    """The arrays of a stage that a run has kept in a folder; name : of the stage, keys : that determine its result.

    Raises CaseError if it is not there or depends on other keys, RecordError if it is damaged, or a link.
    """
    path = folder / f"{name}.npz"
    require_plain(path)
    if not path.is_file():
        raise CaseError([f"static.from: {folder} has no settled state ({name}.npz)"])
    kept = Checkpoint.read(path)
    if different := _unlike(keys, checked(_Kept, kept.facts, path).keys):
        raise CaseError([f"static.from: {folder} has settled another body", *different])
    return kept.arrays


def _unlike(here: Mapping[str, Any], there: Mapping[str, Any]) -> list[str]:
    """The keys of two stages that differ, a line each; one for elements of a continuum, which nobody may have given."""
    sizes = [keys["outside"]["element"] for keys in (here, there) if "outside" in keys]
    follows = ("outside.element:", "outside_rows:")
    lines = differences(here, there)
    others = [line for line in lines if not line.startswith(follows)]
    if len(sizes) < len((here, there)) or len(others) == len(lines):
        return lines
    own, other = (with_unit(size, "m") for size in sizes)
    why = f"elements, which settle too, follow from the waves unless given; they are of {own} here, {other} there"
    return [*others, f"outside.element: {why}; give the same there and here, and settle there anew"]


@dataclass
class _Kept:
    """The facts of a stage."""

    keys: dict[str, Any]


class KeptStages(Stages):
    """Stages that are kept in the folder of a run, or taken from that of another one.

    Parameters
    ----------
    folder : of the stages, created with the first one; None: none are kept.
    keys : the keys of the case on which they depend.
    checkpoints : makes the tracker that writes checkpoints of a stage, given its name.
    source : folder of another run whose stages are used; None: the stages of this run.
    unfinished : name of a stage that a checkpoint was written in, and a function that returns its arrays; or None.
    """

    def __init__(
        self,
        folder: Path | None,
        keys: Mapping[str, Any],
        checkpoints: Callable[[str], Checkpoints],
        source: Path | None = None,
        unfinished: tuple[str, Callable[[], Arrays]] | None = None,
    ) -> None:
        self._folder, self._keys, self._checkpoints = folder, keys, checkpoints
        self._source = folder if source is None else source / FOLDER
        self._required = source is not None
        self._unfinished = unfinished

    def finished(self, name: str) -> Arrays | None:
        """The arrays of a stage; None if it has not been kept.

        Raises CaseError as `settled_state` if it is to be taken from another run.
        """
        if self._source is None or not (self._required or (self._source / f"{name}.npz").is_file()):
            return None
        return settled_state(self._source, name, self._keys)

    def begin(self, name: str, simulation: Simulation) -> None:
        """Write checkpoints of the stage, and continue it from its checkpoint."""
        self._begun = simulation, self._checkpoints(name)
        simulation.track(self._begun[1])
        if self._unfinished is not None and self._unfinished[0] == name:
            with understood(Path(FILE)):
                simulation.state.take(self._unfinished[1]())
            self._unfinished = None

    def finish(self, name: str, arrays: Arrays) -> None:
        """Keep the stage and its checkpoint, with which a run can be resumed before its first step."""
        if self._folder is not None:
            make_folder(self._folder)
            Checkpoint({"version": __version__, "keys": self._keys}, arrays).write(self._folder / f"{name}.npz")
            simulation, checkpoints = self._begun
            checkpoints.write(simulation, durable=False)
