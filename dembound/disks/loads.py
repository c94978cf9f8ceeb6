"""Loads: the particles, or nodes of a continuum, that a ``[[load]]`` acts on, and its forces."""

from __future__ import annotations

import numpy as np

from dembound.boundaries.support import SupportBuilder
from dembound.casefile.disks.load import Load
from dembound.disks.beyond.surroundings import Surroundings
from dembound.disks.body import DiskBody
from dembound.disks.hole_wall import pressure_on
from dembound.disks.membrane import forces_on_sides
from dembound.edges import is_within
from dembound.errors import CaseError
from dembound.nearest import nearest
from dembound.outside.traction import Traction, traction_in
from dembound.packings.tiling import Assembly
from dembound.table import EVERYWHERE

ROUNDING = 1e-6
"""Part of an element by which a traction's part of the surface may be shorter."""


def forces_of(load: Load, scene: DiskBody) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (k,) a load acts on, and its forces and moments on them (k, 3) N and N·m before the time factor.

    On particles a force is shared in proportion to the masses, which are as the areas of the disks and halved for half
    cells; an acceleration acts on each particle's mass. On the free surface of a continuum a force is a uniform
    traction over the part of the surface in the load's region. For a pressure see `hole_wall` and `membrane`.

    Raises CaseError if there is neither a particle nor a free surface, or both, for tractions on less than an element
    or on a layer that absorbs, and for holes without a wall.
    """
    if load.sides is not None:
        return forces_on_sides(load, scene)
    if load.pressure is not None:
        return pressure_on(load, scene)
    traction = None if scene.outside is None else _traction(load, scene.outside)
    nodes = _particles(load, scene.assembly)
    if scene.outside is not None and traction is not None:
        if len(nodes) > 0:
            raise _error(load, "region: has particles and free surface of the continuum; give each its own load")
        return scene.outside.first + traction.node, _along(load, traction.share)
    if len(nodes) == 0:
        surface = "" if scene.outside is None else ", nor does it have free surface of the continuum"
        problem = f"no particle is centred in its region {list(load.region or ())} (m){surface}"
        raise CaseError([f"load.{load.name}: {problem}"])
    share = scene.mass[nodes]
    if load.acceleration is None:
        share = share / share.sum()
    return nodes, _along(load, share)


def _along(load: Load, share: np.ndarray) -> np.ndarray:
    """Forces and moments (k, 3) of a load's vector on nodes with shares (k,) of it."""
    return share[:, None] * np.array([*load.vector, 0.0])


def _particles(load: Load, assembly: Assembly) -> np.ndarray:
    """Particles (k,) at the load's position or in its region."""
    positions = assembly.positions
    if load.position is not None:
        return nearest(positions, np.array([load.position]))
    if load.region is None:
        return np.arange(len(positions))
    return np.flatnonzero(is_within(load.region, positions, float(assembly.size.max())))


def _traction(load: Load, outside: Surroundings) -> Traction | None:
    """The traction of a load on the free surface of a continuum; None if it does not reach it."""
    mesh = outside.body.mesh
    if load.position is not None and outside.is_beyond(np.array([load.position]))[0]:
        least = traction_in(mesh, EVERYWHERE).least
        raise _error(load, f"position: lies in the continuum, where a force needs a region at least {least:.4g} m wide")
    if load.region is None:
        return None
    traction = traction_in(mesh, load.region, outside.depths)
    if traction.absorbs:
        low, high = mesh.between_layers
        allowed = f"({low[0]:.10g}, {low[1]:.10g}) to ({high[0]:.10g}, {high[1]:.10g}) m"
        raise _error(load, f"region: reaches the layer that absorbs; must lie within {allowed}")
    if 0.0 < traction.length < (1.0 - ROUNDING) * traction.least:
        has = f"has {traction.length:.4g} m of the continuum's free surface"
        raise _error(load, f"region: {has}, must have at least {traction.least:.4g} m, an element")
    return traction if traction.length > 0.0 else None


def _error(load: Load, problem: str) -> CaseError:
    """The error for a mistake in a key of a load."""
    return CaseError([f"load.{load.name}.{problem}"])


def drive(scene: DiskBody, supports: SupportBuilder) -> None:
    """Add the loads of a scene that follow a wave to a support table."""
    for load in scene.case.load:
        if load.wave is not None:
            nodes, forces = forces_of(load, scene)
            for component in np.flatnonzero(forces.any(axis=0)).tolist():
                signal = scene.case.wave[load.wave].velocity
                supports.add(nodes, component, drive=forces[:, component], signal=signal)


def steady(scene: DiskBody) -> np.ndarray:
    """Forces and moments (3, n) N, N·m of a scene's loads without a wave."""
    force = np.zeros((3, scene.count))
    for load in scene.case.load:
        if load.wave is None:
            nodes, forces = forces_of(load, scene)
            force[:, nodes] += forces.T
    return force
