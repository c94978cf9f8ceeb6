"""Motion and stress of the monitors against time, record sections and hodographs."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dembound.casefile.disks.load import FREE_FIELD
from dembound.casefile.disks.monitor_rows import spread_names
from dembound.errors import CaseError
from dembound.plot.style import (
    TimeUnit,
    finished,
    line_style,
    measured_once,
    new_figure,
    stacked_height,
    styled,
    time_unit,
)
from dembound.results.histories import SCALES, UNITS, Band, MonitorRecord, Quantity, read_bands, read_histories
from dembound.results.reader import COMPONENTS, record_names

Component = Literal["x", "y", "both", "rotation"]

Histories = dict[str, MonitorRecord]
"""The histories of a run by monitor."""

SENSES = {"stress": ", tension positive"}
"""The meaning of a positive value, if the axis does not show it."""

MOST_PANELS = 8
"""Number of monitors above which long rows of them are not shown in full, unless monitors are named."""

MOST_PLACES = 2
"""Largest number of listed positions of a monitor in several runs; more are only counted."""

BESIDE_TWINS: tuple[Any, ...] = ("-", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))
"""Line style of monitors in runs with free-field twins, whose lines are dashed."""

BEHIND: dict[str, Any] = {"linestyle": "--", "linewidth": 3.0, "alpha": 0.4, "zorder": 1.9}
"""Line style of a twin, visible also below the line of a monitor with the same motion."""

WITHIN: dict[str, Any] = {"alpha": 0.2, "linewidth": 0.0, "zorder": 1.5}
"""Style of the bands of estimated errors: below all lines."""

CORRECTED: dict[str, Any] = {"linewidth": 0.9, "linestyle": (0, (2, 2)), "color": "#000000", "zorder": 2.5}
"""Style of lines without the estimated error of the sides."""


@styled
def plot_histories(
    runs: Sequence[Path],
    component: Component | None = None,
    quantity: Quantity = "velocity",
    monitors: Sequence[str] | None = None,
    most: int = MOST_PANELS,
) -> Figure:
    """One panel per monitor, with common axes; several runs are drawn in the same panel.

    With free-field sides the panel of a monitor also has its twin in the free-field column, dashed. Runs with estimated
    errors have a band around their line and, where the error of the sides is known, a line without this error. The
    title gives the position of the monitor's particle, and the requested position if it differs.

    Parameters
    ----------
    runs
        ``run.h5`` files; a monitor need not occur in all of them.
    component
        of a motion, by default x or y, whichever is larger in any run; both: x on the left, y on the right.
    quantity
        velocity in m/s, displacement in m, acceleration in m/s² (rad/s, rad, rad/s² for the rotation), or of bars
        stress in MPa.
    monitors
        names of the monitors to show, in this order; by default all, but of long rows ends and some between, as is
        noted. A twin that is given by its name has a separate panel.
    most
        number of monitors above which this is so.

    Raises CaseError when a file cannot be read or lacks a requested stress, no run has a monitor, none has
    a requested monitor, or a component of a stress is requested.
    """
    if quantity == "stress" and component is not None:
        raise CaseError(["component: is of motions; the stress of a bar is that along it"])
    histories = [read_histories(path, quantity) for path in runs]
    shown = chosen_monitors(runs, histories, monitors, most)
    drawn = those(histories, (*shown, *map(twin_of, shown)))
    columns, unit = shown_columns(drawn, component), _time_unit_of(drawn)
    figure = new_figure(9.0 if len(columns) == 1 else 12.0, stacked_height(len(shown)))
    panels = figure.subplots(len(shown), len(columns), sharex=True, sharey=True, squeeze=False)
    bands = [read_bands(path, quantity) for path in runs]
    twins = any(twin_of(name) in run for run in drawn for name in shown)
    for index, (label, run, band) in enumerate(zip(record_names(runs), drawn, bands, strict=True)):
        style = line_style(index) | ({"linestyle": BESIDE_TWINS[index % len(BESIDE_TWINS)]} if twins else {})
        for row, monitor in zip(panels, shown, strict=True):
            for panel, column in zip(row, columns, strict=True):
                _draw(panel, run, monitor, column, unit.seconds, label, style)
                if monitor in run and monitor in band and column < band[monitor].half_width.shape[1]:
                    history, units = run[monitor], (unit.seconds, SCALES[quantity])
                    draw_band(panel, band[monitor], history.time, history.values[:, column], column, units, label)
    title_monitors(panels, shown, drawn)
    for panel in panels[-1]:
        panel.set_xlabel(unit.label)
    name_columns(panels, columns)
    of = f"{quantity} {' and '.join(map(direction, columns))}"
    beside = f"{of if len(columns) == 1 else quantity}{SENSES.get(quantity, '')} ({UNITS[quantity][columns[0]]})"
    figure.supylabel(beside, fontsize=10)
    measured_once(panels)
    title = f"{of.capitalize()} at the monitors{left_out(shown, histories, monitors)}"
    return finished(figure, title, panels.flat, 3)


def _draw(
    panel: Axes, run: Histories, monitor: str, column: int, seconds: float, label: str, style: dict[str, Any]
) -> None:
    """Draw a monitor's history in one run, if it has it, and its twin's, dashed; times in units of `seconds`."""
    twin: dict[str, Any] = {"color": style["color"], **BEHIND}
    for name, words, looks in ((monitor, label, style), (twin_of(monitor), f"{label}, free field", twin)):
        if name in run:
            history = run[name]
            panel.plot(history.time / seconds, history.values[:, column], label=words, gid=name, **looks)


def those(runs: Sequence[Histories], names: Sequence[str]) -> list[Histories]:
    """For each run the histories of the named monitors that it has."""
    return [{name: run[name] for name in names if name in run} for run in runs]


def _time_unit_of(runs: Sequence[Histories]) -> TimeUnit:
    """The unit for the times of all histories."""
    return time_unit(max(history.time.max(initial=0.0) for run in runs for history in run.values()))


def title_monitors(panels: np.ndarray, shown: Sequence[str], runs: Sequence[Histories]) -> None:
    """Write above the first panel of each row (rows, columns) which monitor it shows, and where that is."""
    for panel, monitor in zip(panels[:, 0], shown, strict=True):
        panel.set_title(monitor_title(monitor, runs), loc="left", fontsize=9, pad=3)


def name_columns(panels: np.ndarray, columns: Sequence[int]) -> None:
    """Write its direction beside each of the panels (rows, columns) where they show several."""
    if len(columns) > 1:
        for row in panels:
            for panel, column in zip(row, columns, strict=True):
                panel.set_ylabel(direction(column), fontsize=9)


def twin_of(monitor: str) -> str:
    """Name of a monitor's twin in the free-field column in records."""
    return f"{monitor}{FREE_FIELD}"


def monitor_title(monitor: str, runs: Sequence[Histories]) -> str:
    """Name of the monitor, position of its particle in each run that has it, and the given position if it differs."""
    own = [run[monitor] for run in runs if monitor in run]
    places, requested = (list(dict.fromkeys(getattr(each, what) for each in own)) for what in ("place", "requested"))
    asked = "" if places == requested else f", requested {_in_words(requested)}"
    return f"{monitor} at {_in_words(places)}{asked}"


def _in_words(places: Sequence[str]) -> str:
    """Positions as text; of many only some."""
    if len(places) <= MOST_PLACES:
        return " and ".join(places)
    return f"{places[0]} and {len(places) - 1} other places"


def chosen_monitors(
    runs: Sequence[Path],
    histories: Sequence[Histories],
    requested: Sequence[str] | None,
    most: int | None = MOST_PANELS,
) -> list[str]:
    """Names of the monitors that have a panel, each once; errors as in `plot_histories`.

    most : number above which of long rows ends and some between are chosen; None for all.
    """
    known = list(dict.fromkeys(name for run in histories for name in run))
    if not known:
        raise CaseError([f"{', '.join(map(str, runs))}: has no monitors to show"])
    if requested is None:
        own = _without_twins(known)
        return own if most is None else spread_names(own, most)
    if unknown := [name for name in requested if name not in known]:
        raise CaseError([f"monitor: is {name}, must be one of {', '.join(known)}" for name in unknown])
    return list(dict.fromkeys(requested))


def _without_twins(names: Iterable[str]) -> list[str]:
    """The monitors among names, each once."""
    return [name for name in dict.fromkeys(names) if not name.endswith(FREE_FIELD)]


def left_out(shown: Sequence[str], histories: Sequence[Histories], requested: Sequence[str] | None) -> str:
    """A line of a title on how many monitors are shown; empty if some were requested or none is left out."""
    known = _without_twins(name for run in histories for name in run)
    if requested is not None or len(shown) == len(known):
        return ""
    return f"\n{len(shown)} of {len(known)}: ends of rows and some between; --monitor shows others"


def shown_columns(histories: Sequence[Histories], component: Component | None) -> list[int]:
    """The columns of the histories that are shown: one, or x and y."""
    if component == "both":
        return [0, 1]
    return [int(np.argmax(largest_values(histories))) if component is None else COMPONENTS.index(component)]


def largest_values(histories: Sequence[Histories]) -> np.ndarray:
    """Largest sizes (2,) along x and y, (1,) of a stress, in any history; there must be one."""
    largest = [np.abs(h.values[:, :2]).max(axis=0, initial=0.0) for run in histories for h in run.values()]
    return np.asarray(np.max(largest, axis=0))


def direction(column: int) -> str:
    """The direction of a column of a motion in words."""
    return "of rotation" if COMPONENTS[column] == "rotation" else f"along {COMPONENTS[column]}"


def draw_band(
    panel: Axes, band: Band, time: np.ndarray, values: np.ndarray, column: int, units: tuple[float, float], label: str
) -> None:
    """Draw the band of a history (k,) of a column at times (k,) s, and the corrected line if there is one.

    The band has its own times, and ends with the estimate. units : seconds in a unit of time, and SI units in one
    of the values.
    """
    at, half = band.time / units[0], band.half_width[:, column] / units[1]
    middle = np.interp(band.time, time, values)
    colour = panel.lines[-1].get_color()
    panel.fill_between(at, middle - half, middle + half, color=colour, label=f"{label}, estimated error", **WITHIN)
    if band.corrected is not None:
        corrected = band.corrected[:, column] / units[1]
        panel.plot(at, corrected, label=f"{label}, without the error of its sides", **CORRECTED)


SPREAD = 0.9
"""Height of the largest value over the mean distance between neighbours."""


@styled
def plot_section(
    runs: Sequence[Path],
    component: Component | None = None,
    quantity: Quantity = "velocity",
    monitors: Sequence[str] | None = None,
) -> Figure:
    """Histories of monitors, each drawn at its distance from the first one, with the same scale, which is printed.

    The names of the monitors stand beside their histories on the right, at the distances in the first run. Distances
    are those of the true positions of their particles. Parameters as of `plot_histories`; the order of the monitors is
    free, distances begin at the first of them.

    Raises CaseError as `plot_histories`, with fewer than two monitors, and for both components.
    """
    if component == "both":
        raise CaseError(["--component: is both; a section shows one"])
    histories = [read_histories(path, quantity) for path in runs]
    shown = chosen_monitors(runs, histories, monitors, most=None)
    common = [name for name in shown if all(name in run for run in histories)]
    if len(common) < 2:
        raise CaseError([f"--monitor: a section needs two monitors that all runs have, here are {len(common)}"])
    drawn = those(histories, common)
    (column,) = [0] if quantity == "stress" else shown_columns(drawn, component)
    unit = _time_unit_of(drawn)
    places = [np.array([run[name].position for name in common]) for run in drawn]
    distances = [np.hypot(*(each - each[0]).T) for each in places]
    largest = max(float(np.abs(h.values[:, column]).max(initial=0.0)) for run in drawn for h in run.values())
    gap = max(float(np.ptp(each)) for each in distances) / (len(common) - 1) or 1.0
    scale = SPREAD * gap / (largest or 1.0)
    figure = new_figure(8.0, 3.5 + 0.4 * len(common))
    panel = figure.subplots()
    for index, (run_name, run, along) in enumerate(zip(record_names(runs), drawn, distances, strict=True)):
        style: dict[str, Any] = line_style(index)
        for (name, history), distance in zip(run.items(), along, strict=True):
            raised = distance + scale * history.values[:, column]
            panel.plot(history.time / unit.seconds, raised, label=run_name, gid=name, linewidth=0.9, **style)
    for name, distance in zip(common, distances[0], strict=True):
        beside = (1.0, distance), (4.0, 0.0), ("axes fraction", "data"), "offset points"
        panel.annotate(name, *beside, va="center", fontsize=8)
    panel.set_xlabel(unit.label)
    where = "" if quantity == "stress" else f" {direction(column)}"
    panel.set_ylabel(f"distance from {common[0]} (m), {quantity}{where} upwards", fontsize=9)
    panel.set_title(f"{gap:.3g} m upwards is {gap / scale:.3g} {UNITS[quantity][column]}", loc="left", fontsize=9)
    return finished(figure, f"Section of the {quantity} at the monitors", [panel], 3)


ACROSS = 3
"""Number of panels side by side."""


@styled
def plot_hodograph(
    runs: Sequence[Path], quantity: Quantity = "velocity", monitors: Sequence[str] | None = None
) -> Figure:
    """Motion along y against motion along x, a panel for each monitor with equal scales; a dot marks the end.

    Parameters and errors as of `plot_histories`; also raises CaseError for stresses.
    """
    if quantity == "stress":
        raise CaseError(["--quantity: is stress; a hodograph is of a motion"])
    histories = [read_histories(path, quantity) for path in runs]
    shown = chosen_monitors(runs, histories, monitors)
    across = min(ACROSS, len(shown))
    down = -(-len(shown) // across)
    figure = new_figure(1.0 + 3.4 * across, 1.0 + 3.2 * down)
    panels = figure.subplots(down, across, squeeze=False)
    for panel in panels.flat[len(shown) :]:
        panel.set_visible(False)
    unit = UNITS[quantity][0]
    for name, panel in zip(shown, panels.flat, strict=False):
        for index, (run_name, run) in enumerate(zip(record_names(runs), histories, strict=True)):
            if name in run:
                x, y = run[name].values[:, :2].T
                (path,) = panel.plot(x, y, label=run_name, gid=name, linewidth=0.9, **line_style(index))
                panel.plot(x[-1:], y[-1:], "o", color=path.get_color())
        panel.set_aspect("equal", adjustable="datalim")
        panel.set_title(monitor_title(name, histories), loc="left", fontsize=8)
        panel.set_xlabel(f"{quantity} along x ({unit})", fontsize=8)
        panel.set_ylabel(f"{quantity} along y ({unit})", fontsize=8)
    title = f"Paths of the {quantity} at the monitors, dots at their ends{left_out(shown, histories, monitors)}"
    return finished(figure, title, panels.flat, 3)
