"""Loads: the particles a ``[[load]]`` acts on, and its forces."""

import numpy as np

from dembound.boundaries.support import SupportBuilder
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import Load
from dembound.errors import CaseError
from dembound.packings.tiling import Assembly


def forces_of(load: Load, assembly: Assembly, mass: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Particles (k,) a load acts on, and its forces on them (k, 2) N before the time factor.

    mass (n,) kg. A force is shared in proportion to the masses, which are as the areas of the disks and halved for half
    cells; an acceleration acts on each particle's mass.
    Raises CaseError if there is no particle.
    """
    nodes = _loaded(load, assembly)
    share = mass[nodes]
    if load.acceleration is None:
        share = share / share.sum()
    return nodes, share[:, None] * np.array(load.vector)


def _loaded(load: Load, assembly: Assembly) -> np.ndarray:
    """Particles (k,) at the load's position or in its region."""
    positions = assembly.positions
    if load.position is not None:
        return np.array([int(np.argmin(np.hypot(*(positions - load.position).T)))])
    if load.region is None:
        return np.arange(len(positions))
    low, high = np.array(load.region[:2]), np.array(load.region[2:])
    nodes = np.flatnonzero(((positions >= low) & (positions <= high)).all(axis=1))
    if len(nodes) == 0:
        raise CaseError([f"load.{load.name}: no particle is centred in its region {list(load.region)} (m)"])
    return nodes


def drive(case: DiskCase, assembly: Assembly, mass: np.ndarray, supports: SupportBuilder) -> None:
    """Add the loads that follow a wave to the support table."""
    for load in case.load:
        if load.wave is not None:
            nodes, forces = forces_of(load, assembly, mass)
            for axis in load.axes:
                supports.add(nodes, axis, drive=forces[:, axis], signal=case.wave[load.wave].velocity)


def steady(case: DiskCase, assembly: Assembly, mass: np.ndarray) -> np.ndarray:
    """Forces and moments (3, n) N, N·m of the loads without a wave."""
    force = np.zeros((3, len(mass)))
    for load in case.load:
        if load.wave is None:
            nodes, forces = forces_of(load, assembly, mass)
            force[:2, nodes] += forces.T
    return force
