"""A sweep: the values of its members with mean and confidence interval over seeds."""

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedFormatter, FixedLocator

from dembound.plot.style import COLOURS, REFERENCE, finished, new_figure, styled
from dembound.results.reader import open_record, text_of
from dembound.results.structure import Members

WIDEST = 0.06
"""Half the width of the members' points of one group, over the distance of two groups."""


@dataclass(frozen=True)
class Panel:
    """A quantity: values (n,) of the members, nan for those without it, and mean and interval (g,) of each group."""

    name: str
    unit: str
    values: np.ndarray
    mean: np.ndarray
    interval: np.ndarray


@dataclass(frozen=True)
class Content:
    """Contents of the picture: the number of the group of every member (n,), the groups, and the panels."""

    title: str
    member_group: np.ndarray
    groups: list[dict[str, Any]]
    panels: list[Panel]


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
    content = read_content(path)
    count = len(content.panels)
    columns = min(count, 2)
    figure = new_figure(5.2 * columns + 1.0, 3.4 * math.ceil(count / columns) + 0.9)
    places, label = _places(content.groups)
    axes = figure.subplots(math.ceil(count / columns), columns, squeeze=False).ravel()
    for panel, each in zip(axes, content.panels, strict=False):
        _draw(panel, each, content, places)
        panel.set_ylabel(f"{each.name} ({'–' if each.unit == '1' else each.unit})")
        panel.set_xlabel(label)
        if not _is_by_value(content.groups):
            panel.xaxis.set_major_locator(FixedLocator(places.tolist()))
            panel.xaxis.set_major_formatter(FixedFormatter([_in_words(group) for group in content.groups]))
            panel.set_xlim(-0.7, len(places) - 0.3)
    for panel in axes[count:]:
        panel.set_axis_off()
    return finished(figure, content.title, axes, 3)


def read_content(path: Path) -> Content:
    """The contents of a picture; errors as `plot_sweep`."""
    with open_record(path) as file:
        texts = [text_of(each) for each in file["members/group"][:]]
        names = list(dict.fromkeys(texts))
        return Content(
            title=text_of(file.attrs["title"]).strip("\0") or text_of(file.attrs["name"]),
            member_group=np.array([names.index(each) for each in texts]),
            groups=[json.loads(each) for each in names],
            panels=[_read_panel(file, name, names) for name in json.loads(file.attrs["shown"])],
        )


def _read_panel(file: h5py.File, name: str, groups: list[str]) -> Panel:
    """A quantity of an open record."""
    statistics = Members(file, "statistics")[name]
    rows = {text_of(each): row for row, each in enumerate(statistics["group"][:])}
    columns = {
        column: np.array([statistics[column][rows[group]] if group in rows else np.nan for group in groups])
        for column in ("mean", "interval")
    }
    return Panel(name, text_of(file["values"][name].attrs["unit"]), file["values"][name][:], **columns)


def _is_by_value(groups: Sequence[dict[str, Any]]) -> bool:
    """Whether groups differ in a single key, which has numbers."""
    values = [value for group in groups for value in group.values()]
    numbers = all(isinstance(value, int | float) and not isinstance(value, bool) for value in values)
    return len(groups) > 1 and all(len(group) == 1 for group in groups) and numbers


def _places(groups: Sequence[dict[str, Any]]) -> tuple[np.ndarray, str]:
    """Positions (g,) of the groups along the horizontal axis, and its label."""
    keys = list(dict.fromkeys(key for group in groups for key in group))
    if _is_by_value(groups):
        return np.array([group[keys[0]] for group in groups], dtype=float), keys[0]
    return np.arange(float(len(groups))), ", ".join(keys)


def _in_words(group: dict[str, Any]) -> str:
    """The values of a group, one in a line; empty without keys."""
    return "\n".join(value if isinstance(value, str) else json.dumps(value) for value in group.values())


def _draw(panel: Axes, each: Panel, content: Content, places: np.ndarray) -> None:
    """Draw the members of every group in their order, side by side, and beside them mean and interval."""
    distance = float(np.diff(np.unique(places)).min()) if len(places) > 1 else 1.0
    for number, place in enumerate(places):
        inside = np.flatnonzero(content.member_group == number)
        across = WIDEST * distance * np.linspace(-1.0, 1.0, len(inside)) if len(inside) > 1 else np.zeros(1)
        label = "members, side by side" if number == 0 else None
        panel.plot(place + across, each.values[inside], "o", color=COLOURS[4], markersize=4.0, label=label)
    has_interval = np.isfinite(each.interval)
    if has_interval.any():
        panel.errorbar(
            places[has_interval],
            each.mean[has_interval],
            each.interval[has_interval],
            fmt="s",
            color=COLOURS[1],
            capsize=6.0,
            zorder=3,
            label="mean over seeds with 95 % interval",
        )
    if _is_by_value(content.groups):
        order = np.argsort(places)
        panel.plot(places[order], each.mean[order], "-", color=REFERENCE, linewidth=0.9, zorder=1)
