"""The runs of a page: their records, results and summaries."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dembound.errors import CaseError, RecordError
from dembound.kinds import kind_of_record
from dembound.motion.kind import Kind
from dembound.results.reader import record_names, understood
from dembound.results.results import Results
from dembound.results.summary import read_summary


@dataclass(frozen=True)
class ReportedRun:
    """A run: its record, a unique name, its kind, its results, and its summary.

    The summary is empty for a run that is not complete.
    """

    record: Path
    name: str
    kind: Kind[Any, Any]
    results: Results
    summary: Mapping[str, Any]

    @property
    def has_histories_alone(self) -> bool:
        """Whether the record has only histories of monitors, exact or superposed from a library, and no body."""
        return len(self.results.particles) == 0

    @property
    def is_bar(self) -> bool:
        """Whether the record is that of a bar."""
        return self.kind.name == "bar"


def read_runs(records: Sequence[Path]) -> list[ReportedRun]:
    """The runs of a page.

    Raises CaseError or RecordError, with one line for each record that cannot be read, is not that of a run, or is of
    another kind than the first.
    """
    found: list[tuple[Path, Kind[Any, Any], Results, Mapping[str, Any]]] = []
    errors: list[CaseError] = []
    for record in records:
        try:
            found.append((record, *_read(record)))
        except CaseError as error:
            errors.append(error)
    if errors:
        failure = RecordError if all(isinstance(error, RecordError) for error in errors) else CaseError
        raise failure([line for error in errors for line in str(error).splitlines()])
    kinds = sorted({kind.plural for _, kind, _, _ in found})
    if len(kinds) > 1:
        raise CaseError(
            [f"RESULTS: holds runs of {' and of '.join(kinds)}, which have no page in common; name one kind"]
        )
    names = record_names(records)
    return [
        ReportedRun(record, name, kind, results, summary)
        for name, (record, kind, results, summary) in zip(names, found, strict=True)
    ]


def _read(record: Path) -> tuple[Kind[Any, Any], Results, Mapping[str, Any]]:
    """Kind, results and summary of a record."""
    if record.name == "calibration.h5":
        raise CaseError([f"{record}: is of a calibration; pages and movies are of runs"])
    kind, results = kind_of_record(record), Results(record)
    if record.name != "run.h5" or not (record.parent / "summary.json").is_file():
        return kind, results, {}
    summary = read_summary(record.parent)
    with understood(record):
        _ = summary["version"]  # which every summary has
        return kind, results, dict(summary)
