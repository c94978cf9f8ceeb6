"""A scene of disks that changes with time: each snapshot in the same axes, with the same colours."""

from dataclasses import replace
from pathlib import Path
from typing import Any, cast, get_args

import h5py
import numpy as np

from dembound.casefile.messages import counted
from dembound.errors import CaseError
from dembound.plot.continuum import GROUP
from dembound.plot.disks import Window
from dembound.plot.field import OF_THE_RUN, Field, FieldInRecord, FieldName, find_field, read_disks
from dembound.plot.scene import DRAWING, LONG, close_up, draw_panel, mark_monitors, mark_part
from dembound.plot.style import Powers, lay_out, new_figure, outside_legend, pixels_of, set_pixels, styled
from dembound.results.reader import cracks_until, open_record, reading

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
        factor of the displacements of disks, nodes and cracks; 0 shows them at their first places. Monitors, outlines
        of elements and ties do not move.

    Raises CaseError when the file cannot be read, has no snapshots, or does not contain the field.
    """

    @styled
    def __init__(self, run: Path, field: str = "velocity", exaggerate: float = 0.0) -> None:
        if field not in CHANGING:
            raise CaseError([f"field: is {field}, must be one of {', '.join(CHANGING)} for disks that move"])
        self._run, self._exaggerate = run, exaggerate
        with open_record(run) as file:
            self._disks = read_disks(file)
            found = find_field(file, cast(FieldName, field), None)
            self.times = np.array([group.attrs["time"] for group in found.groups])
            self._cracks = [len(cracks_until(file, time)["time"]) for time in self.times]
            self._window = self._widened(found)
            self._names = [group.name for group in found.groups]
            self._found = replace(found, groups=[])  # the file is closed
            largest = found.at([found.groups[int(np.argmax(found.largest))]])
            last = found.at([found.groups[-1]])
        self._part = close_up(self._disks, largest.values[0]) if self._is_long else None
        self._make_panels()
        self._fill(last, len(self.times) - 1)
        bar: dict[str, Any] = {"label": last.label, "shrink": 0.9, "pad": 0.02, "format": Powers()}
        self.figure.colorbar(self._colours, ax=self._panels, **bar)
        moved = f", displacements × {exaggerate:g}" if exaggerate else ""
        self.words = f"{self._disks.case}: {last.name} of {self._disks.in_words}{moved}"
        self.figure.suptitle("\n".join(filter(None, [self.words, self._disks.laws])), fontsize=11)
        outside_legend(self.figure, self._panels, columns=3)
        lay_out(self.figure)

    @property
    def _is_long(self) -> bool:
        length, width = max(self._window.size), min(self._window.size)
        return bool(length > LONG * width)

    def _widened(self, found: FieldInRecord) -> Window:
        """The window of the whole scene with all exaggerated displacements."""
        window = self._disks.window
        if self._exaggerate == 0.0:
            return window
        names = ["displacement", *([f"{GROUP}/displacement"] if self._disks.continuum is not None else [])]
        largest = max(float(np.abs(group[name][:, :2]).max()) for group in found.groups for name in names)
        margin = abs(self._exaggerate) * largest
        return Window(window.corner - margin, window.size + 2.0 * margin)

    def _make_panels(self) -> None:
        """Make one panel, and for a long scene another for the enlarged part: below, or beside an upright scene."""
        windows = [self._window] if self._part is None else [self._window, self._part]
        upright = bool(self._part and self._window.size[1] > self._window.size[0])
        room = [float(min(DRAWING / window.size)) for window in windows]
        sizes = np.array([scale * window.size for scale, window in zip(room, windows, strict=True)])
        across, up = sizes.T
        shape: dict[str, Any]
        if upright:
            self.width, self.height = float(across.sum()) + 3.8, float(up.max()) + 2.0
            shape = {"ncols": len(windows), "width_ratios": across}
        else:
            self.width, self.height = max(float(across.max()), 3.0) + 1.8, float(up.sum()) + 2.2
            shape = {"nrows": len(windows), "height_ratios": up}
        self.figure = new_figure(self.width, self.height)
        self._panels = list(self.figure.subplots(squeeze=False, **shape).flat)
        self._scales = room

    def _fill(self, shown: Field, index: int) -> None:
        """Draw a snapshot into all panels, in place of another one."""
        whole, *close = self._panels
        whole.clear()
        scale = self._scales[0]
        dots = self.figure.dpi
        self._colours = draw_panel(whole, self._disks, shown, 0, self._window, scale * dots, counted=False)
        mark_monitors(whole, self._disks, scale)
        whole.set_title(self.caption(index), pad=18)  # above the names of monitors at the top
        if self._part is not None:
            mark_part(whole, self._part)
            close[0].clear()
            draw_panel(close[0], self._disks, shown, 0, self._part, self._scales[1] * dots, counted=False)

    def caption(self, index: int) -> str:
        """The time of a frame, and how many bonds have broken until then."""
        broken = self._cracks[index]
        return f"t = {self.times[index]:.4g} s" + (f", {counted(broken, 'broken bond')}" if broken else "")

    @styled
    def frame(self, index: int, pixels: int) -> np.ndarray:
        """One frame as a picture (rows, pixels, 3)."""
        set_pixels(self.figure, pixels)
        with reading(self._run) as file:
            group = file[self._names[index]]
            shown = self._moved(group, self._found.at([group]))
        self._fill(shown, index)
        return pixels_of(self.figure)

    def _moved(self, group: h5py.Group, shown: Field) -> Field:
        """The field at a snapshot, with its disks, nodes and cracks moved by the exaggerated displacements."""
        if self._exaggerate == 0.0:
            return shown
        moved = self._exaggerate * group["displacement"][:, :2]
        cracks = [
            each | {"position": each["position"] + moved[each["particles"]].mean(axis=1)} for each in shown.cracks
        ]
        beyond = None
        if self._disks.continuum is not None:
            beyond = self._exaggerate * group[f"{GROUP}/displacement"][:, :2][None]
        return replace(shown, cracks=cracks, moved=moved[None], moved_beyond=beyond)
