"""The case of a record, and results shared by the runs of a batch."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tomli_w
from filelock import Timeout

from dembound.casefile.model import Case
from dembound.casefile.reader import parsed
from dembound.errors import CaseError, DemboundError, RecordError
from dembound.files import lock_of, make_folder
from dembound.interrupts import look
from dembound.kinds import kind_of
from dembound.results.folder import DIGEST, PLACE, Folder, file_of, problem_of, recorded_source
from dembound.results.reader import open_record, text_of
from dembound.schemas import loads

if TYPE_CHECKING:
    import h5py

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


RECORDED = ("origin", "kind", PLACE, DIGEST)
"""Attributes of a record that identify its case."""


def recorded_case(record: Path) -> Case:
    """The case of a record, with the files that it refers to, all read from the record.

    A settled state of another run (``static.from``) is not in the record; the body settles again, with the same result.

    Raises CaseError for a record of no run, RecordError, in one line, if there is none or its case cannot be read.
    """
    with open_record(record) as file:
        missing = [name for name, there in (("case", file.attrs), ("inputs", file)) if name not in there]
        if len(missing) == 2 and "particles" not in file:
            raise CaseError([f"{record}: is of no run, it has no case that could be run again"])
        if missing:
            raise RecordError([f"{record}: is damaged: it has no {' and no '.join(missing)}"])
        text, name = text_of(file.attrs["case"]), text_of(file.attrs["name"])
        origin = text_of(file.attrs["origin"]) if "origin" in file.attrs else name  # earlier versions have none
        silent = silent_of(file)
        files = inputs_of(file)
    data = tables_of(text, record)
    if isinstance(static := data.get("static"), dict) and static.pop("from", None) is not None:
        text = tomli_w.dumps(data)
    return replace(case_of(text, record, name, files), origin=origin, silent=silent)


def silent_of(file: "h5py.File") -> frozenset[str]:
    """The waves of a record's case without motion."""
    return frozenset(map(text_of, file.attrs.get("silent", ())))


def inputs_of(file: "h5py.File") -> dict[str, str]:
    """Texts of the files that the case of a record refers to, by their paths in it."""
    return {text_of(given.attrs["path"]): given[()].tobytes().decode() for given in file.get("inputs", {}).values()}


def require_replaceable(folder: Folder, case: Case) -> None:
    """Raise CaseError if a run would replace the results of a case from another file or of another kind of body.

    A case whose numbers have been changed is the same case, and so is one whose file has been moved. Records without an
    origin, of earlier versions, and those that cannot be read are replaced.
    """
    for path in (folder.final, folder.partial):
        if not (path / "run.h5").is_file():
            continue
        try:
            with open_record(path / "run.h5") as file:
                texts = {name: text_of(file.attrs[name]) for name in RECORDED if name in file.attrs}
        except DemboundError:
            continue
        there = {name: texts[name] for name in ("origin", "kind") if name in texts}
        own = {"origin": case.origin, "kind": kind_of(case).name}
        if different := [name for name in there if there[name] != own[name]]:
            whose = {"origin": "case {}", "kind": "a case of {}"}[different[0]]
            raise _taken(path, whose.format(there[different[0]]), whose.format(own[different[0]]))
        source, file = recorded_source(texts, folder.final.parent), file_of(case)
        if source is not None and file.is_file() and not file.samefile(source[0]):
            raise _taken(path, source[0], file)


def _taken(path: Path, there: object, own: object) -> CaseError:
    """The error for a folder that has results of another case or kind than those of a run."""
    advice = "give another --name or --output, or remove them"
    return CaseError([f"{path}: has results of {there}, which this run of {own} would replace; {advice}"])


def file_of_record(record: Path) -> Path | None:
    """The case file of a record in its folder of results; None if it is no longer there."""
    with open_record(record) as file:
        texts = {name: text_of(file.attrs[name]) for name in (PLACE, DIGEST) if name in file.attrs}
    source = recorded_source(texts, record.parent.parent)
    return None if source is None else source[0]


def tables_of(text: str, record: Path) -> dict[str, Any]:
    """The tables of a recorded case; raises RecordError for a text that is no case."""
    try:
        return parsed(text)
    except CaseError as error:
        raise RecordError([f"{record}: the case in it is damaged: {error.problems[0]}"]) from None


def case_of(text: str, record: Path, name: str, files: Mapping[str, str]) -> Case:
    """A recorded case; raises RecordError for one that this version cannot read, with its first mistake."""
    if problem := problem_of(name):
        raise RecordError([f"{record}: its name is {name!r}, {problem}"])
    try:
        return loads(text, name=name, files=files)
    except CaseError as error:
        more = f" ({len(error.problems) - 1} more)" if len(error.problems) > 1 else ""
        raise RecordError([f"{record}: the case in it cannot be read here: {error.problems[0]}{more}"]) from None


def recorded_beginning(record: Path) -> float | None:
    """The duration (s) for which the run of a record was begun, if it was continued to another time; else None."""
    with open_record(record) as file:
        if "regular_steps" not in file.attrs:
            return None
        return float(file.attrs["regular_steps"] * file.attrs["time_step"])
