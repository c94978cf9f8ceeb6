"""Bodies that change with time: each snapshot in the same axes, with histories below."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, cast, get_args

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg

from dembound.casefile.messages import counted
from dembound.errors import CaseError
from dembound.plot.bar import FIELDS, mark_damage, read_course
from dembound.plot.field import OF_THE_RUN, Field, FieldName, read_disks
from dembound.plot.field_reader import find_field
from dembound.plot.histories import plot_histories
from dembound.plot.places import displacement_of, framed
from dembound.plot.scene import (
    DRAWING,
    LONG,
    add_colour_bars,
    close_up,
    draw_panel,
    mark_monitors,
    mark_part,
    out_of_frame,
    with_margins,
)
from dembound.plot.style import (
    COLOURS,
    lay_out,
    new_figure,
    outside_legend,
    pixels_of,
    set_pixels,
    styled,
    time_unit,
)
from dembound.results.histories import read_histories
from dembound.results.reader import cracks_until, open_record, reading

MOST_BELOW = 4
"""Number of monitors above which long rows of them are not shown in full below a body that moves."""


class TimeLine:
    """Velocities at the monitors of a run, with a vertical line at a time; the rest is drawn once.

    Parameters
    ----------
    run
        the ``run.h5`` of a run.
    width
        of the picture in inches.
    monitors
        names of the monitors to show; None for all, but of long rows ends and some between.

    Raises CaseError as `plot_histories`.
    """

    @styled
    def __init__(self, run: Path, width: float, monitors: Sequence[str] | None = None) -> None:
        self.figure = plot_histories([run], monitors=monitors, most=MOST_BELOW)
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


MARGIN = 0.05
"""Margin of the vertical axes over the range of the values in all frames."""

WIDTH = 11.0
"""Width of a frame, inches."""


def _caption(time: str, broken: int) -> str:
    """A time in words, and the number of bonds that have broken until then, if any have."""
    return f"t = {time}" + (f", {counted(broken, 'broken bond')}" if broken else "")


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
            factor = exaggerate * FIELDS["displacement"].scale
            self._places = self._places + factor * self._course.values["displacement"]
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
            values = self._course.values[name]
            low, high = (0.0, 1.0) if name == "damage" else (float(values.min()), float(values.max()))
            margin = MARGIN * (high - low) or 1.0
            panel.plot(self._places[index], values[index], color=COLOURS[0])
            panel.set(xlim=(self._places.min(), self._places.max()), ylim=(low - margin, high + margin))
            panel.set_ylabel(FIELDS[name].label)
            if name == "damage":
                mark_damage(panel)
            self._mark_cracks(panel, index)
        for panel in self._panels[:-1]:
            panel.tick_params(labelbottom=False)
        self._panels[0].set_title(self.caption(index))
        self._panels[-1].set_xlabel("x (m)")

    def _mark_cracks(self, panel: Axes, index: int) -> None:
        """A mark at the foot of a panel for every bond broken up to a snapshot, at the bond's first place."""
        broken = self._course.crack_place[self._course.crack_time <= self._course.time[index]]
        if len(broken) > 0:
            foot = panel.get_xaxis_transform()
            looks: dict[str, Any] = {"marker": "|", "s": 60.0, "color": "black", "linewidths": 1.0}
            panel.scatter(broken, np.full(len(broken), 0.03), transform=foot, label="bond broken", **looks)

    def caption(self, index: int) -> str:
        """The time of a frame, and how many bonds have broken until then."""
        time = self._course.time[index]
        return _caption(self._course.moment(time), int(np.count_nonzero(self._course.crack_time <= time)))

    @styled
    def frame(self, index: int, pixels: int) -> np.ndarray:
        """One frame as a picture (rows, pixels, 3)."""
        set_pixels(self.figure, pixels)
        self._fill(index)
        return pixels_of(self.figure)


CHANGING = tuple(name for name in get_args(FieldName) if name not in OF_THE_RUN)
"""The fields that snapshots have."""


class MovingScene:
    """The disks of a run, and a continuum around them, coloured by a field at every snapshot.

    A long scene has a second panel with an enlarged part of it. One snapshot is in RAM at a time.

    Parameters
    ----------
    run
        the ``run.h5`` of a run.
    field
        one of `CHANGING`, as in `plot_scene`.
    exaggerate
        as of `plot_scene`. Monitors, outlines of elements and ties do not move.

    Raises CaseError when the file cannot be read, has no snapshots, or does not contain the field.
    """

    @styled
    def __init__(self, run: Path, field: str = "velocity", exaggerate: float | None = None) -> None:
        if field not in CHANGING:
            raise CaseError([f"field: is {field}, must be one of {', '.join(CHANGING)} for disks that move"])
        self._run = run
        with open_record(run) as file:
            self._disks = read_disks(file)
            found = find_field(file, cast(FieldName, field), None, exaggerate)
            self.times = np.array([group.attrs["time"] for group in found.groups])
            self._cracks = [len(cracks_until(file, time)["time"]) for time in self.times]
            self._window = self._disks.window
            if found.factor != 0.0:
                moves = (found.factor * displacement_of(group) for group in found.groups)
                self._window = framed(self._window, self._disks.positions, self._disks.radii, moves)
            self._names = [group.name for group in found.groups]
            self._found = replace(found, groups=[])  # the file is closed
            largest = found.at([found.groups[int(np.argmax(found.largest))]])
            last = found.at([found.groups[-1]])
        is_long = max(self._window.size) > LONG * min(self._window.size)
        self._part = close_up(self._disks, largest.values[0], largest.palette is not None) if is_long else None
        self._make_panels(last)
        self._fill(last, len(self.times) - 1)
        add_colour_bars(self.figure, self._panels, self._colours, last)
        moved = f", displacements × {found.factor:g}" if found.factor not in (0.0, 1.0) else ""
        self.words = f"{self._disks.case}: {last.name} of {self._disks.in_words}{moved}"
        self.figure.suptitle("\n".join(filter(None, [self.words, self._disks.laws])), fontsize=11)
        outside_legend(self.figure, self._panels, columns=3)
        lay_out(self.figure)

    def _make_panels(self, last: Field) -> None:
        """Make one panel, and for a long scene another for the enlarged part: below, or beside an upright scene.

        last : the field at the last snapshot.
        """
        windows = [self._window] if self._part is None else [self._window, self._part]
        upright = bool(self._part and self._window.size[1] > self._window.size[0])
        self._scales = [float(min(DRAWING / window.size)) for window in windows]
        across, up = np.array([scale * each.size for scale, each in zip(self._scales, windows, strict=True)]).T
        shape: dict[str, Any]
        if upright:
            self.width, self.height = float(across.sum()) + 3.8, float(up.max()) + 2.0
            shape = {"ncols": len(windows), "width_ratios": across}
        else:
            self.width, self.height = with_margins(float(across.max()), float(up.sum()) + 2.2, last)
            shape = {"nrows": len(windows), "height_ratios": up}
        self.figure = new_figure(self.width, self.height)
        self._panels = list(self.figure.subplots(squeeze=False, **shape).flat)

    def _fill(self, shown: Field, index: int) -> None:
        """Draw a snapshot into all panels, in place of another one."""
        whole, *close = self._panels
        whole.clear()
        scale, dots = self._scales[0], self.figure.dpi
        self._colours = draw_panel(whole, self._disks, shown, 0, self._window, scale * dots, numbered=False)
        mark_monitors(whole, self._disks, scale)
        out = out_of_frame(self._disks, shown, 0, self._window)
        whole.set_title(self.caption(index) + out, pad=18)  # above the names of monitors at the top
        if self._part is not None:
            mark_part(whole, self._part)
            close[0].clear()
            draw_panel(close[0], self._disks, shown, 0, self._part, self._scales[1] * dots, numbered=False)

    def caption(self, index: int) -> str:
        """The time of a frame, and how many bonds have broken until then."""
        return _caption(f"{self.times[index]:.4g} s", self._cracks[index])

    @styled
    def frame(self, index: int, pixels: int) -> np.ndarray:
        """One frame as a picture (rows, pixels, 3)."""
        set_pixels(self.figure, pixels)
        with reading(self._run) as file:
            shown = self._found.at([file[self._names[index]]])
        self._fill(shown, index)
        return pixels_of(self.figure)
