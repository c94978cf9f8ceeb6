"""The whole scene at one time, or a long one at several times, with disks coloured by a field."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator, NullLocator

from dembound.casefile.disks.monitor_rows import shown_names
from dembound.casefile.messages import counted
from dembound.plot.crack_lines import mark_cracks, times_of_cracks
from dembound.plot.disks import Window, draw_continuum, draw_field
from dembound.plot.field import Disks, Field, FieldName, read_disks
from dembound.plot.field_reader import read_field
from dembound.plot.lines import (
    ABOVE_CRACKS,
    LETTER_WIDTH,
    NAME_HEIGHT,
    mark_areas,
    mark_joints,
    mark_layers,
    mark_seams,
    mark_walls,
)
from dembound.plot.outlines import draw_outlines
from dembound.plot.pieces import name_hues
from dembound.plot.places import framed
from dembound.plot.style import FEWEST_NUMBERS, Powers, finished, measured_once, new_figure, styled
from dembound.results.reader import open_record
from dembound.words import CracksBy

LONG = 6.0
"""A scene longer than this many times its width has a second panel with an enlarged part of it."""

CLOSE_UP_DIAMETERS = 40
"""Largest width of the enlarged part in mean disk diameters, at which every disk is visible."""

CLOSE_UP_ASPECT = 3.0
"""Length of the enlarged part over its width; the length is at least `CLOSE_UP_DIAMETERS`."""

DRAWING = (9.5, 6.5)
"""Largest width and height of the scene on the page in inches."""

MOST_STRIPS = 8
"""Largest number of times at which a long horizontal scene is shown, as strips below each other."""

STRIP_GAP = 0.12
"""Inches between two strips."""

SHORTEST = {"x": 0.8, "y": 0.4}
"""Length (inches) of a panel with room for three numbers along x or y."""

TICK_APART, SMALL = 0.6, 7
"""Distance (inches) between numbers of a panel with room for three; size (points) of numbers without this room."""

ROOM_OF_BAR = 1.4
"""Inches for a second colour bar."""

LEGEND_WIDTH = 8.3
"""Inches of a legend with two columns."""

FOOT: dict[str, Any] = {"color": "black", "linewidth": 1.0, "linestyle": (0, (1, 2)), "zorder": 1.4}
"""Line below which the continuum has no free field: above its elements, below its ties."""

BESIDE_MARK = ((0.0, 7.0), (0.0, -19.0), (1.0, -6.0), (-1.0, -6.0), (0.0, 20.0), (0.0, -32.0))
"""Positions for the name of a monitor: right or left of it, and the points from it to the name's lower end."""


@styled
def plot_scene(
    run: Path,
    snapshot: int | None = None,
    field: FieldName = "velocity",
    component: Literal["x", "y", "rotation"] | None = None,
    exaggerate: float | None = None,
    cracks: CracksBy = "kind",
) -> Figure:
    """The scene at a snapshot, with the monitors and one colour scale for the run.

    The scale has 99.5 % of the disks, if the others are beyond 1.25 times of it. Bonds broken up to this time are lines
    across them, as wide as the smaller disk; the legend has their number. A very long scene has another panel with an
    enlarged part of it. A continuum round the disks has the same colours, its absorbing layers are hatched. Thin lines
    separate the layers of the ground.

    Parameters
    ----------
    run
        the ``run.h5`` of a run.
    snapshot
        number of the snapshot; negative ones count from the last. By default the one in which the field is largest, of
        velocities a monitor's, of fragments the last; of a long horizontal scene, as many as fit, evenly chosen.
    field
        velocity in m/s or displacement in m; a stress in MPa, tension positive; peak, the largest speed of each disk in
        the whole run in m/s; layer, its number from the surface; fragments, a hue for each. The record must contain it.
    component
        of a velocity or displacement, by default whichever of x and y is largest in any snapshot of the run.
    exaggerate
        factor of the displacements with which disks, nodes, walls and cracks are drawn; 0 shows them at their first
        places. By default 1 if a disk moves by more than a tenth of the mean diameter in the run, else 0. Disks far
        from the body, see `are_near`, are not in the frame, which has their number.
    cracks
        what gives the colours of broken bonds: their kind, or the time at which they broke.

    Raises CaseError when the file cannot be read, has no such snapshot or does not contain the field.
    """
    with open_record(run) as file:
        disks = read_disks(file)
        shown = read_field(file, field, component, snapshot, strips_on_page(disks.window), exaggerate)
    shown = replace(shown, by_time=cracks == "time")
    window = disks.window
    if shown.moved is not None:
        window = framed(window, disks.positions, disks.radii, shown.moved)
    width, height = window.size
    if max(width, height) > LONG * min(width, height):
        figure, panels, colours = _draw_long(disks, shown, window)
    else:
        figure, panels, colours = _draw_whole(disks, shown, window)
    add_colour_bars(figure, panels, colours, shown)
    title = f"{disks.case}: {shown.name} of {disks.in_words}"
    return finished(figure, "\n".join(filter(None, [title, disks.laws])), panels, 3)


def with_margins(width: float, height: float, shown: Field) -> tuple[float, float]:
    """Width and height (inches) of a figure for panels of a width: with a colour bar, or with a longer legend."""
    if shown.palette is None:
        return max(width, 3.0) + 1.8, height
    return max(width + 0.9, LEGEND_WIDTH), height + 0.9


def add_colour_bars(figure: Figure, panels: Sequence[Axes], colours: ScalarMappable, shown: Field) -> None:
    """The colour bars beside panels: of a field's values, if they are no numbers of colours, and of times of cracks."""
    looks: dict[str, Any] = {"ax": panels, "shrink": 0.9, "pad": 0.02, "format": Powers()}
    if shown.palette is None:
        ticks = MaxNLocator(integer=True) if shown.name == "layer" else None
        figure.colorbar(colours, label=shown.label, ticks=ticks, extend=shown.extend, **looks)
    if (times := times_of_cracks(shown)) is not None:
        figure.set_figwidth(figure.get_figwidth() + ROOM_OF_BAR)
        figure.colorbar(times, label="time at which the bond broke (s)", **looks)


def strips_on_page(scene: Window) -> int:
    """Number of pictures of a whole scene below each other: one unless it is long, at most `MOST_STRIPS`."""
    length, width = scene.size
    if length <= LONG * width:
        return 1
    return min(MOST_STRIPS, int(DRAWING[1] / (DRAWING[0] * width / length + STRIP_GAP)))


def _draw_whole(disks: Disks, shown: Field, window: Window) -> tuple[Figure, list[Axes], ScalarMappable]:
    """Draw a window of the scene in one panel."""
    width, height = window.size
    scale = min(DRAWING[0] / width, DRAWING[1] / height)
    rows = 1.6 if disks.continuum is None else 2.1  # of title, axis and legend
    figure = new_figure(*with_margins(scale * width, scale * height + rows, shown))
    panel = figure.subplots()
    colours = draw_panel(panel, disks, shown, 0, window, scale * figure.dpi)
    out = out_of_frame(disks, shown, 0, window)
    panel.set_title(shown.captions[0] + out, pad=18)  # above the names of monitors at the top
    mark_monitors(panel, disks, scale)
    return figure, [panel], colours


def _draw_long(disks: Disks, shown: Field, window: Window) -> tuple[Figure, list[Axes], ScalarMappable]:
    """Draw a window of a long scene as strips, one per time, and below or beside them an enlarged part of one."""
    upright = bool(window.size[1] > window.size[0])
    count = len(shown.captions)
    framed = int(np.argmax(np.abs(shown.values).max(axis=1))) if shown.palette is None else count - 1
    part = close_up(disks, shown.values[framed], shown.palette is not None)
    room = DRAWING[1] if upright else DRAWING[0]
    scales = [room / max(each.size) for each in (window, part)]
    strip, close = (scale * min(each.size) for scale, each in zip(scales, (window, part), strict=True))
    sizes = [strip] * count + [close]
    if upright:
        figure = new_figure(sum(sizes) + 4.2, room + 1.4)
        panels = figure.subplots(1, count + 1, width_ratios=sizes)
    else:
        figure = new_figure(room + 2.6, max(sum(sizes) + STRIP_GAP * count, 1.3) + 2.2)
        panels = figure.subplots(count + 1, 1, height_ratios=sizes)
    _draw_strips(panels[:-1], disks, shown, window, scales[0] * figure.dpi)
    colours = draw_panel(panels[-1], disks, shown, framed, part, scales[1] * figure.dpi)
    mark_part(panels[framed], part)
    mark_monitors(panels[0], disks, scales[0])
    return figure, list(panels), colours


def _draw_strips(panels: np.ndarray, disks: Disks, shown: Field, window: Window, scale: float) -> None:
    """Draw a window of the scene at each of its times, in panels (k,) with one axis at the last.

    scale : in pixels per metre.
    """
    for index, (panel, caption) in enumerate(zip(panels, shown.captions, strict=True)):
        draw_panel(panel, disks, shown, index, window, scale)
        beside: dict[str, Any] = {"textcoords": "offset points", "va": "center", "fontsize": 9}
        panel.annotate(caption, (1.0, 0.5), (8, 0), xycoords="axes fraction", **beside)
    for panel in panels[:-1]:
        panel.set_xlabel("")
        panel.tick_params(labelbottom=False)
    measured_once(panels[:, None])


def mark_part(panel: Axes, part: Window) -> None:
    """Mark the enlarged part of the scene."""
    left, right, bottom, top = part.extent
    looks: dict[str, Any] = {"fill": False, "linewidth": 1.5, "clip_on": False, "label": "part shown closely"}
    panel.add_patch(Rectangle((left, bottom), right - left, top - bottom, **looks))


def close_up(disks: Disks, values: np.ndarray, are_pieces: bool) -> Window:
    """The part of a long scene around half the largest of values (n,), where colours change most.

    are_pieces : values are of `PALETTE`, and the part is that in the middle of all fragments.
    """
    if are_pieces and values.any():
        return part_around(disks, np.median(disks.positions[values > 0.0], axis=0))
    sizes = np.abs(values)
    return part_around(disks, disks.positions[np.argmin(np.abs(sizes - 0.5 * sizes.max()))])


def part_around(disks: Disks, centre: np.ndarray) -> Window:
    """The part of a long scene around a place (2,) m in which every disk is visible."""
    scene = disks.window
    along = int(np.argmax(scene.size))
    width = CLOSE_UP_DIAMETERS * 2.0 * float(disks.radii.mean())
    size = np.minimum(scene.size, width)
    size[along] = min(scene.size[along], max(CLOSE_UP_ASPECT * size.min(), width))
    return Window(np.clip(centre - 0.5 * size, scene.corner, scene.corner + scene.size - size), size)


def draw_panel(
    panel: Axes, disks: Disks, shown: Field, index: int, window: Window, scale: float, numbered: bool = True
) -> ScalarMappable:
    """A window of the scene at one of its times, at `scale` pixels per metre.

    numbered : labels have numbers of cracks.
    """
    positions = disks.positions if shown.moved is None else disks.positions + shown.moved[index]
    there = slice(None) if shown.gone is None else ~shown.gone[index]
    drawn = positions[there], disks.radii[there], shown.values[index][there]
    colours = draw_field(panel, window, *drawn, shown.limits, scale, disks.holes, shown.palette)
    covered = isinstance(colours, AxesImage) and shown.moved is None  # cells of the image reach into holes
    draw_outlines(panel, disks.holes, disks.own_window, 2.0 * float(disks.radii.mean()), filled=covered)
    if disks.continuum is not None:
        beyond = None if shown.beyond is None else shown.beyond[index]
        continuum = disks.continuum.moved(None if shown.moved_beyond is None else shown.moved_beyond[index])
        draw_continuum(panel, continuum, disks.part_windows, beyond, shown.limits, scale)
        if beyond is not None and disks.foot is not None:
            left, right = disks.continuum.window.extent[:2]
            panel.hlines(disks.foot, left, right, label="below: motion without the free field", **FOOT)
    if shown.palette is not None:
        name_hues(panel, drawn[2])
    mark_seams(panel, disks, window)
    mark_walls(panel, disks.walls if shown.walls is None else shown.walls)
    mark_layers(panel, disks, window, scale / panel.figure.dpi)
    mark_joints(panel, disks, shown.joints[index] if shown.joints else None)
    mark_areas(panel, disks)
    mark_cracks(panel, shown, index, numbered, 2.0 * float(disks.radii.mean()) * scale * 72.0 / panel.figure.dpi)
    for name, axis, pixels in zip("xy", (panel.xaxis, panel.yaxis), scale * window.size, strict=True):
        inches = pixels / panel.figure.dpi
        if inches > SHORTEST[name]:
            most = int(np.clip(inches / TICK_APART, FEWEST_NUMBERS, 9))
            axis.set_label_text(f"{name} (m)")
            axis.set_major_locator(MaxNLocator(nbins=most, steps=[1, 2, 5, 10], min_n_ticks=FEWEST_NUMBERS))
            axis.set_tick_params(labelsize=SMALL if inches < FEWEST_NUMBERS * TICK_APART else "medium")
        else:
            axis.set_major_locator(NullLocator())  # three numbers would collide
    return colours


def out_of_frame(disks: Disks, shown: Field, index: int, window: Window) -> str:
    """How many disks are out of a window of the scene at one of its times, as the end of a caption; "" for none."""
    if shown.moved is None:
        return ""
    count = np.count_nonzero(~window.touches(disks.positions + shown.moved[index], disks.radii))
    return f", {counted(int(count), 'disk')} farther away" if count else ""


def mark_monitors(panel: Axes, disks: Disks, scale: float) -> None:
    """A triangle and a name at each monitor, a hollow triangle at each twin; `scale` in inches per metre."""
    if not disks.monitors:
        return
    mark: dict[str, Any] = {"marker": "^", "s": 40, "clip_on": False, "zorder": ABOVE_CRACKS}
    x, y = np.array(list(disks.monitors.values())).T
    panel.scatter(x, y, color="black", edgecolors="white", label="monitor", **mark)
    if len(disks.twins):
        hollow: dict[str, Any] = {"facecolors": "white", "edgecolors": "black", "label": "its twin in the free field"}
        x, y = disks.twins.T
        panel.scatter(x, y, **hollow, **mark)
    plate: dict[str, Any] = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none", "alpha": 0.8}
    looks: dict[str, Any] = {"textcoords": "offset points", "fontsize": 8, "bbox": plate, "zorder": ABOVE_CRACKS}
    named = shown_names(list(disks.monitors))
    places = np.array([disks.monitors[name] for name in named])
    sides = name_sides(72.0 * scale * places, [len(name) for name in named])
    for name, place, (side, up) in zip(named, places, sides, strict=True):
        align = {0.0: "center", 1.0: "left", -1.0: "right"}[side]
        panel.annotate(name, tuple(place), (8.0 * side, up), ha=align, va="bottom", **looks)


def name_sides(marks: np.ndarray, letters: Sequence[int]) -> list[tuple[float, float]]:
    """For each mark the entry of `BESIDE_MARK` at which its name covers the least area of names and other marks.

    Parameters
    ----------
    marks
        (k, 2) places on the page in points.
    letters
        of each name.
    """
    low, high = marks - 4.0, marks + 4.0  # corners of what is there, marks and then names
    way, up = np.array(BESIDE_MARK).T
    chosen = []
    for (x, y), count in zip(marks, letters, strict=True):
        width = LETTER_WIDTH * count + 4.0
        begins = np.stack([x + 8.0 * way + 0.5 * (way - 1.0) * width, y + up], axis=1)[:, None]
        ends = begins + np.array([width, NAME_HEIGHT])
        sides = np.maximum(np.minimum(ends, high) - np.maximum(begins, low), 0.0)
        best = int(np.argmin(sides.prod(axis=2).sum(axis=1)))
        chosen.append(BESIDE_MARK[best])
        low, high = np.append(low, begins[best], axis=0), np.append(high, ends[best], axis=0)
    return chosen
