"""Results that a run replaces, in words."""

import json
from collections.abc import Iterator
from pathlib import Path

from dembound.casefile import Case
from dembound.errors import DemboundError
from dembound.results.checkpoint import FILE as CHECKPOINT
from dembound.results.checkpoint import differences
from dembound.results.folder import Folder
from dembound.results.reader import open_record, text_of
from dembound.running.unfinished import listed


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
