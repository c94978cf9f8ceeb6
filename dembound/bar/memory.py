"""What a run of a bar needs: RAM and bytes on disk, from the numbers of its nodes and bonds."""

from __future__ import annotations

from dembound.casefile.bar.model import BarCase
from dembound.motion.memory import Storage, for_paraview, largest, must_fit, recorded, total

BLOCK, WIDTH = 2048, 7
"""Steps of a block of the record, and numbers of a node in it."""


def must_fit_here(case: BarCase) -> None:
    """Raise CaseError if a run of a case needs more RAM than is free on this machine, without building it."""
    lengths = case.method.largest_horizon
    horizon = f" with a horizon of {lengths:,} spacings" if lengths > 1 else ""
    must_fit(run_bytes(case), "bar.spacing", f"{case.bar.nodes:,} nodes{horizon}")


def counts_of(case: BarCase) -> dict[str, float]:
    """Numbers of nodes, bonds and records of a run, see `motion.memory.BYTES`."""
    nodes, lengths = float(case.bar.nodes), max(case.method.largest_horizon, 1)
    beyond = case.method.horizon_beyond
    layers = [table.layer.nodes for table in case.boundary.values() if table.layer]
    return {
        "node": nodes,
        "slot": nodes,
        "bond": lengths * nodes,
        "link": (lengths + 1) * nodes,
        "layer_link": sum((beyond + 1.0) * (count + beyond) for count in layers),
        **recorded(len(case.monitor), BLOCK, WIDTH, sum(load.nodes for load in case.load) + 2.0),
    }


def run_bytes(case: BarCase) -> float:
    """Largest RAM (bytes) of a run, with the temporary arrays of its largest moment."""
    counts, snapshots = counts_of(case), case.output.snapshots > 0
    stages = {
        "step": total(counts, "bar", "bonds", "bands"),
        "run": total(
            counts,
            *("bar", "bonds", "bar_motion", "ledger", "record", "bar_layer"),
            opening=case.bar.opens,
            damage=snapshots,
        ),
        "export": total(counts, bar_export=snapshots),
    }
    return largest(stages, case)


def storage_of(case: BarCase) -> Storage:
    """Bytes on disk of the results of a bar."""
    counts, files = counts_of(case), case.output.paraview
    vtu = total(counts, "bar_vtu", bar_vtu_peaks=case.output.peaks)
    return Storage(
        total(counts, "bar_header") + for_paraview(files, 0.0, total(counts, "bar_vtkhdf_header")),
        total(counts, "bar_snapshot") + for_paraview(files, vtu, total(counts, "bar_vtkhdf")),
        total(counts, "bar_state", "bonds"),
    )
