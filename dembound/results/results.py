"""The results of a run as arrays, for Python: the same names as in ``run.h5`` (docs/reference/results.md)."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NoReturn, overload

import h5py
import numpy as np

from dembound.errors import RecordError
from dembound.results.histories import Named, missing
from dembound.results.reader import (
    Snapshots,
    datasets_in,
    energy_of,
    laws_of,
    open_record,
    reading,
    side_energies_of,
    snapshots_of,
    state_of,
    text_of,
)
from dembound.results.summary import Entries, read_summary


class _Record:
    """A record that is read again and again, as long as no later run has replaced it.

    That of a complete run does not change; that of another one may grow.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        with open_record(path) as file:
            self._is_complete = bool(file.attrs.get("complete", False))
            self._state = self._state_now()

    @contextmanager
    def opened(self) -> Iterator[h5py.File]:
        """Open it for reading; errors as of `reading`, and RecordError if it has been replaced."""
        with reading(self.path) as file:
            self.require_same()
            yield file

    def require_same(self) -> None:
        """Raise RecordError if it has been replaced."""
        if self._state_now() != self._state:
            own = "give runs names of their own: dembound.change(case, …, name=…)"
            raise RecordError([f"{self.path.parent}: was replaced by a later run; {own}"])

    def _state_now(self) -> tuple[int, ...]:
        """What no other record at this place has: its state, or while it grows its number."""
        return state_of(self.path)[: None if self._is_complete else 2]


class Arrays(Mapping[str, np.ndarray]):
    """The datasets of one group of a record, each read from the file when it is accessed.

    Attributes
    ----------
    attributes : attributes of the group, such as ``time`` of a snapshot in s.
    """

    def __init__(self, record: _Record, name: str, group: h5py.Group | None) -> None:
        self._record, self._group = record, name
        self._names = [] if group is None else list(datasets_in(group))
        attributes = {} if group is None else group.attrs
        self.attributes: dict[str, Any] = {name: _plain(value) for name, value in attributes.items()}

    def __getitem__(self, name: str) -> np.ndarray:
        """The array of a name, in SI units; raises NameMissingError, a KeyError, with the existing names."""
        self._require(name)
        with self._record.opened() as file:
            return file[self._group][name][:]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<{self._group}: {', '.join(self._names)}>"

    def units(self, name: str) -> tuple[str, ...]:
        """The units of the columns of an array, such as x, y and rotation; errors as for the array."""
        self._require(name)
        with self._record.opened() as file:
            dataset = file[self._group][name]
            parts = tuple(text_of(dataset.attrs.get("unit", "")).split(", "))
            return parts * (dataset.shape[1] if dataset.ndim > 1 else 1) if len(parts) == 1 else parts

    def _require(self, name: str) -> None:
        """Raise NameMissingError if there is no such array."""
        if name not in self._names:
            raise missing("array", name, self._names, f"{self._record.path}, {self._group}")


_PARTS = "histories, snapshots, particles, boundaries, walls, joints, cracks, energy, side_energies, laws, summary"
"""Attributes of `Results` with recorded data."""


class _Snapshots(Sequence[Arrays]):
    """The snapshots of a record in the order of time, each opened when it is accessed."""

    def __init__(self, record: _Record, names: list[str]) -> None:
        self._record, self._names = record, names

    @overload
    def __getitem__(self, number: int) -> Arrays: ...

    @overload
    def __getitem__(self, number: slice) -> list[Arrays]: ...

    def __getitem__(self, number: int | slice) -> Arrays | list[Arrays]:
        """A snapshot; raises NumberMissingError, an IndexError, with the range of the existing ones."""
        with self._record.opened() as file:
            found = Snapshots(file, self._names)[number]
            arrays = [Arrays(self._record, each.name, each) for each in (found if isinstance(found, list) else [found])]
            return arrays if isinstance(number, slice) else arrays[0]

    def __len__(self) -> int:
        return len(self._names)


class Results:
    """A folder of results, such as ``results/quickstart``.

    Parameters
    ----------
    folder : the folder, or its ``run.h5``; also ``<name>.partial`` of a run that failed.

    Attributes
    ----------
    folder : path of the folder.
    attributes : name, kind, time_step, steps, size … of the run, see docs/reference/results.md.
    particles : reference positions and the like, one row per particle (of a bar, node); none of exact histories.
    histories : of every monitor ``time`` (k,), ``displacement`` and ``velocity`` (k, 3), of a bar ``stress`` (k,).
    boundaries : of every side its particles and their peak velocities, and of the side as a whole ``time`` (k,), mean
    ``displacement`` (k, 3) and ``force`` (k, 2).
    walls : of every wall its ``points`` (p, 2) at the start, and ``time`` (k,), ``displacement`` and ``force`` (k, 2).
    joints : of every joint its ``points`` (p, 2) at the start, and ``time``, ``slip``, ``opening``, ``pressure``,
    ``shear``, ``closed`` and ``sliding`` (k,).
    snapshots : in the order of time: ``displacement``, ``velocity`` (n, 3) and more; ``attributes["time"]`` in s.
    cracks : ``time``, ``position``, ``particles``, ``shear`` of the bonds that broke.

    Raises RecordError when there is no record that can be read, when a snapshot that cannot be read is accessed, and
    when anything is accessed after a later run has replaced the record.
    """

    def __init__(self, folder: Path | str) -> None:
        path = Path(folder)
        self._record = _Record(path if path.suffix == ".h5" else path / "run.h5")
        self.folder = self._record.path.parent
        with self._record.opened() as file:
            self.attributes: dict[str, Any] = {name: _plain(value) for name, value in file.attrs.items()}
            self.particles = self._array(file, "particles")
            self.histories = self._arrays(file, "histories", "monitor")
            self.boundaries = self._arrays(file, "boundaries", "side")
            self.walls = self._arrays(file, "walls", "wall")
            self.joints = self._arrays(file, "joints", "joint")
            self.snapshots: Sequence[Arrays] = _Snapshots(self._record, snapshots_of(file).names)
            self.cracks = self._array(file, "cracks")
            self.laws: list[tuple[str, float]] = laws_of(file)

    def __repr__(self) -> str:
        return f"<Results of {self.name}: {len(self.histories)} histories, {len(self.snapshots)} snapshots>"

    def __getitem__(self, name: str) -> NoReturn:
        """Raises TypeError with the existing attributes."""
        raise TypeError(f"results have no [{name!r}]; their parts are attributes: {_PARTS}")

    @property
    def name(self) -> str:
        """The case's name."""
        return str(self.attributes["name"])

    @property
    def case(self) -> str:
        """The TOML text of the case, for `dembound.loads`."""
        return str(self.attributes["case"])

    @property
    def summary(self) -> dict[str, Any]:
        """The contents of ``summary.json``; raises CaseError for a run that is not complete, which has none.

        A name that it does not have raises NameMissingError, a KeyError, with the existing names.
        """
        self._record.require_same()
        return read_summary(self.folder, Entries)

    @property
    def energy(self) -> dict[str, np.ndarray]:
        """The columns (k,) of the energy ledger, and ``relative_error``; raises CaseError where there is none."""
        with self._record.opened() as file:
            return energy_of(file)

    @property
    def energy_units(self) -> dict[str, str]:
        """The unit of each column of `energy`; the same errors."""
        with self._record.opened() as file:
            group = file.get("energy", {})
            return {
                name: text_of(group[name].attrs.get("unit", "")) if name in group else "1" for name in energy_of(file)
            }

    @property
    def side_energies(self) -> dict[str, dict[str, np.ndarray]]:
        """Energies of every side: ``came_in``, ``absorbed`` and ``stored``, (k,) at the times of the energy ledger."""
        with self._record.opened() as file:
            return side_energies_of(file)

    def _array(self, file: h5py.File, name: str) -> Arrays:
        """A group of the record, without arrays if the record does not have it, such as exact histories."""
        return Arrays(self._record, f"/{name}", file.get(name))

    def _arrays(self, file: h5py.File, name: str, what: str) -> Named[Arrays]:
        """The groups within a group of the record."""
        found = {key: Arrays(self._record, group.name, group) for key, group in file.get(name, {}).items()}
        return Named(found, what, str(self._record.path))


def _plain(value: Any) -> Any:
    """An attribute as a plain Python value."""
    if isinstance(value, np.ndarray):
        return [_plain(each) for each in value.tolist()]
    if isinstance(value, bytes):
        return text_of(value)
    return value.item() if isinstance(value, np.generic) else value
