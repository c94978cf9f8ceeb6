"""Builds the scene of a case: packs, tiles, makes holes, adds supports and the free-field column."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from dembound.boundaries import Periodic, is_far
from dembound.boundaries.half_mass import half_edges, mass_factor, with_shares
from dembound.boundaries.support import Edge, SupportBuilder, Waves
from dembound.boundaries.viscous import BearingDashpots
from dembound.casefile.disks import DiskCase
from dembound.continuum.sizing import GridSizes
from dembound.disks import columns
from dembound.disks.bearing import Springs, bearing_springs, together
from dembound.disks.body import DiskBody, with_half_contacts, with_layers
from dembound.disks.contacts.layout import lay_out
from dembound.disks.contacts.pairs import plain_contacts
from dembound.disks.faces.cut import with_joints
from dembound.disks.faces.found import Faces
from dembound.disks.material.case_material import make_packed_material, nominal_moduli
from dembound.disks.material.confined import confined
from dembound.disks.material.grouped import GroupedGround
from dembound.disks.material.layered import LayeredGround, layered
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.unlike import UnlikeGround
from dembound.disks.memory import SceneSizes, must_fit_here, run_bytes
from dembound.disks.monitors import monitors_of
from dembound.disks.pressure import in_run
from dembound.disks.side_forces import side_forces
from dembound.disks.sides import boundary_medium, media_of, medium_of_side, sides_of, tied_of
from dembound.disks.stepping.fields import particle_stress
from dembound.disks.stepping.system import DiskSystem
from dembound.disks.supports import steady, supports_of
from dembound.disks.surroundings.continuum import Surroundings, surroundings_of
from dembound.disks.surroundings.edges import edges_beside_columns, find_edges, hollowed, require_held
from dembound.disks.surroundings.frequencies import mechanisms_of
from dembound.disks.surroundings.layered_waves import undisturbed
from dembound.disks.surroundings.mesh import NO_FLOORS, Outline
from dembound.holes.hole import Floor
from dembound.kernels.contacts import REFERENCE
from dembound.packings.column import Seam, Standing, columns_end, with_columns
from dembound.packings.tiling import Assembly, tile

CANCELS = 1e-6
"""Resultant of the differences of side forces from stress times length, over the forces, that counts as rounding."""


@dataclass(frozen=True)
class DiskScene(DiskBody):
    """The arrays of a case, with the scene before an excavation.

    Attributes
    ----------
    before : the scene before the excavation, in which the static stage begins; None without an excavation. kept : (n,)
    indices of the remaining particles in that scene.
    """

    before: "DiskScene | None" = None
    kept: np.ndarray | None = None

    @cached_property
    def sides(self) -> dict[str, Edge]:  # type: ignore[override]  # computed once
        """The edges of the body, of its column bottom and top, as ``bottom.free_field``, and those of continua."""
        return sides_of(self)

    @cached_property
    def tied(self) -> dict[str, np.ndarray]:  # type: ignore[override]  # computed once
        """Nodes (k,) that ties act on, by side: particles beside a free field or a continuum, nodes of continua."""
        return tied_of(self)

    @cached_property
    def bearing(self) -> Springs | None:  # type: ignore[override]  # computed once
        """The springs of sides on relative motion; None without any."""
        return together([*self._bearing_by_side.values()]) if self._bearing_by_side else None

    @property
    def borne(self) -> Mapping[str, tuple[np.ndarray, np.ndarray]]:
        """Disks (k,) with springs on relative motion by side, and its shares (k, 2) of their forces."""
        if (springs := self.bearing) is None:
            return {}
        found = {}
        for side, own in self._bearing_by_side.items():
            every = springs.stiffness[np.searchsorted(springs.node, own.node)]
            found[side] = own.node, np.divide(own.stiffness, every, out=np.zeros_like(every), where=every > 0.0)
        return found

    @cached_property
    def _bearing_by_side(self) -> dict[str, Springs]:
        found = {}
        for side, bearing in self.case.bearing.items():
            table = self.case.side(side)
            assert isinstance(table, BearingDashpots)
            below = [(self.sides[side], medium_of_side(self, side))]  # without the columns beside it
            media = below if side == "bottom" else media_of(self, side)
            found[side] = bearing_springs(bearing, table, media, self.twin)
        return found

    @cached_property
    def steady_load(self) -> np.ndarray:
        """Forces and moments (3, n) N, N·m of the loads without a wave."""
        return steady(self)

    def elastic_stress(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (n, 3) xx, yy, xy in Pa at displacements (3, n) under the elastic law, see `particle_stress`."""
        pairs = plain_contacts(self.inside, self.assembly, self.layout.slot)
        return particle_stress(self, pairs, displacement, REFERENCE)

    @property
    def forces_by_side(self) -> dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Disks (k,) and forces by which sides hold the target stress of a static stage; empty without one.

        A contact across a corner, and the disks that are left out there as they touch none of the body, act by one side
        or by none, so that a side carries not quite the stress times its length. It is recorded with exactly that: the
        disk with the largest force gets the rest. Over all sides this cancels; where it does not, as a hole takes a
        part of a side, sides are recorded with their actual forces.
        """
        static = self.case.static
        if static is None or static.stress is None or self.at_rest is not None:
            return {}
        stress, found, rests = np.array(static.stress), {}, np.zeros(2)
        for side, each in side_forces(self).items():
            acting, edge = each.under(stress)[:2], self.edges[side]
            rest = edge.length * stress[[0, 2] if edge.axis == 0 else [2, 1]]
            rest = rest * (1.0 if is_far(side) else -1.0) - acting.sum(axis=1)
            shown, most = acting.copy(), np.abs(acting).argmax(axis=1)
            shown[[0, 1], most] += rest
            rests += rest
            found[side] = each.node, acting, shown
        whole = sum(np.abs(acting).sum() for _, acting, _ in found.values())
        if np.abs(rests).max() <= CANCELS * whole:
            return found
        return {side: (node, acting, acting) for side, (node, acting, _) in found.items()}

    def system(self, time_step: float) -> DiskSystem:
        """Its parts and ties at rest as built, to be stepped by time_step (s)."""
        return DiskSystem(self, time_step, load=in_run(self, np.zeros((3, self.count)), self.steady_load))

    @property
    def largest_memory(self) -> float:
        """Largest RAM (bytes) of a run of the scene."""
        return run_bytes(self.case, [self.sizes], None if self.before is None else self.before.sizes)

    @property
    def sizes(self) -> SceneSizes:
        """Numbers of its disks, contacts and nodes, from which RAM is counted."""
        return SceneSizes(
            disks=self.disk_count,
            slots=self.disk_count if self.slots is None else self.slots.count,
            contacts=len(self.assembly.pairs),
            supported=len(self.supports),
            in_rows=not (self.slots is None or self.slots.is_plain),
            grid=GridSizes.all_of([each.body.mesh for each in self.continua]) if self.continua else None,
            ties=sum(len(each.wall.element) for each in self.continua),
            probes=len(self.probes),
        )


def build(case: DiskCase) -> DiskScene:
    """Build the scene of a case: pack, tile, make holes and add supports.

    Raises PackingError without a brick or particles, CaseError for a side without any, and for a lack of RAM.
    """
    must_fit_here(case)
    ground = ground_of(case)
    body = tile(ground.brick, case.packing.copies, case.periodic, case.packing.origin)
    shapes = [hole for hole in case.holes if hole.is_shape]
    for shape in shapes:
        body, _ = body.without(shape.takes(body.positions, case.packing.span))
    edges = find_edges(body, case.periodic, () if shapes else case.packing.regular_sides)
    holes = [hole for hole in case.holes if not hole.is_shape]
    first, later = (tuple(hole for hole in holes if hole.stage == stage) for stage in ("before", "after"))
    if first:
        body, edges, _ = hollowed(case, ground.brick, body, edges, first, case.floors_of(first))
    require_held(case, edges)
    groups = GroupedGround.of(ground, case, body) if case.group else None
    scene = _scene(case, ground, body, edges, case.floors_of(first), groups)
    if not later:
        return scene
    body, edges, left = hollowed(case, ground.brick, body, edges, later, case.floors)
    kept = scene.column_count + left
    after = _scene(case, ground, body, edges, case.floors, groups, (scene.faces, kept))
    return replace(after, before=scene, kept=np.concatenate([*(_same_in(scene, after, s) for s in after.seams), kept]))


def _same_in(before: DiskScene, after: DiskScene, seam: Seam) -> np.ndarray:
    """Disks (k,) of the column of a scene before an excavation that those of a column after it were."""
    own = before.seams[min(after.seams.index(seam), len(before.seams) - 1)].disks
    both, count = ((before.assembly, own), (after.assembly, seam.disks)), len(before.ground.brick.radii)
    first, then = (of.tile[disks, 1].astype(np.int64) * count + of.brick_particle[disks] for of, disks in both)
    order = np.argsort(first)
    return np.asarray(own.start + order[np.searchsorted(first, then, sorter=order)])


def _scene(
    case: DiskCase,
    ground: PackedMaterial,
    assembly: Assembly,
    edges: Mapping[str, Edge],
    floors: Mapping[str, Floor] = NO_FLOORS,
    groups: GroupedGround | None = None,
    before: tuple[Sequence[Faces], np.ndarray] | None = None,
) -> DiskScene:
    """The scene of a body and its sides, with a free-field column and a continuum if the case has such sides.

    floors : left by its holes at left and right sides. groups : the ground of its disks, see `DiskBody`. before : of an
    excavation, see `with_joints`.
    """
    body, beyond = assembly, case.outside_sides
    seams: tuple[Seam, ...] = ()
    around = columns.ground_beneath(case, ground) if set(beyond) == {"bottom"} else ground
    standing = columns.standing_of(case, ground, body, floors)
    outline = None
    if beyond:
        slit = len(standing) > 1 or (case.incident is not None and bool(floors))
        outline = Outline.of(case, around, body, beyond, case.periodic, floors, slit=slit)
    if standing:
        left, bottom, right, _ = case.box
        if outline is not None:
            left = outline.mesh.origin[0]
            right = left + float(outline.mesh.size[0])
        assembly, seams = with_columns(ground.brick, body, standing, case.column_rows, (left, bottom, right))
        edges = edges_beside_columns(assembly, seams, edges)
    assembly, seams = with_half_contacts(case, ground.brick, assembly, seams, edges)
    assembly, faces = with_joints(case, ground, assembly, columns_end(seams), before)
    assembly, seams = with_layers(ground, assembly, seams)
    assembly = assembly if groups is None else groups.typed(assembly, columns_end(seams))
    edges = with_shares(count := len(assembly.radii), edges, case.boundary)
    fraction = mass_factor(count, edges, case.boundary)
    levels = columns.levels_by_part(case, ground, assembly, seams, case.surface)
    slots, rows = lay_out(assembly, (groups or ground).stepped, columns.parts_of(count, seams), fraction, levels)
    outside, layout = None, slots
    if outline is not None:
        outside = surroundings_of(around, body, outline, slots, columns_end(seams), tuple(each.twin for each in seams))
        layout = outside.laid_out(layout)
    feet: list[Surroundings] = []
    for seam in seams if "bottom" in beyond else ():
        feet.append(columns.foot_of(case, ground, assembly, seam, layout, outline if len(seams) > 1 else None))
        layout = feet[-1].laid_out(layout)
    waves = None if outside is None else undisturbed(case, ground, outside)
    monitors, between = monitors_of(case, ground, assembly, seams, outside, waves)
    beyond_sides = {"outside": outside, "feet": tuple(feet), "between": between, "ground_waves": waves}
    known: dict[str, Any] = beyond_sides | {"surface": case.surface, "faces": faces, "groups": groups}
    none = SupportBuilder().table()
    scene = DiskScene(case, ground, assembly, rows, edges, none, monitors, seams, slots, **known)
    return with_waves(scene, case.wave)


def column_alone(scene: DiskScene, number: int = 0) -> DiskScene:
    """A free-field column of a body as a separate scene, with boundaries only at its bottom and top.

    Its particles are numbered as in the body's scene; only loads that act on all particles act on it. Its dashpots have
    the factors used beside the body. It has no continuum at its ends and no column of its own: a side of type
    "outside" is free.
    """
    seam = scene.seams[number]
    case, ground = scene.case.beside(columns.side_of(seam)), scene.ground.beside(columns.side_of(seam))
    brick = ground.brick
    sides = {"left": Periodic(type="periodic"), "right": Periodic(type="periodic")}
    medium = boundary_medium(ground.at(case.box[1]), axis=1)
    upright = {
        side: table.with_numbers(scene.edges[side], medium) if side in scene.edges else table
        for side, table in case.boundary.items()
        if side not in sides and not table.is_outside
    }
    if (static := case.static) is not None:
        ends = {side: table for side, table in static.boundary.items() if side not in sides}
        if columns.columns_stand_fast(case, scene.seams):
            ends = {side: columns.standing_fast(table) for side, table in ends.items()}
        static = static.model_copy(update={"boundary": ends})
    everywhere = tuple(load for load in case.load if load.is_everywhere)
    without: dict[str, Any] = {"load": everywhere, "group": (), "hole": (), "wall": (), "joint": (), "monitor": ()}
    alone = replace(case, boundary=sides | upright, static=static, ground=case.ground.level(), **without)
    column = Standing((), seam.top).tiled(brick, case.column_rows[1], case.box[:2])
    alone_scene = _scene(alone, ground, column, find_edges(column, columns.UPRIGHT, case.packing.regular_sides))
    surface = None if scene.surface is None else columns.level_at(scene.surface, seam)
    intact = scene.intact is not None and bool(scene.intact[seam.disks].all())
    return replace(alone_scene, surface=surface, all_intact=intact)


def ground_of(case: DiskCase) -> PackedMaterial:
    """The case's brick, packed or from the cache, with its material."""
    brick = case.packing.pack(nominal_moduli(case.materials[-1]).emod)
    along = 1 if case.layer else 0  # waves in layers run upwards
    places = [f"layer.{name}" for name in case.layer_names] or ["material"]
    materials = [
        make_packed_material(brick, each, case.motion.held, along, mechanisms_of(case, each.quality_factor), place)
        for place, each in reversed([*zip(places, case.materials, strict=True)])
    ][::-1]
    if len(materials) == 1:
        return confined(materials[0], case)
    if case.ground.meet is None:
        return _in_layers(case, materials)
    numbers = {side: case.numbers_beside(side) for side in case.sides_of_ground}
    sides = [_in_layers(case.beside(side), [materials[number] for number in own]) for side, own in numbers.items()]
    return UnlikeGround.of(sides, [*numbers.values()], case.ground.meet)


def _in_layers(case: DiskCase, materials: Sequence[PackedMaterial]) -> LayeredGround:
    """The ground of a case that is the same at both sides; materials : of its layers from the surface down."""
    return layered(materials[::-1], case.layer_planes[::-1], case.packing.origin[1])


def with_boundaries(scene: DiskScene, case: DiskCase) -> DiskScene:
    """The scene under the boundaries of another case; only [boundary.*] and [wave.*] of that case are used."""
    built_in = [
        ([edge.side for edge in half_edges(scene.edges, each.boundary)], each.free_field_sides, each.outside_sides)
        for each in (scene.case, case)
    ]
    if built_in[0] != built_in[1]:
        return build(case)  # masses, contacts and the column change with them
    return with_waves(replace(scene, case=case), case.wave)


def with_waves(scene: DiskScene, waves: Waves) -> DiskScene:
    """The scene with these waves, by the names that its sides have for them."""
    return replace(scene, supports=supports_of(scene, waves))
