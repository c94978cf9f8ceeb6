"""VTU files: unstructured grids of VTK, with their arrays compressed and appended to the XML as they are.

The quickest level of compression takes a third of the time of the usual one, and the files are a few per cent larger.
"""

import zlib
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from dembound.motion.mesh import Mesh
from dembound.results.reader import replacing

LEVEL = 1
"""Level of compression, the quickest."""

CELL_TYPES = {1: 1, 2: 3}
"""Number of points of a cell -> VTK's number of its type: vertex, line."""

NAMES = {"i": "Int", "u": "UInt", "f": "Float"}
"""Kind of a numpy type -> name of VTK's type, before its number of bits."""


def write_mesh(path: Path, mesh: Mesh) -> None:
    """Write a VTU file, either completely or not at all."""
    root = ElementTree.Element(
        "VTKFile",
        type="UnstructuredGrid",
        version="1.0",
        byte_order="LittleEndian",
        header_type="UInt64",
        compressor="vtkZLibDataCompressor",
    )
    grid = ElementTree.SubElement(root, "UnstructuredGrid")
    sizes = {"NumberOfPoints": str(len(mesh.points)), "NumberOfCells": str(len(mesh.cells))}
    piece = ElementTree.SubElement(grid, "Piece", sizes)
    appended = bytearray()
    for section, arrays in (
        ("Points", {"Points": mesh.points}),
        ("Cells", _cells(mesh.cells)),
        ("PointData", mesh.point_data),
        ("CellData", mesh.cell_data),
    ):
        element = ElementTree.SubElement(piece, section)
        for name, values in arrays.items():
            element.append(_described(name, values, len(appended)))
            appended += _block(values)
    head, end, _ = ElementTree.tostring(root, encoding="unicode").rpartition("</VTKFile>")
    with replacing(path) as part:
        part.write_bytes(
            f'<?xml version="1.0"?>\n{head}<AppendedData encoding="raw">_'.encode()
            + bytes(appended)
            + f"\n</AppendedData>{end}\n".encode()
        )


def _cells(cells: np.ndarray) -> dict[str, np.ndarray]:
    """Cells (m, k) as VTK's arrays: the points of all, where those of each end, their types."""
    count, points = cells.shape
    return {
        "connectivity": cells.ravel(),
        "offsets": np.arange(1, count + 1) * points,
        "types": np.full(count, CELL_TYPES[points], np.uint8),
    }


def _described(name: str, values: np.ndarray, offset: int) -> ElementTree.Element:
    """The element of an array whose block begins `offset` bytes into the appended data."""
    about = {
        "type": f"{NAMES[values.dtype.kind]}{8 * values.dtype.itemsize}",
        "Name": name,
        "format": "appended",
        "offset": str(offset),
    }
    if values.ndim > 1:
        about["NumberOfComponents"] = str(values.shape[1])
    return ElementTree.Element("DataArray", about)


def _block(values: np.ndarray) -> bytes:
    """An array as one compressed block: the number of blocks, their size, that of a shorter last one, the packed size.

    Sizes are in bytes; an array without values has no block.
    """
    if values.size == 0:
        return np.zeros(3, "<u8").tobytes()
    plain = values.astype(values.dtype.newbyteorder("<"), copy=False).tobytes()
    packed = zlib.compress(plain, LEVEL)
    return np.array([1, len(plain), 0, len(packed)], "<u8").tobytes() + packed
