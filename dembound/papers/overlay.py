"""Lines over each other in one panel, as papers print them."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from dembound.plot.style import COLOURS, DASHES, MARKERS, REFERENCE, finished, new_figure, styled
from dembound.results.results import Results

ROOM = 0.2
"""Height of a legend inside a panel, over that of the lines."""


class Line(NamedTuple):
    """A line: x and y (k,), its name, and numbers of its colour and of its dashes; marked : points, not lines alone."""

    x: np.ndarray
    y: np.ndarray
    name: str
    colour: int
    dashes: int = 0
    marked: bool = False


def history(run: Results, monitor: str, quantity: str, column: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Times (k,) s and one component (k,) of a quantity at a monitor."""
    arrays = run.histories[monitor]
    return arrays["time"], arrays[quantity][:, column]


@styled
def overlay(title: str, panels: Sequence[tuple[str, Sequence[Line]]], x: str, y: str, level: float = np.nan) -> Figure:
    """A panel for each name and its lines, two beside each other.

    x, y : labels of the axes; level : of a thin line across. A single panel has its legend below, several inside.
    """
    across, several = min(len(panels), 2), len(panels) > 1
    figure = new_figure(2.5 + 5.0 * across, 1.0 + 4.0 * math.ceil(len(panels) / across))
    axes = figure.subplots(math.ceil(len(panels) / across), across, sharex=True, sharey=True, squeeze=False)
    for panel, (name, lines) in zip(axes.flat, panels, strict=True):
        for each in lines:
            look: dict[str, Any] = {"color": COLOURS[each.colour % len(COLOURS)], "label": each.name}
            look |= {"linestyle": DASHES[each.dashes % len(DASHES)]}
            panel.plot(each.x, each.y, marker=MARKERS[each.colour % len(MARKERS)] if each.marked else "", **look)
        if np.isfinite(level):
            panel.axhline(level, color=REFERENCE, linewidth=0.8, zorder=1)
        panel.set_title(name)
        if several:
            panel.legend(fontsize=8.0, loc="upper left", ncols=2 if len(lines) > 3 else 1)
    if several:
        low, high = axes[0, 0].get_ylim()
        axes[0, 0].set_ylim(low, high + ROOM * (high - low))
    for panel in axes[-1]:
        panel.set_xlabel(x)
    for row in axes:
        row[0].set_ylabel(y)
    return finished(figure, title, () if several else axes.flat, 3)
