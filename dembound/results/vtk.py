"""Snapshots for ParaView: a VTU file each, or all in one VTKHDF file."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, nullcontext
from hashlib import blake2b
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from dembound.casefile.tables import ParaView
from dembound.files import make_folder, replacing, replacing_by_name, write_text
from dembound.interrupts import look
from dembound.motion.kind import Kind
from dembound.motion.state import Arrays
from dembound.results.committed import new_file
from dembound.results.datasets import CHUNK_BYTES, chunk_rows, extend
from dembound.results.new_record import MOTION, UNBALANCED
from dembound.results.pieces import PIECE, pieces_at
from dembound.results.reader import cracks_until, datasets_in, open_record, snapshots_of, until, walls_at

if TYPE_CHECKING:
    import h5py
    import meshio

VERSION = (2, 0)
"""Version of the format."""

CELL_TYPES = {"vertex": 1, "line": 3, "quad": 9}
"""VTK's numbers of the types of cells."""

NAMES = {"coordination": "coordNumber"}
"""Names in ParaView of fields that have others in a record."""

PRECISION = {"f": np.float32, "i": np.int32, "b": np.uint8}
"""Types of fields for ParaView, by the kind of those in a record."""

PART_SIZES = ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds")


class TemporalFile:
    """Writes meshes of one cell block, all with the same arrays, into an open file.

    Parameters
    ----------
    file : a new HDF5 file.
    """

    def __init__(self, file: h5py.File) -> None:
        self._root = file.create_group("VTKHDF")
        self._root.attrs["Version"] = VERSION
        self._root.attrs["Type"] = np.bytes_("UnstructuredGrid")  # of fixed length, VTK reads no other text
        self._begun: dict[str, tuple[bytes, int]] = {}
        self._parts: list[tuple[int, int, int]] = []
        self._cells: tuple[bytes, dict[str, int]] = b"", {}
        self._tables: dict[str, list[float]] = defaultdict(list)
        self._rows: dict[str, int] = defaultdict(int)  # so far, written or kept
        self._kept: dict[str, list[np.ndarray]] = defaultdict(list)

    def append(self, time: float, mesh: meshio.Mesh) -> None:
        """Append a mesh at a time in s."""
        rows = self._cells_of(mesh) | {"PointOffsets": self._row("Points", mesh.points)}
        for name, values in mesh.point_data.items():
            rows[f"PointDataOffsets/{name}"] = self._row(f"PointData/{name}", values)
        for name, (values,) in mesh.cell_data.items():
            rows[f"CellDataOffsets/{name}"] = self._row(f"CellData/{name}", values)
        for name, row in rows.items():
            self._tables[name].append(row)
        self._tables["Values"].append(time)

    def finish(self) -> None:
        """Write buffered values, sizes and tables, without which the file cannot be read."""
        for name in list(self._kept):
            self._write(name)
        for name, sizes in zip(PART_SIZES, zip(*self._parts, strict=True), strict=True):
            self._root[name] = np.array(sizes, dtype=np.int64)
        steps = self._root.create_group("Steps")
        steps.attrs["NSteps"] = len(self._tables["Values"])
        for name, column in self._tables.items():
            steps[name] = np.array(column, dtype=np.float64 if name == "Values" else np.int64)

    def _cells_of(self, mesh: meshio.Mesh) -> dict[str, int]:
        """The tables' rows for the cells of a mesh; cells that equal the step before are not written again."""
        block = mesh.cells[0]
        (count, corners), ids = block.data.shape, block.data.ravel().astype(np.int64)
        sizes = (len(mesh.points), count, len(ids))
        same = _digest(np.append(ids, sizes))
        if self._cells[0] != same:
            self._extend("Offsets", corners * np.arange(count + 1))  # one more than cells, from 0 in every part
            begun = {
                "PartOffsets": len(self._parts),
                "NumberOfParts": 1,
                "CellOffsets": self._extend("Types", np.full(count, CELL_TYPES[block.type], np.uint8)),
                "ConnectivityIdOffsets": self._extend("Connectivity", ids),
            }
            self._parts.append(sizes)
            self._cells = same, begun
        return self._cells[1]

    def _row(self, name: str, values: np.ndarray) -> int:
        """The row of a dataset at which values begin; values that equal the step before are not appended."""
        same = _digest(values)
        if name not in self._begun or self._begun[name][0] != same:
            self._begun[name] = same, self._extend(name, values)
        return self._begun[name][1]

    def _extend(self, name: str, values: np.ndarray) -> int:
        """Append values to a dataset; returns the row at which they begin. Several small ones are written at once."""
        begin, kept = self._rows[name], self._kept[name]
        kept.append(values)
        self._rows[name] += len(values)
        if sum(each.nbytes for each in kept) >= CHUNK_BYTES:
            self._write(name)
        return begin

    def _write(self, name: str) -> None:
        """Write the buffered values of a dataset."""
        values = np.concatenate(self._kept.pop(name))
        width = values.shape[1:]
        if name not in self._root:
            chunks = (chunk_rows(width, values.dtype, CHUNK_BYTES, len(values)), *width)
            shape, most = (0, *width), (None, *width)
            self._root.create_dataset(name, shape, values.dtype, chunks=chunks, maxshape=most)
        extend(self._root[name], values)


@contextmanager
def temporal_file(path: Path) -> Iterator[TemporalFile]:
    """A new VTKHDF file, which appears when all its meshes are written; raises OSError, such as for a full disk."""
    with new_file(path) as file:
        series = TemporalFile(file)
        yield series
        series.finish()


def _digest(values: np.ndarray) -> bytes:
    """A hash of an array, which differs between different arrays of one type and width."""
    return blake2b(np.ascontiguousarray(values).data).digest()


def write_paraview(run: Path, folder: Path, kind: Kind[Any, Any], files: ParaView = "vtu") -> None:
    """Write every snapshot of a run for ParaView, nothing for a run without snapshots, or if `files` is none.

    Parameters
    ----------
    run
        the ``run.h5`` of a run.
    folder
        created if it does not exist; receives ``particles_0000.vtu`` …, all with the digits of the last one, and
        ``particles.pvd``, or ``particles.vtkhdf``; ``view.py`` and, where bonds broke, ``cracks.vtu``; the same files
        for ``contacts``, ``walls`` and ``joints`` if the record has them; for a bar ``bar_0000.vtu`` … in place of
        ``particles``.
    kind
        the kind of body that the run is of.
    files
        formats that are written.

    PVD files are written last, so all files they list exist.

    Raises CaseError when the record cannot be read, OSError or RecordError when a file cannot be written.
    """
    if files == "none":
        return
    with open_record(run) as file:
        snapshots = {str(snapshot.name).rsplit("/", maxsplit=1)[-1]: snapshot for snapshot in snapshots_of(file)}
        if not snapshots:
            return
        digits = max(map(len, snapshots))
        make_folder(folder)
        particles = {name: dataset[:] for name, dataset in file["particles"].items()}
        particles |= {f"continuum/{name}": dataset[:] for name, dataset in file.get("continuum", {}).items()}
        cracks = cracks_until(file, np.inf)
        with ExitStack() as stack:
            series: dict[str, Callable[[str, float, meshio.Mesh], None]] = {}
            for number, snapshot in snapshots.items():
                look()
                time = float(snapshot.attrs["time"])
                fields = {name: dataset[:] for name, dataset in datasets_in(snapshot).items()}
                fields |= {f"walls/{name}": points for name, points in walls_at(file, time).items()}
                if (pieces := pieces_at(file, time)) is not None:
                    fields[PIECE] = pieces
                for name, mesh in kind.meshes(particles, fields, until(cracks, time)).items():
                    if name not in series:
                        series[name] = stack.enter_context(_series(folder, name, files))
                    series[name](number.zfill(digits), time, mesh)
        if len(cracks["time"]) > 0:
            data = {"time": cracks["time"], "mode": cracks["shear"].astype(int), "particles": cracks["particles"]}
            _write(folder / "cracks.vtu", vertices(in_space(cracks["position"]), data))
    write_text(folder / "view.py", kind.view_script)


@contextmanager
def _series(folder: Path, name: str, files: ParaView) -> Iterator[Callable[[str, float, meshio.Mesh], None]]:
    """A function that writes one mesh of a series, given its number and time (s), as VTU or to the VTKHDF file.

    The PVD file is written at the end.
    """
    times: dict[str, float] = {}
    with temporal_file(folder / f"{name}.vtkhdf") if files != "vtu" else nullcontext() as all_in_one:

        def append(number: str, time: float, mesh: meshio.Mesh) -> None:
            if files != "vtkhdf":
                _write(folder / f"{name}_{number}.vtu", mesh)
                times[f"{name}_{number}.vtu"] = time
            if all_in_one is not None:
                all_in_one.append(time, mesh)

        yield append
    if files != "vtkhdf":
        _write_index(folder / f"{name}.pvd", times)


def vertices(points: np.ndarray, data: Arrays) -> meshio.Mesh:
    """One vertex per point (n, 3) m, with arrays (n, …) on them."""
    import meshio  # imported here, as commands that write no files need not wait for it

    return meshio.Mesh(points, [("vertex", np.arange(len(points), dtype=np.int32)[:, None])], point_data=dict(data))


def shown(fields: Arrays) -> dict[str, np.ndarray]:
    """Fields by name in the precision for ParaView: single, whole numbers in 32 bits, truth values in 8."""
    return {name: values.astype(PRECISION[values.dtype.kind], copy=False) for name, values in fields.items()}


def passed_through(snapshot: Arrays, group: str = "") -> dict[str, np.ndarray]:
    """Fields of a snapshot that are no motion, of all nodes of a group, for ParaView.

    They are those that `Part.snapshot` of a part gives. One number for each node remains a number, two are a vector,
    three are the xx, yy, xy of a symmetric tensor; what else a foreign record has is left out.
    """
    shapes: dict[tuple[int, ...], Callable[[np.ndarray], np.ndarray]] = {(): np.asarray, (2,): in_space, (3,): tensors}
    count = len(snapshot[f"{group}displacement"])
    own = {name.removeprefix(group): values for name, values in snapshot.items() if name.startswith(group)}
    return {
        NAMES.get(name, name): shapes[values.shape[1:]](values)
        for name, values in own.items()
        if "/" not in name and not name.endswith(MOTION) and name != UNBALANCED
        if values.shape[:1] == (count,) and values.shape[1:] in shapes and values.dtype.kind in PRECISION
    }


def tensors(stress: np.ndarray) -> np.ndarray:
    """Stresses (n, 3) xx, yy, xy as (n, 6), in VTK's order of symmetric tensors: xx, yy, zz, xy, yz, xz."""
    tensors = np.zeros((len(stress), 6))
    tensors[:, [0, 1, 3]] = stress
    return tensors


def _write(path: Path, mesh: meshio.Mesh) -> None:
    """Write a VTU file, either completely or not at all."""
    import meshio

    with replacing_by_name(path) as part:
        meshio.write(part, mesh, file_format="vtu", compression=None)


def in_space(vectors: np.ndarray, precision: type = np.float64) -> np.ndarray:
    """Vectors (n, 2) as (n, 3) with z = 0."""
    whole: np.ndarray = np.zeros((len(vectors), 3), precision)
    whole[:, :2] = vectors
    return whole


def _write_index(path: Path, times: dict[str, float]) -> None:
    """Write the PVD file: file name -> time in s."""
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1")
    collection = ElementTree.SubElement(root, "Collection")
    for name, time in times.items():
        ElementTree.SubElement(collection, "DataSet", timestep=repr(time), part="0", file=name)
    ElementTree.indent(root)
    with replacing(path) as file:
        ElementTree.ElementTree(root).write(file, encoding="utf-8", xml_declaration=True)
