"""Loads: the particles, or nodes of a continuum, that a ``[[load]]`` acts on, and its forces."""

import numpy as np

from dembound.boundaries.support import SupportBuilder
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import Load
from dembound.disks.surroundings import Surroundings
from dembound.errors import CaseError
from dembound.outside.traction import Traction, traction_in
from dembound.packings.tiling import Assembly

EVERYWHERE = (-np.inf, -np.inf, np.inf, np.inf)
"""The region (m) of the whole plane."""

ROUNDING = 1e-6
"""Part of an element by which a traction's part of the surface may be shorter."""


def forces_of(
    load: Load, assembly: Assembly, mass: np.ndarray, outside: Surroundings | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (k,) a load acts on, and its forces on them (k, 2) N before the time factor.

    mass : (n,) kg, of the particles first. On particles a force is shared in proportion to the masses, which are as the
    areas of the disks and halved for half cells; an acceleration acts on each particle's mass. On the free surface of a
    continuum a force is a uniform traction over the part of the surface in the load's region.

    Raises CaseError if there is neither a particle nor a free surface, or both, and for tractions on less than an
    element or on a layer that absorbs.
    """
    traction = None if outside is None else _traction(load, outside)
    if outside is not None and traction is not None:
        if len(_particles(load, assembly)) > 0:
            raise _error(load, "region: has particles and free surface of the continuum; give each its own load")
        return outside.first + traction.node, traction.share[:, None] * np.array(load.vector)
    nodes = _particles(load, assembly)
    if len(nodes) == 0:
        surface = "" if outside is None else ", nor does it have free surface of the continuum"
        problem = f"no particle is centred in its region {list(load.region or ())} (m){surface}"
        raise CaseError([f"load.{load.name}: {problem}"])
    share = mass[nodes]
    if load.acceleration is None:
        share = share / share.sum()
    return nodes, share[:, None] * np.array(load.vector)


def _particles(load: Load, assembly: Assembly) -> np.ndarray:
    """Particles (k,) at the load's position or in its region."""
    positions = assembly.positions
    if load.position is not None:
        return np.array([int(np.argmin(np.hypot(*(positions - load.position).T)))])
    if load.region is None:
        return np.arange(len(positions))
    low, high = np.array(load.region[:2]), np.array(load.region[2:])
    return np.flatnonzero(((positions >= low) & (positions <= high)).all(axis=1))


def _traction(load: Load, outside: Surroundings) -> Traction | None:
    """The traction of a load on the free surface of a continuum; None if it does not reach it."""
    mesh = outside.body.mesh
    if load.position is not None and outside.is_beyond(np.array([load.position]))[0]:
        least = traction_in(mesh, EVERYWHERE).least
        raise _error(load, f"position: lies in the continuum, where a force needs a region at least {least:.4g} m wide")
    if load.region is None:
        return None
    traction = traction_in(mesh, load.region, outside.skins)
    if traction.absorbs:
        low, high = mesh.between_layers
        allowed = f"({low[0]:.10g}, {low[1]:.10g}) to ({high[0]:.10g}, {high[1]:.10g}) m"
        raise _error(load, f"region: reaches the layer that absorbs; must lie within {allowed}")
    if 0.0 < traction.length < (1.0 - ROUNDING) * traction.least:
        has = f"has {traction.length:.4g} m of the continuum's free surface"
        raise _error(load, f"region: {has}, must have at least {traction.least:.4g} m, an element")
    return traction if traction.length > 0.0 else None


def _error(load: Load, problem: str) -> CaseError:
    """A mistake in a key of a load."""
    return CaseError([f"load.{load.name}.{problem}"])


def drive(
    case: DiskCase, assembly: Assembly, mass: np.ndarray, outside: Surroundings | None, supports: SupportBuilder
) -> None:
    """Add the loads that follow a wave to the support table."""
    for load in case.load:
        if load.wave is not None:
            nodes, forces = forces_of(load, assembly, mass, outside)
            for axis in load.axes:
                supports.add(nodes, axis, drive=forces[:, axis], signal=case.wave[load.wave].velocity)


def steady(case: DiskCase, assembly: Assembly, mass: np.ndarray, outside: Surroundings | None) -> np.ndarray:
    """Forces and moments (3, n) N, N·m of the loads without a wave on nodes of these masses (n,) kg."""
    force = np.zeros((3, len(mass)))
    for load in case.load:
        if load.wave is None:
            nodes, forces = forces_of(load, assembly, mass, outside)
            force[:2, nodes] += forces.T
    return force
