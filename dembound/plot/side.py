"""Stress and mean displacement of one side against time, and stress against the strain between two sides."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from dembound.errors import CaseError
from dembound.plot.style import line_style, new_figure, outside_legend, styled, time_unit
from dembound.results.reader import record_names
from dembound.results.sides import SideHistory, read_side_history

LEAST = 1e-6
"""Share of the other component below which a component is left out."""

LINES = {"stress": ("normal, tension positive", "shear, xy"), "displacement": ("along x", "along y")}
"""Names of the components; the second is dashed."""


@styled
def plot_side(runs: Sequence[Path], side: str, quantity: str) -> Figure:
    """Mean stress (MPa, tension positive) or displacement (m) of a side against time, for several runs.

    On the right, stress against the strain between the side and the opposite one, if all runs have both.

    Parameters
    ----------
    runs
        ``run.h5`` files.
    side
        left, right, bottom or top.
    quantity
        stress or displacement.

    Raises CaseError for another quantity, and when a file cannot be read or has no such side.
    """
    if quantity not in LINES:
        raise CaseError([f"--quantity: of a side must be one of {', '.join(LINES)}, is {quantity}"])
    histories = [read_side_history(path, side) for path in runs]
    strained = quantity == "stress" and all(history.strain is not None for history in histories)
    figure = new_figure(12.0 if strained else 9.0, 4.5)
    panels = figure.subplots(1, 2 if strained else 1, sharey=True, squeeze=False)[0]
    unit = time_unit(max(float(history.time.max(initial=0.0)) for history in histories))
    shown = _shown([_values(history, quantity) for history in histories])
    for index, (name, history) in enumerate(zip(record_names(runs), histories, strict=True)):
        values = _values(history, quantity)
        for component in shown:
            style = line_style(index) | {"linestyle": ("-", "--")[component]}
            label = f"{name}, {LINES[quantity][component]}"
            panels[0].plot(history.time / unit.seconds, values[:, component], label=label, gid=label, **style)
            if strained and component == 0 and history.strain is not None:
                panels[1].plot(100.0 * history.strain, values[:, 0], label=label, gid=label, **style)
    panels[0].set_xlabel(unit.label)
    for panel in panels:
        panel.set_ylabel("mean stress (MPa)" if quantity == "stress" else "mean displacement (m)")
    if strained:
        panels[1].set_xlabel("strain to the opposite side, extension positive (%)")
    figure.suptitle(f"{quantity.capitalize()} of the {side} side", fontsize=11)
    outside_legend(figure, [panels[0]], columns=2)
    return figure


def _values(history: SideHistory, quantity: str) -> np.ndarray:
    """(k, 2) of a quantity in the unit shown."""
    return history.stress / 1e6 if quantity == "stress" else history.displacement


def _shown(values: Sequence[np.ndarray]) -> list[int]:
    """The components that are not negligible in all runs; the first if all are zero."""
    largest = np.max([np.abs(each).max(axis=0, initial=0.0) for each in values], axis=0)
    return [component for component in range(2) if largest[component] > LEAST * largest.max()] or [0]
