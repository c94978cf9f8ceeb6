"""The histories of a library under a record, written with the layout of a run, and warnings about the record."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.files import make_folder
from dembound.results.committed import new_file
from dembound.results.datasets import describe, write
from dembound.results.new_record import DISPLACEMENT_UNIT, VELOCITY_UNIT
from dembound.running import plan, warnings_before
from dembound.studies.library.build import under
from dembound.studies.library.library import Library
from dembound.studies.library.record import Record

COPIED = ("kind", "size", "time_step", "step_limit", "steps", "version")
"""Attributes that a response takes from the library."""


def case_of(library: Library, record: Record) -> DiskCase:
    """The case of the direct run of a record: with its files as file waves, other inputs silent."""
    waves = {name: {"type": "file", "path": given.as_posix()} for name, (given, _) in record.files.items()}
    case = under(library.case, waves, record.name, _texts(record))
    return replace(case, silent=frozenset(library.inputs) - set(record.files))


def record_warnings(library: Library, records: Sequence[Record]) -> Iterator[tuple[Record, str]]:
    """Warnings of `dembound run` under each record that are not due to silence: units, samples, lengths, strengths.

    Also what the library's spacing takes from it.
    """
    silent = replace(library.case, silent=frozenset(library.inputs))
    before = set(warnings_before(plan(silent)))
    for record in records:
        yield from ((record, each) for each in record.losses)
        yield from ((record, each) for each in warnings_before(plan(case_of(library, record))) if each not in before)


def _texts(record: Record) -> dict[str, str]:
    """Texts of the files of a record, by their paths."""
    return {given.as_posix(): text for given, text in record.files.values()}


def write_response(library: Library, record: Record, path: Path) -> np.ndarray:
    """Write the histories of a library under a record as a ``run.h5``; returns the motion (k, monitors, 6).

    The case in it is that of a direct run, with the record as a file wave: `dembound rerun` runs it. The attribute
    ``superposed`` has the name of the library. The folder of the path is created if it does not exist.
    """
    motion = library.motion(record.values)
    case, files = case_of(library, record), _texts(record)
    make_folder(path.parent)
    with new_file(path) as file:
        own = {"name": record.name, "title": case.title, "case": case.text, "keys": json.dumps(case.keys)}
        inherited = {name: library.attributes[name] for name in COPIED if name in library.attributes}
        describe(file, own | inherited | {"superposed": library.name, "complete": True})
        if case.silent:
            describe(file, {"silent": sorted(case.silent)})
        inputs = file.create_group("inputs")
        for number, (name, text) in enumerate(files.items()):
            write(inputs, str(number), np.frombuffer(text.encode(), dtype=np.uint8), "UTF-8")
            describe(inputs[str(number)], {"path": name})
        histories = file.create_group("histories", track_order=True)
        for index, name in enumerate(library.monitors):
            group = histories.create_group(name)
            for key, value in library.places[name].items():
                group.attrs[key] = value
            write(group, "time", library.time, "s")
            write(group, "displacement", motion[:, index, :3], DISPLACEMENT_UNIT)
            write(group, "velocity", motion[:, index, 3:], VELOCITY_UNIT)
    return motion
