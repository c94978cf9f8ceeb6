"""Lines at broken bonds, with colours by their kind or by the time at which they broke."""

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, Normalize

from dembound.plot.field import Field
from dembound.plot.lines import ABOVE_DISKS

CRACKS = {"bond broken in tension": "black", "bond broken in shear": "#C000C0"}
"""Names of the two kinds of cracks in the legend; colours of their lines."""

TIME_MAP = ListedColormap(colormaps["plasma"](np.linspace(0.0, 0.85, 64)))
"""Colours of cracks by time, without the lightest, which would not be seen on white."""

DASHED: tuple[Any, ...] = ("-", (0, (1.5, 0.7)))
"""Lines of cracks in tension and in shear where colours are times."""

CRACK_WIDTH, THINNEST_CRACK = 0.12, 0.6
"""Width of the line of a crack in mean diameters, and its least width in points."""


def mark_cracks(panel: Axes, shown: Field, index: int, numbered: bool, diameter: float) -> None:
    """A line at each bond broken up to one of the times; the legend may have their number at the last time.

    diameter : mean, in points.
    """
    until = f" until {shown.captions[-1]}" if len(shown.captions) > 1 else ""
    width = max(THINNEST_CRACK, CRACK_WIDTH * diameter)
    for shear, (label, colour) in enumerate(CRACKS.items()):
        lines, last = (each["ends"][each["shear"] == shear] for each in (shown.cracks[index], shown.cracks[-1]))
        if len(lines) > 0:
            number = f" ({len(last):,}{until})" if numbered else ""
            looks: dict[str, Any] = {"colors": colour, "linewidths": width, "zorder": ABOVE_DISKS}
            if shown.by_time:
                del looks["colors"]  # which would be taken for those of the times
                broken = shown.cracks[index]
                looks |= {"cmap": TIME_MAP, "clim": _ends_of(shown), "linestyles": DASHED[shear]}
                looks["array"] = broken["time"][broken["shear"] == shear]
            drawn = LineCollection(list(lines), label=f"{label}{number}", **looks)
            if shown.by_time:
                drawn.update_scalarmappable()  # the legend has one of the colours
            panel.add_collection(drawn, autolim=False)


def times_of_cracks(shown: Field) -> ScalarMappable | None:
    """The colours of the times (s) of cracks for a bar; None where cracks have other colours, or none is drawn."""
    if not shown.by_time or not np.isfinite(shown.cracks[-1]["ends"]).any():
        return None
    return ScalarMappable(Normalize(*_ends_of(shown)), TIME_MAP)


def _ends_of(shown: Field) -> tuple[float, float]:
    """Times (s) of the first and the last crack drawn."""
    times = shown.cracks[-1]["time"]
    return float(times.min()), float(times.max())
