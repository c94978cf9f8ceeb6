"""Pictures of a page, embedded with their lines as numbers for charts to zoom, and movies of a run.

A movie has the body at every snapshot, and below it the histories with a line at the time.
"""

from __future__ import annotations

import base64
import io
import math
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.errors import CaseError
from dembound.files import new_folder, replacing, require_folder
from dembound.kinds import kind_of_record
from dembound.motion.kind import MovingPicture
from dembound.plot.moving import TimeLine
from dembound.plot.style import SIGNED_MAP, UNSIGNED_MAP, pixels_of, styled
from dembound.plot.table import named_lines, x_label
from dembound.results.histories import monitor_names

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from PIL.Image import Image

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
    panels = [] if chart is None else chart["panels"]
    peaks = [_peak_in_words(panel, line) for panel in panels for line in panel["lines"]]
    words = "; ".join([title.replace("\n", ", "), *peaks])
    height, width, _ = pixels.shape
    return Picture(title, words, uri_of(pixels, lossless=True), width, height, chart)


def uri_of(pixels: np.ndarray, *, lossless: bool) -> str:
    """A picture (rows, columns, 3) of red, green and blue from 0 to 255 as a data URI."""
    file = io.BytesIO()
    _picture(pixels).save(file, "webp", lossless=lossless, quality=FRAME_QUALITY, method=4)
    return f"data:image/webp;base64,{base64.b64encode(file.getvalue()).decode()}"


def chart_of(figure: Figure) -> dict[str, Any] | None:
    """The named lines of a figure as plain JSON values; None if it has none.

    It has a panel for each of the figure's axes with lines; lines end at the ends of the x axis.
    """
    panels = [panel for panel in figure.axes if named_lines(panel)]
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
                "lines": [_line(each, panel.get_xlim()) for each in named_lines(panel)],
            }
            for panel in panels
        ],
    }


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


PALETTE_FRAMES = 6
"""Number of frames from which the common colours of a GIF are taken."""

SHADES = 96
"""Number of colours from a scene's colour map in the palette: neighbours cannot be distinguished."""

ROUNDING = 2
"""Largest difference (of 255) between a colour of the map and a drawn pixel in red, green and blue."""

RARE = 0.3
"""Power of the number of pixels as the weight of a colour in the palette: waves are small, and most pixels are
white.
"""

WHITE = 245
"""Value of red, green and blue above which a colour of the palette, a mean of nearly white ones, is made white."""

FASTEST_GIF = 2
"""Least duration of a GIF's frame in hundredths of a second: browsers show frames of one hundredth ten times as
long.
"""


@dataclass(frozen=True)
class Movie:
    """The frames of a movie: a moving picture at some of its times, and a time line below it, if there is one.

    chosen : numbers of the snapshots shown. pixels : width of a frame.
    """

    picture: MovingPicture
    below: TimeLine | None
    chosen: Sequence[int]
    pixels: int

    def __len__(self) -> int:
        return len(self.chosen)

    def frame(self, number: int) -> np.ndarray:
        """One frame (rows, columns, 3), of an even number of rows and columns, as videos require."""
        index = self.chosen[number]
        parts = [self.picture.frame(index, self.pixels)]
        if self.below is not None:
            parts.append(self.below.frame(float(self.picture.times[index]), self.pixels))
        whole = np.vstack(parts)
        rows, columns, _ = whole.shape
        return np.pad(whole, ((0, rows % 2), (0, columns % 2), (0, 0)), mode="edge")


def movie_of(
    record: Path,
    *,
    field: str | None = None,
    exaggerate: float | None = None,
    monitors: Sequence[str] | None = None,
    every: int = 1,
    pixels: int = 960,
) -> Movie:
    """The movie of a run.

    Parameters
    ----------
    record
        a ``run.h5``.
    field
        field that colours disks, or is drawn along a bar; by default velocity, for a bar stress and damage.
    exaggerate
        factor of the displacements; 0 shows nodes at their first places, None disks where they are once they have moved
        by a tenth of a diameter.
    monitors
        monitors whose histories are drawn below; by default all, none if empty.
    every
        number of snapshots per frame; the last one is always shown.
    pixels
        width of a frame.

    Raises CaseError when the record cannot be read, has fewer than two snapshots, or lacks the field or a monitor.
    """
    picture = kind_of_record(record).moving_picture(record, field, exaggerate)
    count = len(picture.times)
    if count < 2:
        raise CaseError([f"{record}: has only one snapshot, a movie needs two; run with output.snapshots above 1"])
    chosen = sorted({*range(0, count, every), count - 1})
    shown = monitor_names(record) if monitors is None else monitors
    return Movie(picture, TimeLine(record, picture.width, shown) if shown else None, chosen, pixels)


def write_movie(
    movie: Movie, path: Path, fps: float = 10.0, progress: Callable[[int], None] = lambda frames: None
) -> None:
    """Write a movie, either completely or not at all: a GIF, or a new folder with a PNG file for each frame.

    Parameters
    ----------
    path
        of the GIF, with this ending, or of the folder, without an ending: ``0000.png`` and so on.
    fps
        frames per second of a GIF, whose frames take whole hundredths of a second, at least two.
    progress
        called with the number of frames drawn so far.

    Raises CaseError for another ending, or a folder that is there.
    """
    from PIL.Image import Dither

    require_movie(path)

    def frames() -> Iterator[np.ndarray]:
        for number in range(len(movie)):
            yield movie.frame(number)
            progress(number + 1)

    if path.suffix:
        colours = _common_colours(movie)
        with replacing(path) as file:
            reduced = (_picture(frame).quantize(palette=colours, dither=Dither.NONE) for frame in frames())
            duration = 10 * max(FASTEST_GIF, math.floor(100.0 / fps + 0.5))
            looks = {"save_all": True, "append_images": reduced, "duration": duration, "loop": 0, "optimize": False}
            next(reduced).save(file, "gif", **looks)
        return
    with new_folder(path) as folder:
        for number, frame in enumerate(frames()):
            with replacing(folder / f"{number:04d}.png") as file:
                _picture(frame).save(file, "png")


def require_movie(path: Path) -> None:
    """Raise CaseError if no movie of such a name can be written here, FileNotFoundError if there is no such folder."""
    if path.suffix.lower() not in (".gif", ""):
        raise CaseError([f"--output: is {path}, must end in .gif, or have no ending: a folder for frames as PNG files"])
    if not path.suffix and os.path.lexists(path):
        raise CaseError([f"--output: {path} is there already, frames are written to a new folder"])
    require_folder(path)


def _picture(pixels: np.ndarray) -> Image:
    from PIL import Image

    return Image.fromarray(pixels)


def _common_colours(movie: Movie) -> Image:
    """A picture whose palette has the colours of a few frames of a movie."""
    some = np.unique(np.linspace(0, len(movie) - 1, PALETTE_FRAMES).astype(int))
    pixels = np.concatenate([movie.frame(int(number)).reshape(-1, 3) for number in some])
    found, counts = np.unique(pixels, axis=0, return_counts=True)
    shades = _shades(found)
    weighed = np.repeat(found, np.ceil(counts**RARE).astype(int), axis=0)
    colours = _picture(weighed[None]).quantize(256 - len(shades), kmeans=1)
    palette = np.concatenate([shades, np.array(colours.getpalette()).reshape(-1, 3)])[:256]
    palette[palette.min(axis=1) >= WHITE] = 255
    colours.putpalette(palette.ravel().tolist())
    return colours


def _shades(found: np.ndarray) -> np.ndarray:
    """Evenly chosen colours (k, 3) of the colour map of a picture, whose colours (m, 3) are given; none without one."""
    from matplotlib import colormaps

    for name in (SIGNED_MAP, UNSIGNED_MAP):
        shades = colormaps[name](np.linspace(0.0, 1.0, SHADES), bytes=True)[:, :3].astype(int)
        away = np.array([np.abs(found.astype(int) - shade).max(axis=1).min() for shade in shades])
        if np.mean(away <= ROUNDING) > 0.5:
            return shades
    return np.zeros((0, 3), dtype=int)
