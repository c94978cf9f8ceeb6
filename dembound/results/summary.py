"""The summary of a run as numbers, for scripts, and reading it from ``summary.json``."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.casefile.disks.layer import CONTINUUM
from dembound.errors import CaseError, RecordError
from dembound.files import content_of
from dembound.motion.kind import Plan
from dembound.motion.memory import total
from dembound.motion.trackers import Run
from dembound.results.histories import missing
from dembound.results.new_record import NO_PARTICLE
from dembound.results.reader import energy_of, open_record, side_energies_of, text_of, understood
from dembound.results.text_files import LARGEST
from dembound.version import __version__

if TYPE_CHECKING:
    import h5py

END = ("time", "displacement", "velocity")
"""What is written of the motion of a monitor at the end of a run."""

ENDS = {
    "silent": "all monitors silent",
    "peak": "the force on the driven sides past its peak",
    "rest": "what fell at rest",
}
"""Why a run ended early, in words."""

WORTH_SAYING = 1e6
"""Bytes of a snapshot below which leaving it out saves too little."""


def summarise(planned: Plan, run: Run, record: Path, seconds: Mapping[str, float]) -> dict[str, Any]:
    """The run in numbers, for scripts: plain JSON values, SI units; seconds : time spent, by part of the run."""
    scene, state = run.scene, run.state
    with open_record(record) as file:
        shear, columns = file["cracks/shear"][:], energy_of(file)
        found = {
            # including those of the static stage
            "cracks": {"tension": int(np.count_nonzero(~shear)), "shear": int(np.count_nonzero(shear))},
            # the last entry of the ledger (J/m), and the largest error of any entry over the supplied energy
            "energy": {name: float(column[-1]) for name, column in columns.items()}
            | {"relative_error": float(np.abs(columns["relative_error"]).max())},
            "sides": _describe_sides(file),
            "monitors": _describe_monitors(file),
        }
    return {
        "name": scene.case.name,
        "title": scene.case.title,
        "keys": scene.case.keys,
        "version": __version__,
        "time_step": planned.time_step,
        "step_limit": planned.step_limit if np.isfinite(planned.step_limit) else None,
        "steps": state.step,
        "duration": run.time,
        "ended": _describe_end(planned, run),
        "wall_time": sum(seconds.values()),
        "seconds": dict(seconds),
        "threads": scene.threads,
        "particle_steps_per_second": scene.count * state.step / seconds["step"],
        "memory_bytes": round(scene.largest_memory),
        "waves": {name: made for name, wave in scene.case.wave.items() if (made := wave.describe())},
        "laws": [{"law": name, "from": step * run.time_step} for name, step in state.laws],
        **found,
        "reduced": [*scene.reduced, *run.system.saved(state), *_fields_left_out(planned)],
        "not_reduced": [*planned.refused, *run.system.refused],
    }


def _describe_end(planned: Plan, run: Run) -> dict[str, Any] | None:
    """Reason and time of a run's end before its duration, and the saved share of its steps; None for a whole run."""
    step = run.state.step
    if step == planned.steps:
        return None
    saved = 1.0 - step / planned.steps
    return {"why": planned.scene.case.run.until, "time": run.time, "planned_steps": planned.steps, "saved": saved}


def end_in_words(summary: Mapping[str, Any]) -> list[str]:
    """One sentence on a run that ended early; none for a whole run."""
    if (ended := summary["ended"]) is None:
        return []
    return [f"ended at {ended['time']:.4g} s, {ENDS[ended['why']]}: {100.0 * ended['saved']:.0f} % of the steps saved"]


def _fields_left_out(planned: Plan) -> list[str]:
    """In words, the size of a large scene's snapshot, in a run that keeps none."""
    size = total({"disk": planned.scene.count}, "snapshot")
    if planned.scene.case.output.snapshots > 0 or size < WORTH_SAYING:
        return []
    return [f"fields: no snapshot is kept, {size / 1e6:.3g} MB each"]


def _describe_sides(file: h5py.File) -> dict[str, Any]:
    """Energies of every side at the end of the run; `absorbed_share` is over all that came in through any side.

    The total is the sum of the largest energy that came in through each side up to any time, without the energy that a
    continuum takes from the body; null if nothing came in.
    """
    sides = side_energies_of(file)
    through = [columns["came_in"] for side, columns in sides.items() if not side.endswith(CONTINUUM)]
    came = sum(max(0.0, float(came_in.max(initial=0.0))) for came_in in through)
    return {
        side: {name: float(column[-1]) for name, column in columns.items()}
        | {"absorbed_share": float(columns["absorbed"][-1]) / came if came > 0.0 else None}
        for side, columns in sides.items()
    }


def _describe_monitors(file: h5py.File) -> dict[str, Any]:
    """Peaks and arrivals of every history, and the motion at the end of the run, after its last sample."""
    return {
        name: {
            "particle": None if group.attrs["particle"] == NO_PARTICLE else int(group.attrs["particle"]),
            "position": group.attrs["position"].tolist(),
            **arrival(group["time"][:], group["velocity"][:, :2]),
            "peak_displacement": np.abs(group["displacement"][:, :2]).max(axis=0).tolist(),
            "end": {of: group.attrs[f"end_{of}"].tolist() for of in END if f"end_{of}" in group.attrs},
        }
        for name, group in file.get("histories", {}).items()
    }


def arrival(time: np.ndarray, velocity: np.ndarray) -> dict[str, Any]:
    """Largest motion of a history and its time.

    time (k,) s, velocity (k, 2) m/s. Taken from the component with the largest motion: `peak_velocity` (signed),
    `peak_time`, and `arrival`, the moment |velocity| first passes half its peak, interpolated; null at rest.
    """
    axis = int(np.argmax(np.abs(velocity).max(axis=0)))
    speed = np.abs(velocity[:, axis])
    crest = int(np.argmax(speed))
    half = 0.5 * speed[crest]
    if half == 0.0:
        return {"component": "xy"[axis], "peak_velocity": 0.0, "peak_time": None, "arrival": None}
    first = int(np.argmax(speed >= half))
    passed = time[first]
    if first > 0:
        part = (half - speed[first - 1]) / (speed[first] - speed[first - 1])
        passed = time[first - 1] + part * (time[first] - time[first - 1])
    return {
        "component": "xy"[axis],
        "peak_velocity": float(velocity[crest, axis]),
        "peak_time": float(time[crest]),
        "arrival": float(passed),
    }


FILE = "summary.json"


class Summary(dict[str, Any]):
    """An object of a summary; an entry that it lacks is an error of the file."""

    def __missing__(self, name: str) -> Any:
        raise RecordError([f"{self.path}: is damaged, or of another version of dembound; it has no {name}"])

    path: Path


class Entries(Summary):
    """An object of a summary for users, who may have mistyped the name of an entry."""

    def __missing__(self, name: str) -> Any:
        raise missing("entry", name, self, str(self.path))


def read_json(path: Path, kind: type[Summary] = Summary) -> dict[str, Any]:
    """The object in a JSON file, with all objects of a kind.

    Raises RecordError, in one line, for any other file.
    """
    content = content_of(path, LARGEST)
    try:
        found = json.loads(content, object_hook=kind)
    except (ValueError, RecursionError):
        raise RecordError([f"{path}: is damaged, no JSON"]) from None
    if not isinstance(found, Summary):
        raise RecordError([f"{path}: is damaged, it does not hold an object of JSON"])
    for each in _objects(found):
        each.path = path
    return found


def _objects(found: Any) -> list[Summary]:
    """An object and all objects in it."""
    waiting, objects = [found], []
    while waiting:
        each = waiting.pop()
        if isinstance(each, Summary):
            objects.append(each)
            waiting += each.values()
        elif isinstance(each, list):
            waiting += each
    return objects


def read_summary(folder: Path, kind: type[Summary] = Summary) -> dict[str, Any]:
    """The summary of a complete run in its folder, with all objects of a kind.

    Raises CaseError where there is none, RecordError as `read_json`, for a requested entry that is missing, and
    for a summary that belongs to another run than the record beside it.
    """
    path = folder / FILE
    if not path.is_file():
        raise CaseError([f"{path}: is missing, the run is not complete"])
    found = read_json(path, kind)
    if (record := folder / "run.h5").is_file():
        _require_same_run(found, record, path)
    return found


def _require_same_run(summary: Mapping[str, Any], record: Path, path: Path) -> None:
    """Raise RecordError if a summary and a record differ in the keys of their case or in the number of steps."""
    with understood(record), open_record(record) as file:
        there = {"steps": file.attrs.get("steps"), "keys": json.loads(text_of(file.attrs.get("keys", "null")))}
    for name, value in there.items():
        if value is not None and name in summary and summary[name] != value:
            raise RecordError([f"{path}: is of another run than run.h5 beside it: their {name} differ"])
