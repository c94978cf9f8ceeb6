"""Pictures of studies: convergence of calibrations, energy of noise against steps, and sweeps.

A sweep shows the values of its members with mean and confidence interval over seeds.
"""

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedFormatter, FixedLocator, FuncFormatter, MaxNLocator, NullFormatter

from dembound.errors import CaseError
from dembound.plot.style import COLOURS, REFERENCE, decade, finished, new_figure, open_point_style, styled
from dembound.results.reader import open_record, record_names, text_of
from dembound.results.structure import Members


@styled
def plot_convergence(records: Sequence[Path]) -> Figure:
    """Peak M_out at the side, with the incident M_in (upper panel), and factor β (lower panel) against the pass.

    Parameters
    ----------
    records
        ``calibration.h5`` files. A calibration without passes (homogenised) appears only in the legend.

    Raises CaseError when a file cannot be read or none of them has a pass.
    """
    calibrations = [_read_passes(path) for path in records]
    if not any(len(beta) for beta, *_ in calibrations):
        raise CaseError([f"{', '.join(map(str, records))}: has no passes to show"])
    figure = new_figure(8.0, 6.5)
    upper, lower = figure.subplots(2, 1, sharex=True)
    for index, (name, (beta, outgoing, _, asked)) in enumerate(zip(record_names(records), calibrations, strict=True)):
        passes, style = np.arange(1, len(beta) + 1), open_point_style(index)
        upper.plot(passes, outgoing, label=f"{name}, {asked}", gid=name, **style)
        lower.plot(passes, beta, gid=name, label=name, **style)
    for incident in sorted({incident for _, _, incident, _ in calibrations}):
        label = f"incident peak, {incident:.4g} m/s"
        upper.axhline(incident, color=REFERENCE, linewidth=1.0, zorder=1, label=label)
    upper.set_ylabel("peak velocity at the side (m/s)")
    lower.set(xlabel="pass", ylabel="boundary factor β (–)")
    lower.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    return finished(figure, "Calibration: β is right when the side moves as the incident wave does", [upper], 2)


def _read_passes(path: Path) -> tuple[np.ndarray, np.ndarray, float, str]:
    """Factors β (p,) and outgoing peaks (p,) m/s of a calibration's passes, the incident peak (m/s), and its task."""
    with open_record(path) as file:
        boundary, kind, wave, method = (text_of(file.attrs[name]) for name in ("boundary", "kind", "wave", "method"))
        asked = f"{boundary} {kind} {wave.upper()}, {method}"
        return file["beta"][:], file["outgoing"][:], float(file.attrs["incident"]), asked


LEAST, MOST = 1e-20, 1e100
"""Smallest and largest energy drawn, over that of the noise."""


@dataclass(frozen=True)
class Line:
    """Energy of a run over the energy of its noise.

    name : of the run; group : index of the trial, which has one colour; steps (k,); energy (k,); dashed :
    whether the line is dashed.
    """

    name: str
    group: int
    steps: Sequence[int]
    energy: Sequence[float]
    dashed: bool = False


@styled
def plot_stability(short: Sequence[Line], long: Sequence[Line], title: str) -> Figure:
    """Kinetic energy of short runs around the limit (left), and energy at the case's own step (right)."""
    figure = new_figure(10.0, 4.8)
    left, right = figure.subplots(1, 2)
    for panel, lines in ((left, short), (right, long)):
        for line in lines:
            energy = np.clip(np.array(line.energy, dtype=float), LEAST, MOST)
            look = {"color": COLOURS[line.group % len(COLOURS)], "linestyle": "--" if line.dashed else "-"}
            panel.plot(line.steps[: len(energy)], energy, label=line.name, gid=line.name, **look)
        panel.axhline(1.0, color=REFERENCE, linewidth=1.0, zorder=1)
        panel.set_yscale("log")
        panel.yaxis.set_major_formatter(FuncFormatter(decade))
        panel.yaxis.set_minor_formatter(NullFormatter())
        panel.set_xlabel("steps")
        panel.set_xlim(left=0)
    left.set(ylabel="kinetic energy / that of the noise (–)", title="around the largest stable step")
    right.set(ylabel="energy / that of the noise (–)", title="at the case's own step")
    low, high = right.get_ylim()
    right.set_ylim(min(low, 0.1), max(high, 10.0))
    return finished(figure, title, [left, right], 2)


WIDEST = 0.06
"""Half the width of the members' points of one group, over the distance of two groups."""


class SweptQuantity(NamedTuple):
    """A quantity: values (n,) of the members, nan for those without it, and mean and interval (g,) of each group."""

    name: str
    unit: str
    values: np.ndarray
    mean: np.ndarray
    interval: np.ndarray


@styled
def plot_sweep(path: Path) -> Figure:
    """A panel for each quantity: all members as points, and mean with 95 % interval over members that differ in seeds.

    Groups are placed by their value, if they differ in one key that has numbers, else side by side.

    Parameters
    ----------
    path
        ``sweep.h5`` of a sweep, which also has the names of the drawn quantities.

    Raises CaseError when the file cannot be read.
    """
    with open_record(path) as file:
        title = text_of(file.attrs["title"]).strip("\0") or text_of(file.attrs["name"])
        of_members = [text_of(each) for each in file["members/group"][:]]
        names = list(dict.fromkeys(of_members))
        shown = [_read_swept(file, name, names) for name in json.loads(file.attrs["shown"])]
    groups, by_number = [json.loads(each) for each in names], [names.index(each) for each in of_members]
    columns = min(len(shown), 2)
    rows = math.ceil(len(shown) / columns)
    figure = new_figure(5.2 * columns + 1.0, 3.4 * rows + 0.9)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    keys = list(dict.fromkeys(key for group in groups for key in group))
    is_by_value = _is_by_value(groups)
    places = np.array([group[keys[0]] for group in groups] if is_by_value else range(len(groups)), dtype=float)
    for panel, each in zip(axes, shown, strict=False):
        _draw_swept(panel, each, np.array(by_number), places)
        panel.set(xlabel=", ".join(keys), ylabel=f"{each.name} ({'–' if each.unit == '1' else each.unit})")
        if is_by_value:
            order = np.argsort(places)
            panel.plot(places[order], each.mean[order], "-", color=REFERENCE, linewidth=0.9, zorder=1)
        else:
            panel.xaxis.set_major_locator(FixedLocator(places.tolist()))
            panel.xaxis.set_major_formatter(FixedFormatter([_in_words(group) for group in groups]))
            panel.set_xlim(-0.7, len(places) - 0.3)
    for panel in axes[len(shown) :]:
        panel.set_axis_off()
    return finished(figure, title, axes, 3)


def _read_swept(file: h5py.File, name: str, groups: Sequence[str]) -> SweptQuantity:
    """A quantity of an open record."""
    statistics, values = Members(file, "statistics")[name], file["values"][name]
    rows = {text_of(each): row for row, each in enumerate(statistics["group"][:])}
    mean, interval = (
        np.array([statistics[column][rows[group]] if group in rows else np.nan for group in groups])
        for column in ("mean", "interval")
    )
    return SweptQuantity(name, text_of(values.attrs["unit"]), values[:], mean, interval)


def _is_by_value(groups: Sequence[dict[str, Any]]) -> bool:
    """Whether groups differ in a single key, which has numbers."""
    values = [value for group in groups for value in group.values()]
    numbers = all(isinstance(value, int | float) and not isinstance(value, bool) for value in values)
    return len(groups) > 1 and all(len(group) == 1 for group in groups) and numbers


def _in_words(group: dict[str, Any]) -> str:
    """The values of a group, one in a line; empty without keys."""
    return "\n".join(value if isinstance(value, str) else json.dumps(value) for value in group.values())


def _draw_swept(panel: Axes, each: SweptQuantity, groups: np.ndarray, places: np.ndarray) -> None:
    """Draw the members of every group in their order, side by side, and beside them mean and interval.

    groups (n,) : number of that of each member; places (g,) : of the groups along the horizontal axis.
    """
    distance = float(np.diff(np.unique(places)).min()) if len(places) > 1 else 1.0
    for number, place in enumerate(places):
        inside = np.flatnonzero(groups == number)
        across = WIDEST * distance * np.linspace(-1.0, 1.0, len(inside)) if len(inside) > 1 else np.zeros(1)
        label = "members, side by side" if number == 0 else None
        panel.plot(place + across, each.values[inside], "o", color=COLOURS[4], markersize=4.0, label=label)
    known = np.isfinite(each.interval)
    if known.any():
        looks: dict[str, Any] = {"fmt": "s", "color": COLOURS[1], "capsize": 6.0, "zorder": 3}
        label = "mean over seeds with 95 % interval"
        panel.errorbar(places[known], each.mean[known], each.interval[known], label=label, **looks)
