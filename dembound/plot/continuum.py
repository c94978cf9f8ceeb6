"""Draws the continuum round disks: its elements, layers that absorb, free surface and ties, coloured by a field."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import h5py
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection, TriMesh
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path
from matplotlib.tri import Triangulation

from dembound.plot.disks import EMPTY, Window, colours_within

GROUP = "continuum"
"""Group of the continuum in a record and in its snapshots."""

FINEST_CELL, FINEST_ELEMENT = 2.0, 10.0
"""Pixels: where cells are narrower elements have their mean colours, elements that are narrower have no outline."""

BELOW, BEHIND, ABOVE_CELLS, BESIDE_DISKS = -1.0, -0.9, -0.8, 1.5
"""Drawing order: of the gaps between disks, cells, and lines on them, all below disks or their image; of ties above."""

LINE, HATCH = "#8A8A8A", "#9A9A9A"
"""Colours of the elements' outlines and of the hatching."""

HALVES = np.array([[0, 1, 2], [0, 2, 3]])
"""Corners of the two triangles that a cell consists of."""

AROUND = [Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY]


@dataclass(frozen=True)
class ContinuumCells:
    """A continuum before the motion, of m nodes in e elements with c cells each.

    nodes (e, c, 4) and corners (e, c, 4, 2) m of the cells between its nodes, counterclockwise; elements (e, 4) m,
    left, bottom, right and top; absorbs (e,) bool; surface (s, 4) m, ends of the lines at its free surface; ties (t, 2)
    m, where they act.
    """

    nodes: np.ndarray
    corners: np.ndarray
    elements: np.ndarray
    absorbs: np.ndarray
    surface: np.ndarray
    ties: np.ndarray

    @property
    def window(self) -> Window:
        """The smallest window with all elements."""
        low = self.elements[:, :2].min(axis=0)
        return Window(low, self.elements[:, 2:].max(axis=0) - low)

    def moved(self, displacements: np.ndarray | None) -> Self:
        """The mesh with its cells moved by displacements (m, 2) m of the nodes; None: not moved."""
        return self if displacements is None else replace(self, corners=self.corners + displacements[self.nodes])


def read_continuum(file: h5py.File) -> ContinuumCells | None:
    """The continuum of an open record, None without one."""
    if GROUP not in file:
        return None
    position, absorbs, node, elements, surface, ties = (
        file[f"{GROUP}/{name}"][:] for name in ("position", "absorbs", "node", "element", "surface", "tie")
    )
    cells = [node[:, :-1, :-1], node[:, :-1, 1:], node[:, 1:, 1:], node[:, 1:, :-1]]
    nodes = np.stack([corner.reshape(len(node), -1) for corner in cells], axis=2)
    corners, first = position[nodes], elements[:, None, None, :2]
    size = elements[:, 2:] - elements[:, :2]
    whole = elements[:, 2:].max(axis=0) - elements[:, :2].min(axis=0)
    corners += whole * (corners < first - 1e-6 * size[:, None, None])  # a periodic one ends at its first nodes
    return ContinuumCells(nodes, corners, elements, absorbs[node].any(axis=(1, 2)), surface, ties)


def is_scattered(file: h5py.File) -> bool:
    """Whether the continuum of an open record has only stresses and peaks of the scattered motion."""
    return f"{GROUP}/total" in file


def draw_continuum(
    axes: Axes,
    continuum: ContinuumCells,
    disks: Sequence[Window],
    values: np.ndarray | None,
    limits: tuple[float, float],
    scale: float,
) -> None:
    """Add a continuum around disks to axes whose limits are set.

    disks : the windows filled by disks, outside of which the background is white. values : (m,) a field of its nodes,
    in the colours of `draw_field` with the same limits; None: without. scale : pixels per metre.
    """
    axes.set_facecolor("white")
    for window in disks:
        gaps = Rectangle(tuple(window.corner), *window.size, facecolor=EMPTY, linewidth=0.0, zorder=BELOW)
        axes.add_patch(gaps)
    element = scale * float(np.median(continuum.elements[:, 2:] - continuum.elements[:, :2]))
    if values is not None:
        _draw_field(axes, continuum, values, limits, element)
    corners = _corners(continuum.elements)
    if element >= FINEST_ELEMENT:
        looks: dict[str, Any] = {"facecolors": "none", "edgecolors": LINE, "linewidths": 0.4, "zorder": ABOVE_CELLS}
        axes.add_collection(PolyCollection(list(corners), label="elements of the continuum", **looks), autolim=False)
    _draw_layers(axes, corners[continuum.absorbs])
    if len(continuum.surface) > 0:
        looks = {"colors": "black", "linewidths": 1.2, "label": "free surface of the continuum"}
        axes.add_collection(LineCollection(list(continuum.surface.reshape(-1, 2, 2)), **looks), autolim=False)
    looks = {"s": 3.0, "color": "black", "linewidths": 0.0, "zorder": BESIDE_DISKS}
    axes.scatter(*continuum.ties.T, label=f"ties of cut bonds ({len(continuum.ties):,})", **looks)


def _draw_field(
    axes: Axes, continuum: ContinuumCells, values: np.ndarray, limits: tuple[float, float], element: float
) -> None:
    """A field (m,) between the nodes, or its means over elements where cells are small; element : pixels of a side."""
    at_corners = values[continuum.nodes]
    looks = {"zorder": BEHIND, **colours_within(limits)}
    if element < FINEST_CELL * np.sqrt(at_corners.shape[1]):
        flat = PolyCollection(list(_corners(continuum.elements)), linewidths=0.0, antialiaseds=False, **looks)
        flat.set_array(at_corners.mean(axis=(1, 2)))
        axes.add_collection(flat, autolim=False)
        return
    first = np.arange(0, at_corners.size, 4)[:, None, None]
    x, y = continuum.corners.reshape(-1, 2).T
    smooth = TriMesh(Triangulation(x, y, (first + HALVES).reshape(-1, 3)), **looks)
    smooth.set_array(at_corners.ravel())
    axes.add_collection(smooth, autolim=False)


def _draw_layers(axes: Axes, corners: np.ndarray) -> None:
    """Hatch the elements (k, 4, 2) m that absorb, as one patch."""
    if len(corners) == 0:
        return
    closed = np.concatenate([corners, corners[:, :1]], axis=1).reshape(-1, 2)
    path = Path(closed, np.tile(AROUND, len(corners)))
    looks: dict[str, Any] = {"facecolor": "none", "edgecolor": HATCH, "linewidth": 0.0, "hatch": "////"}
    axes.add_patch(
        PathPatch(path, zorder=ABOVE_CELLS, label="layers that absorb, in place of the ground beyond", **looks)
    )


def _corners(elements: np.ndarray) -> np.ndarray:
    """Corners (e, 4, 2) of rectangles (e, 4), counterclockwise."""
    return elements[:, [0, 1, 2, 1, 2, 3, 0, 3]].reshape(-1, 4, 2)
