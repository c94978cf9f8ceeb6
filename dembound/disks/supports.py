"""The support table of a scene: sides, loads that follow a wave, continua; and what a ``[[load]]`` acts on."""

from __future__ import annotations

import numpy as np

from dembound.boundaries.support import Incident, SupportBuilder, Supports, Waves
from dembound.casefile.disks.load import Load
from dembound.casefile.disks.model import DiskCase
from dembound.continuum.edges import Traction, traction_in
from dembound.disks.body import DiskBody
from dembound.disks.pressure import forces_on_sides, pressure_on
from dembound.disks.sides import ENDS_OF_COLUMNS, media_of
from dembound.disks.stepping.scene_parts import disks_on_foot
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.ground_waves import GroundWaves, UnlikeWaves, rising_waves
from dembound.disks.surroundings.incident import let_in, let_in_below, power_through
from dembound.disks.surroundings.layered_waves import LayeredWaves, rising_in_layers
from dembound.disks.surroundings.oblique_jump import let_jump
from dembound.errors import CaseError
from dembound.packings.tiling import Assembly
from dembound.places import is_within, nearest
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


def supports_of(scene: DiskBody, waves: Waves) -> Supports:
    """The support table: rows of all sides under these waves, of all loads that follow a wave, and of continua."""
    case, builder = scene.case, SupportBuilder(held=scene.ground.held)
    for side, table in case.boundary.items():
        builder.side = side
        for edge, medium in media_of(scene, side) if side in scene.edges else ():
            table.support(edge, medium, waves, builder)
    builder.side = ""
    drive(scene, builder)
    for each in scene.continua:
        each.support(builder)
    bottom = case.side("bottom")
    if bottom.is_outside and bottom.waves:
        names = bottom.waves_by_axis(1)
        x, y = (None if name is None else waves[name] for name in names)
        _let_in_below(scene, (x, y), builder)
    if scene.outside is not None and scene.ground_waves is not None:
        let_in(scene.outside, scene.ground_waves, scene.positions, builder)
        if isinstance(scene.ground_waves, UnlikeWaves):
            let_jump(scene.outside, scene.ground_waves, case.run.duration, builder)
    return builder.table()


def _rising(
    case: DiskCase, beneath: Surroundings, signals: tuple[Incident | None, Incident | None], grain: float
) -> GroundWaves | LayeredWaves:
    """The motion of the ground beneath a body under waves that run straight up, as if its layer there went on above.

    They have the given velocities at the lower side of the body; with layers below it, at the top of the lowest layer.
    """
    ground, height = beneath.body.ground, beneath.box[1]
    joints = tuple(joint for joint in ground.joints if joint < beneath.body.mesh.sides[2])
    relative = [None if each is None else each.relative_modulus for each in beneath.body.mechanisms[len(joints) :: -1]]
    if not joints and not any(relative):
        return rising_waves(ground.at(height), height, signals, grain)
    media, span = ground.media[len(joints) :: -1], (min(wave.start for wave in case.wave.values()), case.run.duration)
    at = joints[0] if joints else height
    return rising_in_layers(media, joints[::-1], None, signals, at, span, grain, relative)


def _let_in_below(scene: DiskBody, signals: tuple[Incident | None, Incident | None], builder: SupportBuilder) -> None:
    """Add the waves along x and y, None for none, that enter through the continuum below to the support table.

    Beside free-field columns they enter through the foot of each, and the body's disks that stand on the ground below
    have the forces of their twins in the first.
    """
    disks = disks_on_foot(scene)
    twins = scene.seams[0].twin[disks] if scene.feet else disks
    for number, beneath in enumerate(scene.feet or scene.continua):
        waves = _rising(scene.case, beneath, signals, scene.ground.brick.mean_diameter)
        builder.side = "bottom"
        let_in_below(beneath, waves, scene.positions, builder, (twins, disks))
        twins = disks = disks[:0]
        side = f"bottom{ENDS_OF_COLUMNS[number]}" if scene.feet else "bottom"
        builder.add_power(side, power_through("bottom", beneath.body.mesh.sides, waves, beneath.body.thickness))
