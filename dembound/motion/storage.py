"""Bytes on disk, counted from the shapes of written arrays."""

from typing import NamedTuple

from dembound.casefile.output import ParaView

TEXT = 4.0 / 3.0
"""Bytes in a VTU file for each byte of data, as it is base64 text."""

POINT = 24.0
"""Bytes of a position, three doubles."""


class Storage(NamedTuple):
    """Bytes on disk of a scene.

    header : of data written once. snapshot : of a snapshot, in the record and in all files for ParaView.
    checkpoint : of a checkpoint, and of a settled state.
    """

    header: float
    snapshot: float
    checkpoint: float


def paraview_bytes(files: ParaView, vtu: float, vtkhdf: float) -> float:
    """Bytes of the requested files for ParaView, from the bytes of each format."""
    return vtu * (files in ("vtu", "both")) + vtkhdf * (files in ("vtkhdf", "both"))


def mesh_bytes(points: float, point_data: float, cells: float, corners: int, cell_data: float) -> float:
    """Bytes of a VTU file from numbers of points and cells, and the bytes of data for each.

    Cells have the numbers of their corners (4 bytes), where they end (4) and their types (8).
    """
    return TEXT * (points * (POINT + point_data) + cells * (4.0 * corners + 12.0 + cell_data))
