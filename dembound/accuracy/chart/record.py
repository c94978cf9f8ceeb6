"""The runs of a chart in ``chart.h5``, each written as soon as it is over, so that a chart can be resumed."""

from __future__ import annotations

import logging
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.accuracy.runner import Run
from dembound.errors import CaseError, RecordError
from dembound.files import make_folder, remove, require_no_link, require_writable
from dembound.formulas.history import History, Motions
from dembound.motion.kind import Finding
from dembound.results.committed import changed_file
from dembound.results.reader import finite, increasing, open_record, text_of, understood
from dembound.results.structure import Members

if TYPE_CHECKING:
    import h5py

LOGGER = logging.getLogger(__name__)

FILE = "chart.h5"

OWN = (*(f"{FILE}{ending}" for ending in ("", ".new", ".log", ".log.part")), "chart.csv", "chart.png")
"""The files of a chart; all others in its folder are somebody else's, and are kept."""

NUMBERS = ("failure", "time_step", "step_limit", "steps", "count", "work", "threads", "late")
"""Attributes of an outcome that are single values."""

MOST = 1e15
"""Beyond all costs and counts of a run."""

LEAST = dict.fromkeys(NUMBERS, 0.0) | {"late": -MOST}
"""Smallest values of these numbers."""

MOTION = ("displacement", "velocity", "stress")
"""What a gauge records; the last of them only bars have."""

UNITS = {"time": "s", "displacement": "m, m, rad", "velocity": "m/s, m/s, rad/s", "stress": "Pa"}


class Record:
    """The runs of a chart in a file, by the digest of their case; the file is closed between two calls."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def get(self, key: str, monitors: Iterable[str] = (), quantity: str = "velocity") -> Run | None:
        """The results of the case with this digest; None if it has not been run.

        Raises RecordError for results that no run writes, and for a successful run without the quantity at one of these
        monitors.
        """
        if not self.path.is_file():
            return None
        with open_record(self.path) as file:
            group = Members(file, "runs").get(key)
            if group is None:
                return None
            values = {name: _plain(group.attrs[name]) for name in NUMBERS}
            for name, value in values.items():
                if name != "failure" and not (isinstance(value, int | float) and LEAST[name] <= value < MOST):
                    raise _damaged(group, f"attribute {name}")
            if not isinstance(values["failure"], str) or (not values["failure"] and values["work"] < 1):
                raise _damaged(group, "attribute failure or work")
            found = Run(**values)
            found.motions = {name: _read_history(inner, found) for name, inner in group["gauges"].items()}
            for name in () if found.failure else monitors:
                if name not in found.motions or quantity not in found.motions[name].values:
                    raise _damaged(group, f"{quantity} at {name}")
            numbers = {name: value for name, value in group["findings"].items() if value.shape == ()}
            found.findings = {n: Finding(float(v[()]), text_of(v.attrs["unit"])) for n, v in numbers.items()}
            found.cpu, found.wall = (_read_costs(group, name) for name in ("cpu", "wall"))
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
    """The record of a chart in its folder; with `resume` an earlier chart is kept, otherwise it is deleted.

    Other files in the folder remain. Raises CaseError for a folder that holds something else, RecordError for links.
    """
    path = folder / FILE
    require_no_link(folder)
    require_writable(*(folder / name for name in OWN))
    if folder.exists() and any(folder.iterdir()) and not path.is_file():
        raise CaseError([f"{folder}: exists and holds no chart, give another --output or --name"])
    if path.is_file() and not resume:
        LOGGER.info("%s: replacing the chart of before, whose runs --resume would keep", folder)
        remove(*(folder / name for name in OWN))
    make_folder(folder)
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


def _read_history(group: h5py.Group, run: Run) -> History:
    """The history of a monitor as written by `write_motions`; raises RecordError for any other contents."""
    position = np.asarray(group.attrs["position"], dtype=float)
    if position.shape != (2,) or not np.isfinite(position).all():
        raise _damaged(group, "attribute position")
    time = increasing(group["time"])
    if len(time) == 0 or time[0] < 0.0 or time[-1] > (run.steps + 1) * run.time_step:
        raise _damaged(group, "time")
    values = {name: finite(group[name]).astype(float) for name in MOTION if name in group or name != "stress"}
    for name, column in values.items():
        if column.shape != (len(time), 3)[: 1 if name == "stress" else 2]:
            raise _damaged(group, name)
    return History.of(position, time.astype(float), **values)


def _read_costs(group: h5py.Group, name: str) -> list[float]:
    """The costs (s) of the timed runs of a case; raises RecordError for values that are no costs."""
    costs = finite(group[name])
    if costs.ndim != 1 or not np.all((costs >= 0.0) & (costs < MOST)):
        raise _damaged(group, name)
    return [float(cost) for cost in costs]


def _damaged(group: h5py.Group, what: str) -> RecordError:
    """The error for a part of a run that is not as a chart writes it."""
    return RecordError([f"{group.file.filename}: is damaged: {group.name[1:]}, {what}: is not as a chart writes it"])


def _plain(value: Any) -> Any:
    """An attribute as a plain Python value."""
    return value.item() if isinstance(value, np.generic) else value
