"""Spectra of the monitors: Fourier amplitudes, transfer functions, response spectra."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from dembound.errors import CaseError
from dembound.plot.histories import (
    BEHIND,
    Component,
    Histories,
    chosen_monitors,
    direction,
    left_out,
    name_columns,
    shown_columns,
    those,
    title_monitors,
    twin_of,
)
from dembound.plot.style import REFERENCE, finished, line_style, new_figure, plain_numbers, styled
from dembound.results.histories import UNITS, MonitorRecord, Quantity, read_histories
from dembound.results.reader import record_names
from dembound.spectra import (
    SAMPLES_PER_PERIOD,
    fourier_spectrum,
    response_spectrum,
    shown_frequencies,
    slope,
    smoothed,
    transfer_function,
    usual_periods,
)
from dembound.words import with_unit

DECADES = 1e-4
"""Smallest amplitude shown, over the largest."""

FEW_DECADES = 300.0
"""End of an axis over its begin below which not only powers of ten have numbers, but also their multiples."""

NUMBERED = (1.0, 2.0, 5.0)
"""Multiples of powers of ten that are labelled on an axis."""

FEWEST = 16
"""Least number of samples of a spectrum."""

FAINT: dict[str, Any] = {"linewidth": 0.5, "alpha": 0.3, "zorder": 1.8}
"""Line style of spectra that are not smoothed."""

NOT_SMOOTHED = ", not smoothed"
"""End of the names of lines that are not smoothed."""

LEGEND_OF_FAINT: dict[str, Any] = {"linewidth": 0.5, "color": REFERENCE, "label": "thin: not smoothed"}
"""Line in the legend for the unsmoothed spectra of all runs."""


class Curve(NamedTuple):
    """A line: places (k,) along the axis, and values (k,); faint : places and values before smoothing, or None.

    is_listed : whether these are in tables too, with their crest named in the picture, as smoothing lowers it.
    """

    along: np.ndarray
    values: np.ndarray
    faint: tuple[np.ndarray, np.ndarray] | None = None
    is_listed: bool = False


CurveOf = Callable[[Histories, str, int], Curve | None]
"""The line of a run's histories for a monitor that it has and a column; None if there is none."""


def fourier_curve(values: np.ndarray, time_step: float) -> Curve:
    """The smoothed Fourier amplitudes of values (n,), time_step (s) apart, over those that are not smoothed."""
    frequency, spectrum = fourier_spectrum(values, time_step)
    centre = shown_frequencies(len(values), time_step)
    power = np.abs(spectrum) ** 2
    return Curve(centre, np.sqrt(smoothed(frequency, power, centre)), (frequency[1:], np.sqrt(power[1:])))


def response_curve(acceleration: np.ndarray, time_step: float, shortest: int) -> Curve:
    """The pseudo-accelerations, 5 % damping, of a base's acceleration (n,), m/s², time_step (s) apart.

    shortest : samples in the shortest period.
    """
    found = response_spectrum(acceleration, time_step, usual_periods(len(acceleration), time_step, shortest))
    return Curve(found.period, found.pseudo_acceleration)


@styled
def plot_fourier(
    runs: Sequence[Path],
    component: Component | None = None,
    quantity: Quantity = "velocity",
    monitors: Sequence[str] | None = None,
) -> Figure:
    """Smoothed Fourier amplitude spectra of the monitors, a panel each, over thin unsmoothed ones.

    Twins in a free-field column are dashed. Parameters and errors as of `plot_histories`.
    """

    def curve(run: Histories, name: str, column: int) -> Curve:
        return fourier_curve(run[name].values[:, column], _time_step(name, run[name]))

    return _figure(
        runs, quantity, monitors, None, component, curve, f"Fourier spectra of the {quantity} at the monitors",
        "frequency (Hz)",
        lambda along, unit: f"Fourier amplitude of the {quantity}{along} ({unit}·s)",
    )  # fmt: skip


@styled
def plot_transfer(
    runs: Sequence[Path],
    component: Component | None = None,
    quantity: Quantity = "velocity",
    monitors: Sequence[str] | None = None,
    reference: str | None = None,
) -> Figure:
    """Amplitudes of transfer functions to the monitors, a panel each, from another monitor or their free-field twins.

    Smoothed ones, over thin unsmoothed ones, whose crests are named. They are blank at frequencies at which the input
    has no energy (`Transfer`).

    Parameters
    ----------
    reference
        monitor that is the input; None: each monitor's twin in the free-field column.

    Other parameters and errors as of `plot_histories`. Also raises CaseError when no run has the input.
    """
    histories = [read_histories(path, quantity) for path in runs]
    known = sorted({name for run in histories for name in run})
    if reference is not None and reference not in known:
        raise CaseError([f"--reference: is {reference}, must be one of {', '.join(known)}"])
    if reference is None and not any(twin_of(name) in known for name in known):
        raise CaseError(["--reference: is missing; these runs have no free-field twins to take instead"])
    shown = [name for name in chosen_monitors(runs, histories, monitors) if name != reference]
    shown = [name for name in shown if reference is not None or twin_of(name) in known]
    if not shown:
        raise CaseError(["--monitor: names only the monitor that is the input"])

    def curve(run: Histories, name: str, column: int) -> Curve | None:
        source = twin_of(name) if reference is None else reference
        if source not in run:
            return None
        output, given = run[name], run[source]
        found = transfer_function(output.values[:, column], given.values[:, column], _time_step(name, output))
        return Curve(found.centre, found.amplitude, (found.frequency[1:], np.abs(found.ratio[1:])), is_listed=True)

    below = "their free-field twins" if reference is None else reference
    return _figure(
        runs, quantity, monitors, shown, component, curve, f"Transfer functions of the {quantity} to the monitors",
        "frequency (Hz)",
        lambda along, _: f"amplitude over that of {below}, {quantity}{along} (–)",
    )  # fmt: skip


@styled
def plot_response(
    runs: Sequence[Path], component: Component | None = None, monitors: Sequence[str] | None = None
) -> Figure:
    """Response spectra of the monitors' accelerations for 5 % damping, a panel each; twins are dashed.

    They begin at eight samples of the coarsest run in a period, from which on they are within 0.5 % of those of the
    band-limited motion through the samples.

    Parameters and errors as of `plot_histories`.
    """
    if component == "rotation":
        raise CaseError(["--component: is rotation; a response spectrum is of x or y"])
    begins = []

    def curve(run: Histories, name: str, column: int) -> Curve:
        step = _time_step(name, run[name])
        found = response_curve(slope(run[name].values[:, column], step), step, SAMPLES_PER_PERIOD)
        begins.append(found.along[0])
        return found

    figure = _figure(
        runs, "velocity", monitors, None, component, curve, "", "period (s)",
        lambda along, _: f"pseudo-acceleration{along}, 5 % damping (m/s²)",
    )  # fmt: skip
    begin = with_unit(max(begins), "s", digits=2)
    title = f"Response spectra of the monitors, from {begin} on: eight samples in a period"
    figure.suptitle(title + figure.get_suptitle(), fontsize=11)
    return figure


def _figure(
    runs: Sequence[Path],
    quantity: Quantity,
    monitors: Sequence[str] | None,
    shown: Sequence[str] | None,
    component: Component | None,
    curve: CurveOf,
    title: str,
    along: str,
    label: Callable[[str, str], str],
) -> Figure:
    """A panel for each monitor and component with the lines of all runs, on logarithmic axes.

    monitors : as asked for. shown : which have panels, if not these. label : text beside the panels, from the direction
    after a blank, empty where panels have one each, and the unit.
    """
    histories = [read_histories(path, quantity) for path in runs]
    shown = shown or chosen_monitors(runs, histories, monitors)
    columns = [0] if quantity == "stress" else shown_columns(those(histories, shown), component)
    figure = new_figure(7.5 if len(columns) == 1 else 12.0, 1.2 + 2.4 * len(shown))
    panels = figure.subplots(len(shown), len(columns), sharex=True, sharey=True, squeeze=False)
    for index, (run_name, run) in enumerate(zip(record_names(runs), histories, strict=True)):
        for row, name in zip(panels, shown, strict=True):
            for panel, column in zip(row, columns, strict=True):
                _draw(panel, curve, run, name, column, run_name, line_style(index))
    if any(_is_faint(line) for panel in panels.flat for line in panel.lines):
        panels.flat[-1].plot([], [], **LEGEND_OF_FAINT)
    on_logarithmic_axes(panels)
    title_monitors(panels, shown, histories)
    for panel in panels[-1]:
        panel.set_xlabel(along)
    has_one = len(columns) == 1 and quantity != "stress"  # which is along the bar
    figure.supylabel(label(f" {direction(columns[0])}" if has_one else "", UNITS[quantity][columns[0]]), fontsize=10)
    name_columns(panels, columns)
    return finished(figure, f"{title}{left_out(shown, histories, monitors)}", panels.flat, 3)


def _draw(
    panel: Axes, curve: CurveOf, run: Histories, name: str, column: int, label: str, style: dict[str, Any]
) -> None:
    """Draw a monitor's smoothed spectrum in one run, if it has it, over a thin unsmoothed one; its twin's dashed."""
    twin = twin_of(name)
    if twin in run and (line := curve(run, twin, column)) is not None:
        behind = {"color": style["color"], **BEHIND}
        panel.plot(line.along, line.values, label=f"{label}, free field", gid=twin, **behind)
    if name in run and (line := curve(run, name, column)) is not None:
        draw_curve(panel, line, name, label, style)


def draw_curve(panel: Axes, line: Curve, name: str, label: str, style: dict[str, Any]) -> None:
    """Draw a smoothed spectrum over a thin one that is not; the line has the name, and the label in a legend."""
    panel.plot(line.along, line.values, label=label, gid=name, **style)
    if line.faint is not None:
        (faint,) = panel.plot(*line.faint, color=style["color"], **FAINT)
        if line.is_listed:
            faint.set(gid=f"{name}{NOT_SMOOTHED}", label=f"_{label}")
            _name_crest(panel, *line.faint)


def _name_crest(panel: Axes, along: np.ndarray, values: np.ndarray) -> None:
    """Name the largest of some values, and where it is."""
    if (shown := along[np.isfinite(values)]).size > 0:
        at = int(np.nanargmax(values))
        words = f"{values[at]:.3g} at {along[at]:.3g} Hz{NOT_SMOOTHED}"
        right = np.log(along[at] / shown[0]) > 0.5 * np.log(shown[-1] / shown[0])
        panel.annotate(
            words, (along[at], values[at]), xytext=(-4 if right else 4, 0), textcoords="offset points", fontsize=7,
            ha="right" if right else "left", va="center", color=REFERENCE,
        )  # fmt: skip


def _is_faint(line: Line2D) -> bool:
    """Whether a line is of values before smoothing."""
    return line.get_gid() is None or str(line.get_gid()).endswith(NOT_SMOOTHED)


def on_logarithmic_axes(panels: np.ndarray) -> None:
    """Make all axes logarithmic, from the lowest to the highest value of named lines, or down to `DECADES` of it.

    Lines that are not smoothed count for the highest value alone. Raises CaseError if all lines are zero or blank.
    """
    lines = [line for panel in panels.flat for line in panel.lines if line.get_gid()]
    values = np.concatenate([np.zeros(0), *(line.get_ydata() for line in lines if not _is_faint(line))])
    values = values[values > 0.0]  # False for nan
    if len(values) == 0:
        raise CaseError(["RESULTS: nothing moves at these monitors, or the input has no energy: there is no spectrum"])
    crests = [np.nanmax(each, initial=0.0) for line in lines if len(each := np.asarray(line.get_ydata())) > 0]
    values = np.append(values, max(crests))
    for panel in panels.flat:
        panel.set(xscale="log", yscale="log")
        for axis in (panel.xaxis, panel.yaxis):
            plain_numbers(axis)
        if values.max() < FEW_DECADES * values.min():
            panel.yaxis.set_major_locator(LogLocator(subs=NUMBERED))
        if np.divide(*panel.get_xlim()[::-1]) < FEW_DECADES:
            panel.xaxis.set_major_locator(LogLocator(subs=NUMBERED))
        panel.set_ylim(0.7 * max(values.min(), DECADES * values.max()), 1.4 * values.max())


def _time_step(name: str, history: MonitorRecord) -> float:
    """Time (s) between two samples of a history; raises CaseError for too few of them."""
    if len(history.time) < FEWEST:
        raise CaseError([f"monitor {name}: has {len(history.time)} samples, a spectrum needs at least {FEWEST}"])
    return float((history.time[-1] - history.time[0]) / (len(history.time) - 1))
