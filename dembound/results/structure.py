"""What a file must be like before anything is read from it as a record: built like one, and of bounded size.

A file may come from anywhere. HDF5 lets it refer to other files, contain itself, or declare petabytes that are nowhere;
a record does none of this, and has its columns in known shapes.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from dembound.errors import RecordError
from dembound.interrupts import look

if TYPE_CHECKING:
    import h5py

DEEPEST = 10
"""Largest number of groups within each other; those of a record are at most five."""

MOST_OBJECTS = 2_000_000
"""Largest number of groups, datasets and attributes."""

UNWRITTEN = 2**20
"""Bytes that a dataset may declare beyond those that it has in the file."""

LARGEST_CHUNK = 2**26
"""Bytes of a chunk, each of which is read as a whole."""

EXPANDED, SMALL = 50, 2**26
"""All datasets of a file may declare `SMALL` bytes plus so many for each byte of the file, as some are compressed."""

RUN_LINK = re.compile(r"/runs/([0-9a-f]+)")
"""Path of the links from the choices of a chart to their runs, as versions before this one wrote them."""

NUMBERS, TEXTS = "iufb", "SO"
"""Kinds of types."""

Shapes = Mapping[str, tuple[int, ...]]

COLUMNS: Mapping[str, Shapes] = {
    "particles": {"position": (2,), "radius": (), "brick_particle": (), "bonds": (), "column": (), "volume": ()},
    "continuum": {"position": (2,), "absorbs": (), "cell": (4,), "element": (4,), "surface": (4,), "tie": (2,)},
    "histories/[^/]+": {"time": (), "displacement": (3,), "velocity": (3,), "stress": ()},
    "boundaries/[^/]+": {
        "particle": (),
        "position": (2,),
        "diameter": (),
        "peak_velocity": (3, 2),
        "time": (),
        "displacement": (3,),
        "force": (2,),
    },
    "snapshots/[^/]+": {"displacement": (3,), "velocity": (3,), "coordination": (), "unbalanced": (2,), "damage": ()},
    "cracks": {"time": (), "position": (2,), "particles": (2,), "shear": ()},
    "laws": {"time": ()},
    "static(/before)?": {"displacement": (3,)},
}
"""Columns of the groups of a run's record, and the shape of a row of each."""

ATTRIBUTES: Mapping[str, tuple[str, tuple[int, ...]]] = {
    **{name: (TEXTS, ()) for name in ("name", "title", "case", "keys", "kind", "version")},
    **{name: (NUMBERS, ()) for name in ("time_step", "step_limit", "steps", "regular_steps", "complete")},
    "size": (NUMBERS, (2,)),
}
"""Attributes of a run's record, with their types and shapes."""


def require_structure(file: h5py.File, size: int) -> None:
    """Raise RecordError for a file that is not built like a record; size : of the file, bytes.

    No link of any kind is followed, and nothing is visited twice. Every group, dataset and attribute is opened once, as
    methods such as ``items`` leave out damaged ones, so this raises what h5py raises for them, too.
    """
    from h5py import h5a, h5d

    objects, declared = 0, 0
    is_run = "histories" in file and "runs" not in file
    for name, item in _items(file):
        count = h5a.get_num_attrs(item)
        objects += 1 + count
        if objects > MOST_OBJECTS:
            raise _refused(file, "", f"has more than {MOST_OBJECTS:,} groups, datasets and attributes")
        if count:
            _require_attributes(file, name, item, size, is_run and name == "")
        if isinstance(item, h5d.DatasetID):
            shape, dtype = item.shape, item.dtype
            declared += _bytes_declared(file, name, item, shape, dtype)
            if declared > SMALL + EXPANDED * size:
                raise _refused(file, "", f"declares {declared:,} bytes of numbers in {size:,} bytes")
            if is_run:
                _require_column(file, name, shape, dtype)


def run_of(group: h5py.Group) -> str:
    """The digest under which the run of a choice of a chart is recorded; of earlier versions it is in a link."""
    if "digest" in group.attrs:
        return str(group.attrs["digest"])
    link = group.get("run", getlink=True)
    return str(getattr(link, "path", "")).rsplit("/", 1)[-1]


def _items(file: h5py.File) -> Iterator[tuple[str, Any]]:
    """The file itself, and all groups and datasets in it, as h5py's identifiers, by their paths.

    These take a third of the time that its groups and datasets take.
    """
    from h5py import h5d, h5g, h5l, h5o

    seen: set[int] = set()
    waiting: list[tuple[str, Any]] = [("", h5o.open(file.id, b"/"))]
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
            found: list[tuple[bytes, int]] = []
            item.links.iterate(lambda inner, info, found=found: found.append((inner, info.type)), info=True)
            for inner, kind in found:
                text = inner.decode("utf-8", "surrogateescape")
                path = f"{name}/{text}" if name else text
                if kind == h5l.TYPE_HARD or not _is_of_chart(file, path):
                    waiting.append((path, h5o.open(item, inner)))
        elif not isinstance(item, h5d.DatasetID):
            raise _refused(file, name, "is neither a group nor a dataset")


def _is_of_chart(file: h5py.File, path: str) -> bool:
    """Whether a link is one from a choice of an earlier chart to its run; raises RecordError for any other."""
    import h5py

    link = file.get(path, getlink=True)
    if type(link) is h5py.SoftLink and path.startswith("choices/") and RUN_LINK.fullmatch(str(link.path)):
        return True
    raise _refused(file, path, "is a link, of which a record has none")


def _require_attributes(file: h5py.File, name: str, item: Any, size: int, is_header: bool) -> None:
    """Raise RecordError for an attribute of a type that none has, or, in the header of a run, of another type."""
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
            kinds, wanted = ATTRIBUTES[key]
            if dtype.kind not in kinds or shape != wanted:
                raise _refused(file, where, f"must be {'text' if kinds == TEXTS else _numbers(wanted)}")
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


def _refused(file: h5py.File, where: str, why: str) -> RecordError:
    return RecordError([f"{file.filename}: is no record of dembound: {f'{where}: ' if where else ''}{why}"])
