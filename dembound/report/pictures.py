"""Pictures of a page: embedded data, with their lines as numbers, from which scripts draw charts to zoom."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.plot.style import pixels_of, styled
from dembound.plot.table import x_label

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

MOST_POINTS = 2000
"""Largest number of points of a line; of more, the smallest and the largest of several in a row are kept."""

DIGITS = 6
"""Digits of the numbers of a chart."""

FRAME_QUALITY = 80
"""Quality of frames of a scene in WebP's scale up to 100; other pictures are compressed without loss."""


@dataclass(frozen=True)
class Picture:
    """A picture of a page: title, description, data as a URI, size in pixels, chart or None."""

    title: str
    words: str
    uri: str
    width: int
    height: int
    chart: dict[str, Any] | None = None


@styled
def picture_of(figure: Figure) -> Picture:
    """A figure as a picture of a page, with a chart if it has named lines."""
    pixels = pixels_of(figure)
    title = figure.get_suptitle()
    chart = chart_of(figure)
    peaks = (
        [] if chart is None else [_peak_in_words(panel, line) for panel in chart["panels"] for line in panel["lines"]]
    )
    words = "; ".join([title.replace("\n", ", "), *peaks])
    height, width, _ = pixels.shape
    return Picture(title, words, uri_of(pixels, lossless=True), width, height, chart)


def uri_of(pixels: np.ndarray, *, lossless: bool) -> str:
    """A picture (rows, columns, 3) of red, green and blue from 0 to 255 as a data URI."""
    from PIL import Image

    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "webp", lossless=lossless, quality=FRAME_QUALITY, method=4)
    return f"data:image/webp;base64,{base64.b64encode(file.getvalue()).decode()}"


def chart_of(figure: Figure) -> dict[str, Any] | None:
    """The named lines of a figure as plain JSON values; None if it has none.

    It has a panel for each of the figure's axes with lines; lines end at the ends of the x axis.
    """
    panels = [panel for panel in figure.axes if _named(panel)]
    if not panels:
        return None
    shared = panels[0].get_shared_y_axes()
    return {
        "title": figure.get_suptitle().replace("\n", ", "),
        "x": x_label(panels[-1]),
        "sharedY": all(shared.joined(panels[0], other) for other in panels[1:]),
        "panels": [
            {
                "title": panel.get_title("left") or panel.get_title(),
                "y": panel.get_ylabel() or figure.get_supylabel(),
                "range": [float(end) for end in panel.get_xlim()],
                "lines": [_line(each, panel.get_xlim()) for each in _named(panel)],
            }
            for panel in panels
        ],
    }


def _named(panel: Axes) -> list[Line2D]:
    """The lines of a panel that have a name."""
    return [line for line in panel.lines if line.get_gid() is not None]


def _line(line: Line2D, ends: tuple[float, float]) -> dict[str, Any]:
    """A line between two ends of x: its name, style, and points."""
    from matplotlib.colors import to_hex

    x, y = (np.asarray(values, dtype=float) for values in line.get_data())
    inside = (x >= ends[0]) & (x <= ends[1])
    x, y = thinned(x[inside], y[inside], MOST_POINTS)
    label = str(line.get_label())
    return {
        "name": str(line.get_gid()) if label.startswith("_") else label,
        "colour": to_hex(line.get_color()),
        "dashed": line.get_linestyle() != "-",
        "opacity": line.get_alpha() or 1.0,
        "width": line.get_linewidth(),
        "x": _rounded(x),
        "y": _rounded(y),
    }


def thinned(x: np.ndarray, y: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """A line of up to `most` points in place of one of more, x and y (k,), with the same extremes.

    Of each group of consecutive points the smallest and the largest y remain, in their order.
    """
    if len(x) <= most:
        return x, y
    parts = np.linspace(0, len(x), max(1, most // 2) + 1).astype(int)
    kept = [begin + each(y[begin:end]) for begin, end in pairwise(parts) for each in (np.argmin, np.argmax)]
    chosen = np.unique(kept)
    return x[chosen], y[chosen]


def _rounded(values: np.ndarray) -> list[float | None]:
    """Numbers with as many digits as a chart needs; None where there is none."""
    return [float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None for value in values]


def _peak_in_words(panel: dict[str, Any], line: dict[str, Any]) -> str:
    """The largest value of a line of a chart, and its place, in words."""
    place = f", {panel['title']}" if panel["title"] else ""
    sizes = np.abs(np.array(line["y"], dtype=float))
    if not np.isfinite(sizes).any():
        return f"{line['name']}{place}: no values"
    peak = int(np.nanargmax(sizes))
    return f"{line['name']}{place}: peak {line['y'][peak]:.4g} where x is {line['x'][peak]:.4g}"
