"""Lines over the disks of a scene: between layers, along walls and joints, and round groups."""

import math
from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patheffects import Normal, Stroke

from dembound.plot.disks import Window
from dembound.plot.field import Disks
from dembound.plot.lines_of_ground import LayersOfSide, Segments
from dembound.words import with_unit

ABOVE_DISKS, ABOVE_CRACKS = 2.5, 3.0
"""Drawing order of marks."""

JOINT, THIN, WIDE = "black", 1.0, 4.5
"""Colour of joints, and widths (points) without slip and with the largest of the run."""

NAME_HEIGHT, LETTER_WIDTH = 12.0, 5.2
"""Size of a monitor's name in points, with its background."""

PLATE = {"boxstyle": "round,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.8}
"""Background of the names of areas and layers."""


def mark_walls(panel: Axes, walls: Sequence[np.ndarray]) -> None:
    """A line for every wall (p, 2) m."""
    looks: dict[str, Any] = {"color": "black", "linewidth": 1.6, "zorder": ABOVE_DISKS}
    for number, line in enumerate(walls):
        panel.plot(*line.T, label=None if number else "wall", scalex=False, scaley=False, **looks)


def mark_seams(panel: Axes, disks: Disks, window: Window) -> None:
    """A line between the body and each free-field column in a window of the scene."""
    for seam, label in zip(disks.seams, ("between the free-field column and the body", None), strict=False):
        if window.extent[0] < seam < window.extent[1]:
            panel.axvline(seam, color="black", linewidth=1.0, label=label)


def mark_joints(panel: Axes, disks: Disks, segments: Segments | None) -> None:
    """Lines along joints, visible on all colours: the wider, the more they have slid, and white where they are open.

    segments : at a time; None: the whole lines, for a field without a time.
    """
    looks: dict[str, Any] = {"zorder": ABOVE_DISKS, "capstyle": "butt"}
    if segments is None:
        for colour, width in (("white", 2.2), (JOINT, THIN)):
            panel.add_collection(LineCollection(list(disks.joints), colors=colour, linewidths=width, **looks), False)
        return
    parts, share = list(segments.ends), np.abs(segments.slip) / (disks.most_slip or 1.0)
    widths, colours = THIN + (WIDE - THIN) * share, np.where(segments.is_open, "white", JOINT)
    for colour, more in (("white", 1.0), ("black", 0.6)):
        panel.add_collection(LineCollection(parts, colors=colour, linewidths=widths + more, **looks), False)
    panel.add_collection(LineCollection(parts, colors=colours.tolist(), linewidths=widths, **looks), False)
    kinds = [(JOINT, THIN, "joint")]
    kinds += [(JOINT, WIDE, f"joint that has slid {with_unit(disks.most_slip, 'm')}")] if disks.most_slip else []
    kinds += [("white", THIN, "joint that is open")] if segments.is_open.any() else []
    for colour, width, label in kinds:
        edge = [Stroke(linewidth=width + 1.0, foreground="black"), Normal()]
        panel.plot([], [], color=colour, linewidth=width, label=label, path_effects=edge, scalex=False, scaley=False)


def mark_areas(panel: Axes, disks: Disks) -> None:
    """A broken line round every group, and every hole made during the run, with its name."""
    for name, points in disks.areas.items():
        closed = np.vstack([points, points[:1]])
        looks: dict[str, Any] = {"linewidth": 0.9, "zorder": ABOVE_DISKS, "scalex": False, "scaley": False}
        panel.plot(*closed.T, color="white", **looks)
        panel.plot(*closed.T, color="black", linestyle=(0, (4, 3)), **looks)
        top = points[np.lexsort((points[:, 0], -points[:, 1].round(9)))[0]]
        place: dict[str, Any] = {"xytext": (3.0, -3.0), "textcoords": "offset points", "va": "top"}
        panel.annotate(name, tuple(top), fontsize=7, bbox=PLATE, zorder=ABOVE_CRACKS, annotation_clip=True, **place)


def mark_layers(panel: Axes, disks: Disks, window: Window, scale: float) -> None:
    """Thin lines at the joints of layers, and the names of layers where a window has room; inches per metre."""
    bottom, top = window.extent[2:]
    dashes: Sequence[dict[str, Any]] = {"color": "white"}, {"color": "black", "linestyle": (0, (6, 3))}
    looks: dict[str, Any] = {"linewidth": 0.7, "zorder": ABOVE_DISKS}
    left, right, aligned = _beside_layers(disks, *window.extent[:2])
    for number, own in enumerate(disks.layers):
        ends = np.clip((own.low, own.high), left, right).tolist()
        for joint, way in product(own.joints, dashes):  # dashes of two colours, visible on all others
            panel.plot(ends, (joint, joint), **way, **looks)
        at = ("left", "right")[number] if len(disks.layers) > 1 else aligned
        aside = 3.0 if at == "left" else -3.0
        surface = max(min(top, _surface_at(disks, ends[at == "right"])), bottom)
        heights = np.clip([surface, *own.joints, bottom], bottom, surface)
        for name, high, low in zip(own.names, heights[:-1], heights[1:], strict=True):
            room = 72.0 * scale * np.array([ends[1] - ends[0], high - low])
            if (room > (LETTER_WIDTH * len(name) + 8.0, NAME_HEIGHT + 4.0)).all():
                place: dict[str, Any] = {"xytext": (aside, -3.0), "textcoords": "offset points", "ha": at, "va": "top"}
                panel.annotate(name, (ends[at == "right"], high), fontsize=7, bbox=PLATE, zorder=ABOVE_DISKS, **place)
    for way in dashes if len(disks.layers) > 1 else ():
        panel.plot((disks.layers[0].high,) * 2, (_one_below(disks.layers), top), **way, **looks)


def _surface_at(disks: Disks, place: float) -> float:
    """Height y (m) of the body's highest disk within a tenth of its width from x = place, m."""
    x, y = disks.positions[disks.column :].T
    near = np.abs(x - place) < 0.1 * float(np.ptp(x))
    return float((y + disks.radii[disks.column :])[near].max(initial=-np.inf))


def _one_below(sides: Sequence[LayersOfSide]) -> float:
    """Height y (m) below which two sides have the same layers."""
    names, joints = zip(*(side.names[::-1] for side in sides), strict=False), [side.joints[::-1] for side in sides]
    lowest = math.inf
    for (one, other), *ends in zip(names, *joints, strict=False):
        if one != other:
            break
        lowest = min(ends)
        if ends[0] != ends[1]:
            break
    return lowest


def _beside_layers(disks: Disks, left: float, right: float) -> tuple[float, float, str]:
    """Ends (m) of a window without free-field columns; and at which of them layers are named.

    At the right, or at the left where the ground is higher there: above lower ground their names would be in the air.
    """
    middle = 0.5 * (left + right)
    for seam in disks.seams:
        left, right = (max(left, seam), right) if seam < middle else (left, min(right, seam))
    x, y = disks.positions[disks.column :].T
    near = 0.1 * float(np.ptp(x))
    highs = [y[side].max() for side in (x < x.min() + near, x > x.max() - near)]
    is_higher = bool(highs[0] > highs[1] + 4.0 * float(disks.radii.max()))
    return left, right, "left" if is_higher else "right"
