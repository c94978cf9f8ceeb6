"""A bar that changes with time: fields along it at each snapshot, in the same axes."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from dembound.casefile.messages import counted
from dembound.errors import CaseError
from dembound.laws.peridynamic import CRACKED
from dembound.plot.bar import FIELDS, read_course
from dembound.plot.style import COLOURS, REFERENCE, lay_out, new_figure, outside_legend, pixels_of, set_pixels, styled

MARGIN = 0.05
"""Margin of the vertical axes over the range of the values."""

WIDTH = 11.0
"""Width of a frame, inches."""


class MovingBar:
    """Fields along a bar at every snapshot, and places of the bonds broken until then.

    Parameters
    ----------
    run
        the ``run.h5`` of a bar's run.
    fields
        names of some of `FIELDS`, a panel each.
    exaggerate
        factor of the displacements of nodes along the bar; 0 shows the nodes at their first places.

    Raises CaseError when the file cannot be read, has no snapshots, or bars have no such field.
    """

    @styled
    def __init__(self, run: Path, fields: Sequence[str] = ("stress", "damage"), exaggerate: float = 0.0) -> None:
        if unknown := [field for field in fields if field not in FIELDS]:
            raise CaseError([f"field: is {name}, must be one of {', '.join(FIELDS)} for a bar" for name in unknown])
        self._course = read_course(run, (*fields, *(["displacement"] if exaggerate else [])))
        self._fields = fields
        self._places = np.broadcast_to(self._course.place, self._course.values[fields[0]].shape)
        if exaggerate:
            self._places = (
                self._places + exaggerate * FIELDS["displacement"].scale * self._course.values["displacement"]
            )
        self.times = self._course.time * self._course.unit.seconds
        self.width, self.height = WIDTH, 1.6 + 2.2 * len(fields)
        self.figure = new_figure(self.width, self.height)
        self._panels = self.figure.subplots(len(fields), 1, sharex=True, squeeze=False)[:, 0]
        shown = " and ".join(FIELDS[name].words for name in fields)
        moved = f", displacements × {exaggerate:g}" if exaggerate else ""
        self.words = f"{self._course.case}: {shown} along the bar{moved}"
        self.figure.suptitle(self.words, fontsize=11)
        self._fill(len(self.times) - 1)
        outside_legend(self.figure, self._panels, columns=3)
        lay_out(self.figure)

    def _fill(self, index: int) -> None:
        """Draw a snapshot into all panels, in place of another one."""
        for panel, name in zip(self._panels, self._fields, strict=True):
            panel.clear()
            panel.plot(self._places[index], self._course.values[name][index], color=COLOURS[0])
            panel.set(xlim=(self._places.min(), self._places.max()), ylim=self._limits(name))
            panel.set_ylabel(FIELDS[name].label)
            if name == "damage":
                label = f"cracked from a damage of {CRACKED:g}"
                panel.axhline(CRACKED, color=REFERENCE, linewidth=1.0, linestyle="--", zorder=1, label=label)
            self._mark_cracks(panel, index)
        for panel in self._panels[:-1]:
            panel.tick_params(labelbottom=False)
        self._panels[0].set_title(self.caption(index))
        self._panels[-1].set_xlabel("x (m)")

    def _limits(self, name: str) -> tuple[float, float]:
        """The ends of the vertical axis of a field, the same in all frames."""
        values = self._course.values[name]
        low, high = (0.0, 1.0) if name == "damage" else (float(values.min()), float(values.max()))
        margin = MARGIN * (high - low) or 1.0
        return low - margin, high + margin

    def _mark_cracks(self, panel: Axes, index: int) -> None:
        """A mark at the foot of a panel for every bond broken up to a snapshot, at the bond's first place."""
        broken = self._course.crack_place[self._course.crack_time <= self._course.time[index]]
        if len(broken) > 0:
            foot = panel.get_xaxis_transform()
            looks: dict[str, Any] = {
                "marker": "|",
                "s": 60.0,
                "color": "black",
                "linewidths": 1.0,
                "label": "bond broken",
            }
            panel.scatter(broken, np.full(len(broken), 0.03), transform=foot, **looks)

    def caption(self, index: int) -> str:
        """The time of a frame, and how many bonds have broken until then."""
        broken = int(np.count_nonzero(self._course.crack_time <= self._course.time[index]))
        return f"t = {self._course.moment(self._course.time[index])}" + (
            f", {counted(broken, 'broken bond')}" if broken else ""
        )

    @styled
    def frame(self, index: int, pixels: int) -> np.ndarray:
        """One frame as a picture (rows, pixels, 3)."""
        set_pixels(self.figure, pixels)
        self._fill(index)
        return pixels_of(self.figure)
