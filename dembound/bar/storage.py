"""Bytes on disk of a bar of n nodes with bonds of m lengths."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dembound.bar.ram import bonds_bytes
from dembound.motion.storage import POINT, Storage, mesh_bytes, paraview_bytes

if TYPE_CHECKING:
    from dembound.bar.scene import BarScene

CHANGING, CONSTANT = 32.0, 8.0
"""Bytes of the motion, stress and damage of a node for ParaView, and of the fields that remain."""


def storage_of(scene: BarScene) -> Storage:
    """Bytes on disk of the results of a bar."""
    nodes, lengths = float(scene.count), max(scene.case.method.largest_horizon, 1)
    output = scene.case.output
    vtu = mesh_bytes(1.0, CHANGING + CONSTANT + 4.0 * output.peaks, 1.0, 2, 4.0)
    header = 24.0 + paraview_bytes(output.paraview, 0.0, 36.0)  # positions, volumes; in the VTKHDF file what remains
    snapshot = 64.0 + paraview_bytes(output.paraview, vtu, POINT + CHANGING)
    return Storage(nodes * header, nodes * snapshot, 96.0 * nodes + bonds_bytes(nodes, lengths))
