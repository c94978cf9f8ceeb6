"""Motion of the monitors against time (Z figs 3, 7, 8, 14, 16)."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dembound.errors import CaseError
from dembound.plot.style import UNITS, line_style, new_figure, outside_legend, styled
from dembound.results import COMPONENTS, open_record, record_names

Quantity = Literal["velocity", "displacement"]
Component = Literal["x", "y", "rotation"]


@dataclass(frozen=True)
class History:
    """One monitor's motion in one run: time (k,) s, motion (k, 3) in `UNITS`, and the place asked for (2,) m."""

    time: np.ndarray
    motion: np.ndarray
    position: np.ndarray


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
        what to show; by default whichever of x and y moved most in any run.
    quantity
        what to show of it, in m/s or m (rad/s or rad for the rotation).
    monitors
        names of those to show, in this order; by default all.

    Raises CaseError when a file cannot be read, no run has a monitor, or none has one of those asked for.
    """
    histories = [read_histories(path, quantity) for path in runs]
    shown = _choose(runs, histories, monitors)
    histories = [{name: run[name] for name in shown if name in run} for run in histories]
    column = _largest(histories) if component is None else COMPONENTS.index(component)
    figure = new_figure(9.0, 1.6 + len(shown) * np.clip(9.0 / len(shown), 0.6, 1.6))
    panels = figure.subplots(len(shown), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for index, (label, run) in enumerate(zip(record_names(runs), histories, strict=True)):
        for panel, monitor in zip(panels, shown, strict=True):
            if monitor in run:
                history = run[monitor]
                panel.plot(history.time, history.motion[:, column], label=label, **line_style(index))
    for panel, monitor in zip(panels, shown, strict=True):
        _tell_places(panel, monitor, [run[monitor].position for run in histories if monitor in run])
    direction = _direction(column)
    panels[-1].set_xlabel("time (s)")
    figure.supylabel(f"{quantity} {direction} ({UNITS[quantity][column]})", fontsize=10)
    figure.suptitle(f"{quantity.capitalize()} {direction} at the monitors", fontsize=11)
    outside_legend(figure, panels, columns=3)
    return figure


def read_histories(path: Path, quantity: Quantity) -> dict[str, History]:
    """The histories of a run by monitor name; empty for a run without monitors.

    Raises CaseError when the file cannot be read.
    """
    with open_record(path) as file:
        return {
            name: History(group["time"][:], group[quantity][:], group.attrs["wanted"])
            for name, group in file.get("histories", {}).items()
        }


def _tell_places(panel: Axes, monitor: str, positions: Sequence[np.ndarray]) -> None:
    """The monitor's name, and its place in the title if it is the same (2,) m for every line, else beside each line."""
    places = ["({:.2f}, {:.2f}) m".format(*position) for position in positions]
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
    """0 or 1, the translation with the largest motion in any history."""
    largest = [np.abs(h.motion[:, :2]).max(axis=0, initial=0.0) for run in histories for h in run.values()]
    return int(np.argmax(np.max(largest, axis=0)))


def _direction(column: int) -> str:
    return "of rotation" if COMPONENTS[column] == "rotation" else f"along {COMPONENTS[column]}"
