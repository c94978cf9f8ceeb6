"""The most RAM that a run of a bar needs, from its numbers of nodes n and of bond lengths m."""

from dembound.casefile.bar import BarCase
from dembound.motion.ram import largest, ledger_bytes, must_fit, record_bytes


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
