"""Builds the scene of a case: packs, tiles, makes holes, adds supports and the free-field column."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from dembound.boundaries import Periodic
from dembound.boundaries.half_mass import half_contacts, half_edges, mass_factor, with_shares
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Supports
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.monitor import FREE_FIELD
from dembound.disks.body import DiskBody, parts_of
from dembound.disks.contacts import plain_contacts
from dembound.disks.edges import edge_without, edges_beside_column, find_edges
from dembound.disks.layout import lay_out
from dembound.disks.loads import drive
from dembound.disks.memory import Sizes, must_fit_here, run_bytes
from dembound.disks.packed_material import PackedMaterial, make_packed_material, nominal_moduli
from dembound.disks.stress import particle_stress
from dembound.disks.surroundings import Surroundings, surroundings_of
from dembound.disks.system import DiskSystem
from dembound.errors import CaseError
from dembound.holes import Hole
from dembound.kernels.contacts import REFERENCE
from dembound.packings.brick import Brick
from dembound.packings.column import Seam, with_column
from dembound.packings.cut import cut_contacts
from dembound.packings.tiling import Assembly, tile


@dataclass(frozen=True)
class DiskScene(DiskBody):
    """The arrays of a case, also those before an excavation.

    Attributes
    ----------
    before : the scene before the excavation, in which the static stage begins; None without an excavation. kept : (n,)
    indices of the remaining particles in that scene.
    """

    before: "DiskScene | None" = None
    kept: np.ndarray | None = None

    def elastic_stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (n, 3) xx, yy, xy in Pa at displacements (3, n) under the elastic law, see `particle_stress`."""
        contacts = plain_contacts(self.ground, self.assembly, self.layout.slot)
        return particle_stress(self, contacts, displacement, REFERENCE)

    @property
    def places_in_whole(self) -> np.ndarray:
        """(n,) the disk of the scene of the case that each disk is or moves as."""
        return np.arange(self.count)

    def system(self, time_step: float) -> DiskSystem:
        """Its parts and ties at rest as built, to be stepped by time_step (s)."""
        return DiskSystem(self, time_step)

    @property
    def largest_memory(self) -> float:
        """Largest memory (bytes) of a run of it, or of the scene it is stepped in place of."""
        before = None if self.before is None else Sizes.of(self.before)
        return run_bytes(self.case, [Sizes.of(scene) for scene in self.chain], before)

    @property
    def chain(self) -> "tuple[DiskScene, ...]":
        """The scene of the case, and the smaller ones in its place, down to this one."""
        return (self,)


def build(case: DiskCase) -> DiskScene:
    """Build the scene of a case: pack, tile, make holes and add supports.

    Raises PackingError when the brick cannot be made or no particle remains, CaseError when no particle of a side
    remains, or when a run needs more memory than there is.
    """
    must_fit_here(case)
    ground = ground_of(case)
    periodic = (case.side("left").is_periodic, case.side("bottom").is_periodic)
    body = tile(ground.brick, case.packing.copies, periodic)
    edges = find_edges(body, periodic, case.packing.regular_sides)
    first, later = (tuple(hole for hole in case.hole if hole.stage == stage) for stage in ("before", "after"))
    if first:
        body, edges, _ = _hollowed(case, ground.brick, body, edges, first)
    scene = _scene(case, ground, body, edges)
    if not later:
        return scene
    body, edges, kept = _hollowed(case, ground.brick, body, edges, later)
    column = np.arange(0 if scene.seam is None else scene.seam.count)
    kept = np.concatenate([column, len(column) + kept])
    return replace(_scene(case, ground, body, edges), before=scene, kept=kept)


def _scene(case: DiskCase, ground: PackedMaterial, assembly: Assembly, edges: Mapping[str, Edge]) -> DiskScene:
    """The scene of a body and its sides, with a free-field column if the case has such sides."""
    seam = None
    if sides := _free_field_sides(case):
        assembly, seam = with_column(ground.brick, assembly, sides)
        edges = edges_beside_column(assembly, seam, edges)
    assembly, seam = with_half_contacts(case, ground.brick, assembly, seam, edges)
    count = len(assembly.radii)
    edges = with_shares(count, edges, case.boundary)
    slots, rows = lay_out(assembly, ground, parts_of(count, seam), mass_factor(count, edges, case.boundary))
    beyond = _outside_sides(case)
    outside = surroundings_of(case, ground, assembly, slots, beyond) if beyond else None
    return DiskScene(
        case=case,
        ground=ground,
        assembly=assembly,
        rows=rows,
        edges=edges,
        supports=_supports(case, ground, assembly, edges, outside),
        monitors=_monitors(case, assembly, seam),
        seam=seam,
        slots=slots,
        outside=outside,
    )


def column_alone(scene: DiskScene) -> DiskScene:
    """The free-field column of a body as a separate scene, with boundaries only at its bottom and top.

    Its particles are numbered as in the body's scene; only loads that act on all particles act on it.
    """
    case, brick = scene.case, scene.ground.brick
    sides = {"left": Periodic(type="periodic"), "right": Periodic(type="periodic")}
    upright = {side: table for side, table in case.boundary.items() if side not in sides}
    static = case.static
    if static is not None:
        ends = {side: table for side, table in static.boundary.items() if side not in sides}
        static = static.model_copy(update={"boundary": ends})
    everywhere = tuple(load for load in case.load if load.position is None and load.region is None)
    alone = replace(case, boundary=sides | upright, static=static, load=everywhere, hole=(), monitor=())
    column = tile(brick, (1, scene.assembly.copies[1]), (True, False))
    return _scene(alone, scene.ground, column, find_edges(column, (True, False), case.packing.regular_sides))


def ground_of(case: DiskCase) -> PackedMaterial:
    """The case's brick, packed or from the cache, with its material."""
    brick = case.packing.pack(nominal_moduli(case.material).emod)
    return make_packed_material(brick, case.material, case.motion.held)


def _free_field_sides(case: DiskCase) -> tuple[str, ...]:
    return tuple(side for side, table in case.boundary.items() if table.needs_column)


def _outside_sides(case: DiskCase) -> tuple[str, ...]:
    return tuple(side for side, table in case.boundary.items() if table.is_outside)


def _hollowed(
    case: DiskCase, brick: Brick, body: Assembly, edges: Mapping[str, Edge], holes: tuple[Hole, ...]
) -> tuple[Assembly, dict[str, Edge], np.ndarray]:
    """A body and its sides without the particles in holes, and the indices (m,) of the remaining particles.

    The surface of a hole is free: no particles are added to a side.
    """
    removed = np.logical_or.reduce([hole.contains(body.positions) for hole in holes])
    left, kept = body.without(removed)
    if sides := _free_field_sides(case):
        seam = with_column(brick, body, sides)[1]
        if not np.isin(seam.node - seam.count, kept).all():
            raise CaseError([f"hole: reaches the free field of {' or '.join(sides)}, which has no hole"])
    if sides := _outside_sides(case):
        before, after = (len(cut_contacts(brick, each, sides).node) for each in (body, left))
        if after < before:
            raise CaseError([f"hole: reaches the continuum of {' or '.join(sides)}, which has no hole"])
    return left, {side: edge_without(edge, kept) for side, edge in edges.items()}, kept


def with_boundaries(scene: DiskScene, case: DiskCase) -> DiskScene:
    """The same body under the boundaries of another case; only [boundary.*] and [wave.*] of that case are used."""
    built_in = [
        ([edge.side for edge in half_edges(scene.edges, each.boundary)], _free_field_sides(each), _outside_sides(each))
        for each in (scene.case, case)
    ]
    if built_in[0] != built_in[1]:
        return build(case)  # masses, contacts and the column change with them
    return replace(scene, case=case, supports=_supports(case, scene.ground, scene.assembly, scene.edges, scene.outside))


def with_half_contacts(
    case: DiskCase, brick: Brick, assembly: Assembly, seam: Seam | None, edges: Mapping[str, Edge]
) -> tuple[Assembly, Seam | None]:
    """Replace contacts along sides of half cells, also across a seam, by types with half the stiffness."""
    vectors, whole = brick.vectors, len(brick.pairs)

    def halved(contact_type: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        plain = contact_type % whole
        half = half_contacts(first, second, vectors[plain], edges, case.boundary)
        return plain + whole * half.astype(contact_type.dtype)

    assembly = replace(assembly, contact_type=halved(assembly.contact_type, *assembly.pairs.T))
    if seam is not None:
        owner = np.repeat(seam.twin[seam.node], seam.contact_counts)
        seam = replace(seam, contact_type=halved(seam.contact_type, owner, seam.neighbour))
    return assembly, seam


def boundary_medium(case: DiskCase, ground: PackedMaterial, axis: int) -> BoundaryMedium:
    """The medium beyond a side: the wave speeds given in the case, else those of the packing along the side's normal.

    axis is that of the normal, 0 (x) or 1 (y): a packing may be stiffer along one than along the other.
    """
    p_gradient, s_gradient = ((0, 3), (1, 2))[axis]  # of u_n and of u_s along the normal, see homogenise.GRADIENTS
    p_speed, s_speed = case.material.p_wave_speed, case.material.s_wave_speed
    if p_speed is None:
        p_speed = float(np.sqrt(ground.material_tensor[p_gradient, p_gradient] / ground.density))
    if s_speed is None:
        s_speed = float(np.sqrt(ground.material_tensor[s_gradient, s_gradient] / ground.density))

    def mirror_stiffness(diameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        between = ground.law.stiffness(ground.moduli, 0.5 * diameters, 0.5 * diameters, diameters)
        return between.normal, between.bending

    return BoundaryMedium(ground.density, p_speed, s_speed, mirror_stiffness)


def _supports(
    case: DiskCase,
    ground: PackedMaterial,
    assembly: Assembly,
    edges: Mapping[str, Edge],
    outside: Surroundings | None,
) -> Supports:
    """The support table: rows of all sides and of all loads that follow a wave."""
    builder = SupportBuilder(held=ground.held)
    for side, table in case.boundary.items():
        if side in edges:
            edge, builder.side = edges[side], side
            table.support(edge, boundary_medium(case, ground, edge.axis), case.wave, builder)
    factor = mass_factor(len(assembly.radii), edges, case.boundary)
    builder.side = ""
    drive(case, assembly, ground.mass[assembly.brick_particle] * factor, builder)
    if outside is not None:  # nodes do not rotate
        builder.add(outside.disks + outside.wall.nodes, 2, prescribed=True)
    return builder.table()


def _monitors(case: DiskCase, assembly: Assembly, seam: Seam | None) -> dict[str, int]:
    """The particle of the body nearest to each monitor's position, and its twin in the free-field column."""
    if not case.monitor:
        return {}
    from scipy.spatial import cKDTree

    first = 0 if seam is None else seam.count
    _, nodes = cKDTree(assembly.positions[first:]).query([m.position for m in case.monitor])
    monitors = {m.name: first + int(node) for m, node in zip(case.monitor, nodes, strict=True)}
    if seam is not None:
        monitors |= {f"{name}{FREE_FIELD}": int(seam.twin[node]) for name, node in monitors.items()}
    return monitors
