"""Draws many disks, the outlines of holes, and a continuum: elements, absorbing layers, free surface and ties."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import h5py
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection, TriMesh
from matplotlib.colors import Colormap
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path
from matplotlib.tri import Triangulation

from dembound.holes.hole import Hole
from dembound.plot.style import SIGNED_MAP, UNSIGNED_MAP

# Disks narrower than this cannot be distinguished from the gaps, and a picture of many of them has megabytes.
SMALLEST_PIXELS = 4.0

# Cells of the averaged picture, in mean diameters: wide enough that none inside the packing is empty, so that
# an empty cell is a hole.
CELL_DIAMETERS = 2.0

EMPTY = "#B5B5B5"
"""Colour of the gaps, on which disks at rest, which are white, are visible."""


@dataclass(frozen=True)
class Window:
    """A rectangle in metres: lower left corner and size, each (2,)."""

    corner: np.ndarray
    size: np.ndarray

    @classmethod
    def around(cls, positions: np.ndarray, radii: np.ndarray) -> "Window":
        """The smallest window with all disks; positions (n, 2), radii (n,) in m."""
        low = (positions - radii[:, None]).min(axis=0)
        return cls(low, (positions + radii[:, None]).max(axis=0) - low)

    @classmethod
    def of_boxes(cls, boxes: np.ndarray) -> "Window":
        """The smallest window with rectangles (k, 4) m of left, bottom, right and top."""
        low = boxes[:, :2].min(axis=0)
        return cls(low, boxes[:, 2:].max(axis=0) - low)

    def within(self, other: "Window") -> "Window":
        """The part of this window that lies in another, which it meets."""
        low = np.maximum(self.corner, other.corner)
        return Window(low, np.minimum(self.corner + self.size, other.corner + other.size) - low)

    def with_other(self, other: "Window") -> "Window":
        """The smallest window with this one and another."""
        low = np.minimum(self.corner, other.corner)
        return Window(low, np.maximum(self.corner + self.size, other.corner + other.size) - low)

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom, top in metres."""
        (left, bottom), (right, top) = self.corner, self.corner + self.size
        return float(left), float(right), float(bottom), float(top)

    def touches(self, positions: np.ndarray, radii: np.ndarray) -> np.ndarray:
        """Mask (n,) of disks that reach into the window; positions (n, 2), radii (n,) in m."""
        nearest = np.clip(positions, self.corner, self.corner + self.size)
        return np.hypot(*(positions - nearest).T) < radii * (1.0 - 1e-9)  # touching disks, to rounding, are outside


def frame(panel: Axes, window: Window) -> None:
    """Show a window of the axes, in true proportions."""
    panel.set(aspect="equal", xlim=window.extent[:2], ylim=window.extent[2:], xlabel="x (m)", ylabel="y (m)")
    panel.grid(False)


def draw_disks(axes: Axes, positions: np.ndarray, radii: np.ndarray, **looks: Any) -> EllipseCollection:
    """Add disks to the axes in true size; positions (n, 2) and radii (n,) in m; looks : arguments for matplotlib."""
    place: dict[str, Any] = {"units": "xy", "offsets": positions, "offset_transform": axes.transData}
    disks = EllipseCollection(2.0 * radii, 2.0 * radii, np.zeros(len(radii)), **place, **looks)
    axes.add_collection(disks, autolim=False)
    return disks


def draw_field(
    axes: Axes,
    window: Window,
    positions: np.ndarray,
    radii: np.ndarray,
    values: np.ndarray,
    limits: tuple[float, float],
    scale: float,
    holes: Sequence[Hole] = (),
    palette: Colormap | None = None,
) -> ScalarMappable:
    """Fill the axes with a window of a field; returns the object for the colour bar.

    Parameters
    ----------
    window
        the part of the scene to show.
    positions (n, 2), radii (n,)
        m.
    values
        (n,) the field.
    limits
        the ends of the colour scale, see `colours_within`.
    scale
        pixels per metre. Disks below `SMALLEST_PIXELS` are replaced by the mean of the field on a grid.
    holes
        the cells of this grid are filled up to the outlines of holes.
    palette
        colours of values that are numbers of colours, which have no mean: disks of any size are drawn.
    """
    axes.set(aspect="equal", xlim=window.extent[:2], ylim=window.extent[2:], facecolor=EMPTY)
    axes.grid(False)
    inside = window.touches(positions, radii)
    positions, radii, values = positions[inside], radii[inside], values[inside]
    colours = colours_within(limits) if palette is None else {"cmap": palette, "clim": limits}
    diameter = 2.0 * float(radii.mean())
    if palette is not None or diameter * scale >= SMALLEST_PIXELS:
        return draw_disks(axes, positions, radii, array=values, linewidths=0.0, **colours)
    means = mean_on_grid(positions, values, window, max(1.0 / scale, CELL_DIAMETERS * diameter))
    _fill_beside(means, window, holes)
    return axes.imshow(means, origin="lower", extent=window.extent, interpolation="nearest", **colours)


def _fill_beside(means: np.ndarray, window: Window, holes: Sequence[Hole]) -> None:
    """Fill empty cells of an image (rows, columns) of a window beside holes with the mean of the cells around them."""
    cell = window.size / means.shape[::-1]
    rows, columns = np.nonzero(np.isnan(means))
    if not holes or len(rows) == 0:
        return
    middle = window.corner + (np.stack([columns, rows], axis=1) + 0.5) * cell
    low, high = (np.array([hole.box[at : at + 2] for hole in holes])[:, None] for at in (0, 2))
    beside = ((middle > low - cell) & (middle < high + cell)).all(axis=2).any(axis=0)
    padded = np.pad(means, 1, constant_values=np.nan)
    around = np.array([padded[rows + i, columns + j] for i in range(3) for j in range(3)])
    known = ~np.isnan(around)
    filled = beside & known.any(axis=0)
    total = np.where(known, around, 0.0).sum(axis=0)
    means[rows[filled], columns[filled]] = total[filled] / known.sum(axis=0)[filled]


def colours_within(limits: tuple[float, float]) -> dict[str, Any]:
    """Colour map and limits of a field, for matplotlib; a scale with a negative end is white at its middle."""
    return {"cmap": SIGNED_MAP if limits[0] < 0.0 else UNSIGNED_MAP, "clim": limits}


def mean_on_grid(positions: np.ndarray, values: np.ndarray, window: Window, cell: float) -> np.ndarray:
    """Mean of `values` (n,) over the disks centred in each cell, (rows, columns); NaN where there is none.

    positions (n, 2) and cell, the least width of a cell, in m. The first row is the lowest.
    """
    shape = np.maximum(1, np.floor(window.size / cell)).astype(int)[::-1]
    left, right, bottom, top = window.extent
    place: dict[str, Any] = {"bins": shape, "range": ((bottom, top), (left, right))}
    count, _, _ = np.histogram2d(positions[:, 1], positions[:, 0], **place)
    total, _, _ = np.histogram2d(positions[:, 1], positions[:, 0], weights=values, **place)
    return np.divide(total, count, out=np.full_like(total, np.nan), where=count > 0)


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
        return Window.of_boxes(self.elements)

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
        axes.add_patch(Rectangle(tuple(window.corner), *window.size, facecolor=EMPTY, linewidth=0.0, zorder=BELOW))
    element = scale * float(np.median(continuum.elements[:, 2:] - continuum.elements[:, :2]))
    if values is not None:
        _draw_field(axes, continuum, values, limits, element)
    corners, looks = _corners(continuum.elements), dict[str, Any]()
    if element >= FINEST_ELEMENT:
        looks = {"facecolors": "none", "edgecolors": LINE, "linewidths": 0.4, "zorder": ABOVE_CELLS}
        axes.add_collection(PolyCollection(list(corners), label="elements of the continuum", **looks), autolim=False)
    if continuum.absorbs.any():  # hatched, as one patch
        layers = corners[continuum.absorbs]
        closed = Path(np.append(layers, layers[:, :1], axis=1).reshape(-1, 2), np.tile(AROUND, len(layers)))
        looks = {"facecolor": "none", "edgecolor": HATCH, "linewidth": 0.0, "hatch": "////", "zorder": ABOVE_CELLS}
        axes.add_patch(PathPatch(closed, label="layers that absorb, in place of the ground beyond", **looks))
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
        looks |= {"linewidths": 0.0, "antialiaseds": False, "array": at_corners.mean(axis=(1, 2))}
        axes.add_collection(PolyCollection(list(_corners(continuum.elements)), **looks), autolim=False)
        return
    first = np.arange(0, at_corners.size, 4)[:, None, None]
    x, y = continuum.corners.reshape(-1, 2).T
    cells = Triangulation(x, y, (first + HALVES).reshape(-1, 3))
    axes.add_collection(TriMesh(cells, array=at_corners.ravel(), **looks), autolim=False)


def _corners(elements: np.ndarray) -> np.ndarray:
    """Corners (e, 4, 2) of rectangles (e, 4), counterclockwise."""
    return elements[:, [0, 1, 2, 1, 2, 3, 0, 3]].reshape(-1, 4, 2)
