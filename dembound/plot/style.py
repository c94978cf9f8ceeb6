"""The style of all figures: fonts, colours, size, and saving."""

from collections.abc import Callable, Iterable
from functools import wraps
from pathlib import Path
from typing import Any, NamedTuple, ParamSpec, TypeVar

import numpy as np
from matplotlib import style
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.font_manager import get_font_names
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.path import Path as Path2D
from matplotlib.ticker import AutoLocator, LogLocator, NullFormatter, ScalarFormatter

from dembound.files import replacing
from dembound.interrupts import look

# Okabe & Ito: distinct with every kind of colour vision; without yellow, which is too pale for lines on white
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
DASHES = ("-", "--", "-.", ":")
MARKERS = "os^Dv"
REFERENCE = "#7F7F7F"
"""Colour of lines for comparison: incident peaks, frames."""

SIGNED_MAP = "RdBu_r"
"""Colour map of fields that may have either sign; white is zero."""

UNSIGNED_MAP = "viridis"
"""Colour map of fields that are never negative."""

# DejaVu comes with matplotlib; the others, if installed, have Chinese characters for titles
FONTS = ("DejaVu Sans", "Noto Sans CJK SC", "Microsoft YaHei", "PingFang SC", "SimHei", "WenQuanYi Zen Hei")

DOTS_PER_INCH = 150

COMPRESSION = 2
"""Level of compression of pictures: half the time of the usual one, and a fifth more bytes."""

FEWEST_NUMBERS = 3
"""Least number of numbers along an axis: with fewer neither scale nor zero can be read."""

NUMBERED = ((1.0,), (1.0, 2.0, 5.0), (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0))
"""Sets of multiples of powers of ten as numbers of a logarithmic axis: the first with enough numbers is used."""

LEGEND = 0.45
"""Height (inches) of a legend of two rows, for which figures have room."""

THINNEST = 1.5
"""Width (points) of a band below which the line within hides it."""

RAISED = str.maketrans("0123456789−-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁻")
"""Superscript characters of exponents."""

SHORT = 0.1
"""Duration (s) below which pictures have times in milliseconds."""

Parameters = ParamSpec("Parameters")
Drawn = TypeVar("Drawn")


class TimeUnit(NamedTuple):
    """The unit of times: its name, and its length in seconds."""

    name: str
    seconds: float

    @property
    def label(self) -> str:
        """Text for an axis."""
        return f"time ({self.name})"


def time_unit(last: float) -> TimeUnit:
    """The unit for a picture of times up to `last` seconds."""
    return TimeUnit("ms", 1e-3) if last < SHORT else TimeUnit("s", 1.0)


def styled(draw: Callable[Parameters, Drawn]) -> Callable[Parameters, Drawn]:
    """Give a drawing function this style, independent of the user's matplotlib settings."""

    @wraps(draw)
    def in_style(*args: Parameters.args, **kwargs: Parameters.kwargs) -> Drawn:
        installed = set(get_font_names())
        settings = {
            "font.family": [name for name in FONTS if name in installed],
            "font.size": 10.0,
            "axes.titlesize": 10.0,
            "axes.grid": True,
            "axes.axisbelow": True,
            "axes.unicode_minus": True,
            "grid.color": "#E5E5E5",
            "grid.linewidth": 0.6,
            "lines.linewidth": 1.4,
            "lines.markersize": 4.0,
            "text.parse_math": False,  # names and titles appear as they are, with whatever they have of $ and \\
            "legend.frameon": False,
        }
        with style.context(["default", settings]):
            return draw(*args, **kwargs)

    return in_style


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of this size in inches with automatic layout."""
    return Figure(figsize=(width, height), dpi=DOTS_PER_INCH, layout="constrained")


def measured_once(panels: np.ndarray, *, same_y: bool = True) -> None:
    """Let the layout measure common axes only once, which would take most of its time; nothing moves.

    panels (rows, columns): only the last row has numbers on x; same_y : numbers on y are the same in all rows. Ticks
    without numbers belong to the spines.
    """
    for row, panel in ((row, panel) for row, across in enumerate(panels) for panel in across):
        has_x, has_y = row == len(panels) - 1, row == 0 or not same_y
        panel.xaxis.set_in_layout(has_x)
        panel.yaxis.set_in_layout(has_y)
        for side, spine in panel.spines.items():
            spine.set_in_layout((side == "bottom" and not has_x) or (side == "left" and has_y))


class Powers(ScalarFormatter):
    """The numbers of an axis, with a common power of ten at its end, such as ×10⁻⁵.

    Mathtext does the same, but its start takes longer than the rest of an axis.
    """

    def __init__(self) -> None:
        super().__init__(useOffset=False)
        self.set_powerlimits((-3, 4))

    def get_offset(self) -> str:
        """The power of ten; empty if there is none."""
        power = super().get_offset().removeprefix("1e")
        return power and f"×10{power.translate(RAISED)}"


def plain_numbers(axis: Axis) -> None:
    """Give a logarithmic axis numbers such as 0.05 at its ticks, and none between them."""
    axis.set_major_formatter(lambda value, _: f"{value:g}")
    axis.set_minor_formatter(NullFormatter())


def decade(value: float, _: object = None) -> str:
    """A number of a logarithmic axis, such as 10⁻³ or 5×10⁻³, for `matplotlib.ticker.FuncFormatter`."""
    power = int(np.floor(np.log10(value) + 1e-9))
    times = value / 10.0**power
    return f"{f'{times:.3g}×' if abs(times - 1.0) > 1e-6 else ''}10{str(power).translate(RAISED)}"


def stacked_height(count: int) -> float:
    """Height (inches) of a figure of `count` panels below each other, each with room for three numbers."""
    return 1.6 + count * float(np.clip(9.0 / count, 0.9, 1.6))


def number_axes(figure: Figure) -> None:
    """Give all numbered axes with matplotlib's own ticks at least `FEWEST_NUMBERS` numbers."""
    for axis in (axis for panel in figure.axes for axis in (panel.xaxis, panel.yaxis)):
        locator = axis.get_major_locator()
        if isinstance(locator, AutoLocator):
            locator.set_params(min_n_ticks=FEWEST_NUMBERS)
        elif isinstance(locator, LogLocator):
            low, high = sorted(axis.get_view_interval())
            for subs in NUMBERED:
                if np.count_nonzero((axis.get_majorticklocs() >= low) & (axis.get_majorticklocs() <= high)) >= 3:
                    break
                axis.set_major_locator(LogLocator(subs=subs, numticks=12))


def line_style(index: int) -> dict[str, str]:
    """Colour and dashes of the index-th of several lines; repeats only after 28."""
    return {"color": COLOURS[index % len(COLOURS)], "linestyle": DASHES[index % len(DASHES)]}


def point_style(index: int) -> dict[str, Any]:
    """Colour and marker of the index-th of several rows of points, joined by thin lines; repeats after 35."""
    colour, marker = COLOURS[index % len(COLOURS)], MARKERS[index % len(MARKERS)]
    return {"color": colour, "marker": marker, "linewidth": 0.8}


def open_point_style(index: int) -> dict[str, Any]:
    """Style of points with hollow markers and dashes, so that rows that coincide remain visible."""
    return point_style(index) | {"linestyle": DASHES[index % len(DASHES)], "markersize": 6.0, "fillstyle": "none"}


def outside_legend(figure: Figure, panels: Iterable[Axes], columns: int) -> None:
    """Put one legend of all labels in the panels, each once, below everything else.

    It has as many columns as fit the width of the figure, at most `columns`; of more than two rows it makes the figure
    higher. Lines outside the axes, and bands thinner
    than a line, have no entry.
    """
    handles: dict[str, Artist] = {}
    for panel in panels:
        for handle, label in zip(*panel.get_legend_handles_labels(), strict=True):
            if label not in handles and is_seen(handle, panel):
                handles[label] = handle
    if not handles:
        return
    for count in range(columns, 0, -1):
        legend = figure.legend(list(handles.values()), list(handles), loc="outside lower center", ncols=count)
        extent = legend.get_window_extent()
        if count == 1 or extent.width <= figure.bbox.width:
            width, height = figure.get_size_inches()
            figure.set_size_inches(width, height + max(0.0, extent.height / figure.dpi - LEGEND))
            return
        legend.remove()


def finished(figure: Figure, title: str, panels: Iterable[Axes], columns: int) -> Figure:
    """The figure with a title above all panels, and one legend below them, see `outside_legend`."""
    figure.suptitle(title, fontsize=11)
    outside_legend(figure, panels, columns)
    return figure


def is_seen(artist: Any, panel: Axes) -> bool:
    """Whether any part of an artist is within the axes, and not thinner than a line; False for one without data."""
    if isinstance(artist, tuple):  # bars, and points with the ranges of their errors
        return any(is_seen(part, panel) for part in np.ravel(np.array(artist, dtype=object)) if part is not None)
    if not artist.get_visible():
        return False
    panel.get_xlim(), panel.get_ylim()  # found only when they are asked for
    if isinstance(artist, PathCollection):
        return _holds_any(panel, artist.get_offset_transform().transform(np.ma.getdata(artist.get_offsets())))
    if isinstance(artist, Line2D) and artist.get_marker() not in (None, "", "None", " "):
        return _holds_any(panel, artist.get_transform().transform(artist.get_xydata()))
    if isinstance(artist, Line2D | Patch):
        return _meets(artist.get_transform().transform_path(artist.get_path()), panel)
    if isinstance(artist, PolyCollection | LineCollection):
        paths = [artist.get_transform().transform_path(path) for path in artist.get_paths()]
        seen = [path for path in paths if _meets(path, panel)]
        least = THINNEST * panel.figure.dpi / 72.0
        return any(isinstance(artist, LineCollection) or _thickness(path) > least for path in seen)
    return True


def _holds_any(panel: Axes, places: np.ndarray) -> bool:
    """Whether any of places (k, 2) on the page, in pixels, is within the axes."""
    box = panel.bbox.padded(1.0)
    return len(places) == 0 or bool(((places >= box.min) & (places <= box.max)).all(axis=1).any())


def _meets(path: Path2D, panel: Axes) -> bool:
    """Whether a path on the page, in pixels, meets the axes."""
    cleaned = path.cleaned(remove_nans=True)
    return len(np.asarray(path.vertices)) == 0 or bool(cleaned.intersects_bbox(panel.bbox.padded(1.0), filled=False))


def _thickness(path: Path2D) -> float:
    """The largest extent upwards of an area at any of the x of its corners, pixels."""
    corners = np.asarray(path.vertices)
    x, y = corners[np.isfinite(corners).all(axis=1)].T
    order = np.argsort(x, kind="stable")
    begins = np.flatnonzero(np.diff(x[order], prepend=-np.inf) > 1e-6)
    return float((np.maximum.reduceat(y[order], begins) - np.minimum.reduceat(y[order], begins)).max())


def save(figure: Figure, path: Path, title: str | None = None) -> None:
    """Write the figure as a PNG file, either completely or not at all; `title` replaces the title of the figure."""
    look()
    if title is not None:
        figure.suptitle(title, fontsize=11, parse_math=False)
    lay_out(figure)
    look()
    with replacing(path) as file:  # by the canvas, as savefig draws everything twice
        FigureCanvasAgg(figure).print_png(file, pil_kwargs={"compress_level": COMPRESSION})


def lay_out(figure: Figure) -> None:
    """Compute the places of all panels and keep them when panels change; axes get enough numbers."""
    number_axes(figure)
    if figure.axes and (layout := figure.get_layout_engine()) is not None:
        layout.execute(figure)
        figure.set_layout_engine("none")


def pixels_of(figure: Figure) -> np.ndarray:
    """The picture (rows, columns, 3) of the present figure, red, green and blue from 0 to 255."""
    look()
    lay_out(figure)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[:, :, :3].copy()


def set_pixels(figure: Figure, width: int) -> None:
    """Set the width of a figure in pixels; its size in inches, and so the relative size of texts, is kept."""
    figure.set_dpi((width + 0.5) / figure.get_figwidth())  # the canvas leaves out fractions of a pixel
