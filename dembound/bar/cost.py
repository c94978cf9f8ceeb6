"""What a run of a bar needs: RAM and bytes on disk."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dembound.casefile.bar.model import BarCase
from dembound.motion.resources import (
    POINT,
    Storage,
    largest,
    ledger_bytes,
    mesh_bytes,
    must_fit,
    paraview_bytes,
    record_bytes,
)

if TYPE_CHECKING:
    from dembound.bar.scene import BarScene


def must_fit_here(case: BarCase) -> None:
    """Raise CaseError if a run of a case needs more RAM than is free on this machine, without building it."""
    lengths = case.method.largest_horizon
    horizon = f" with a horizon of {lengths:,} spacings" if lengths > 1 else ""
    must_fit(run_bytes(case), "bar.spacing", f"{case.bar.nodes:,} nodes{horizon}")


def run_bytes(case: BarCase) -> float:
    """Largest RAM (bytes) of a run, with the temporary arrays of its largest moment."""
    nodes, lengths = float(case.bar.nodes), max(case.method.largest_horizon, 1)
    run = scene_bytes(nodes) + bonds_bytes(nodes, lengths) + motion_bytes(nodes) + ledger_bytes(nodes)
    run += record_bytes(len(case.monitor), 2048, 7, sum(load.nodes for load in case.load) + 2.0)
    run += sum(
        layer_bytes(table.layer.nodes, case.method.horizon_beyond) for table in case.boundary.values() if table.layer
    )
    if case.bar.opens:
        run += opening_bytes(nodes, lengths)
    if case.output.snapshots:
        run += damage_bytes(nodes, lengths)
    step = scene_bytes(nodes) + bonds_bytes(nodes, lengths) + 4 * 8 * (lengths + 1) * nodes  # bands of the stiffness
    return largest({"step": step, "run": run, "export": export_bytes(case, nodes)}, case)


def scene_bytes(nodes: float) -> float:
    """Bytes of a scene: places, volumes, masses, inertia, slots (48 n), springs, sections, limits and drag (32 n)."""
    return 80 * nodes


def bonds_bytes(nodes: float, lengths: int) -> float:
    """Bytes of springs and limits (33 n), bonds, their stiffness and the steps they broke in (24 m n), work space."""
    return (33 + 24 * lengths + 16) * nodes


def layer_bytes(nodes: int, lengths: int) -> float:
    """Bytes of a layer beyond an end: by bond its force, rate, stiffness and two factors (56), by node as much."""
    return 56.0 * (lengths + 1) * (nodes + lengths)


def opening_bytes(nodes: float, lengths: int) -> float:
    """Bytes of the list of bonds that open (64 each), and of the steps before they did (8), if all of them open."""
    return 72 * (lengths + 1) * nodes


def motion_bytes(nodes: float) -> float:
    """Bytes of u, its successor and v, of which only the first of three rows is moved, and mobilities (16 n)."""
    return (24 + 8 + 8 + 16) * nodes


def damage_bytes(nodes: float, lengths: int) -> float:
    """Bytes of the damage in a snapshot: families (32 m n), and per pair volumes and factors (90 m n)."""
    return (32 + 90) * lengths * nodes


def export_bytes(case: BarCase, nodes: float) -> float:
    """Bytes of a snapshot as a file for ParaView, when the scene is gone; counted by array as in `disks/ram.py`."""
    return 290 * nodes if case.output.snapshots else 0.0


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
