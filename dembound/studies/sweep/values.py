"""The numbers of a member in the table of a sweep, by dotted names, and their units."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from dembound.casefile.sweep import Action
from dembound.results.reader import open_record
from dembound.studies.all_sides import changes_of
from dembound.studies.calibration import Calibration

LEFT_OUT = {
    *("name", "title", "keys", "version", "seconds", "wall_time", "threads", "particle_steps_per_second"),
    *("memory_bytes", "laws", "warnings", "reduced", "not_reduced", "resumed", "particle"),
}
"""Entries of a summary that are not results, or that differ between runs of the same case."""

MOST_SHOWN = 6
"""Number of quantities that are printed and drawn by default."""

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
    return next((unit for unit, names in UNITS.items() if last in names), "1")


def shown_by_default(names: Sequence[str], action: Action) -> list[str]:
    """The first few of the calibrated factors, or of the peak velocities at monitors."""
    if action == "calibrate":
        found = [name for name in names if not name.endswith((".passes", ".ratio"))]
    else:
        found = [name for name in names if name.startswith("monitors.") and name.endswith("peak_velocity")]
    return (found or list(names))[:MOST_SHOWN]
