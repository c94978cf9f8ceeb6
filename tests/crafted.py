"""Results that no run has written: links, cycles, wrong types, shapes and numbers, missing parts, absurd sizes."""

import json
import random
import shutil
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import h5py
import numpy as np

HUGE = 2**38
"""Number of rows for which no machine has the memory, and no file the bytes."""

TEXTS = ("", "x", "\x1b[2J", "nul\ud800", "[run\n", "{", "[]", "null", "[[[[", '{"a": NaN}', "9" * 5000, "é" * 300)


def crafted(folder: Path, draw: random.Random) -> str:
    """Change the copy of a folder of results in up to three ways; returns what was done."""
    done = []
    for _ in range(draw.choice((1, 1, 1, 2, 3))):
        records = sorted(folder.rglob("*.h5"))
        others = sorted([*folder.rglob("*.json"), *folder.rglob("*.npz")])
        path = draw.choice(others) if others and draw.random() < 0.2 else draw.choice(records)
        change = draw.choice(CHANGES if path.suffix == ".h5" else FILES)
        try:
            done.append(f"{path.relative_to(folder)}: {change.__name__} {change(path, draw)}")
        except (
            LookupError,
            OSError,
            TypeError,
            ValueError,
            RuntimeError,
        ) as error:
            done.append(f"{change.__name__} failed: {type(error).__name__}")
    return "; ".join(done)


def _note(found: list[str], name: str, inner: str) -> None:
    found.append(f"{name}/{inner}")


def some(file: h5py.File, draw: random.Random, kind: type | None = None) -> str:
    """The path of a group or dataset, those near the root as often as all others."""
    found: list[str] = []
    for name in file:
        found += [name] * (draw.random() < 0.5)
        if file.get(name, getlink=True).__class__ is h5py.HardLink and isinstance(file[name], h5py.Group):
            file[name].visit(partial(_note, found, name))
    fitting = [path for path in found if kind is None or isinstance(file.get(path), kind)]
    return draw.choice(fitting or sorted(file))


def linked(path: Path, draw: random.Random) -> str:
    """A link of any kind in place of something, or beside it."""
    with h5py.File(path, "a") as file:
        place = some(file, draw)
        if draw.random() < 0.5:
            place = f"{place.rpartition('/')[0]}/link".lstrip("/")
        elif place in file:
            del file[place]
        target: Any = draw.choice(
            [
                h5py.SoftLink("/"),
                h5py.SoftLink("/nowhere"),
                h5py.SoftLink(f"/{place}"),
                h5py.SoftLink("/snapshots/0000/displacement"),
                h5py.ExternalLink("/etc/passwd", "/"),
                h5py.ExternalLink(path.name, "/"),
                file["/"],
                file[some(file, draw)],
            ]
        )
        file[place] = target
        return f"{place} -> {getattr(target, 'path', getattr(target, 'name', ''))}"


def retyped(path: Path, draw: random.Random) -> str:
    """A dataset of another type or shape, or a group in its place."""
    with h5py.File(path, "a") as file:
        place = some(file, draw)
        old = file[place]
        values = old[()] if isinstance(old, h5py.Dataset) else np.zeros(3)
        del file[place]
        rows = max(1, len(values)) if getattr(values, "ndim", 0) else 1
        made: dict[str, Callable[[], Any]] = {
            "group": lambda: file.create_group(place),
            "scalar": lambda: file.create_dataset(place, data=1.0),
            "text": lambda: file.create_dataset(place, data=["a"] * rows),
            "bytes": lambda: file.create_dataset(place, data=np.full(rows, b"\xff\xfe", "S2")),
            "integers": lambda: file.create_dataset(place, data=np.arange(rows)),
            "wide": lambda: file.create_dataset(place, data=np.zeros((rows, 7))),
            "one more": lambda: file.create_dataset(place, data=np.zeros((rows + 1, *np.shape(values)[1:]))),
            "transposed": lambda: file.create_dataset(place, data=np.asarray(values).T),
            "no rows": lambda: file.create_dataset(place, data=np.zeros((0, *np.shape(values)[1:]))),
            "nan": lambda: file.create_dataset(place, data=np.full(np.shape(values), np.nan)),
            "large": lambda: file.create_dataset(place, data=np.full(np.shape(values), 1e300)),
            "far": lambda: file.create_dataset(place, data=np.full(np.shape(values), 2**40)),
            "negative": lambda: file.create_dataset(place, data=np.full(np.shape(values), -7)),
            "compound": lambda: file.create_dataset(place, data=np.zeros(rows, [("x", "f8"), ("y", "f8")])),
            "complex": lambda: file.create_dataset(place, data=np.zeros(rows, complex)),
            "references": lambda: file.create_dataset(place, data=[file.ref] * rows, dtype=h5py.ref_dtype),
            "lists": lambda: file.create_dataset(place, shape=(rows,), dtype=h5py.vlen_dtype(np.float64)),
            "empty": lambda: file.create_dataset(place, data=h5py.Empty("f8")),
            "named type": lambda: file.__setitem__(place, np.dtype("f8")),
        }
        name = draw.choice(sorted(made))
        made[name]()
        return f"{place} as {name}"


def swollen(path: Path, draw: random.Random) -> str:
    """A dataset without data, in another file, or much larger than the file."""
    with h5py.File(path, "a") as file:
        place = some(file, draw, h5py.Dataset)
        width = np.shape(file[place])[1:]
        del file[place]
        shape = (HUGE, *width)
        part = (1024, *width)
        layout = h5py.VirtualLayout((HUGE, *width), "f8")
        name = draw.choice(
            ("contiguous", "chunked", "zeros", "one chunk", "virtual", "external", "long text", "filter")
        )
        if name == "contiguous":
            file.create_dataset(place, shape, "f8", fillvalue=1.0)
        elif name == "chunked":
            file.create_dataset(place, shape, "f8", chunks=part)
        elif name == "zeros":
            file.create_dataset(place, (3_000_000, *width), "f8", chunks=(100_000, *width), compression="gzip")[:] = 0.0
        elif name == "one chunk":
            file.create_dataset(place, (100, *width), "f8", maxshape=(None, *width), chunks=(2**24, *width))
        elif name == "virtual":
            layout[: 2**20] = h5py.VirtualSource(str(path.name), "/histories", shape=(2**20, *width))
            file.create_virtual_dataset(place, layout, fillvalue=0.0)
        elif name == "external":
            file.create_dataset(place, (1000,), "u1", external=[("/etc/passwd", 0, 1000)])
        elif name == "long text":
            file.create_dataset(place, (3,), f"S{2**31 - 8}", chunks=(1,), compression="gzip")
        else:
            file.create_dataset(place, data=np.arange(1000.0), compression="lzf")
        return f"{place} {name}"


def spread(path: Path, draw: random.Random) -> str:
    """Very many groups, or groups very deep in each other."""
    with h5py.File(path, "a") as file:
        place = draw.choice(("histories", "snapshots", "boundaries", "choices", "runs", "more"))
        group = file.require_group(place)
        if draw.random() < 0.5:
            for number in range(2000):
                group.create_group(f"{number:05d}x")
            return f"2000 in {place}"
        for _ in range(draw.choice((12, 900))):
            group = group.create_group("g")
        return f"deep in {place}"


def removed(path: Path, draw: random.Random) -> str:
    """A record without one of its parts."""
    with h5py.File(path, "a") as file:
        place = some(file, draw)
        del file[place]
        return place


def one_changed(values: np.ndarray, draw: random.Random) -> tuple[np.ndarray, str]:
    """The numbers, of at least one row, with one of them changed, or with rows in another order."""
    new = np.array(values)
    flat, at = new.reshape(-1), draw.randrange(new.size)
    row, other = at // (new.size // len(new)), draw.randrange(len(new))
    name = draw.choice(
        ["nan", "inf", "minus inf", "huge", "tiny", "negative", "one more", "one less", "swap", "repeat"]
    )
    if name == "swap":
        new[[row, other]] = new[[other, row]]
    elif name == "repeat":
        new[other:] = new[other]
    else:
        old = float(flat[at])
        found = {
            "nan": np.nan, "inf": np.inf, "minus inf": -np.inf, "huge": 1e300, "tiny": 1e-300,
            "negative": -old or -1.0, "one more": old + 1.0, "one less": old - 1.0,
        }[name]  # fmt: skip
        if new.dtype.kind == "f":
            flat[at] = found
        else:
            limits = (0, 1) if new.dtype.kind == "b" else (np.iinfo(new.dtype).min, np.iinfo(new.dtype).max)
            flat[at] = int(min(max(limits[0], np.nan_to_num(found, nan=limits[1])), limits[1] // 2 + 1))
    return new, f"{name} at {at}"


def miscounted(path: Path, draw: random.Random) -> str:
    """Change one number of a dataset, or the order of its rows; returns the change in words."""
    with h5py.File(path, "a") as file:
        place = some(file, draw, h5py.Dataset)
        item = file[place]
        if not isinstance(item, h5py.Dataset) or item.dtype.kind not in "iufb" or item.size == 0:
            return f"{place} left"
        values, how = one_changed(np.atleast_1d(item[()]), draw)
        item[...] = values.reshape(item.shape)
        return f"{place} {how}"


def misdescribed(path: Path, draw: random.Random) -> str:
    """An attribute anywhere that is another number, of another type, or none."""
    with h5py.File(path, "a") as file:
        found: list[Any] = [file] * bool(file.attrs)
        file.visititems(lambda _, item: found.append(item) if len(item.attrs) > ("unit" in item.attrs) else None)
        item = draw.choice(found)
        key = draw.choice(sorted(item.attrs))
        value = np.asarray(item.attrs[key])
        if draw.random() < 0.1:
            del item.attrs[key]
            return f"{item.name} {key} gone"
        if value.dtype.kind in "iufb" and value.size > 0 and draw.random() < 0.6:
            new, how = one_changed(np.atleast_1d(value), draw)
            item.attrs[key] = new.reshape(value.shape)[()]
        else:
            values: list[Any] = [
                *TEXTS, "x", b"\xff\xfe", -1, 3, 2**62, 1.5, 1e308, True, [1.0, 2.0, 3.0], ["a", "b"], np.zeros((2, 2)),
                np.array(["a", "b"], "S1"), np.zeros(0), h5py.Empty("f8"), np.zeros(1, [("x", "f8")]),
            ]  # fmt: skip
            item.attrs[key] = made = draw.choice(values)
            how = f"= {made!r:.30}"
        return f"{item.name} {key} {how}"


def written(path: Path, draw: random.Random) -> str:
    """Another text in place of a file of JSON, or of an archive; or with one entry changed."""
    if path.suffix == ".json" and draw.random() < 0.7:
        tables = json.loads(path.read_text())
        key = draw.choice(sorted(tables))
        inner = tables[key]
        if isinstance(inner, dict) and inner and draw.random() < 0.5:
            tables, key = inner, draw.choice(sorted(inner))
        whole = json.loads(path.read_text())
        target = whole if tables is not inner else whole[next(k for k in whole if whole[k] == inner)]
        value = draw.choice([None, "x", -1, 1e308, [], {}, [{}], True])
        if isinstance(tables[key], int | float) and draw.random() < 0.5:
            value = draw.choice([tables[key] + 1, -tables[key], float("nan"), float("inf")])
        if draw.random() < 0.3:
            target.pop(key, None)
        else:
            target[key] = value
        path.write_text(json.dumps(whole))
        return f"{key} = {value!r}"
    text = draw.choice([*(each for each in TEXTS if each.isprintable()), "[" * 100_000, "\x00" * 10])
    path.write_bytes(text.encode("utf-8", "replace") if draw.random() < 0.8 else b"\xff\xfe\x00")
    return f"{text!r:.20}"


def repacked(path: Path, draw: random.Random) -> str:
    """An archive of arrays with one changed."""
    if path.suffix != ".npz":
        return written(path, draw)
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    name = draw.choice(sorted(arrays))
    if name == "facts":
        facts = json.loads(arrays[name].tobytes())
        key = draw.choice(sorted(facts))
        facts[key] = draw.choice([None, "x", -1, 1e308, [], {}, "[run\n", float("nan"), 2**70])
        arrays[name] = np.frombuffer(json.dumps(facts).encode(), np.uint8)
        name = f"fact {key}"
    else:
        if arrays[name].size > 0 and arrays[name].dtype.kind in "iufb" and draw.random() < 0.6:
            values, how = one_changed(np.atleast_1d(arrays[name]), draw)
            arrays[name] = values.reshape(arrays[name].shape)
            np.savez(path, **arrays)
            return f"{name} {how}"
        change = draw.choice((lambda a: a[None], lambda a: a.ravel()[:0], lambda a: a.astype("S4"), lambda a: None))
        arrays[name] = change(arrays[name])
    kept = {name: values for name, values in arrays.items() if values is not None}
    (np.savez_compressed if draw.random() < 0.2 else np.savez)(path, **kept)
    return name


CHANGES = (
    linked, retyped, retyped, swollen, spread, removed,
    misdescribed, misdescribed, misdescribed, miscounted, miscounted, miscounted,
)  # fmt: skip
FILES = (written, repacked)


def copied(source: Path, target: Path) -> Path:
    """A fresh copy of a folder of results."""
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(source, target)
    return target
