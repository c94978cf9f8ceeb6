"""All snapshots of a run in one file for ParaView: VTKHDF of the type ``UnstructuredGrid`` with ``Steps``.

The format is version 2.0 of the "VTKHDF format specification" (docs.vtk.org), which VTK 9.4 and later read. Datasets
have the values of all steps one after the other; tables in ``Steps`` have the time of every step and the rows at which
its points, cells and arrays begin. Values that equal the step before, such as cells, radii and ids, are not written
again but have the same row.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import blake2b
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dembound.results.committed import new_file
from dembound.results.datasets import CHUNK_BYTES, chunk_rows, extend

if TYPE_CHECKING:
    import h5py
    import meshio

VERSION = (2, 0)
"""Version of the format."""

CELL_TYPES = {"vertex": 1, "line": 3, "quad": 9}
"""VTK's numbers of the types of cells."""

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
