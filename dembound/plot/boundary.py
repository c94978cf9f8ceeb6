"""The particles of one side: their diameters and the peaks of their motion along it (Z figs 11, 12)."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from dembound.errors import CaseError
from dembound.plot.style import new_figure, outside_legend, point_style, styled
from dembound.results.histories import UNITS
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
        _draw((upper, lower), each.of_column(False), column, name, point_style(index))
        if each.column.any():
            hollow = point_style(index) | {"linestyle": "none", "markerfacecolor": "white"}
            _draw((upper, lower), each.of_column(True), column, f"{name}, free-field column", hollow)
    along = "y" if side in ("left", "right") else "x"
    upper.set_ylabel("particle diameter (m)")
    unit = UNITS["velocity"][column]
    lower.set_ylabel(f"peak |velocity| along {COMPONENTS[column]} ({unit})")
    lower.set_xlabel(f"{along}, along the side (m)")
    for panel in (upper, lower):
        _widen(panel)
    figure.suptitle(f"Particles of the {side} side: diameters, and peaks of their velocity", fontsize=11)
    outside_legend(figure, [lower], columns=1)  # the labels are long
    return figure


def _draw(panels: tuple[Axes, Axes], side: Side, column: int, name: str, style: dict[str, Any]) -> None:
    """Diameters of some particles in the upper panel, peaks of a component of their velocity in the lower one."""
    upper, lower = panels
    peaks = side.peaks[:, column]
    upper.plot(side.along, side.diameters, gid=name, label=name, **style)
    lower.plot(side.along, peaks, gid=name, label=f"{name}: {_summary(peaks)}", **style)


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
        group = sides[side]
        axis = 1 if side in ("left", "right") else 0
        peaks = np.abs(group["peak_velocity"][:]).max(axis=2)
        along, column = group["position"][:, axis], group["particle"][:] < file.attrs.get("column", 0)
        order = np.argsort(along, kind="stable")
        return Side(along[order], group["diameter"][:][order], peaks[order], column[order])


def _summary(peaks: np.ndarray) -> str:
    """Number, mean and standard deviation as text."""
    mean = float(peaks.mean())
    spread = 100.0 * float(peaks.std()) / mean if mean > 0.0 else 0.0
    return f"{len(peaks)} particles, mean {mean:.4g} m/s, standard deviation {spread:.2f} %"


def _widen(panel: Axes) -> None:
    """Widen the vertical axis, so that small differences are not magnified."""
    low, high = panel.get_ylim()
    middle = 0.5 * (low + high)
    half = max(0.5 * (high - low), LEAST_SPAN * abs(middle))
    panel.set_ylim(middle - half, middle + half)
