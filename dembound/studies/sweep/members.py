"""The members of a sweep: changed cases, their folders, and the numbers of a member."""

import hashlib
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from dembound.accuracy.choice import choices_of, digest, in_words, short_keys
from dembound.casefile.messages import counted
from dembound.casefile.model import Case
from dembound.casefile.tables import Action, Method
from dembound.errors import CaseError
from dembound.results.folder import PARTIAL, problem_of
from dembound.results.reader import open_record
from dembound.studies.all_sides import changes_of
from dembound.studies.calibration import Calibration

LONGEST = 80
"""Largest number of characters of a name."""

SEED = "seed"
"""Suffix of keys that select one of many equally likely members."""


@dataclass(frozen=True)
class Member:
    """A member of a sweep.

    Attributes
    ----------
    name : of its folder. changes : its keys that differ from the case, with their values.
    case : the changed case, of that name.
    key : hash of case and action, equal for members with the same results, whatever their names.
    """

    name: str
    changes: Mapping[str, Any]
    case: Case
    key: str

    @property
    def group(self) -> dict[str, Any]:
        """The changes without seeds; members with equal ones are averaged."""
        return {key: value for key, value in self.changes.items() if not key.endswith(SEED)}


def variations(vary: Mapping[str, Sequence[Any]], together: bool) -> list[dict[str, Any]]:
    """All combinations of the values of keys; together : the first values of all keys, then the second ones, and so on.

    Raises CaseError if there is no key, or keys varied together have different numbers of values.
    """
    if not vary:
        raise CaseError(["--vary: is missing; give keys and values, or a table [sweep.vary] in the case"])
    counts = {key: len(values) for key, values in vary.items()}
    if together and len(set(counts.values())) > 1:
        listed = ", ".join(f"{key} {counted(count, 'value')}" for key, count in counts.items())
        raise CaseError([f"--together: keys must have equally many values, here {listed}"])
    rows = zip(*vary.values(), strict=True) if together else product(*vary.values())
    return [dict(zip(vary, row, strict=True)) for row in rows]


def members_of(
    case: Case, changes: Sequence[Mapping[str, Any]], action: Action, method: Method
) -> tuple[list[Member], list[str]]:
    """The members whose changed cases are valid, each once, and a line for each of the others.

    Raises CaseError with these lines if no member is valid.
    """
    choices, left_out = choices_of(case, dict(zip(_names(changes), changes, strict=True)))
    done = [action, method if action == "calibrate" else ""]
    return [
        Member(choice.name, choice.changes, replace(choice.case, name=choice.name), key_of(choice.case, done))
        for choice in choices
    ], left_out


def key_of(case: Case, done: Sequence[str]) -> str:
    """The key of a member, see `Member`; done : the action, and its method."""
    return hashlib.sha256(json.dumps([digest(case), *done]).encode()).hexdigest()[:16]


def _names(changes: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Names such as ``seed=3,size=[4, 2]``, which all systems allow; long or duplicate names end with a hash."""
    taken: set[str] = set()
    for each in changes:
        words = zip(short_keys(each), each.values(), strict=True)
        name = re.sub(r"[^\w.,=+()\[\]-]+", "-", ",".join(f"{key}={in_words(value)}" for key, value in words))
        if len(name) > LONGEST or name.lower() in taken or problem_of(name) or name.endswith(PARTIAL):
            digits = hashlib.sha256(json.dumps(each).encode()).hexdigest()[:8]
            name = f"{name[:LONGEST].rstrip('.')}-{digits}"
        taken.add(name.lower())
        yield name


LEFT_OUT = {
    *("name", "title", "keys", "version", "seconds", "wall_time", "threads", "particle_steps_per_second"),
    *("memory_bytes", "laws", "warnings", "reduced", "not_reduced", "resumed", "particle"),
}
"""Entries of a summary that are not results, or that differ between runs of the same case."""

MOST_SHOWN = 6
"""Number of quantities that are printed and drawn by default."""

RAN_OUT = ("debris.share", ".x99", ".largest", ".singles")
"""Ends of the names of debris that are shown by default."""

COMPONENTS = ("x", "y", "xy")
"""Names of the entries of lists of two or three numbers."""

ENDS = ("from", "to")
"""Names of the entries that give the ranges of a bar between which a spall lies."""

ENERGY = "J/m, of bars J"

UNITS = {
    "m/s": ("peak_velocity", "rms_velocity", "p_wave_speed", "s_wave_speed", "wave_speed", "outgoing", "incident"),
    "m": (
        *("position", "peak_displacement", "length", "diameter", "mean_diameter", "start", "end", "spacing"),
        *("diameter_min", "diameter_mean", "diameter_max", "crack_opening", "characteristic_length"),
    ),
    "m²": ("section",),
    "s": ("time_step", "step_limit", "duration", "peak_time", "arrival", "time", "began"),
    "kg/m³": ("density",),
    "Pa·s/m": ("impedance",),
    "1/m": ("attenuation",),
    "J/m²": ("fracture_energy",),
    "Pa": ("stress", "emod", "pb_emod", "C11", "C22", "C12", "C66", "youngs_modulus", "strength"),
    ENERGY: ("absorbed", "came_in", "stored"),
}
"""Unit -> last parts of names, without component; other names are pure numbers unless within `WITHIN`."""

OF_DEBRIS = {
    "m": ("x95", "x99", "centre", "largest", "d50", "d80"),
    "kg/m": ("mass",),
    "degrees": ("angle",),
    "s": ("rest",),
    ENERGY: ("fall", "kinetic"),
}
"""The same within the entry "debris"."""

WITHIN = {"energy": ENERGY, "stress": "Pa", "pull_back_strength": "Pa"}
"""Entry of the summary -> unit of all numbers within it."""


def values_of_run(folder: Path, summary: Mapping[str, Any]) -> dict[str, float]:
    """The numbers of the summary of a run, and of every monitor peak and RMS of each component of its velocity."""
    return dict(_numbers(summary, "")) | dict(_of_monitors(folder / "run.h5"))


def _numbers(entry: Any, place: str) -> Iterator[tuple[str, float]]:
    """All numbers within an entry of a summary, by dotted names."""
    if isinstance(entry, Mapping):
        for name, inner in entry.items():
            if name not in LEFT_OUT:
                yield from _numbers(inner, f"{place}.{name}" if place else name)
    elif isinstance(entry, list):
        names: Sequence[str] | range = range(1, len(entry) + 1)
        if len(entry) in (2, 3) and not isinstance(entry[0], Mapping):
            names = ENDS if place.startswith("spalls.") else COMPONENTS
        for name, inner in zip(names, entry, strict=False):
            yield from _numbers(inner, f"{place}.{name}")
    elif isinstance(entry, bool | int | float):
        yield place, float(entry)


def _of_monitors(record: Path) -> Iterator[tuple[str, float]]:
    """Largest |v| and √(Σv²/k) of both components at every monitor, m/s."""
    with open_record(record) as file:
        for name, group in file.get("histories", {}).items():
            velocity = group["velocity"][:, :2]
            for axis, component in enumerate("xy"):
                of = f"monitors.{name}"
                yield f"{of}.peak_velocity.{component}", float(np.abs(velocity[:, axis]).max())
                yield f"{of}.rms_velocity.{component}", float(np.sqrt(np.mean(velocity[:, axis] ** 2)))


def values_of_calibration(found: Sequence[Calibration]) -> dict[str, float]:
    """The calibrated factors by key, each with its number of passes and M_out/M_in of the last pass."""
    values: dict[str, float] = dict(changes_of(found))
    for key, each in zip(changes_of(found), found, strict=True):
        values[f"{key}.passes"] = float(len(each.beta))
        if each.ratio:
            values[f"{key}.ratio"] = each.ratio[-1]
    return values


def unit_of(name: str) -> str:
    """The unit of the values of a name; 1 for pure numbers."""
    first, *parts = name.split(".")
    last = next((part for part in reversed(parts) if part not in (*COMPONENTS, *ENDS)), first)
    if first in WITHIN and last != "relative_error":
        return WITHIN[first]
    units = OF_DEBRIS if first == "debris" else UNITS
    return next((unit for unit, names in units.items() if last in names), "1")


def shown_by_default(names: Sequence[str], action: Action) -> list[str]:
    """The first few of the calibrated factors, of run-out and fragments where debris ran out, or of peak velocities."""
    ran_out = [name for name in names if name.startswith("debris.") and name.endswith(RAN_OUT)]
    if action == "calibrate":
        found = [name for name in names if not name.endswith((".passes", ".ratio"))]
    elif any(name.endswith("x99") for name in ran_out):
        found = ["cracks.tension", *ran_out]
    else:
        found = [name for name in names if name.startswith("monitors.") and name.endswith("peak_velocity")]
    return (found or list(names))[:MOST_SHOWN]
