"""Motion and stress of the monitors against time (Z figs 3, 7, 8, 14, 16; L figs 6, 7)."""

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dembound.errors import CaseError
from dembound.plot.style import line_style, new_figure, outside_legend, styled, time_unit
from dembound.results.histories import UNITS, History, Quantity, read_histories
from dembound.results.reader import COMPONENTS, record_names

Component = Literal["x", "y", "rotation"]

SENSES = {"velocity": "", "displacement": "", "stress": ", tension positive"}
"""What a positive value means, where the axis does not tell."""


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
