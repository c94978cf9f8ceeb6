"""Histories at the monitors with a line that moves with time."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg

from dembound.plot.histories import plot_histories
from dembound.plot.style import COLOURS, lay_out, set_pixels, styled, time_unit
from dembound.results.histories import read_histories


class TimeLine:
    """Velocities at the monitors of a run, with a vertical line at a time; the rest is drawn once.

    Parameters
    ----------
    run
        the ``run.h5`` of a run.
    width
        of the picture in inches.
    monitors
        names of the monitors to show; None for all.

    Raises CaseError as `plot_histories`.
    """

    @styled
    def __init__(self, run: Path, width: float, monitors: Sequence[str] | None = None) -> None:
        self.figure = plot_histories([run], monitors=monitors)
        self.width, self.height = width, float(self.figure.get_size_inches()[1])
        self.figure.set_size_inches(self.width, self.height)
        self._canvas = FigureCanvasAgg(self.figure)
        last = max(history.time[-1] for history in read_histories(run, "velocity").values())
        self._seconds = time_unit(last).seconds
        looks: dict[str, Any] = {"color": COLOURS[1], "linewidth": 1.2, "animated": True}
        self._lines = [panel.axvline(0.0, **looks) for panel in self.figure.axes]
        self._pixels = 0

    @styled
    def frame(self, time: float, pixels: int) -> np.ndarray:
        """The picture (rows, pixels, 3) of red, green and blue from 0 to 255 with the line at a time in s."""
        if pixels != self._pixels:
            set_pixels(self.figure, pixels)
            lay_out(self.figure)
            self._canvas.draw()
            self._still = self._canvas.copy_from_bbox(self.figure.bbox)
            self._pixels = pixels
        self._canvas.restore_region(self._still)
        for panel, line in zip(self.figure.axes, self._lines, strict=True):
            line.set_xdata([time / self._seconds] * 2)
            panel.draw_artist(line)
        return np.asarray(self._canvas.buffer_rgba())[:, :, :3].copy()
