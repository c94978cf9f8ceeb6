"""Hodographs: the path of each monitor's motion in the plane."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from dembound.errors import CaseError
from dembound.plot.histories import chosen_monitors, monitor_title
from dembound.plot.style import line_style, new_figure, outside_legend, styled
from dembound.results.histories import UNITS, Quantity, read_histories
from dembound.results.reader import record_names

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
                style = line_style(index)
                panel.plot(x, y, label=run_name, gid=name, linewidth=0.9, **style)
                panel.plot(x[-1:], y[-1:], "o", color=style["color"])
        panel.set_aspect("equal", adjustable="datalim")
        panel.set_title(monitor_title(name, [run[name] for run in histories if name in run]), loc="left", fontsize=8)
        panel.set_xlabel(f"{quantity} along x ({unit})", fontsize=8)
        panel.set_ylabel(f"{quantity} along y ({unit})", fontsize=8)
    figure.suptitle(f"Paths of the {quantity} at the monitors, dots at their ends", fontsize=11)
    outside_legend(figure, list(np.ravel(panels)), columns=3)
    return figure
