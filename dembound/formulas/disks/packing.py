"""Errors that no setting of a continuum reduces, as a body consists of disks: dispersion, and copies of bricks."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dembound.boundaries.edge import normal_axis
from dembound.continuum import sizing
from dembound.continuum.sizing import Signal
from dembound.disks.material import packing_waves
from dembound.disks.scene import DiskScene
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


def unevenness(scene: DiskScene, signals: Sequence[Signal], lowest: float = math.inf) -> float:
    """k²LD, RMS over the energy of velocities, to which scattering by uneven bricks is proportional; 0 on lattices.

    k : wave number of the slowest waves, none shorter than a brick; L, D : length of a random brick and mean diameter
    of its disks. The largest over signals. lowest : frequency (Hz) from which on the energy is that of displacements,
    see `sizing.energies`.
    """
    if scene.case.packing.is_lattice:
        return 0.0
    assert scene.outside is not None
    speed, brick = sizing.slowest(scene.outside.body.medium), scene.ground.brick
    length, found = float(max(brick.size)), [0.0]
    for signal in signals:
        frequency, energy = sizing.energies(signal, lowest)
        k = 2.0 * math.pi * np.minimum(frequency / speed, 1.0 / length)
        squares = (k**2 * length * brick.mean_diameter) ** 2
        found.append(math.sqrt(float(energy @ squares / energy.sum())))
    return max(found)


def lattice_errors(scene: DiskScene, signals: Sequence[Signal], lowest: float = math.inf) -> tuple[float, float]:
    """Error of velocities by reflection of ties, and by the lag of waves over the scene's longer side L, RMS over RMS.

    Half of a lattice's bond has the impedance ρc/cos(kD/2), so that a continuum beyond it returns (kD)²/16; the ties'
    dashpots, `damping` times ρc_pD, add (kD)²·(damping/8) c/c_p. Waves on the lattice lag by the phase kL(kD)²/24. For
    the slowest waves, of the speed c; the largest over signals. lowest : frequency (Hz) from which on errors are those
    of displacements, see `sizing.energies`.
    """
    outside = scene.outside
    assert outside is not None
    speed = sizing.slowest(outside.body.medium)
    diameter, length = scene.ground.brick.mean_diameter, max(scene.case.size)
    returned = 1.0 / 16.0 + 0.25 * outside.wall.lag * speed / diameter
    found = []
    for signal in signals:
        frequency, energy = sizing.energies(signal, lowest)
        k = 2.0 * math.pi * frequency / speed
        square = (k * diameter) ** 2
        errors = [returned * square, k * length * square / 24.0]
        found.append([math.sqrt(float(np.sum(energy * np.minimum(e, 1.0) ** 2) / energy.sum())) for e in errors])
    ties, across = np.max(found, axis=0).tolist()
    return ties, across
