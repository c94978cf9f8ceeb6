"""Draws many disks: as disks if they are large enough to be visible, else as an image of mean values."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection

from dembound.holes import Hole
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


def draw_disks(axes: Axes, positions: np.ndarray, radii: np.ndarray, **looks: Any) -> EllipseCollection:
    """Add disks to the axes in true size; positions (n, 2) and radii (n,) in m; looks : arguments for matplotlib."""
    disks = EllipseCollection(
        2.0 * radii,
        2.0 * radii,
        np.zeros(len(radii)),
        units="xy",
        offsets=positions,
        offset_transform=axes.transData,
        **looks,
    )
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
    """
    axes.set(aspect="equal", xlim=window.extent[:2], ylim=window.extent[2:], facecolor=EMPTY)
    axes.grid(False)
    inside = window.touches(positions, radii)
    positions, radii, values = positions[inside], radii[inside], values[inside]
    colours = colours_within(limits)
    diameter = 2.0 * float(radii.mean())
    if diameter * scale >= SMALLEST_PIXELS:
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
