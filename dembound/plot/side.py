"""One side of a scene: its particles, their peaks, its stress and mean displacement."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dembound.errors import CaseError
from dembound.plot.style import finished, line_style, new_figure, point_style, styled, time_unit
from dembound.results.histories import UNITS, read_side_history
from dembound.results.reader import COMPONENTS, is_line, open_record, record_names, require_run

# The axes show at least ± this part of the middle value, so that small differences are not magnified.
LEAST_SPAN = 0.1


@dataclass(frozen=True)
class Side:
    """The q particles of a side in their order along it.

    along (q,) m, diameters (q,) m, largest |velocity| peaks (q, 3) m/s, rad/s; column (q,) bool, which of them
    belong to the free-field column.
    """

    along: np.ndarray
    diameters: np.ndarray
    peaks: np.ndarray
    column: np.ndarray

    def of_column(self, column: bool) -> "Side":
        """The side with only the particles of the column, or only the particles of the body."""
        chosen = self.column == column
        return Side(self.along[chosen], self.diameters[chosen], self.peaks[chosen], self.column[chosen])


@styled
def plot_boundary(runs: Sequence[Path], side: str) -> Figure:
    """Diameter (upper panel) and peak velocity (lower panel) of the particles along a side, for several runs.

    The peak is that of the component, x or y, with the largest motion on the side in any run. The legend gives the
    number of particles, the mean peak, and its standard deviation in per cent. Particles of a free-field column are
    drawn separately, as hollow marks without lines.

    Parameters
    ----------
    runs
        ``run.h5`` files of complete runs.
    side
        left, right, bottom or top.

    Raises CaseError when a file cannot be read, is that of a bar, or a run has no such side.
    """
    sides = [read_side(path, side) for path in runs]
    column = int(np.argmax(np.max([s.peaks[:, :2].max(axis=0) for s in sides], axis=0)))
    figure = new_figure(9.0, 6.5)
    upper, lower = figure.subplots(2, 1, sharex=True)
    for index, (name, each) in enumerate(zip(record_names(runs), sides, strict=True)):
        if not each.column.all():
            _draw((upper, lower), each.of_column(False), column, name, point_style(index))
        if each.column.any():
            hollow = point_style(index) | {"linestyle": "none", "markerfacecolor": "white"}
            _draw((upper, lower), each.of_column(True), column, f"{name}, free-field column", hollow)
    along = f"{'y' if side in ('left', 'right') else 'x'}, along the side (m)"
    upper.set_ylabel("particle diameter (m)")
    lower.set(xlabel=along, ylabel=f"peak |velocity| along {COMPONENTS[column]} ({UNITS['velocity'][column]})")
    for panel in (upper, lower):
        low, high = panel.get_ylim()
        middle = 0.5 * (low + high)
        half = max(0.5 * (high - low), LEAST_SPAN * abs(middle))
        panel.set_ylim(middle - half, middle + half)
    title = f"Particles of the {side} side: diameters, and peaks of their velocity"
    return finished(figure, title, [lower], 1)  # the labels are long


def _draw(panels: tuple[Axes, Axes], side: Side, column: int, name: str, style: dict[str, Any]) -> None:
    """Diameters of some particles in the upper panel, peaks of a component of their velocity in the lower one."""
    upper, lower = panels
    peaks = side.peaks[:, column]
    mean, spread = float(peaks.mean()), float(peaks.std())
    deviation = f"standard deviation {100.0 * spread / mean if mean > 0.0 else 0.0:.2f} %"
    words = f"{name}: {len(peaks)} particles, mean {mean:.4g} m/s, {deviation}"
    upper.plot(side.along, side.diameters, gid=name, label=name, **style)
    lower.plot(side.along, peaks, gid=name, label=words, **style)


def read_side(path: Path, side: str) -> Side:
    """The particles of a side of a run.

    Raises CaseError when the file cannot be read, is that of a bar, or has no such side.
    """
    with open_record(path) as file:
        if is_line(file.attrs["size"]):
            raise CaseError([f"{path}: is a bar, each end of which is one node; monitors there show its motion"])
        require_run(file)
        sides = file.get("boundaries", {})
        if side not in sides:
            there = ", ".join(sides) or "none (the run is not complete, or the scene is periodic)"
            raise CaseError([f"{path}: has no particles of side {side}, sides there: {there}"])
        group, axis = sides[side], 1 if side in ("left", "right") else 0
        peaks = np.abs(group["peak_velocity"][:]).max(axis=2)
        along, column = group["position"][:, axis], group["particle"][:] < file.attrs.get("column", 0)
        order = np.argsort(along, kind="stable")
        return Side(along[order], group["diameter"][:][order], peaks[order], column[order])


LEAST = 1e-6
"""Share of the other component, in all runs, below which a component is left out; the first remains if all are zero."""

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
    each = [history.stress / 1e6 if quantity == "stress" else history.displacement for history in histories]
    largest = np.max([np.abs(values).max(axis=0, initial=0.0) for values in each], axis=0)
    shown = [component for component in range(2) if largest[component] > LEAST * largest.max()] or [0]
    for index, (name, history, values) in enumerate(zip(record_names(runs), histories, each, strict=True)):
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
    return finished(figure, f"{quantity.capitalize()} of the {side} side", [panels[0]], 2)
