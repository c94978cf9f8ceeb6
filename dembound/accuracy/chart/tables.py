"""The results of a chart in files: groups of ``chart.h5`` beside the runs, and ``chart.csv``."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.accuracy.chart.record import write_motions
from dembound.accuracy.chart.study import Charted, Line
from dembound.accuracy.choice import digest
from dembound.formulas.cause import TITLES
from dembound.results.committed import changed_file
from dembound.results.text_files import write_csv
from dembound.version import __version__

if TYPE_CHECKING:
    import h5py

RESULTS = ("choices", "reference")
"""The groups with the results, which are written anew every time."""

COLUMNS = (
    *("choice", "on_front", "failure", "monitor", "component", "rms", "total", "peak", "monitor_apart_m", "cost_s"),
    *("cpu_min_s", "cpu_max_s", "run_s", "work", "threads", "stepped", "steps", "time_step_s"),
)
"""Columns of every table; then those of findings, and one for every key that a choice changes."""


def write_results(charted: Charted, path: Path) -> None:
    """Write errors, front and reference into the record that has the runs of the chart."""
    with changed_file(path) as file:
        for name in RESULTS:
            if name in file:
                del file[name]
        case = charted.case
        file.attrs.update({"name": case.name, "title": case.title, "case": case.text, "version": __version__})
        file.attrs.update({"quantity": charted.quantity, "work_unit": charted.work_unit})
        file.attrs.update({"sentence": charted.sentence, "left_out": "\n".join(charted.left_out)})
        _write_reference(file.create_group("reference"), charted)
        choices = file.create_group("choices", track_order=True)
        for number, line in enumerate(charted.lines):
            _write_line(choices.create_group(f"{number:04d}"), charted, number, line)


def _write_reference(group: h5py.Group, charted: Charted) -> None:
    """Write the name of the reference, which errors it measures, and its histories.

    Histories of an exact solution are written at the monitors of the first choice.
    """
    reference = charted.reference
    own = np.array(reference.own, dtype=int)
    group.attrs.update({"name": reference.name, "sentence": reference.sentence, "choices": own})
    group.attrs.update({"of": TITLES[reference.of], "covered": reference.covered, **reference.findings})
    line = next(line for line in charted.lines if not line.outcome.failure)
    write_motions(group.create_group("gauges"), reference.motions(line.choice, line.outcome))


def _write_line(group: h5py.Group, charted: Charted, number: int, line: Line) -> None:
    """Write a choice: its name and changes, the digest of its run, and the errors of its monitors."""
    choice, on_front = line.choice, number in charted.front
    group.attrs.update({"name": choice.name, "digest": digest(choice.case), "changes": json.dumps(choice.changes)})
    group.attrs.update({"on_front": on_front, "failure": line.outcome.failure, "found": charted.found(line)})
    if not line.errors:
        return
    group.attrs.update({"error": line.point.error, "cost": line.point.cost})
    group.attrs.update({"wall": line.wall, "work": line.outcome.work})
    group.create_dataset("monitor", data=[error.monitor for error in line.errors])
    group.create_dataset("component", data=[error.component for error in line.errors])
    for name, unit in (("rms", "1"), ("total", "1"), ("peak", "1"), ("apart", "m")):
        group.create_dataset(name, data=np.array([getattr(e, name) for e in line.errors])).attrs["unit"] = unit


def write_table(charted: Charted, path: Path) -> None:
    """Write a row for every choice as CSV, SI units, errors as parts of one; completely or not at all."""
    findings = sorted({name for line in charted.lines for name in line.outcome.findings})
    keys = list(dict.fromkeys(key for line in charted.lines for key in line.choice.changes))
    rows: list[list[Any]] = [[*COLUMNS, *(part for name in findings for part in (name, f"{name} error")), *keys]]
    for number, line in enumerate(charted.lines):
        changed = (line.choice.changes.get(key) for key in keys)
        rows.append([line.choice.name, *_numbers(charted, number, line), *_found(charted, line, findings), *changed])
    write_csv(path, rows)


def _numbers(charted: Charted, number: int, line: Line) -> list[Any]:
    """The columns of a choice after its name."""
    outcome = line.outcome
    if not line.errors:
        return [False, outcome.failure, *[None] * (len(COLUMNS) - 3)]
    worst = line.errors[0]
    error = worst.monitor, worst.component, worst.rms, worst.total, worst.peak, worst.apart
    costs = line.point.cost, min(outcome.cpu), max(outcome.cpu), line.wall, outcome.work, outcome.threads
    return [number in charted.front, "", *error, *costs, outcome.count, outcome.steps, outcome.time_step]


def _found(charted: Charted, line: Line, names: list[str]) -> Iterator[float | None]:
    """The findings of a choice, each followed by its difference from the finding of the reference."""
    for name in names:
        found, expected = line.outcome.findings.get(name), charted.reference.findings.get(name)
        yield None if found is None else found.value
        yield None if found is None or expected is None else found.value - expected
