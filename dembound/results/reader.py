"""Result files: opening records, and writing derived files either completely or not at all."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, overload

import numpy as np

from dembound.errors import CaseError, DemboundError, NumberMissingError, RecordError
from dembound.interrupts import look
from dembound.machine import address_limit
from dembound.results.committed import CommittedFile, log_of
from dembound.results.datasets import (
    damage_in_words,
    datasets_of,
    is_of_checksum,
    require_finite,
    require_places,
    require_readable,
)
from dembound.results.structure import Members, require_structure

if TYPE_CHECKING:
    import h5py

COMPONENTS = ("x", "y", "rotation")
"""The columns of every displacement and velocity in a record."""


_sound: set[tuple[int, ...]] = set()
"""States (`state_of`) of records that this process has checked for damage, without members of their collections."""

_own: set[tuple[int, ...]] = set()
"""States of records that this process has written, which are not checked."""


@contextmanager
def open_record(path: Path) -> Iterator[h5py.File]:
    """Open a record (``run.h5``, ``calibration.h5``) for reading in a ``with`` statement; errors as of `reading`.

    At the first opening it is checked for damage and foreign contents, which takes some 0.2 ms for each dataset.
    Datasets of snapshots, and of runs and choices of charts, are checked when they are used, see `snapshots_of` and
    `Members`.
    """
    with reading(path) as file:
        state = state_of(path)
        if state not in _sound and state not in _own:
            require_structure(file)
            require_equal_rows(file)
            require_places(file)
            _sound.add(state)
        yield file


def trust(path: Path) -> None:
    """Note that a record is sound, as this process has written it just now."""
    _own.add(state_of(path))


def state_of(path: Path) -> tuple[int, ...]:
    """Identity of a file in its present state, for any name: device, number, time of change (ns) and size."""
    status = path.stat()
    return status.st_dev, status.st_ino, status.st_mtime_ns, status.st_size


@contextmanager
def reading(path: Path) -> Iterator[h5py.File]:
    """Open a record that has been checked before.

    Raises RecordError when it cannot be read, and for errors that damaged contents cause inside the statement, which
    should therefore only read. Errors of the operating system about other files are passed on.
    """
    import h5py

    look()
    if not path.is_file():
        raise RecordError([f"{path}: cannot be read as a record of results: there is no such file"])
    try:
        with h5py.File(CommittedFile(path, "r") if log_of(path).is_file() else path, "r") as file:
            try:
                yield file
            except OSError as error:
                if is_of_checksum(error):
                    require_readable(file)
                raise
    except DemboundError:
        raise
    except Exception as error:  # h5py and numpy raise nearly anything for damaged contents
        if isinstance(error, OSError) and error.filename not in (None, str(path)):
            raise
        if isinstance(error, MemoryError) and address_limit() is not None:
            raise
        raise RecordError([f"{path}: {damage_in_words(error, path.stat().st_size)}"]) from error


@contextmanager
def understood(*records: Path) -> Iterator[None]:
    """Raise RecordError, in one line, for all errors inside that records or summaries of other origin cause."""
    try:
        yield
    except (ArithmeticError, AssertionError, AttributeError, LookupError, TypeError, ValueError, MemoryError) as error:
        for record in (path for path in records if path.suffix == ".h5" and path.is_file()):
            with reading(record) as file:
                require_finite(file)
        what = f"{type(error).__name__}: {error}".splitlines()[0][:200]
        names = ", ".join(map(str, records))
        reason = f"it or its summary.json is not of this version of dembound ({what})"
        raise RecordError([f"{names}: {reason}"]) from error


def text_of(value: str | bytes) -> str:
    """A text of a record; texts of fixed length are bytes in UTF-8."""
    return value.decode() if isinstance(value, bytes) else str(value)


def require_equal_rows(file: h5py.File) -> None:
    """Raise RecordError if columns of a group, but for snapshots, of a complete record differ in number of rows."""
    if not file.attrs.get("complete", False):
        return
    for name in ("particles", "energy", "cracks", "laws", *(f"histories/{name}" for name in file.get("histories", {}))):
        if len(_rows(file.get(name, {}))) > 1:
            raise RecordError([f"{file.filename}: is damaged: {name} has columns of different lengths"])


def _rows(group: Mapping[str, h5py.HLObject]) -> set[int]:
    """The numbers of rows of the columns of a group."""
    return {len(column) for column in group.values() if hasattr(column, "shape")}


def finite(column: h5py.Dataset) -> np.ndarray:
    """The numbers of a column that every run records as finite.

    Raises RecordError for others.
    """
    values: np.ndarray = column[:]
    if not np.isfinite(values).all():
        row = int(np.argmin(np.isfinite(values.reshape(len(values), -1)).all(axis=1)))
        name = column.name.removeprefix("/")
        raise RecordError([f"{column.file.filename}: is damaged: {name} has a number that is not finite in row {row}"])
    return values


def increasing(times: h5py.Dataset) -> np.ndarray:
    """The times of a column, each later than the one before; raises RecordError for others, also for infinite ones."""
    values = finite(times)
    if values.ndim != 1 or not np.all(np.diff(values) > 0.0):
        raise RecordError([f"{times.file.filename}: is damaged: the times in {times.name[1:]} do not increase"])
    return values


def history_of(group: h5py.Group, quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Times (k,) in s and values (k, …) of a history; of an interrupted run up to where both were written.

    Raises CaseError for an empty one, RecordError for numbers that are not finite, and as `increasing`.
    """
    time, values = increasing(group["time"]), finite(group[quantity])
    count = min(len(time), len(values))
    if count == 0:
        raise CaseError([f"{group.file.filename}: has no samples yet; a run that was interrupted can be resumed"])
    return time[:count], values[:count]


def has_monitors(path: Path) -> bool:
    """Whether a record has histories."""
    with open_record(path) as file:
        return len(file.get("histories", {})) > 0


def is_line(size: Sequence[float]) -> bool:
    """Whether a scene of this size, (2,) m, has no height, as a bar."""
    return not size[1] > 0.0


def place_in_words(place: Sequence[float], size: Sequence[float]) -> str:
    """A position (2,) m as text; in a scene of size (2,) m without height only x, with millimetres."""
    return f"{place[0]:.4g} m" if is_line(size) else "({:.2f}, {:.2f}) m".format(*place)


def require_run(file: h5py.File) -> None:
    """Raise CaseError for an open record of only histories, which were computed without stepping particles."""
    if "particles" not in file and "histories" in file:
        raise CaseError([f"{file.filename}: has only histories, like those of `dembound exact` and `dembound respond`"])


class Snapshots(Sequence["h5py.Group"]):
    """All snapshots of an open record in the order of time, sorted by number: HDF5 lists 10000 before 1001.

    Each is checked for damage when it is first used, and has as many rows in each column as the record has particles.
    names : of all snapshots, in this order, if known; listing them takes 2 µs each.
    """

    def __init__(self, file: h5py.File, names: list[str] | None = None) -> None:
        self._file = file
        path = Path(file.filename)
        self._is_own = path.is_file() and state_of(path) in _own
        own: Mapping[str, h5py.Group] = file.get("snapshots", {})
        self._members = own if self._is_own else Members(file, "snapshots")
        self.names = sorted(self._members, key=int) if names is None else names
        self._particles: set[int] = _rows(file.get("particles", {})) if file.attrs.get("complete", False) else set()

    @overload
    def __getitem__(self, number: int) -> h5py.Group: ...

    @overload
    def __getitem__(self, number: slice) -> list[h5py.Group]: ...

    def __getitem__(self, number: int | slice) -> h5py.Group | list[h5py.Group]:
        if isinstance(number, slice):
            return [self._group(name) for name in self.names[number]]
        if not -len(self) <= number < len(self):
            there = f"they are 0 to {len(self) - 1}" if self.names else "there are none"
            raise NumberMissingError([f"{self._file.filename}: has no snapshot {number}, {there}"])
        return self._group(self.names[number])

    def __len__(self) -> int:
        return len(self.names)

    def _group(self, name: str) -> h5py.Group:
        """A snapshot; raises RecordError as `Members`, and for columns of different lengths in a complete record."""
        group = self._members[name]
        if self._particles and not self._is_own and len(self._particles | _rows(group)) > 1:
            raise RecordError([f"{self._file.filename}: is damaged: snapshots/{name} has columns of different lengths"])
        return group


def snapshots_of(file: h5py.File, *, required: bool = False) -> Snapshots:
    """All snapshots of an open record.

    Raises CaseError when one is required and there is none.
    """
    if required:
        require_run(file)
    found = Snapshots(file)
    if required and len(found) == 0:
        raise CaseError([f"{file.filename}: has no snapshots, run with output.snapshots above 0"])
    return found


def snapshot_of(file: h5py.File, number: int) -> h5py.Group:
    """A snapshot of an open record by its number; negative ones count from the last.

    Raises CaseError when there is no such snapshot.
    """
    return snapshots_of(file, required=True)[number]


def datasets_in(group: h5py.Group) -> dict[str, h5py.Dataset]:
    """All datasets of a group by name, also those of groups within it, such as ``contacts/bonded``."""
    import h5py

    found: dict[str, h5py.Dataset] = {}

    def note(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            found[name] = item

    group.visititems(note)
    return found


def cracks_until(file: h5py.File, time: float) -> dict[str, np.ndarray]:
    """The bonds of an open record that have broken at a time in s, including those of the static stage.

    Columns time (k,) s, position (k, 2) m, particles (k, 2), shear (k,) bool, in the order the bonds broke.
    """
    return until({name: dataset[:] for name, dataset in file["cracks"].items()}, time)


def until(cracks: dict[str, np.ndarray], time: float) -> dict[str, np.ndarray]:
    """The cracks before a time in s, with the columns of `cracks_until`."""
    broken = cracks["time"] <= time
    return {name: column[broken] for name, column in cracks.items()}


def laws_in_words(laws: Sequence[tuple[str, float]]) -> str:
    """The laws of a run, each with the time in s it began at, such as "elastic law to 0.012 s, then linearpbond"."""
    (first, _), *later = laws
    return f"{first} law" + ("".join(f" to {time:.3g} s, then {name}" for name, time in later) or " all through")


def laws_of(file: h5py.File) -> list[tuple[str, float]]:
    """The laws of an open record, each with the time in s it began at; none if the run was interrupted before."""
    if "laws" not in file:
        return []
    return list(zip(file["laws/name"].asstr()[:], file["laws/time"][:].tolist(), strict=True))


def energy_of(file: h5py.File) -> dict[str, np.ndarray]:
    """The energy ledger of an open record: its columns (k,) by name, time in s and energies in J per metre (a bar: J).

    Another column, relative_error, is the error over the energy supplied in the whole run: the kinetic energy at the
    start, plus the largest energy supplied up to any time by boundaries with driven loads, plus that by steady loads.
    The work of the forces that balance a settled stress and the energy absorbed by boundaries are not included, as both
    also grow in an unstable run.

    Raises CaseError when there is no entry, RecordError for the ledger of an earlier version, and as `finite`.
    """
    if "energy" not in file:
        require_run(file)
    columns = {name: finite(item) for name, item in datasets_of(file["energy"]).items()} if "energy" in file else {}
    if not any(map(len, columns.values())):
        raise CaseError([f"{file.filename}: has no entries in its energy ledger"])
    if missing := [name for name in ("time", "error", "supplied") if name not in columns]:
        lacks = f"its energy ledger has no {', '.join(missing)}"
        raise RecordError([f"{file.filename}: is of another version of dembound, {lacks}; run the case anew"])
    scale = float(columns["supplied"][-1])
    columns["relative_error"] = columns["error"] / scale if scale > 0.0 else np.zeros_like(columns["error"])
    return columns


def side_energies_of(file: h5py.File) -> dict[str, dict[str, np.ndarray]]:
    """Energies (k,) at every side of an open record that came in, were absorbed, and are stored in springs."""
    sides = file.get("energy/sides", {})
    return {side: {name: finite(dataset) for name, dataset in group.items()} for side, group in sides.items()}


def record_names(paths: Sequence[Path]) -> list[str]:
    """A name for each record, for legends: of its case or, where names are equal, of its folder, or else its path."""
    names = []
    for path in paths:
        with open_record(path) as file:
            names.append(text_of(file.attrs["name"]))
    folders = [path.resolve().parent.name for path in paths]
    return [
        name if names.count(name) == 1 else folder if folders.count(folder) == 1 else str(path)
        for name, folder, path in zip(names, folders, paths, strict=True)
    ]


def walls_at(file: h5py.File, time: float, exaggerate: float = 1.0) -> dict[str, np.ndarray]:
    """Points (p, 2) m of the walls of an open record at a time (s), by name, with displacements times `exaggerate`."""
    found = {}
    for name, group in file.get("walls", {}).items():
        moved = np.zeros(2)
        if len(group["time"]) > 0:
            moved = np.array([np.interp(time, group["time"][:], column) for column in group["displacement"][:].T])
        found[name] = group["points"][:] + exaggerate * moved
    return found
