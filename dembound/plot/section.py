"""Record sections: the histories along a line of monitors, each at its distance."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from dembound.errors import CaseError
from dembound.plot.histories import Component, chosen_monitors, direction, shown_columns
from dembound.plot.style import line_style, new_figure, outside_legend, styled, time_unit
from dembound.results.histories import UNITS, Quantity, read_histories
from dembound.results.reader import open_record, record_names

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
    shown = chosen_monitors(runs, histories, monitors)
    common = [name for name in shown if all(name in run for run in histories)]
    if len(common) < 2:
        raise CaseError([f"--monitor: a section needs two monitors that all runs have, here are {len(common)}"])
    those = [{name: run[name] for name in common} for run in histories]
    (column,) = [0] if quantity == "stress" else shown_columns(those, component)
    unit = time_unit(max(history.time.max(initial=0.0) for run in those for history in run.values()))
    distances = [_distances(path, common) for path in runs]
    largest = max(float(np.abs(h.values[:, column]).max(initial=0.0)) for run in those for h in run.values())
    gap = max(float(np.ptp(each)) for each in distances) / (len(common) - 1) or 1.0
    scale = SPREAD * gap / (largest or 1.0)
    figure = new_figure(8.0, 3.5 + 0.4 * len(common))
    panel = figure.subplots()
    for index, (run_name, run, along) in enumerate(zip(record_names(runs), those, distances, strict=True)):
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
    size = f"{gap:.3g} m upwards is {gap / scale:.3g} {UNITS[quantity][column]}"
    panel.set_title(size, loc="left", fontsize=9)
    figure.suptitle(f"Section of the {quantity} at the monitors", fontsize=11)
    outside_legend(figure, [panel], columns=3)
    return figure


def _distances(path: Path, names: Sequence[str]) -> np.ndarray:
    """Distances (k,) in m of monitors from the first of them."""
    with open_record(path) as file:
        places = np.array([file[f"histories/{name}"].attrs["position"] for name in names])
    distances: np.ndarray = np.hypot(*(places - places[0]).T)
    return distances
