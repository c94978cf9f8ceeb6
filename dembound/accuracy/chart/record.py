"""The runs of a chart in ``chart.h5``, each written as soon as it is over, so that a chart can be resumed."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.accuracy.history import History, Motions
from dembound.accuracy.runner import Run
from dembound.errors import CaseError
from dembound.motion.kind import Finding
from dembound.results.committed import changed_file
from dembound.results.reader import open_record, text_of, understood

if TYPE_CHECKING:
    import h5py

LOGGER = logging.getLogger(__name__)

FILE = "chart.h5"

OWN = (FILE, f"{FILE}.new", f"{FILE}.log", f"{FILE}.log.part", "chart.csv", "chart.png")
"""The files of a chart; all others in its folder are somebody else's, and are kept."""

NUMBERS = ("failure", "time_step", "step_limit", "steps", "count", "work", "threads")
"""Attributes of an outcome that are single values."""

UNITS = {"time": "s", "displacement": "m, m, rad", "velocity": "m/s, m/s, rad/s", "stress": "Pa"}


class Record:
    """The runs of a chart in a file, by the digest of their case; the file is closed between two calls."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def get(self, key: str) -> Run | None:
        """The results of the case with this digest; None if it has not been run."""
        if not self.path.is_file():
            return None
        with open_record(self.path) as file:
            group = file.get(f"runs/{key}")
            if group is None:
                return None
            values = {name: _plain(group.attrs[name]) for name in NUMBERS}
            for name, value in values.items():
                if not isinstance(value, str if name == "failure" else int | float):
                    raise TypeError(f"runs/{key}, attribute {name}: is {value!r}")  # which open_record tells of
            found = Run(**values)
            found.motions = _read_motions(group["gauges"])
            found.findings = {
                name: Finding(float(value[()]), text_of(value.attrs["unit"]))
                for name, value in _scalars(group["findings"]).items()
            }
            found.cpu, found.wall = group["cpu"][:].tolist(), group["wall"][:].tolist()
            return found

    def add(self, key: str, outcome: Run) -> None:
        """Write the results of a case; costs come later, one by one."""
        with understood(self.path), changed_file(self.path) as file:
            group = file.require_group("runs").create_group(key)
            group.attrs.update({name: getattr(outcome, name) for name in NUMBERS})
            write_motions(group.create_group("gauges"), outcome.motions)
            findings = group.create_group("findings")
            for name, (value, unit) in outcome.findings.items():
                findings.create_dataset(name, data=value).attrs["unit"] = unit
            for name in ("cpu", "wall"):
                group.create_dataset(name, shape=(0,), maxshape=(None,), dtype="f8").attrs["unit"] = "s"

    def add_cost(self, key: str, cpu: float, wall: float) -> None:
        """Append the costs (s) of another run of a case."""
        with understood(self.path), changed_file(self.path) as file:
            for name, value in (("cpu", cpu), ("wall", wall)):
                dataset = file[f"runs/{key}/{name}"]
                dataset.resize(len(dataset) + 1, axis=0)
                dataset[-1] = value


def record_in(folder: Path, resume: bool) -> Record:
    """The record of a chart in its folder; that of an earlier chart is kept to resume it, otherwise deleted.

    Other files in the folder remain. Raises CaseError for a folder that holds something else.
    """
    path = folder / FILE
    if folder.exists() and any(folder.iterdir()) and not path.is_file():
        raise CaseError([f"{folder}: exists and holds no chart, give another --output or --name"])
    if path.is_file() and not resume:
        LOGGER.info("%s: replacing the chart of before, whose runs --resume would keep", folder)
        for name in OWN:
            (folder / name).unlink(missing_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
    return Record(path)


def write_motions(group: h5py.Group, motions: Motions) -> None:
    """Write the histories of monitors, compressed, each in a group of its name."""
    for name, history in motions.items():
        inner = group.create_group(name)
        inner.attrs["position"] = history.place
        for quantity, values in {"time": history.time, **history.values}.items():
            flat = values[:, 0] if quantity == "stress" else values
            dataset = inner.create_dataset(quantity, data=flat, compression="gzip", shuffle=True)
            dataset.attrs["unit"] = UNITS[quantity]


def _read_motions(group: h5py.Group) -> dict[str, History]:
    """The histories that `write_motions` has written."""
    return {
        name: History.of(
            inner.attrs["position"], **{quantity: inner[quantity][:] for quantity in UNITS if quantity in inner}
        )
        for name, inner in group.items()
    }


def _scalars(group: h5py.Group) -> dict[str, Any]:
    """The single numbers of a group, by name."""
    return {name: dataset for name, dataset in group.items() if dataset.shape == ()}


def _plain(value: Any) -> Any:
    """An attribute as a plain Python value."""
    return value.item() if isinstance(value, np.generic) else value
