"""The whole scene at one moment, or a long one at several, its disks coloured by their motion."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import h5py
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator, NullLocator

from dembound.plot.disks import Window, draw_field
from dembound.plot.style import UNITS, new_figure, outside_legend, styled
from dembound.results import (
    COMPONENTS,
    cracks_until,
    laws_in_words,
    laws_of,
    liveliest_snapshot,
    open_record,
    snapshot_of,
)

LONG = 6.0
"""A scene this many times as long as wide gets a second panel, which shows a part of it closely."""

CLOSE_UP_DIAMETERS = 40
"""Width of that part in mean disk diameters, or that of the scene if it is less: every disk can be seen."""

CLOSE_UP_ASPECT = 3.0
"""Length of that part over its width, but its length is never below `CLOSE_UP_DIAMETERS` either."""

DRAWING = (9.5, 6.5)
"""Largest width and height of the scene on the page in inches."""

MOST_STRIPS = 8
"""A scene that lies long is shown at no more moments than this, strip below strip."""

STRIP_GAP = 0.12
"""Inches between two strips."""

CRACKS = {"bond broken in tension": ("o", 3.0), "bond broken in shear": ("x", 14.0)}
"""What the legend calls the two kinds of cracks, and the shape and size of their marks."""


@dataclass(frozen=True)
class Motion:
    """One field of the disks at k moments of a run.

    positions (n, 2) and radii (n,) in m, before the motion; times (k,) in s; values (k, n) the field; limit, the end
    of its colour scale: the largest |value| in any snapshot of the run, 1 for a run at rest; cracks: at each moment
    those so far, as by `cracks_until`; monitors: name -> place (2,) m; field in words and its unit; name of the case;
    laws in words, empty if one law served all through.
    """

    positions: np.ndarray
    radii: np.ndarray
    times: np.ndarray
    values: np.ndarray
    limit: float
    cracks: list[dict[str, np.ndarray]]
    monitors: dict[str, np.ndarray]
    field: str
    unit: str
    name: str
    laws: str

    @cached_property
    def window(self) -> Window:
        """The whole scene."""
        return Window.around(self.positions, self.radii)


@styled
def plot_scene(
    run: Path,
    snapshot: int | None = None,
    field: Literal["velocity", "displacement"] = "velocity",
    component: Literal["x", "y", "rotation"] | None = None,
) -> Figure:
    """The scene at a snapshot, at its undeformed places, with the monitors; colours mean the same all through a run.

    Bonds that have broken by then are marked where they stood. A very long scene gets one more panel that shows a part
    of it closely.

    Parameters
    ----------
    run
        the ``run.h5`` of a run.
    snapshot
        number of the snapshot; negative ones count from the last. By default the last; of a scene that lies long,
        as many as fit on the page, evenly picked, one below the other.
    field
        velocity in m/s or displacement in m.
    component
        by default whichever of x and y is largest in any snapshot of the run.

    Raises CaseError when the file cannot be read or has no such snapshot.
    """
    shown = read_motion(run, snapshot, field, component)
    width, height = shown.window.size
    if max(width, height) > LONG * min(width, height):
        figure, panels, colours = _draw_long(shown)
    else:
        figure, panels, colours = _draw_whole(shown)
    figure.colorbar(colours, ax=panels, label=f"{shown.field} ({shown.unit})", shrink=0.9, pad=0.02)
    title = f"{shown.name}: {shown.field} of {len(shown.radii)} disks"
    figure.suptitle("\n".join(filter(None, [title, shown.laws])), fontsize=11)
    outside_legend(figure, panels, columns=3)
    return figure


def read_motion(run: Path, snapshot: int | None, field: str, component: str | None) -> Motion:
    """One field of a run at the moments to show; arguments and errors as in `plot_scene`."""
    with open_record(run) as file:
        positions, radii = file["particles/position"][:], file["particles/radius"][:]
        chosen = _choose(file, snapshot, strips_on_page(Window.around(positions, radii)), field)
        largest = np.max([np.abs(group[field][:]).max(axis=0) for group in file["snapshots"].values()], axis=0)
        column = int(np.argmax(largest[:2])) if component is None else COMPONENTS.index(component)
        way = "of rotation" if column == 2 else f"along {COMPONENTS[column]}"
        times = np.array([group.attrs["time"] for group in chosen])
        laws = laws_of(file)
        return Motion(
            positions=positions,
            radii=radii,
            times=times,
            values=np.array([group[field][:, column] for group in chosen]),
            limit=float(largest[column]) or 1.0,
            cracks=[cracks_until(file, time) for time in times],
            monitors={name: group.attrs["position"] for name, group in file.get("histories", {}).items()},
            field=f"{field} {way}",
            unit=UNITS[field][column],
            name=str(file.attrs["name"]),
            laws=laws_in_words(laws) if len(laws) > 1 else "",
        )


def strips_on_page(scene: Window) -> int:
    """How many pictures of a whole scene fit one below the other: one unless it lies long, at most `MOST_STRIPS`."""
    length, width = scene.size
    if length <= LONG * width:
        return 1
    return min(MOST_STRIPS, int(DRAWING[1] / (DRAWING[0] * width / length + STRIP_GAP)))


def _choose(file: h5py.File, snapshot: int | None, most: int, field: str) -> list[h5py.Group]:
    """The snapshot asked for; by default `most` of them, evenly picked, the last among them, or the liveliest one."""
    if snapshot is not None:
        return [snapshot_of(file, snapshot)]
    if most == 1:
        return [liveliest_snapshot(file, field)]
    groups = list(snapshot_of(file, -1).parent.values())
    backwards = np.linspace(len(groups) - 1, 0, min(most, len(groups)))
    return [groups[round(number)] for number in reversed(backwards)]


def _draw_whole(shown: Motion) -> tuple[Figure, list[Axes], ScalarMappable]:
    """One panel."""
    width, height = shown.window.size
    scale = min(DRAWING[0] / width, DRAWING[1] / height)
    figure = new_figure(max(scale * width, 3.0) + 1.8, scale * height + 1.6)
    panel = figure.subplots()
    colours = _draw_panel(panel, shown, 0, shown.window, scale * figure.dpi)
    panel.set_title(f"t = {shown.times[0]:.3g} s", pad=18)  # above the names of monitors at the top
    _mark_monitors(panel, shown)
    return figure, [panel], colours


def _draw_long(shown: Motion) -> tuple[Figure, list[Axes], ScalarMappable]:
    """The whole scene as strips, one per moment, and below or beside them a part of one of them closely."""
    upright = bool(shown.window.size[1] > shown.window.size[0])
    count = len(shown.times)
    framed = int(np.argmax(np.abs(shown.values).max(axis=1)))
    part = close_up(shown, framed)
    room = DRAWING[1] if upright else DRAWING[0]
    scales = [room / max(window.size) for window in (shown.window, part)]
    strip, close = (scale * min(w.size) for scale, w in zip(scales, (shown.window, part), strict=True))
    sizes = [strip] * count + [close]
    if upright:
        figure = new_figure(sum(sizes) + 4.2, room + 1.4)
        panels = figure.subplots(1, count + 1, width_ratios=sizes)
    else:
        figure = new_figure(room + 2.6, max(sum(sizes) + STRIP_GAP * count, 1.3) + 2.2)
        panels = figure.subplots(count + 1, 1, height_ratios=sizes)
    _draw_strips(panels[:-1], shown, scales[0] * figure.dpi)
    colours = _draw_panel(panels[-1], shown, framed, part, scales[1] * figure.dpi)
    _frame(panels[framed], part)
    _mark_monitors(panels[0], shown)
    return figure, list(panels), colours


def _draw_strips(panels: Sequence[Axes], shown: Motion, scale: float) -> None:
    """The whole scene at each of its moments, on one axis at the last; `scale` in pixels per metre."""
    for index, (panel, time) in enumerate(zip(panels, shown.times, strict=True)):
        _draw_panel(panel, shown, index, shown.window, scale)
        beside: dict[str, Any] = {"textcoords": "offset points", "va": "center", "fontsize": 9}
        panel.annotate(f"t = {time:.3g} s", (1.0, 0.5), (8, 0), xycoords="axes fraction", **beside)
    for panel in panels[:-1]:
        panel.set_xlabel("")
        panel.tick_params(labelbottom=False)


def _frame(panel: Axes, part: Window) -> None:
    """Mark the part of the scene that is shown closely."""
    left, right, bottom, top = part.extent
    looks: dict[str, Any] = {"fill": False, "linewidth": 1.5, "clip_on": False, "label": "part shown closely"}
    panel.add_patch(Rectangle((left, bottom), right - left, top - bottom, **looks))


def close_up(shown: Motion, index: int) -> Window:
    """The part of a long scene around half its largest motion, on a wave's flank, where colours change most.

    index is that of the moment.
    """
    scene, motion = shown.window, np.abs(shown.values[index])
    along = int(np.argmax(scene.size))
    width = CLOSE_UP_DIAMETERS * 2.0 * float(shown.radii.mean())
    size = np.minimum(scene.size, width)
    size[along] = min(scene.size[along], max(CLOSE_UP_ASPECT * size.min(), width))
    centre = shown.positions[np.argmin(np.abs(motion - 0.5 * motion.max()))]
    return Window(np.clip(centre - 0.5 * size, scene.corner, scene.corner + scene.size - size), size)


def _draw_panel(panel: Axes, shown: Motion, index: int, window: Window, scale: float) -> ScalarMappable:
    """A window of the scene at one of its moments, at `scale` pixels per metre."""
    colours = draw_field(panel, window, shown.positions, shown.radii, shown.values[index], shown.limit, scale)
    _mark_cracks(panel, shown.cracks[index])
    for name, axis, pixels in zip("xy", (panel.xaxis, panel.yaxis), scale * window.size, strict=True):
        if pixels > 45:
            axis.set_label_text(f"{name} (m)")
            axis.set_major_locator(MaxNLocator(nbins=int(np.clip(pixels / 90, 1, 9)), steps=[1, 2, 5, 10]))
        else:
            axis.set_major_locator(NullLocator())  # two labels would collide
    return colours


def _mark_cracks(panel: Axes, cracks: dict[str, np.ndarray]) -> None:
    """A mark at each broken bond."""
    for shear, (label, (mark, size)) in enumerate(CRACKS.items()):
        places = cracks["position"][cracks["shear"] == shear]
        if len(places) > 0:
            x, y = places.T
            panel.scatter(x, y, s=size, marker=mark, color="black", linewidths=0.8, label=label)


def _mark_monitors(panel: Axes, shown: Motion) -> None:
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
