"""A bar in pictures: stress, damage and motion along it and in time."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import h5py
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.image import NonUniformImage

from dembound.errors import CaseError
from dembound.laws.peridynamic import CRACKED
from dembound.plot.style import (
    COLOURS,
    REFERENCE,
    SIGNED_MAP,
    TimeUnit,
    finished,
    line_style,
    measured_once,
    new_figure,
    styled,
    time_unit,
)
from dembound.results.reader import cracks_until, laws_of, open_record, snapshot_of, snapshots_of, text_of

MILLI, MEGA = 1e-3, 1e6

FEWEST = 10
"""Fewer snapshots than this are drawn as profiles, each a line; more are drawn over position and time."""


@dataclass(frozen=True)
class FieldStyle:
    """The drawing of a field: name, unit and its SI value, meaning of the sign, colour map.

    jumps: whether values change suddenly, so that they must not be interpolated between two snapshots.
    """

    words: str
    unit: str
    scale: float
    sense: str = ""
    colours: str = SIGNED_MAP
    jumps: bool = False

    @property
    def label(self) -> str:
        """Text for an axis or a colour bar."""
        return f"{self.words}{self.sense} ({self.unit})"


FIELDS = {
    "stress": FieldStyle("stress", "MPa", MEGA, ", tension positive"),
    "damage": FieldStyle("local damage", "–", 1.0, colours="Reds", jumps=True),
    "velocity": FieldStyle("velocity", "m/s", 1.0, ", positive to the right"),
    "displacement": FieldStyle("displacement", "mm", MILLI, ", positive to the right"),
}
"""The fields of a bar by name."""


@dataclass(frozen=True)
class SpaceTimeField:
    """Fields of a bar of n nodes at k moments.

    place (n,) m; time (k,) in `unit`, as all times; values: name of a field -> (k, n) in its unit; crack_place (c,) m
    and crack_time (c,) of the bonds broken up to the last of them; changes: changes of method up to then, with their
    times; case: its name.
    """

    place: np.ndarray
    time: np.ndarray
    values: dict[str, np.ndarray]
    crack_place: np.ndarray
    crack_time: np.ndarray
    changes: list[tuple[str, float]]
    case: str
    unit: TimeUnit

    def moment(self, time: float) -> str:
        """Number of a time as text."""
        return f"{time:.4g} {self.unit.name}"


@styled
def plot_bar(run: Path) -> Figure:
    """Stress and damage of a bar over position and time; below, both along the bar at the end. Broken bonds are marked.

    A run with few snapshots shows both along the bar at each.

    Parameters
    ----------
    run
        the ``run.h5`` of a bar's run.

    Raises CaseError when the file cannot be read or has no snapshot.
    """
    return _draw(read_course(run, ("stress", "damage")))


@styled
def plot_bar_field(run: Path, field: str, snapshot: int | None = None) -> Figure:
    """One field of a bar over position and time, or only along the bar at one snapshot.

    Parameters
    ----------
    run
        the ``run.h5`` of a bar's run.
    field
        name of one of `FIELDS`.
    snapshot
        its number; negative ones count from the last. By default all are shown.

    Raises CaseError when the file cannot be read, has no such snapshot, or bars have no such field.
    """
    if field not in FIELDS:
        raise CaseError([f"field: is {field}, must be one of {', '.join(FIELDS)} for a bar"])
    return _draw(read_course(run, (field,), snapshot))


def read_course(run: Path, fields: Sequence[str], snapshot: int | None = None) -> SpaceTimeField:
    """Fields of a bar's record at all snapshots, or at a single one.

    Raises CaseError when the file cannot be read or has no such snapshot.
    """
    with open_record(run) as file:
        groups = [*snapshots_of(file, required=True)] if snapshot is None else [snapshot_of(file, snapshot)]
        time = np.array([group.attrs["time"] for group in groups])
        cracks = cracks_until(file, time[-1])
        unit = time_unit(time[-1])
        return SpaceTimeField(
            place=file["particles/position"][:, 0],
            time=time / unit.seconds,
            values={name: np.array([_along(group[name]) for group in groups]) / FIELDS[name].scale for name in fields},
            crack_place=cracks["position"][:, 0],
            crack_time=cracks["time"] / unit.seconds,
            changes=[(name, since / unit.seconds) for name, since in laws_of(file)[1:] if since <= time[-1]],
            case=text_of(file.attrs["name"]),
            unit=unit,
        )


def _along(dataset: h5py.Dataset) -> np.ndarray:
    """A field along the bar, (n,): stress or damage unchanged, of a motion (n, 3) the component along x."""
    return dataset[:] if dataset.ndim == 1 else dataset[:, 0]


def _draw(course: SpaceTimeField) -> Figure:
    """All fields of a bar's course."""
    figure = _draw_maps(course) if len(course.time) >= FEWEST else _draw_profiles(course)
    shown = " and ".join(FIELDS[name].words for name in course.values)
    return finished(figure, f"{course.case}: {shown} along the bar", figure.axes, 5)


def _draw_maps(course: SpaceTimeField) -> Figure:
    """A column of panels for each field: over position and time, and below that its last profile."""
    count = len(course.values)
    figure = new_figure(2.0 + 4.5 * count, 6.8)
    panels = figure.subplots(2, count, sharex=True, squeeze=False, height_ratios=[5, 2])
    for (upper, lower), name in zip(panels.T, course.values, strict=True):
        colours = _draw_map(upper, course, name)
        figure.colorbar(colours, ax=upper, label=FIELDS[name].label, location="top", aspect=40)
        _draw_profile(lower, course, name, -1, color=COLOURS[0])
        lower.set_ylabel(f"{FIELDS[name].words} ({FIELDS[name].unit})")  # there is no space for more
        lower.set_title(f"at the end, t = {course.moment(course.time[-1])}", loc="left", fontsize=9, pad=3)
        lower.set_xlabel("x (m)")
    measured_once(panels, same_y=False)
    return figure


def _draw_map(panel: Axes, course: SpaceTimeField, name: str) -> ScalarMappable:
    """A field over position and time, with broken bonds and changes of method; returns the colour mapping."""
    values, look = course.values[name], FIELDS[name]
    largest = float(np.abs(values).max()) or 1.0
    limits = (0.0, 1.0) if name == "damage" else (-largest, largest)
    window = (course.place[0], course.place[-1], 0.0, course.time[-1])
    between: Literal["nearest", "bilinear"] = "nearest" if look.jumps else "bilinear"
    picture = NonUniformImage(panel, interpolation=between, extent=window, cmap=look.colours, clim=limits)
    # a bar begins at rest
    picture.set_data(course.place, np.append(0.0, course.time), np.vstack([np.zeros(len(course.place)), values]))
    panel.add_image(picture)
    if len(course.crack_time):
        looks: dict[str, Any] = {"s": 9.0, "color": "black", "linewidths": 0.0, "zorder": 2.5}
        panel.scatter(course.crack_place, course.crack_time, label=f"bond broken ({len(course.crack_time):,})", **looks)
    for index, (method, since) in enumerate(course.changes):
        dashes = line_style(index + 2)["linestyle"]  # unlike the line in the panel of damage below
        label = f"{method} from {course.moment(since)}"
        panel.axhline(since, color="black", linewidth=1.0, linestyle=dashes, label=label)
    panel.set(xlim=window[:2], ylim=window[2:], ylabel=course.unit.label)
    panel.grid(False)
    return picture


def _draw_profiles(course: SpaceTimeField) -> Figure:
    """A panel for each field, with a line for each moment."""
    count = len(course.values)
    figure = new_figure(9.0, 1.6 + 2.4 * count)
    panels = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    for panel, name in zip(panels, course.values, strict=True):
        for number, time in enumerate(course.time):
            _draw_profile(panel, course, name, number, label=f"t = {course.moment(time)}", **line_style(number))
    panels[-1].set_xlabel("x (m)")
    measured_once(panels[:, None], same_y=False)
    return figure


def _draw_profile(panel: Axes, course: SpaceTimeField, name: str, number: int, **looks: Any) -> None:
    """A field along the bar at one moment; damage with the line above which nodes count as cracked."""
    panel.plot(course.place, course.values[name][number], **looks)
    panel.margins(x=0.0)
    panel.set_ylabel(FIELDS[name].label)
    if name == "damage":
        panel.set_ylim(-0.05, 1.05)
        mark_damage(panel)


def mark_damage(panel: Axes) -> None:
    """Draw the line of damage above which nodes count as cracked."""
    label = f"cracked from a damage of {CRACKED:g}"
    panel.axhline(CRACKED, color=REFERENCE, linewidth=1.0, linestyle="--", zorder=1, label=label)
