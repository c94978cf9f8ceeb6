"""Motion and stress of the monitors against time (Z figs 3, 7, 8, 14, 16; L figs 6, 7)."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import h5py
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dembound.errors import CaseError
from dembound.plot.style import UNITS, line_style, new_figure, outside_legend, styled, time_unit
from dembound.results import COMPONENTS, is_bar, open_record, place_in_words, record_names

Quantity = Literal["velocity", "displacement", "stress"]
Component = Literal["x", "y", "rotation"]

SCALES = {"velocity": 1.0, "displacement": 1.0, "stress": 1e6}
"""SI units in the units shown."""

SENSES = {"velocity": "", "displacement": "", "stress": ", tension positive"}
"""What a positive value means, where the axis does not tell."""


@dataclass(frozen=True)
class History:
    """What one monitor felt in one run.

    time (k,) s; values in `UNITS`, of a motion (k, 3), of a stress along x (k, 1); place asked for, in words.
    """

    time: np.ndarray
    values: np.ndarray
    place: str


@styled
def plot_histories(
    runs: Sequence[Path],
    component: Component | None = None,
    quantity: Quantity = "velocity",
    monitors: Sequence[str] | None = None,
) -> Figure:
    """One panel per monitor, on common axes; several runs lie over each other in it.

    Parameters
    ----------
    runs
        ``run.h5`` files; a monitor need not occur in all of them.
    component
        of a motion, by default whichever of x and y moved most in any run.
    quantity
        velocity in m/s, displacement in m (rad/s or rad for the rotation), or of bars stress in MPa.
    monitors
        names of those to show, in this order; by default all.

    Raises CaseError when a file cannot be read or holds no stress that is asked for, no run has a monitor, or none has
    one of those asked for.
    """
    histories = [read_histories(path, quantity) for path in runs]
    shown = _choose(runs, histories, monitors)
    histories = [{name: run[name] for name in shown if name in run} for run in histories]
    column = _largest(histories) if component is None else COMPONENTS.index(component)
    unit = time_unit(max(history.time.max(initial=0.0) for run in histories for history in run.values()))
    figure = new_figure(9.0, 1.6 + len(shown) * np.clip(9.0 / len(shown), 0.6, 1.6))
    panels = figure.subplots(len(shown), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for index, (label, run) in enumerate(zip(record_names(runs), histories, strict=True)):
        for panel, monitor in zip(panels, shown, strict=True):
            if monitor in run:
                history = run[monitor]
                panel.plot(history.time / unit.seconds, history.values[:, column], label=label, **line_style(index))
    for panel, monitor in zip(panels, shown, strict=True):
        _tell_places(panel, monitor, [run[monitor].place for run in histories if monitor in run])
    direction = _direction(column)
    panels[-1].set_xlabel(unit.label)
    figure.supylabel(f"{quantity} {direction}{SENSES[quantity]} ({UNITS[quantity][column]})", fontsize=10)
    figure.suptitle(f"{quantity.capitalize()} {direction} at the monitors", fontsize=11)
    outside_legend(figure, panels, columns=3)
    return figure


def read_histories(path: Path, quantity: Quantity) -> dict[str, History]:
    """The histories of a run by monitor name; empty for a run without monitors.

    Raises CaseError when the file cannot be read or holds no stress that is asked for.
    """
    with open_record(path) as file:
        groups = dict(file.get("histories", {}).items())
        if any(quantity not in group for group in groups.values()):
            raise CaseError([f"{path}: holds no {quantity} of its monitors; runs of bars do"])
        return {name: _read(group, quantity, along_bar=is_bar(file)) for name, group in groups.items()}


def _read(group: h5py.Group, quantity: Quantity, *, along_bar: bool) -> History:
    """A monitor's history."""
    time, values = group["time"][:], group[quantity][:]
    columns = values.reshape(len(time), -1) / SCALES[quantity]
    return History(time, columns, place_in_words(group.attrs["wanted"], along_bar=along_bar))


def _tell_places(panel: Axes, monitor: str, places: Sequence[str]) -> None:
    """The monitor's name, and its place in the title if it is the same for every line, else beside each line."""
    alike = len(set(places)) == 1
    panel.set_title(f"{monitor} at {places[0]}" if alike else monitor, loc="left", fontsize=9, pad=3)
    if not alike:
        panel.legend(panel.lines, places, fontsize=8)


def _choose(runs: Sequence[Path], histories: Sequence[dict[str, History]], wanted: Sequence[str] | None) -> list[str]:
    """Names of the monitors to show, each once; errors as in `plot_histories`."""
    known = list(dict.fromkeys(name for run in histories for name in run))
    if not known:
        raise CaseError([f"{', '.join(map(str, runs))}: has no monitors to show"])
    if wanted is None:
        return known
    if unknown := [name for name in wanted if name not in known]:
        raise CaseError([f"monitor: is {name}, must be one of {', '.join(known)}" for name in unknown])
    return list(dict.fromkeys(wanted))


def _largest(histories: Sequence[dict[str, History]]) -> int:
    """0 or 1, the column of x or y with the largest value in any history."""
    largest = [np.abs(h.values[:, :2]).max(axis=0, initial=0.0) for run in histories for h in run.values()]
    return int(np.argmax(np.max(largest, axis=0)))


def _direction(column: int) -> str:
    return "of rotation" if COMPONENTS[column] == "rotation" else f"along {COMPONENTS[column]}"
