"""The whole scene at one moment, its disks coloured by their motion."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import h5py
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator, NullLocator

from dembound.errors import CaseError
from dembound.plot.disks import Window, draw_field
from dembound.plot.style import UNITS, new_figure, outside_legend, styled
from dembound.results import COMPONENTS, open_record

LONG = 6.0
"""A scene this many times as long as wide gets a second panel, which shows a part of it closely."""

CLOSE_UP_DIAMETERS = 40
"""Width of that part in mean disk diameters, or that of the scene if it is less: every disk can be seen."""

CLOSE_UP_ASPECT = 3.0
"""Length of that part over its width, but its length is never below `CLOSE_UP_DIAMETERS` either."""

DRAWING = (9.5, 6.5)
"""Largest width and height of the scene on the page in inches."""


@dataclass(frozen=True)
class Snapshot:
    """What a picture of the scene needs.

    positions (n, 2) and radii (n,) in m, before the motion; values (n,) the field; time in s; monitors: name ->
    place (2,) m; field in words and its unit; name of the case.
    """

    positions: np.ndarray
    radii: np.ndarray
    values: np.ndarray
    time: float
    monitors: dict[str, np.ndarray]
    field: str
    unit: str
    name: str

    @property
    def limit(self) -> float:
        """The largest |value|, the end of the colour scale; 1 for a scene at rest."""
        return float(np.abs(self.values).max()) or 1.0

    @property
    def window(self) -> Window:
        """The whole scene."""
        return Window.around(self.positions, self.radii)


@styled
def plot_scene(
    run: Path,
    snapshot: int = -1,
    field: Literal["velocity", "displacement"] = "velocity",
    component: Literal["x", "y", "rotation"] | None = None,
) -> Figure:
    """The scene at a snapshot, at its undeformed places, with the monitors.

    A very long scene gets a second panel that shows a part of it closely.

    Parameters
    ----------
    run
        the ``run.h5`` of a run.
    snapshot
        number of the snapshot; negative ones count from the last.
    field
        velocity in m/s or displacement in m.
    component
        by default whichever of x and y is largest at that moment.

    Raises CaseError when the file cannot be read or has no such snapshot.
    """
    shown = read_snapshot(run, snapshot, field, component)
    width, height = shown.window.size
    if max(width, height) > LONG * min(width, height):
        figure, panels, colours = _draw_long(shown)
    else:
        figure, panels, colours = _draw_whole(shown)
    figure.colorbar(colours, ax=panels, label=f"{shown.field} ({shown.unit})", shrink=0.9, pad=0.02)
    figure.suptitle(f"{shown.name}: {shown.field} of {len(shown.values)} disks at t = {shown.time:.4g} s", fontsize=11)
    outside_legend(figure, panels, columns=3)
    return figure


def read_snapshot(run: Path, snapshot: int, field: str, component: str | None) -> Snapshot:
    """One field of one snapshot of a run; arguments and errors as in `plot_scene`."""
    with open_record(run) as file:
        motion = _snapshot_group(run, file, snapshot)
        values = motion[field][:]
        largest = np.abs(values[:, :2]).max(axis=0)
        column = int(np.argmax(largest)) if component is None else COMPONENTS.index(component)
        way = "of rotation" if column == 2 else f"along {COMPONENTS[column]}"
        return Snapshot(
            positions=file["particles/position"][:],
            radii=file["particles/radius"][:],
            values=values[:, column],
            time=float(motion.attrs["time"]),
            monitors={name: group.attrs["position"] for name, group in file.get("histories", {}).items()},
            field=f"{field} {way}",
            unit=UNITS[field][column],
            name=str(file.attrs["name"]),
        )


def _snapshot_group(run: Path, file: h5py.File, snapshot: int) -> h5py.Group:
    groups = list(file.get("snapshots", {}).values())
    if not -len(groups) <= snapshot < len(groups):
        raise CaseError([f"{run}: has no snapshot {snapshot}, it has {len(groups)}"])
    return groups[snapshot]


def _draw_whole(shown: Snapshot) -> tuple[Figure, list[Axes], ScalarMappable]:
    """One panel."""
    width, height = shown.window.size
    scale = min(DRAWING[0] / width, DRAWING[1] / height)
    figure = new_figure(max(scale * width, 3.0) + 1.8, scale * height + 1.4)
    panel = figure.subplots()
    colours = _draw_panel(panel, shown, shown.window, scale * figure.dpi)
    _mark_monitors(panel, shown)
    return figure, [panel], colours


def _draw_long(shown: Snapshot) -> tuple[Figure, list[Axes], ScalarMappable]:
    """The whole scene as a strip, and a part of it closely, below or beside the strip."""
    upright = bool(shown.window.size[1] > shown.window.size[0])
    part = close_up(shown)
    room = DRAWING[1] if upright else DRAWING[0]
    scales = [room / max(window.size) for window in (shown.window, part)]
    strip, close = (scale * min(w.size) for scale, w in zip(scales, (shown.window, part), strict=True))
    if upright:
        figure = new_figure(strip + close + 3.6, room + 1.4)
        panels = figure.subplots(1, 2, width_ratios=[strip, close])
    else:
        figure = new_figure(room + 1.8, max(strip + close, 1.3) + 1.9)
        panels = figure.subplots(2, 1, height_ratios=[strip, close])
    _draw_panel(panels[0], shown, shown.window, scales[0] * figure.dpi)
    colours = _draw_panel(panels[1], shown, part, scales[1] * figure.dpi)
    left, right, bottom, top = part.extent
    frame: dict[str, Any] = {"fill": False, "linewidth": 1.5, "clip_on": False, "label": "part shown closely"}
    panels[0].add_patch(Rectangle((left, bottom), right - left, top - bottom, **frame))
    _mark_monitors(panels[0], shown)
    return figure, list(panels), colours


def close_up(shown: Snapshot) -> Window:
    """The part of a long scene around half its largest motion, on a wave's flank, where colours change most."""
    scene = shown.window
    along = int(np.argmax(scene.size))
    width = CLOSE_UP_DIAMETERS * 2.0 * float(shown.radii.mean())
    size = np.minimum(scene.size, width)
    size[along] = min(scene.size[along], max(CLOSE_UP_ASPECT * size.min(), width))
    centre = shown.positions[np.argmin(np.abs(np.abs(shown.values) - 0.5 * shown.limit))]
    return Window(np.clip(centre - 0.5 * size, scene.corner, scene.corner + scene.size - size), size)


def _draw_panel(panel: Axes, shown: Snapshot, window: Window, scale: float) -> ScalarMappable:
    """A window of the scene at `scale` pixels per metre."""
    colours = draw_field(panel, window, shown.positions, shown.radii, shown.values, shown.limit, scale)
    for axis, pixels in zip((panel.xaxis, panel.yaxis), scale * window.size, strict=True):
        ticks = MaxNLocator(nbins=int(np.clip(pixels / 90, 1, 9)), steps=[1, 2, 5, 10])
        axis.set_major_locator(ticks if pixels > 45 else NullLocator())  # two labels would collide
    panel.set(xlabel="x (m)", ylabel="y (m)")
    return colours


def _mark_monitors(panel: Axes, shown: Snapshot) -> None:
    """A triangle and a name at each monitor."""
    if not shown.monitors:
        return
    x, y = np.transpose(list(shown.monitors.values()))
    mark: dict[str, Any] = {"marker": "^", "color": "black", "edgecolors": "white", "clip_on": False, "zorder": 3}
    panel.scatter(x, y, s=40, label="monitor", **mark)
    plate: dict[str, Any] = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none", "alpha": 0.8}
    beside: dict[str, Any] = {
        "textcoords": "offset points",
        "ha": "center",
        "va": "bottom",
        "fontsize": 8,
        "bbox": plate,
    }
    for name, place in shown.monitors.items():
        panel.annotate(name, tuple(place), (0, 7), **beside)
