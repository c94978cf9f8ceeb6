"""Reads a field of the disks of a record: at some times, or of the whole run."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import repeat
from typing import get_args

import h5py
import numpy as np

from dembound.errors import CaseError
from dembound.plot.disks import GROUP, is_scattered
from dembound.plot.field import FORCES, OF_THE_RUN, Field, FieldName
from dembound.plot.lines_of_ground import gone_at, segments_in
from dembound.plot.pieces import PALETTE, hues_at
from dembound.plot.places import crack_lines, displacement_of, exaggeration, near_ones
from dembound.results.histories import FREE_FIELD, UNITS
from dembound.results.pieces import pieces_at
from dembound.results.reader import COMPONENTS, cracks_until, snapshot_of, snapshots_of, walls_at

QUANTILE, OUTLYING = 0.995, 1.25
"""Share of the disks that a colour scale has at least, and over whose largest size the largest of all is cut off."""

FRAGMENTS = "fragments"
"""Name of the field of the pieces of broken ground."""

MEGA = 1e6
"""Pascals in a megapascal."""

STRESSES = ("stress_xx", "stress_yy", "stress_xy")
"""Names of stresses in the order of the columns in a record."""

SENSES = dict.fromkeys(STRESSES[:2], ", tension positive") | {"stress_xy": ", positive up on a face to the right"}
"""The meaning of a positive stress."""


@dataclass(frozen=True)
class FieldInRecord:
    """The place of a field in a record, and its largest values in all snapshots.

    groups, all snapshots; dataset and beyond, names in each of them, the latter of a continuum, None for none; column
    of both; words, sense and unit as of a `Field`, scale the SI value of the unit; largest (g,) size in each snapshot,
    in the unit, of all disks or, if `cut`, of `QUANTILE` of them; factor of the displacements that are drawn. The
    values of `FRAGMENTS` are numbers in `PALETTE`.
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
    cut: bool = False
    factor: float = 0.0

    @property
    def limit(self) -> float:
        """The end of the colour scale: the largest size, or 1 where all is zero."""
        return float(self.largest.max()) or 1.0

    def at(self, chosen: Sequence[h5py.Group]) -> Field:
        """The field in some snapshots of the record, which must be open."""
        times = [float(group.attrs["time"]) for group in chosen]
        file, last = chosen[0].file, times[-1]
        moves = [displacement_of(group) for group in chosen]
        is_moved, ends = self.factor != 0.0, gone_at(file)
        beyond = moved_beyond = None
        if self.beyond is not None:
            beyond = np.array([group[self.beyond][:, self.column] for group in chosen]) / self.scale
            if is_moved:
                moved_beyond = self.factor * np.array([group[f"{GROUP}/displacement"][:, :2] for group in chosen])
        return Field(
            captions=[f"t = {time:.3g} s" for time in times],
            values=np.array([self._values_in(group) for group in chosen]),
            beyond=beyond,
            palette=PALETTE if self.dataset == FRAGMENTS else None,
            cracks=[drawn_cracks(file, time, moved, self.factor) for time, moved in zip(times, moves, strict=True)],
            limits=(-self.limit, self.limit) if self.dataset != FRAGMENTS else (0.0, PALETTE.N - 1.0),
            name=self.words,
            unit=self.unit,
            sense=self.sense,
            moved=self.factor * np.array(moves) if is_moved else None,
            moved_beyond=moved_beyond,
            walls=tuple(walls_at(file, last, self.factor).values()) or None if is_moved else None,
            cut=self.cut,
            gone=None if ends is None else np.array(times)[:, None] > ends,
            joints=tuple(segments_in(group, self.factor) for group in chosen),
        )

    def _values_in(self, group: h5py.Group) -> np.ndarray:
        """The values (n,) of disks in a snapshot."""
        if self.dataset != FRAGMENTS:
            values: np.ndarray = group[self.dataset][:, self.column] / self.scale
            return values
        return hues_at(group.file, float(group.attrs["time"]))


def drawn_cracks(file: h5py.File, time: float, moved: np.ndarray, factor: float) -> dict[str, np.ndarray]:
    """The cracks of an open record until a time in s, with the `ends` (k, 2, 2) m between which they are drawn."""
    cracks = cracks_until(file, time)
    places = (file["particles/position"][:], file["particles/radius"][:]) if len(cracks["time"]) else ()
    return cracks | {"ends": crack_lines(cracks, *places, moved, factor) if places else np.zeros((0, 2, 2))}


def find_field(
    file: h5py.File, name: FieldName, component: str | None, exaggerate: float | None = None
) -> FieldInRecord:
    """A field of the snapshots of an open record, none of `OF_THE_RUN`; arguments as of `plot_scene`.

    Raises CaseError when the record has no snapshots or does not have the field, or snapshots have no such field.
    """
    if name not in get_args(FieldName):
        raise CaseError([f"field: is {name}, must be one of {', '.join((*get_args(FieldName), FORCES))} for disks"])
    groups = snapshots_of(file, required=True)
    if name == FRAGMENTS:
        return _fragments(file, groups, exaggerate)
    dataset = "stress" if name in STRESSES else name
    if dataset not in groups[0]:
        having = "static stages that stalled" if name == "unbalanced" else "runs with output.stress = true"
        lacking = dataset.replace("unbalanced", "unbalanced forces")
        raise CaseError([f"{file.filename}: holds no {lacking}; {having} do"])
    is_beyond = f"{GROUP}/{dataset}" in groups[0] and not (dataset == "stress" and is_scattered(file))
    beyond = f"{GROUP}/{dataset}" if is_beyond else None
    sizes = _sizes(groups, dataset, (near_ones(file, group) for group in groups))
    if beyond is not None:
        sizes = np.maximum(sizes, _sizes(groups, beyond, repeat(_outside_layers(file))))
    scale = MEGA if name in STRESSES else 1.0
    most, whole = sizes.max(axis=0)
    outlying = (whole > OUTLYING * most) & (most > 0.0)
    column, words, unit = _column(name, component, np.where(outlying, most, whole))
    cut = bool(outlying[column])
    largest, factor = sizes[:, 0 if cut else 1, column] / scale, exaggeration(file, groups, exaggerate)
    sense = SENSES.get(name, "")
    return FieldInRecord(groups, dataset, beyond, column, words, sense, unit, scale, largest, cut, factor)


def _fragments(file: h5py.File, groups: Sequence[h5py.Group], exaggerate: float | None) -> FieldInRecord:
    """The fragments at the snapshots of an open record, of which the last is shown."""
    if pieces_at(file, float(groups[-1].attrs["time"])) is None:
        raise CaseError([f"{file.filename}: holds no fragments; complete runs whose bonds broke do"])
    factor = exaggeration(file, groups, exaggerate)
    order = np.arange(len(groups), dtype=float)
    return FieldInRecord(groups, FRAGMENTS, None, 0, FRAGMENTS, "", "", 1.0, order, factor=factor)


def evenly_chosen(count: int, most: int) -> list[int]:
    """Numbers of up to `most` of `count` snapshots, evenly chosen, including the last."""
    backwards = np.linspace(count - 1, 0, min(most, count))
    return [round(number) for number in reversed(backwards)]


def read_field(
    file: h5py.File,
    name: FieldName,
    component: str | None,
    snapshot: int | None,
    most: int,
    exaggerate: float | None = None,
) -> Field:
    """A field of an open record; name, component and exaggerate as in `plot_scene`.

    Without a snapshot number there are up to `most` snapshots, evenly chosen, including the last, or for 1 the one
    in which the field is largest, of velocities that in which a monitor is fastest. The limits are those of the whole
    run, 1 where all is zero.

    Raises CaseError when the record has no such snapshot or does not have the field, or disks have no such field.
    """
    if name in OF_THE_RUN:
        if snapshot is not None:
            raise CaseError([f"{name}: is of the whole run, not of a snapshot"])
        return _peak(file) if name == "peak" else _layer(file)
    found = find_field(file, name, component, exaggerate)
    if snapshot is not None:
        return found.at([snapshot_of(file, snapshot)])
    if most == 1:
        liveliest = _liveliest(file, found.groups) if name == "velocity" else None
        return found.at([found.groups[int(np.argmax(found.largest)) if liveliest is None else liveliest]])
    return found.at([found.groups[number] for number in evenly_chosen(len(found.groups), most)])


def _liveliest(file: h5py.File, groups: Sequence[h5py.Group]) -> int | None:
    """Number of the snapshot nearest to the time at which a monitor is fastest; None if there is none that moves."""
    fastest, at = 0.0, None
    for name, history in file.get("histories", {}).items():
        if not name.endswith(FREE_FIELD) and len(history["time"]):
            speeds = np.hypot(*history["velocity"][:, :2].T)
            if speeds.max() > fastest:
                fastest, at = speeds.max(), history["time"][int(np.argmax(speeds))]
    return None if at is None else int(np.argmin([abs(group.attrs["time"] - at) for group in groups]))


def _sizes(groups: Sequence[h5py.Group], dataset: str, chosen: Iterable[np.ndarray]) -> np.ndarray:
    """Sizes (g, 2, columns) of the chosen rows of a dataset in each snapshot: of `QUANTILE` of them, and of all."""
    sizes = (np.abs(group[dataset][:][rows]) for group, rows in zip(groups, chosen, strict=False))
    return np.array([np.quantile(each, (QUANTILE, 1.0), axis=0, method="inverted_cdf") for each in sizes])


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
    cracks = drawn_cracks(file, 0.0, np.zeros((len(values), 2)), 0.0)
    return Field([""], values[None], [cracks], (1.0, float(values.max())), "layer", "1 at the surface")


def _peak(file: h5py.File) -> Field:
    """The largest speed of every disk, and of the nodes of a continuum, in the whole run."""
    if "peak_velocity" not in file["particles"]:
        raise CaseError([f"{file.filename}: holds no peaks; complete runs with output.peaks = true do"])
    values = file["particles/peak_velocity"][:]
    cracks = drawn_cracks(file, np.inf, np.zeros((len(values), 2)), 0.0)
    beyond = file[f"{GROUP}/peak_velocity"][:] if GROUP in file and not is_scattered(file) else None
    parts = [values] if beyond is None else [values, beyond[_outside_layers(file)]]
    sizes = [np.quantile(part, (QUANTILE, 1.0), method="inverted_cdf") for part in parts if len(part)]
    most, whole = np.max(sizes, axis=0)
    cut = bool(whole > OUTLYING * most > 0.0)
    caption = f"t = 0 to {file.attrs['steps'] * file.attrs['time_step']:.3g} s"
    limits, beside = (0.0, float(most if cut else whole) or 1.0), None if beyond is None else beyond[None]
    return Field([caption], values[None], [cracks], limits, "largest speed", "m/s", beyond=beside, cut=cut)
