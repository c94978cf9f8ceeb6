"""Estimated errors in pictures of histories: a band around the recorded line, and the line without its sides' error."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from dembound.results.estimates import Band

WITHIN: dict[str, Any] = {"alpha": 0.2, "linewidth": 0.0, "zorder": 1.5}
"""Style of bands: below all lines."""

CORRECTED: dict[str, Any] = {"linewidth": 0.9, "linestyle": (0, (2, 2)), "color": "#000000", "zorder": 2.5}
"""Style of corrected lines."""


def draw_band(
    panel: Axes, band: Band, time: np.ndarray, values: np.ndarray, column: int, units: tuple[float, float], label: str
) -> None:
    """Draw the band of a history (k,) of a column at times (k,) s, and the corrected line if there is one.

    The band ends where the estimate does. units : seconds in a unit of time, and SI units in one of the values.
    """
    count = min(len(band.time), len(time))
    at, middle, half = time[:count] / units[0], values[:count], band.half_width[:count, column] / units[1]
    colour = panel.lines[-1].get_color()
    panel.fill_between(at, middle - half, middle + half, color=colour, label=f"{label}, estimated error", **WITHIN)
    if band.corrected is not None:
        corrected = band.corrected[:count, column] / units[1]
        panel.plot(at, corrected, label=f"{label}, without the error of its sides", **CORRECTED)
