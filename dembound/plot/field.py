"""The data of a picture of a scene: one field of its disks, at some times or of the whole run."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import h5py
import numpy as np
from matplotlib.colors import Colormap

from dembound.holes import Hole
from dembound.plot.disks import ContinuumCells, Window, read_continuum
from dembound.plot.lines_of_ground import LayersOfSide, Segments, areas_in, foot_in, layers_in, segments_in
from dembound.plot.outlines import read_holes
from dembound.results.histories import FREE_FIELD
from dembound.results.reader import laws_in_words, laws_of, require_run, snapshots_of, text_of, walls_at

FieldName = Literal[
    "velocity", "displacement", "stress_xx", "stress_yy", "stress_xy", "peak", "unbalanced", "layer", "fragments"
]

OF_THE_RUN = ("peak", "layer")
"""The fields that do not change with time."""

FORCES = "forces"
"""Name of the picture of contacts, see plot/packing.py."""

SHOWN_LAYER = 0.06
"""Part of the size of the scene as far as which layers that absorb are shown."""

SEEN = 0.3
"""Part of the size of all disks as far as which walls beyond them are shown."""


@dataclass(frozen=True)
class Disks:
    """The disks of a run before the motion.

    positions (n, 2) and radii (n,) in m; monitors: name -> place (2,) m; twins (k, 2) m, the places of theirs in the
    free-field column; case: its name; laws as text, empty if there was only one law; column, how many disks belong to
    the free-field column, which come first; continuum, the one round them, None for none; holes of the case, without
    those that still have their disks; layers: those of the ground, or of its left and right side, none of uniform
    ground; foot, the height (m) below which motion of the continuum is without the free field; walls and joints:
    points (k, 2) m of each; most_slip, m, the largest of joints in any snapshot; areas, corners (k, 2) m of groups, and
    of later holes, by name.
    """

    positions: np.ndarray
    radii: np.ndarray
    monitors: dict[str, np.ndarray]
    twins: np.ndarray
    case: str
    laws: str
    column: int = 0
    continuum: ContinuumCells | None = None
    holes: tuple[Hole, ...] = ()
    layers: tuple[LayersOfSide, ...] = ()
    foot: float | None = None
    walls: tuple[np.ndarray, ...] = ()
    joints: tuple[np.ndarray, ...] = ()
    most_slip: float = 0.0
    areas: Mapping[str, np.ndarray] = field(default_factory=dict)

    @cached_property
    def own_window(self) -> Window:
        """The window of the disks."""
        return Window.around(self.positions, self.radii)

    @property
    def part_windows(self) -> list[Window]:
        """Windows of the disks of free-field columns, if there are any, and of the body."""
        parts = [*self._columns, np.arange(self.column, len(self.radii))]
        return [Window.around(self.positions[part], self.radii[part]) for part in parts if len(part)]

    @cached_property
    def window(self) -> Window:
        """The whole scene: a continuum, as far as `SHOWN_LAYER` into what absorbs, and walls as far as `SEEN`."""
        disks = own = self.own_window
        margin = SEEN * float(max(disks.size))
        for line in self.walls:
            near = np.clip(line, disks.corner - margin, disks.corner + disks.size + margin)
            own = own.with_other(Window(near.min(axis=0), np.ptp(near, axis=0)))
        if self.continuum is None:
            return own
        ground = self.continuum.elements[~self.continuum.absorbs]
        inner = own.with_other(Window.of_boxes(ground)) if len(ground) else own
        margin = SHOWN_LAYER * float(max(inner.size))
        return own.with_other(self.continuum.window).within(Window(inner.corner - margin, inner.size + 2.0 * margin))

    @property
    def in_words(self) -> str:
        """The number of disks as text for a title."""
        return f"{len(self.radii):,} disks{'' if self.continuum is None else ' and a continuum'}"

    @property
    def _columns(self) -> list[np.ndarray]:
        """Disks (k,) of the free-field columns left and right of the body, those that there are."""
        if self.column == 0:
            return []
        right = self.positions[: self.column, 0] > self.positions[self.column :, 0].max()
        return [each for each in (np.flatnonzero(~right), np.flatnonzero(right)) if len(each)]

    @property
    def seams(self) -> list[float]:
        """Positions (m, along x) between free-field columns and the body or its continuum."""
        low, high = (self.positions[:, 0] + sign * self.radii for sign in (-1.0, 1.0))
        begins, ends = float(low[self.column :].min()), float(high[self.column :].max())
        if self.continuum is not None:
            left, right = self.continuum.window.extent[:2]
            begins, ends = min(begins, left), max(ends, right)
        return [
            0.5 * float(high[each].max() + begins) if low[each].min() < begins else 0.5 * float(low[each].min() + ends)
            for each in self._columns
        ]


@dataclass(frozen=True)
class Field:
    """One field of the disks of a run, k times.

    captions, k texts with the times; values (k, n) in the unit; cracks so far, each time, as by `cracks_until`, and
    their `ends` (c, 2, 2) m, as by `crack_lines`; limits of the colour scale, equally far from zero for a field of
    either sign; the name and unit of the field; the meaning of its sign, if the name does not give it; beyond (k, m),
    values of the nodes of a continuum, None if it has none; moved (k, n, 2) and moved_beyond (k, m, 2) m,
    displacements with which disks and nodes are drawn, None for none; walls (p, 2) m as they are drawn, None where
    they are at the start; cut, whether values exceed the limits; gone (k, n) bool, disks that have vanished; joints,
    segments each time, None where the field has no time; palette, the colours of values that are numbers of colours;
    by_time: whether cracks are coloured by the time at which they broke.
    """

    captions: list[str]
    values: np.ndarray
    cracks: list[dict[str, np.ndarray]]
    limits: tuple[float, float]
    name: str
    unit: str
    sense: str = ""
    beyond: np.ndarray | None = None
    moved: np.ndarray | None = None
    moved_beyond: np.ndarray | None = None
    walls: tuple[np.ndarray, ...] | None = None
    cut: bool = False
    gone: np.ndarray | None = None
    joints: tuple[Segments | None, ...] = ()
    palette: Colormap | None = None
    by_time: bool = False

    @property
    def extend(self) -> Literal["neither", "max", "both"]:
        """The ends of a colour bar at which values exceed it, for matplotlib."""
        return "neither" if not self.cut else "both" if self.limits[0] < 0.0 else "max"

    @property
    def label(self) -> str:
        """Text for a colour bar."""
        return f"{self.name}{self.sense} ({self.unit})"


def read_disks(file: h5py.File) -> Disks:
    """The disks of an open record; raises CaseError for one of only histories."""
    require_run(file)
    laws = laws_of(file)
    places = {name: group.attrs["position"] for name, group in file.get("histories", {}).items()}
    twins = [
        place
        for name, place in places.items()  # without a column they are where their monitors are
        if name.endswith(FREE_FIELD) and not np.array_equal(place, places[name.removesuffix(FREE_FIELD)])
    ]
    positions = file["particles/position"][:]
    slipped = [segments_in(snapshot) for snapshot in snapshots_of(file)]
    span = float(np.ptp(positions, axis=0).max())
    return Disks(
        positions=positions,
        radii=file["particles/radius"][:],
        monitors={name: place for name, place in places.items() if not name.endswith(FREE_FIELD)},
        twins=np.array(twins).reshape(-1, 2),
        case=text_of(file.attrs["name"]),
        laws=laws_in_words(laws) if len(laws) > 1 else "",
        column=int(file.attrs.get("column", 0)),
        continuum=read_continuum(file),
        holes=tuple(hole for hole in read_holes(file) if not hole.takes(positions, span).any()),
        layers=tuple(layers_in(file)),
        foot=foot_in(file),
        walls=tuple(walls_at(file, 0.0).values()),
        joints=tuple(group["points"][:] for group in file.get("joints", {}).values()),
        most_slip=max((float(np.abs(each.slip).max(initial=0.0)) for each in slipped if each is not None), default=0.0),
        areas=areas_in(file),
    )
