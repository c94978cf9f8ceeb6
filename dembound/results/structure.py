"""Checks of a file before it is read as a record: structure, types and bounded size.

A file may come from anywhere. HDF5 lets it refer to other files, contain itself, or declare petabytes without data; a
record does none of this, and has its columns in known shapes.

The search takes 0.03 to 0.07 ms for each group, dataset and attribute, so minutes for thousands of snapshots. Groups of
snapshots are therefore searched when they are used, see `Members`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from dembound.casefile.tables import MOST_SNAPSHOTS
from dembound.errors import RecordError
from dembound.interrupts import look
from dembound.results.folder import DIGEST, PLACE

if TYPE_CHECKING:
    import h5py

DEEPEST = 10
"""Largest depth of nested groups; a record has at most five."""

MOST_OBJECTS = 50_000
"""Largest number of groups, datasets and attributes outside of members of `COLLECTIONS`.

A record has some 300, and for each monitor at most 30; a case has at most `casefile.cross_checks.MOST_MONITORS`."""

MOST_ATTRIBUTES = 500
"""Largest number of attributes of one group or dataset; the header of a run has 20."""

COLLECTIONS = {"snapshots": 100, "runs": MOST_OBJECTS, "choices": 100, "statistics": 100}
"""Groups with a member for each snapshot, run, choice or quantity, and the most groups, datasets and attributes in one.

A snapshot has at most 50, a choice of a chart 18, the statistics of a quantity 20, and a run of a chart 9 a monitor.
"""

MOST_MEMBERS = MOST_SNAPSHOTS + 1
"""Largest number of members of a collection; a static stage that stalled is one more snapshot."""

UNWRITTEN = 2**20
"""Bytes that a dataset may declare beyond those that it has in the file."""

LARGEST_CHUNK = 2**26
"""Bytes of a chunk, each of which is read as a whole."""

EXPANDED, SMALL = 50, 2**26
"""All datasets of a file may declare `SMALL` bytes plus `EXPANDED` for each byte of the file, as some are
compressed."""

RUN_LINK = re.compile(r"/runs/([0-9a-f]+)")
"""Path of the links from the choices of a chart to their runs, as versions before this one wrote them."""

NUMBERS, TEXTS = "iufb", "SO"
"""Kinds of types."""

Shapes = Mapping[str, tuple[int, ...]]

COLUMNS: Mapping[str, Shapes] = {
    "particles": {
        "position": (2,),
        **dict.fromkeys(("radius", "brick_particle", "bonds", "column", "layer", "volume"), ()),
    },
    "continuum": {"position": (2,), "absorbs": (), "cell": (4,), "element": (4,), "surface": (4,), "tie": (2,)},
    "histories/[^/]+": {"time": (), "displacement": (3,), "velocity": (3,), "stress": ()},
    "boundaries/[^/]+": {
        **dict.fromkeys(("particle", "diameter", "time"), ()),
        **{"position": (2,), "peak_velocity": (3, 2), "displacement": (3,), "force": (2,)},
    },
    "walls/[^/]+": {"points": (2,), "time": (), "displacement": (2,), "force": (2,)},
    "joints/[^/]+": {
        "points": (2,),
        **dict.fromkeys(("time", "slip", "opening", "pressure", "shear", "closed", "sliding"), ()),
    },
    "snapshots/[^/]+": {"displacement": (3,), "velocity": (3,), "coordination": (), "unbalanced": (2,), "damage": ()},
    "snapshots/[^/]+/joints": {
        "ends": (4,),
        "particles": (2,),
        **dict.fromkeys(("joint", "slip", "opening", "pressure", "shear", "state"), ()),
    },
    "cracks": {"time": (), "position": (2,), "particles": (2,), "shear": ()},
    "laws": {"time": ()},
    "static(/before)?": {"displacement": (3,)},
}
"""Columns of the groups of a run's record, and the shape of a row of each."""

ATTRIBUTES: Mapping[str, tuple[str, tuple[int, ...]]] = {
    **{name: (TEXTS, ()) for name in ("name", "title", "case", "keys", "kind", "version", PLACE, DIGEST)},
    **{name: (NUMBERS, ()) for name in ("time_step", "step_limit", "steps", "regular_steps", "complete")},
    "corner": (NUMBERS, (2,)),
    "size": (NUMBERS, (2,)),
}
"""Attributes of a run's record, with their types and shapes."""


def require_structure(file: h5py.File) -> None:
    """Raise RecordError for a file without the structure of a record; members of its collections are left out.

    No link of any kind is followed, and nothing is visited twice. Every group, dataset and attribute is opened once, as
    methods such as ``items`` leave out damaged ones; errors of h5py for damaged ones are passed on.
    """
    _search(file, "", MOST_OBJECTS, 0)


class Members(Mapping[str, "h5py.Group"]):
    """The groups in one of the `COLLECTIONS` of an open record, by name; each is searched when it is first used.

    Empty where the record has no such collection.
    """

    def __init__(self, file: h5py.File, collection: str) -> None:
        self._file, self._collection = file, collection
        self._group = file.get(collection, {})
        if hasattr(self._group, "dtype"):
            raise _refused(file, collection, "must be a group")
        self._links = frozenset(self._group)
        self._searched: set[str] = set()
        self._declared = 0

    def __getitem__(self, name: str) -> h5py.Group:
        """A member; raises KeyError if there is none, and RecordError as `require_structure`."""
        if name not in self._searched and name in self._links:  # a link that leads nowhere is no key of a group
            path = f"{self._collection}/{name}"
            self._declared = _search(self._file, path, COLLECTIONS[self._collection], self._declared)
            self._searched.add(name)
        return self._group[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._group)

    def __len__(self) -> int:
        return len(self._group)


def _search(file: h5py.File, start: str, most: int, declared: int) -> int:
    """Search a group and its contents; raises RecordError as `require_structure`.

    start : its path, empty for the whole file. most : groups, datasets and attributes. declared : bytes of all datasets
    that were searched before; returns them with those of this group.
    """
    from h5py import h5a, h5d

    objects, size = 0, file.id.get_filesize()
    is_run = "histories" in file and "runs" not in file
    for name, item in _items(file, start, most):
        count = h5a.get_num_attrs(item)
        if count > MOST_ATTRIBUTES:
            raise _refused(file, name, f"has more than {MOST_ATTRIBUTES:,} attributes")
        objects += 1 + count
        if objects > most:
            raise _crowded(file, start, most)
        if count:
            _require_attributes(file, name, item, size, is_run and name == "")
        if isinstance(item, h5d.DatasetID):
            shape, dtype = item.shape, item.dtype
            declared += _bytes_declared(file, name, item, shape, dtype)
            if declared > SMALL + EXPANDED * size:
                raise _refused(file, start, f"declares {declared:,} bytes of numbers in {size:,} bytes")
            if is_run:
                _require_column(file, name, shape, dtype)
    return declared


def _items(file: h5py.File, start: str, most: int) -> Iterator[tuple[str, Any]]:
    """A group, and all groups and datasets in it, as h5py's identifiers, by their paths.

    These take a third of the time that its groups and datasets take.
    """
    from h5py import h5d, h5g, h5l, h5o

    seen = {h5o.get_info(file.id).addr} if start else set()
    waiting: list[tuple[str, Any]] = [(start, h5o.open(file.id, start.encode("utf-8", "surrogateescape") or b"/"))]
    while waiting:
        name, item = waiting.pop()
        place = h5o.get_info(item).addr
        if place in seen:
            raise _refused(file, name, "is linked to more than once")
        seen.add(place)
        if name.count("/") >= DEEPEST:
            raise _refused(file, f"{name[:60]}…", f"is more than {DEEPEST} groups deep")
        yield name, item
        if isinstance(item, h5g.GroupID):
            look()
            if name in COLLECTIONS:
                places = _places_of_members(file, name, item)
                if places & seen:
                    raise _refused(file, name, "has a member that is linked to more than once")
                seen |= places
                continue
            for inner, kind, _ in _links(item, most):
                text = inner.decode("utf-8", "surrogateescape")
                path = f"{name}/{text}" if name else text
                if kind == h5l.TYPE_HARD or not _is_of_chart(file, path):
                    waiting.append((path, h5o.open(item, inner)))
            if len(waiting) > most:
                raise _crowded(file, start, most)
        elif not isinstance(item, h5d.DatasetID):
            raise _refused(file, name, "is neither a group nor a dataset")


def _links(group: Any, most: int) -> list[tuple[bytes, int, int]]:
    """The names of the links of a group, their types, and addresses they lead to; no more than one beyond `most`."""
    found: list[tuple[bytes, int, int]] = []

    def note(name: bytes, info: Any) -> bool | None:
        found.append((name, info.type, info.u))
        return True if len(found) > most else None  # which ends it

    group.links.iterate(note, info=True)
    return found


def _places_of_members(file: h5py.File, name: str, group: Any) -> set[int]:
    """The addresses of the members of a collection, none of which is opened."""
    from h5py import h5l

    links = _links(group, MOST_MEMBERS)
    if len(links) > MOST_MEMBERS:
        raise _refused(file, name, f"has more than {MOST_MEMBERS:,} members")
    for inner, kind, _ in links:
        if kind != h5l.TYPE_HARD:
            raise _refused(file, f"{name}/{inner.decode('utf-8', 'replace')}", "is a link, of which a record has none")
    places = {place for _, _, place in links}
    if len(places) < len(links):
        raise _refused(file, name, "has a member that is linked to more than once")
    return places


def _is_of_chart(file: h5py.File, path: str) -> bool:
    """Whether a link is one from a choice of an earlier chart to its run; raises RecordError for any other."""
    import h5py

    link = file.get(path, getlink=True)
    if type(link) is h5py.SoftLink and path.startswith("choices/") and RUN_LINK.fullmatch(str(link.path)):
        return True
    raise _refused(file, path, "is a link, of which a record has none")


def _require_attributes(file: h5py.File, name: str, item: Any, size: int, is_header: bool) -> None:
    """Raise RecordError for an attribute of an impossible type or, in the header of a run, of another type."""
    import numpy as np
    from h5py import h5a

    keys: list[bytes] = []
    h5a.iterate(item, keys.append)
    for each in keys:
        found, key = h5a.open(item, each), each.decode("utf-8", "surrogateescape")
        where, dtype, shape = f"{name}, attribute {key}".removeprefix(", "), found.dtype, found.shape
        if shape is None or dtype.itemsize * math.prod(shape) > size:
            raise _refused(file, where, "has no value")
        _require_plain(file, where, dtype)
        if is_header and key in ATTRIBUTES:
            kinds, permitted = ATTRIBUTES[key]
            if dtype.kind not in kinds or shape != permitted:
                raise _refused(file, where, f"must be {'text' if kinds == TEXTS else _numbers(permitted)}")
        if dtype.kind == "O":
            texts = np.empty(shape, dtype)
            found.read(texts)
            if shape == ():
                texts.item().decode()  # fails for bytes that are no text


def _bytes_declared(file: h5py.File, name: str, item: Any, shape: tuple[int, ...] | None, dtype: Any) -> int:
    """Bytes of the values of a dataset; raises RecordError for one that a record cannot have."""
    from h5py import h5d, h5z

    if shape is None:
        raise _refused(file, name, "has no values")
    _require_plain(file, name, dtype)
    made = item.get_create_plist()
    if made.get_layout() == h5d.VIRTUAL or made.get_external_count() > 0:
        raise _refused(file, name, "is in another file, to which no record refers")
    filters = {made.get_filter(number)[0] for number in range(made.get_nfilters())}
    if not filters <= {h5z.FILTER_DEFLATE, h5z.FILTER_SHUFFLE, h5z.FILTER_FLETCHER32}:
        raise _refused(file, name, "is compressed in a way that no record is")
    if made.get_layout() == h5d.CHUNKED and dtype.itemsize * math.prod(made.get_chunk()) > LARGEST_CHUNK:
        raise _refused(file, name, f"has chunks of more than {LARGEST_CHUNK:,} bytes")
    declared, stored = dtype.itemsize * math.prod(shape), item.get_storage_size()
    if h5z.FILTER_DEFLATE not in filters and declared > stored + UNWRITTEN:
        raise _refused(file, name, f"declares {declared:,} bytes, and has {stored:,}")
    return int(declared)


def _require_plain(file: h5py.File, where: str, dtype: Any) -> None:
    """Raise RecordError for a type that is neither that of numbers nor of texts."""
    import h5py

    if dtype.kind not in NUMBERS + TEXTS or (dtype.kind == "O" and h5py.check_string_dtype(dtype) is None):
        raise _refused(file, where, "is of a type that no record has, must be numbers or text")


def _require_column(file: h5py.File, name: str, shape: tuple[int, ...], dtype: Any) -> None:
    """Raise RecordError for a known column of a run that has another shape, or no numbers."""
    group, _, column = name.rpartition("/")
    for pattern, shapes in COLUMNS.items():
        if column in shapes and re.fullmatch(pattern, group):
            if dtype.kind not in NUMBERS or len(shape) == 0 or shape[1:] != shapes[column]:
                raise _refused(file, name, f"must have rows of {_numbers(shapes[column])}")
            return


def _numbers(shape: tuple[int, ...]) -> str:
    """A shape in words."""
    return f"{' × '.join(map(str, shape))} numbers" if shape else "one number"


def _crowded(file: h5py.File, where: str, most: int) -> RecordError:
    return _refused(file, where, f"has more than {most:,} groups, datasets and attributes")


def _refused(file: h5py.File, where: str, why: str) -> RecordError:
    return RecordError([f"{file.filename}: is no record of dembound: {f'{where}: ' if where else ''}{why}"])
