"""Runs that can be continued, and results that a run replaces: from a folder to its case and its last checkpoint."""

import json
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import tomli_w
from pydantic import ConfigDict, Field

from dembound.casefile.model import Case
from dembound.casefile.tables import ENDING
from dembound.errors import CaseError, DemboundError, RecordError
from dembound.files import copy, make_folder, require_plain
from dembound.motion.scene import Scene
from dembound.motion.state import Arrays
from dembound.results.checkpoint import FILE, Checkpoint, differences
from dembound.results.checkpoint import FILE as CHECKPOINT
from dembound.results.checkpoint import FOLDER as STAGES
from dembound.results.datasets import require_readable
from dembound.results.folder import DIGEST, PARTIAL, PLACE, Folder, recorded_source, with_name
from dembound.results.new_record import require_laid_out
from dembound.results.reader import increasing, open_record, text_of, understood
from dembound.results.text_files import checked
from dembound.running.recorded import case_of, inputs_of, silent_of
from dembound.schemas import load, loads
from dembound.waves.file_wave import read_text

MOST_KEYS = 5
"""Largest number of changed keys of a case that are listed."""

Count = Annotated[int, Field(ge=0, le=2**53)]


@dataclass
class _Counts:
    """The numbers of rows at a checkpoint, see `Recorder.counts`."""

    histories: Count
    sides: Count
    cracks: Count
    energy: Count
    laws: Count
    snapshots: Count


@dataclass
class _Facts:
    """The facts of the checkpoint of a run, as JSON has them."""

    name: str
    case: str
    files: dict[str, str]
    keys: dict[str, Any]
    seconds: dict[Literal["settle", "step", "record"], Annotated[float, Field(ge=0.0)]]
    step: Count
    regular_steps: Annotated[Count, Field(ge=1)]
    time_step: Annotated[float, Field(gt=0.0)]
    stage: str | None
    counts: _Counts | None
    resumed: list[dict[str, Any]]

    __pydantic_config__ = ConfigDict(allow_inf_nan=False)


@dataclass(frozen=True)
class Unfinished:
    """A run that is continued.

    Attributes
    ----------
    case : with its new duration, if it has one. folder : of its results.
    path : the folder of its checkpoint, the partial or the complete one. facts : of the checkpoint, without its arrays.
    """

    case: Case
    folder: Folder
    path: Path
    facts: dict[str, Any]

    @property
    def stage(self) -> str | None:
        """The stage before the run in which it was stopped; None in the run itself."""
        return self.facts["stage"]

    @property
    def resumed(self) -> list[dict[str, Any]]:
        """The states from which it has been continued, this one included, for the summary."""
        here = {"stage": self.stage, "step": self.facts["step"]}
        return [*self.facts["resumed"], here]

    @property
    def written(self) -> int:
        """Bytes in its partial folder; 0 for a complete run, which is copied there first."""
        if self.path != self.folder.partial:
            return 0
        return sum(path.stat().st_size for path in self.path.rglob("*") if path.is_file())

    def arrays(self) -> Arrays:
        """The arrays of the checkpoint, read anew; raises RecordError if they are of another step than its facts."""
        arrays = Checkpoint.read(self.path / FILE).arrays
        if arrays["step"] != self.facts["step"]:
            raise RecordError([f"{self.path / FILE}: is damaged: its arrays are not of step {self.facts['step']}"])
        return arrays

    def require_record(self, scene: Scene) -> None:
        """Raise RecordError if the record of the run, if it has begun, lacks datasets that the scene appends to.

        Also if the times of its histories do not increase.
        """
        if (counts := self.facts["counts"]) is not None:
            record = self.path / "run.h5"
            with open_record(record) as file, understood(record):
                require_laid_out(file, scene, counts)
                for group in file["histories"].values():
                    increasing(group["time"])

    def copy_to(self, partial: Path) -> None:
        """Copy the files from which a run is continued to its partial folder, unless they are there.

        Raises CaseError if another process has removed them meanwhile.
        """
        if not (self.path / FILE).is_file():
            raise CaseError([f"{self.path}: has been changed by another run meanwhile; nothing is left to resume"])
        if self.path == partial:
            return
        kept = sorted((self.path / STAGES).glob("*.npz"))
        if kept:
            make_folder(partial / STAGES)
        for path in (self.path / "run.h5", self.path / FILE, *kept):
            copy(path, partial / path.relative_to(self.path))


def find_unfinished(folder: Path, until: float | None = None) -> Unfinished:
    """The run of a folder of results; until : s, its new duration.

    Raises CaseError as `dembound.running.resume_case`.
    """
    results = Folder.of(folder)
    results.require_unused()
    path = _place_of_checkpoint(with_name(folder), results.partial)
    facts = dict(Checkpoint.read(path / FILE).facts)
    checked(_Facts, facts, path / FILE)
    case = replace(_case_of(facts, path), name=results.name)
    is_complete = not path.name.endswith(PARTIAL)
    if until is None and is_complete:
        raise CaseError([f"{path}: is complete; a later time, until, continues it"])
    reached = facts["step"] * facts["time_step"] if facts["stage"] is None else 0.0
    if until is not None and until <= reached:
        raise CaseError([f"until: is {until:g} s, must be after {reached:g} s, which the run has reached"])
    if until is not None:  # without an earlier end
        data = tomllib.loads(case.text)
        data["run"] = {key: value for key, value in data["run"].items() if key not in ENDING} | {"duration": until}
        case = loads(tomli_w.dumps(data), case.folder, case.name, case.files)
    if (path / "run.h5").is_file():  # the run itself has begun
        with open_record(path / "run.h5") as record:
            case = replace(case, silent=silent_of(record))
    return Unfinished(case, results, path, facts)


def left_of(partial: Path, command: str) -> list[str]:
    """The results in the partial folder of a run that ended early, and the command that continues it, in words."""
    left = [f"histories so far are in {partial}"] if (partial / "run.h5").is_file() else []
    if (partial / FILE).is_file():
        left.append(f"to continue: {command}")
    return left


def changes_since(folder: Path) -> list[str]:
    """A line for every file of a run's case, and file that it refers to, that has changed since the run began.

    Changes of keys that only end the run, and missing files, are left out.
    """
    with understood(folder / "run.h5"), open_record(folder / "run.h5") as file:
        texts = {name: text_of(file.attrs[name]) for name in (PLACE, DIGEST) if name in file.attrs}
        recorded = _lasting_any_time(json.loads(text_of(file.attrs["keys"])))
        inputs = inputs_of(file)
    source = recorded_source(texts, folder.parent)
    if source is None:
        return []
    path, has_changed = source
    return [*(_changed_keys(path, recorded) if has_changed else ()), *_changed_inputs(path.parent, inputs)]


def _changed_keys(path: Path, recorded: dict[str, Any]) -> Iterator[str]:
    """One line if the keys of a case file are no longer those recorded."""
    try:
        now = json.loads(json.dumps(load(path).keys))
        keys = [line.partition(":")[0] for line in differences(recorded, _lasting_any_time(now))]
    except DemboundError as error:
        keys = [str(error).splitlines()[0]]
    of_it = f"{path}: has changed since the run began ({listed(keys)}); the case as it was goes on"
    yield from [f"{of_it}, dembound run begins the changed one"] if keys else []


def listed(keys: Sequence[str]) -> str:
    """The first few changed keys as text."""
    return ", ".join(keys[:MOST_KEYS]) + ", …" * (len(keys) > MOST_KEYS)


def _changed_inputs(folder: Path, inputs: Mapping[str, str]) -> Iterator[str]:
    """A line for each file whose text is no longer that recorded; folder : of the case."""
    for name, text in inputs.items():
        try:
            is_other = read_text(folder / name) != text
        except ValueError:
            is_other = (folder / name).exists()
        if is_other:
            of_it = f"{folder / name}: has changed since the run began; its values as they were go on"
            yield f"{of_it}, dembound run begins with the changed ones"


def _place_of_checkpoint(folder: Path, partial: Path) -> Path:
    """The folder that has a checkpoint: the one that was given, or the partial one.

    Raises CaseError if none has, RecordError if there is no record either, or a link.
    """
    places = [place for place in (folder, partial) if place.is_dir()]
    if not places:
        raise CaseError([f"{folder}: there is no such folder of results"])
    require_plain(*(place / FILE for place in places))
    if found := [place for place in places if (place / FILE).is_file()]:
        return found[0]
    records = [place / "run.h5" for place in places if (place / "run.h5").is_file()]
    anew = f"; `dembound rerun {records[0]}` runs its case anew" if records else ""
    reasons = "as after a run with run.checkpoint = 0, or one that ended before its first checkpoint"
    raise (CaseError if records else RecordError)([f"{folder}: has no checkpoint ({FILE}), {reasons}{anew}"])


def _case_of(facts: dict[str, Any], path: Path) -> Case:
    """The case of a checkpoint, with the duration that the record has, which may be a later one.

    Raises CaseError if the record has another case, or if its keys differ here from those where it was written, and
    RecordError if the record is damaged.
    """
    checkpoint = path / FILE
    case, text = case_of(facts["case"], checkpoint, facts["name"], facts["files"]), facts["case"]
    others = [("this installation", json.loads(json.dumps(case.keys)))]
    if facts["stage"] is None:
        with open_record(path / "run.h5") as record:
            require_readable(record)
            others.append(("run.h5", dict(json.loads(record.attrs["keys"]))))
            text = text_of(record.attrs["case"])
    for where, keys in others:
        if different := differences(_lasting_any_time(facts["keys"]), _lasting_any_time(keys)):
            raise CaseError([f"{path}: the case of {FILE} is not that of {where}", *different])
    return case if text == facts["case"] else case_of(text, path / "run.h5", facts["name"], facts["files"])


def _lasting_any_time(keys: dict[str, Any]) -> dict[str, Any]:
    """The keys of a case without those that determine when its run ends."""
    lasting = run if isinstance(run := keys.get("run"), dict) else {}
    return keys | {"run": {key: value for key, value in lasting.items() if key not in (*ENDING, "duration")}}


def replaced_in_words(folder: Folder, case: Case) -> Iterator[str]:
    """A line for complete results that a run of the case will replace, and one for a stopped run that it discards."""
    if (folder.final / "run.h5").is_file():
        others = _other_keys(folder.final / "run.h5", case)
        yield f"replaces {folder.final}{others} when it is complete; to keep both, stop it and give --name or --output"
    if (folder.partial / CHECKPOINT).is_file():
        yield f"begins anew, without the stopped run in {folder.partial}, which dembound resume would have continued"


def _other_keys(record: Path, case: Case) -> str:
    """The keys in which the case of a record differs, in brackets; empty if it cannot be read."""
    try:
        with open_record(record) as file:
            there = json.loads(text_of(file.attrs["keys"]))
    except DemboundError:
        return ""
    changed = [line.partition(":")[0] for line in differences(there, json.loads(json.dumps(case.keys)))]
    return f" (with another {listed(changed)})" if changed else " (of the same case)"
