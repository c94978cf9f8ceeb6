"""The data of a picture of a scene: one field of its disks, at some times or of the whole run."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, get_args

import h5py
import numpy as np

from dembound.errors import CaseError
from dembound.holes import Hole
from dembound.plot.disks import GROUP, ContinuumCells, Window, is_scattered, read_continuum, read_holes
from dembound.plot.lines_of_ground import LayersOfSide, Segments, foot_in, layers_in, segments_in
from dembound.results.histories import FREE_FIELD, UNITS
from dembound.results.reader import (
    COMPONENTS,
    cracks_until,
    laws_in_words,
    laws_of,
    require_run,
    snapshot_of,
    snapshots_of,
    text_of,
    walls_at,
)

FieldName = Literal["velocity", "displacement", "stress_xx", "stress_yy", "stress_xy", "peak", "unbalanced", "layer"]

OF_THE_RUN = ("peak", "layer")
"""The fields that do not change with time."""

FORCES = "forces"
"""Name of the picture of contacts, see plot/packing.py."""

SEEN = 0.3
"""Part of the size of all disks as far as which walls beyond them are shown."""

MEGA = 1e6
"""Pascals in a megapascal."""

STRESSES = ("stress_xx", "stress_yy", "stress_xy")
"""Names of stresses in the order of the columns in a record."""

SENSES = dict.fromkeys(STRESSES[:2], ", tension positive") | {"stress_xy": ", positive up on a face to the right"}
"""The meaning of a positive stress."""


@dataclass(frozen=True)
class Disks:
    """The disks of a run before the motion.

    positions (n, 2) and radii (n,) in m; monitors: name -> place (2,) m; twins (k, 2) m, the places of theirs in the
    free-field column; case: its name; laws as text, empty if there was only one law; column, how many disks belong to
    the free-field column, which come first; continuum, the one round them, None for none; holes of the case, without
    those that still have their disks; layers: those of the ground, or of its left and right side, none of uniform
    ground; foot, the height (m) below which motion of the continuum is without the free field; walls and joints:
    points (k, 2) m of each; most_slip, m, the largest of joints in any snapshot.
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
        """The whole scene, with its continuum, and walls as far as `SEEN` of the disks' size beyond them."""
        own = self.own_window
        for line in self.walls:
            margin = SEEN * float(max(self.own_window.size))
            near = np.clip(
                line, self.own_window.corner - margin, self.own_window.corner + self.own_window.size + margin
            )
            own = own.with_other(Window(near.min(axis=0), np.ptp(near, axis=0)))
        return own if self.continuum is None else own.with_other(self.continuum.window)

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

    captions, k texts with the times; values (k, n) in the unit; cracks so far, each time, as by `cracks_until`; limits
    of the colour scale, equally far from zero for a field of either sign; the name and unit of the field; the meaning
    of its sign, if the name does not give it; beyond (k, m), values of the nodes of a continuum, None if it has none;
    moved (k, n, 2) and moved_beyond (k, m, 2) m, displacements with which disks and nodes are drawn, None for none;
    walls (p, 2) m as they are drawn, None where they are at the start; joints, segments each time, None where the
    field has no time.
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
    joints: tuple[Segments | None, ...] = (None,)

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
    )


@dataclass(frozen=True)
class FieldInRecord:
    """The place of a field in a record, and its largest values in all snapshots.

    groups, all snapshots; dataset and beyond, names in each of them, the latter of a continuum, None for none; column
    of both; words, sense and unit as of a `Field`, scale the SI value of the unit; largest (g,) size in each snapshot,
    in the unit.
    """

    groups: Sequence[h5py.Group]
    dataset: str
    beyond: str | None
    column: int
    words: str
    sense: str
    unit: str
    scale: float
    largest: np.ndarray

    @property
    def limit(self) -> float:
        """The end of the colour scale: the largest size, or 1 where all is zero."""
        return float(self.largest.max()) or 1.0

    def at(self, chosen: Sequence[h5py.Group]) -> Field:
        """The field in some snapshots of the record, which must be open."""
        times = [float(group.attrs["time"]) for group in chosen]
        return Field(
            captions=[f"t = {time:.3g} s" for time in times],
            values=np.array([group[self.dataset][:, self.column] for group in chosen]) / self.scale,
            beyond=None
            if self.beyond is None
            else np.array([group[self.beyond][:, self.column] for group in chosen]) / self.scale,
            cracks=[cracks_until(chosen[0].file, time) for time in times],
            limits=(-self.limit, self.limit),
            name=self.words,
            unit=self.unit,
            sense=self.sense,
            joints=tuple(map(segments_in, chosen)),
        )


def find_field(file: h5py.File, name: FieldName, component: str | None) -> FieldInRecord:
    """A field of the snapshots of an open record, none of `OF_THE_RUN`; name and component as in `plot_scene`.

    Raises CaseError when the record has no snapshots or does not have the field, or snapshots have no such field.
    """
    if name not in get_args(FieldName):
        raise CaseError([f"field: is {name}, must be one of {', '.join((*get_args(FieldName), FORCES))} for disks"])
    groups = snapshots_of(file, required=True)
    dataset = "stress" if name in STRESSES else name
    if dataset not in groups[0]:
        having = "static stages that stalled" if name == "unbalanced" else "runs with output.stress = true"
        raise CaseError(
            [f"{file.filename}: holds no {dataset.replace('unbalanced', 'unbalanced forces')}; {having} do"]
        )
    beyond = f"{GROUP}/{dataset}" if f"{GROUP}/{dataset}" in groups[0] else None
    if dataset == "stress" and is_scattered(file):
        beyond = None
    largest = _largest(groups, dataset)
    if beyond is not None:
        largest = np.maximum(largest, _largest(groups, beyond, _outside_layers(file)))
    scale = MEGA if name in STRESSES else 1.0
    column, words, unit = _column(name, component, largest.max(axis=0))
    return FieldInRecord(
        groups, dataset, beyond, column, words, SENSES.get(name, ""), unit, scale, largest[:, column] / scale
    )


def evenly_chosen(count: int, most: int) -> list[int]:
    """Numbers of up to `most` of `count` snapshots, evenly chosen, including the last."""
    backwards = np.linspace(count - 1, 0, min(most, count))
    return [round(number) for number in reversed(backwards)]


def read_field(file: h5py.File, name: FieldName, component: str | None, snapshot: int | None, most: int) -> Field:
    """A field of an open record; name and component as in `plot_scene`.

    Without a snapshot number there are up to `most` snapshots, evenly chosen, including the last, or for 1 the one
    in which the field is largest. The limits are those of the whole run, 1 where all is zero.

    Raises CaseError when the record has no such snapshot or does not have the field, or disks have no such field.
    """
    if name in OF_THE_RUN:
        if snapshot is not None:
            raise CaseError([f"{name}: is of the whole run, not of a snapshot"])
        return _peak(file) if name == "peak" else _layer(file)
    found = find_field(file, name, component)
    if snapshot is not None:
        return found.at([snapshot_of(file, snapshot)])
    if most == 1:
        return found.at([found.groups[int(np.argmax(found.largest))]])
    return found.at([found.groups[number] for number in evenly_chosen(len(found.groups), most)])


def _largest(groups: Sequence[h5py.Group], dataset: str, chosen: slice | np.ndarray = slice(None)) -> np.ndarray:
    """Largest size (g, columns) of a dataset, or of its chosen rows, in each of some snapshots."""
    return np.array([np.abs(group[dataset][:][chosen]).max(axis=0, initial=0.0) for group in groups])


def _outside_layers(file: h5py.File) -> np.ndarray:
    """Nodes (m,) of the continuum outside the layers that absorb, in which the motion is not that of ground."""
    return ~file[f"{GROUP}/absorbs"][:].astype(bool)


def _column(name: str, component: str | None, largest: np.ndarray) -> tuple[int, str, str]:
    """The column of a field, the field in words, and its unit; largest (3,) of each column in the run."""
    if name in STRESSES:
        return STRESSES.index(name), f"stress {name[-2:]}", "MPa"
    column = int(np.argmax(largest[:2])) if component is None else COMPONENTS.index(component)
    way = "of rotation" if column == 2 else f"along {COMPONENTS[column]}"
    if name == "unbalanced":
        return column, f"unbalanced force {way}", "N"
    return column, f"{name} {way}", UNITS[name][column]


def _layer(file: h5py.File) -> Field:
    """The number of the layer of every disk."""
    if "layer" not in file["particles"]:
        raise CaseError([f"{file.filename}: holds no layers; runs of cases with [[layer]] do"])
    values = file["particles/layer"][:].astype(float)
    count = float(values.max())
    return Field([""], values[None], [cracks_until(file, 0.0)], (1.0, count), "layer", "1 at the surface")


def _peak(file: h5py.File) -> Field:
    """The largest speed of every disk, and of the nodes of a continuum, in the whole run."""
    if "peak_velocity" not in file["particles"]:
        raise CaseError([f"{file.filename}: holds no peaks; complete runs with output.peaks = true do"])
    values = file["particles/peak_velocity"][:]
    beyond = file[f"{GROUP}/peak_velocity"][:] if GROUP in file and not is_scattered(file) else None
    largest = [values.max()] if beyond is None else [values.max(), beyond[_outside_layers(file)].max(initial=0.0)]
    return Field(
        captions=[f"t = 0 to {file.attrs['steps'] * file.attrs['time_step']:.3g} s"],
        values=values[None],
        cracks=[cracks_until(file, np.inf)],
        beyond=None if beyond is None else beyond[None],
        limits=(0.0, float(max(largest)) or 1.0),
        name="largest speed",
        unit="m/s",
    )
