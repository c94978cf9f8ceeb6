"""Errors that no setting of a continuum reduces, as a body consists of disks: dispersion, and copies of bricks."""

from __future__ import annotations

from collections.abc import Sequence

from dembound.boundaries.edge import normal_axis
from dembound.continuum.sizing import Signal
from dembound.disks.material import packing_waves
from dembound.disks.scene import DiskScene
from dembound.formulas.disks.continuum import lattice_errors
from dembound.words import Entries, percent, with_unit

LEAST_SHOWN = 1e-5
"""Share of the velocity reflected by copies below which it is not printed."""


def packing_facts(scene: DiskScene, signals: Sequence[Signal]) -> Entries:
    """Facts about a scene with a continuum and signals that do not jump."""
    yield "dispersion of the disks", _dispersion(scene, signals)
    if copies := _copies(scene, signals):
        yield "copies of the brick", copies


def _dispersion(scene: DiskScene, signals: Sequence[Signal]) -> str:
    """Text on the error by dispersion of the lattice."""
    accuracy = scene.case.outside.accuracy
    ties, across = lattice_errors(scene, signals)
    more = f"; more than outside.accuracy = {percent(accuracy)}" if max(ties, across) > accuracy else ""
    return (
        f"ties return up to {percent(ties)} of the velocity of what meets them, and waves change by {percent(across)} "
        f"over the scene's length{more}"
    )


def _copies(scene: DiskScene, signals: Sequence[Signal]) -> str:
    """Text on waves reflected by copies of a random brick; empty if negligible."""
    case, ground = scene.case, scene.ground
    if case.packing.is_lattice:
        return ""
    if len(ground.brick.radii) > packing_waves.MOST_DISKS:
        return (
            f"send back short waves, which is not computed for bricks of more than {packing_waves.MOST_DISKS:,} disks"
        )
    axes = sorted({normal_axis(side) for side in case.driving})
    found = packing_waves.sent_back(ground, signals, case.size, axes if axes and not case.load else (0, 1))
    share, accuracy = found.share, case.outside.accuracy
    beyond = f"waves above {with_unit(found.highest, 'Hz')}, which have {percent(found.above)} of the energy"
    if share < LEAST_SHOWN:
        return f"send back {beyond}, by a part that is not computed" if found.above > 0.0 else ""
    more = f"; more than outside.accuracy = {percent(accuracy)}, shorter bricks send back less"
    return (
        f"send back up to {percent(share)} of the velocity over the ground's length, which a continuum does not"
        f"{f', and a part that is not computed of {beyond}' if found.above > 0.0 else ''}"
        f"{more if share > accuracy else ''}"
    )
