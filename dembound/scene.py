"""The scene: the arrays a case becomes. This is the one place that names them, their shapes and their units."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from dembound.boundaries import FreeField, Periodic
from dembound.boundaries.half_mass import half_contacts, half_edges, mass_factor
from dembound.boundaries.support import Edge, Medium, SupportBuilder, Supports
from dembound.case import DiskCase
from dembound.case.monitor import FREE_FIELD
from dembound.contacts import ContactList
from dembound.edges import edges_beside_column, find_edges, left_of
from dembound.errors import CaseError
from dembound.ground import Ground, make_ground, nominal_moduli
from dembound.holes import Hole
from dembound.kernels import tables
from dembound.kernels.tables import Rows
from dembound.laws import LAWS
from dembound.loads import drive, steady
from dembound.packings.brick import Brick
from dembound.packings.column import Seam, with_column
from dembound.packings.tiling import Assembly, tile
from dembound.rows import contact_rows, palette_of
from dembound.threads import worthwhile_threads


@dataclass(frozen=True)
class Scene:
    """A case turned into arrays; n particles, all SI.

    Attributes
    ----------
    case : where it came from.
    ground : brick and material.
    assembly : the tiled brick: positions (n, 2) m, radii (n,) m, brick_particle (n,), contacts.
    rows : contacts of the elastic law for the kernels.
    edges : side -> its exposed particles, for every side that is not periodic.
    supports : the table of what pushes from outside, loads that follow a wave included.
    monitors : name -> particle.
    kind, energy_unit : what records call it and its energies; record_width : columns of a probe's record; block : steps
        between two looks at a run, which compiled code does not leave in between.
    seam : what joins the free-field column, which stands first in the arrays, to the body; None without one.
    before : the scene before it was excavated, in which the static stage begins; None where nothing is excavated.
    kept : (n,) indices into that one's particles of those that are left.
    """

    case: DiskCase
    ground: Ground
    assembly: Assembly
    rows: Rows
    edges: Mapping[str, Edge]
    supports: Supports
    monitors: Mapping[str, int]
    seam: Seam | None = None
    before: "Scene | None" = None
    kept: np.ndarray | None = None

    kind = "disks"
    energy_unit = "J/m"
    record_width = 6
    block = 256

    @property
    def attributes(self) -> dict[str, Any]:
        """What a record's header has beside that of every run."""
        return {"seed": getattr(self.case.packing, "seed", 0)}

    @property
    def columns(self) -> dict[str, tuple[np.ndarray, str]]:
        """What a record keeps of every particle, by name: values (n, …) and unit."""
        assembly, bonded = self.assembly, self.ground.moduli.pb_emod > 0.0
        return {
            "position": (assembly.positions, "m"),
            "radius": (assembly.radii, "m"),
            "brick_particle": (assembly.brick_particle, "1"),
            "bonds": (np.bincount(assembly.pairs.ravel(), minlength=self.count) * int(bonded), "1"),
        }

    @property
    def places(self) -> dict[str, tuple[float, float]]:
        """Where monitors were wanted, m."""
        return {monitor.name: monitor.position for monitor in self.case.monitor}

    @property
    def count(self) -> int:
        """Number of particles n."""
        return len(self.assembly.radii)

    @property
    def positions(self) -> np.ndarray:
        """(n, 2) m."""
        return self.assembly.positions

    @property
    def size(self) -> np.ndarray:
        """(2,) width and height, m."""
        return self.assembly.size

    @property
    def threads(self) -> int:
        """Threads its steps use."""
        return worthwhile_threads(self.count)

    @property
    def damp(self) -> float:
        """Local damping coefficient."""
        return self.case.material.damp

    @cached_property
    def mass(self) -> np.ndarray:
        """(n,) kg, of which particles on sides with half mass keep their half."""
        return self.ground.mass[self.assembly.brick_particle] * self.share

    @cached_property
    def inertia(self) -> np.ndarray:
        """(n,) kg·m², halved with the mass."""
        return self.ground.inertia[self.assembly.brick_particle] * self.share

    @cached_property
    def share(self) -> np.ndarray:
        """(n,) part of its cell that is a particle's own: 1, on a side of half cells ½, where two such meet ¼."""
        return mass_factor(self.count, self.edges, self.case.boundary)

    @cached_property
    def steady_load(self) -> np.ndarray:
        """(3, n) forces and moments (N, N·m) of the loads that are always there."""
        return steady(self.case, self.assembly, self.mass)

    @cached_property
    def free(self) -> np.ndarray:
        """(3,) 1 for a component that moves, 0 for one held everywhere."""
        free = np.ones(3)
        free[list(self.ground.held)] = 0.0
        return free

    @property
    def remembers(self) -> bool:
        """Whether the scene's law has a memory: contacts that open and slide, bonds that break."""
        return self.case.material.law != "elastic"

    def contact_list(self) -> ContactList:
        """The scene's pairs, with nothing in their memory."""
        periodic = (_is_periodic(self.case, "left"), _is_periodic(self.case, "bottom"))
        periods = tuple(
            float(size) if wraps else None for size, wraps in zip(self.assembly.size, periodic, strict=True)
        )
        return ContactList(self.ground, self.case.material, self.assembly, periods, self.seam)  # type: ignore[arg-type]

    def seam_table(self, nodes: np.ndarray) -> tables.Seam:
        """What the free-field column does to some nodes (k,), ascending; it has no follow and no ends yet."""
        k, seam = len(nodes), self.seam
        empty = np.zeros(0, dtype=np.uint32)
        start = np.zeros(k + 1, dtype=np.uint32)
        if seam is None:
            return tables.Seam(np.full(k, -1), np.zeros((k, 3)), start, empty, empty, empty)
        many = np.zeros(k, dtype=np.uint32)
        many[np.searchsorted(nodes, seam.node)] = seam.many
        np.cumsum(many, out=start[1:])
        line = self._line_of[2 * seam.kind + seam.second]
        twin = np.where(nodes < seam.count, -1, seam.twin[nodes])
        return tables.Seam(
            twin, np.zeros((k, 3)), start, seam.near.astype(np.uint32), line.astype(np.uint32), np.zeros_like(empty)
        )

    @cached_property
    def _line_of(self) -> np.ndarray:
        return palette_of(self.ground)[1]

    @property
    def bytes(self) -> int:
        """Memory of the particle, contact and state arrays, those before an excavation included."""
        state = 9 * 8 * self.count  # u, its successor and v
        step = 4 * 8 * self.count  # mass, inertia and their mobilities
        arrays = (*self.rows, *vars(self.assembly).values())
        before = 0 if self.before is None else self.before.bytes
        return before + state + step + sum(a.nbytes for a in arrays if isinstance(a, np.ndarray))


def build(case: DiskCase) -> Scene:
    """Pack, tile, hollow and support a case.

    Raises PackingError when the brick cannot be made or nothing of it is left, CaseError when nothing of a side is.
    """
    ground = ground_of(case)
    periodic = (_is_periodic(case, "left"), _is_periodic(case, "bottom"))
    body = tile(ground.brick, case.packing.copies, periodic)
    edges = find_edges(body, periodic)
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


def _scene(case: DiskCase, ground: Ground, assembly: Assembly, edges: Mapping[str, Edge]) -> Scene:
    """The scene of a body and its sides, joined to a free-field column where the case has such sides."""
    seam = None
    if sides := _free_field_sides(case):
        assembly, seam = with_column(ground.brick, assembly, sides)
        edges = edges_beside_column(assembly, seam, edges)
    assembly, seam = _with_half_contacts(case, ground.brick, assembly, seam, edges)
    return Scene(
        case=case,
        ground=ground,
        assembly=assembly,
        rows=contact_rows(assembly, ground),
        edges=edges,
        supports=_supports(case, ground, assembly, edges),
        monitors=_monitors(case, assembly, seam),
        seam=seam,
    )


def column_alone(scene: Scene) -> Scene:
    """The free-field column beside a body as a scene of its own, under its bottom and top alone.

    Its particles are numbered as in the body's scene; of the loads it has those that act everywhere.
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
    return _scene(alone, scene.ground, column, find_edges(column, (True, False)))


def ground_of(case: DiskCase) -> Ground:
    """The case's brick, packed or from the cache, with its material."""
    brick = case.packing.pack(nominal_moduli(case.material).emod)
    return make_ground(brick, case.material, case.motion.held)


def _free_field_sides(case: DiskCase) -> tuple[str, ...]:
    return tuple(side for side, table in case.boundary.items() if isinstance(table, FreeField))


def _hollowed(
    case: DiskCase, brick: Brick, body: Assembly, edges: Mapping[str, Edge], holes: tuple[Hole, ...]
) -> tuple[Assembly, dict[str, Edge], np.ndarray]:
    """A body and its sides without what lies in some holes, and the indices (m,) of the particles left.

    What a hole bares is free: no side gets other particles than it had.
    """
    removed = np.logical_or.reduce([hole.contains(body.positions) for hole in holes])
    left, kept = body.without(removed)
    if sides := _free_field_sides(case):
        seam = with_column(brick, body, sides)[1]
        if not np.isin(seam.node - seam.count, kept).all():
            raise CaseError([f"hole: reaches the free field of {' or '.join(sides)}, which has no hole"])
    return left, {side: left_of(edge, kept) for side, edge in edges.items()}, kept


def with_boundaries(scene: Scene, case: DiskCase) -> Scene:
    """The same body under the boundaries of another case; only what stands in [boundary.*] and [wave.*] counts."""
    built_in = [
        ([edge.side for edge in half_edges(scene.edges, each.boundary)], _free_field_sides(each))
        for each in (scene.case, case)
    ]
    if built_in[0] != built_in[1]:
        return build(case)  # masses, contacts and the column change with them
    return replace(scene, case=case, supports=_supports(case, scene.ground, scene.assembly, scene.edges))


def _is_periodic(case: DiskCase, side: str) -> bool:
    return side in case.boundary and case.boundary[side].type == "periodic"


def _with_half_contacts(
    case: DiskCase, brick: Brick, assembly: Assembly, seam: Seam | None, edges: Mapping[str, Edge]
) -> tuple[Assembly, Seam | None]:
    """The contacts along sides of half cells, those across a seam included, made of the half kind."""
    vectors, whole = brick.vectors, len(brick.pairs)

    def halved(kind: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        plain = kind % whole
        return plain + whole * half_contacts(first, second, vectors[plain], edges, case.boundary).astype(kind.dtype)

    assembly = replace(assembly, kind=halved(assembly.kind, *assembly.pairs.T))
    if seam is not None:
        owner = np.repeat(seam.twin[seam.node], seam.many)
        seam = replace(seam, kind=halved(seam.kind, owner, seam.near))
    return assembly, seam


def boundary_medium(case: DiskCase, ground: Ground, axis: int) -> Medium:
    """What a side stands for: the wave speeds the case names, else the packing's own along the side's normal.

    axis is that of the normal, 0 (x) or 1 (y): a packing may be stiffer along one than along the other.
    """
    p_gradient, s_gradient = ((0, 3), (1, 2))[axis]  # of u_n and of u_s along the normal, see ground.GRADIENTS
    p_speed, s_speed = case.material.p_wave_speed, case.material.s_wave_speed
    if p_speed is None:
        p_speed = float(np.sqrt(ground.material_tensor[p_gradient, p_gradient] / ground.density))
    if s_speed is None:
        s_speed = float(np.sqrt(ground.material_tensor[s_gradient, s_gradient] / ground.density))

    def mirror_stiffness(diameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        between = LAWS[ground.law](ground.moduli, 0.5 * diameters, 0.5 * diameters, diameters)
        return between.normal, between.bending

    return Medium(ground.density, p_speed, s_speed, mirror_stiffness)


def _supports(case: DiskCase, ground: Ground, assembly: Assembly, edges: Mapping[str, Edge]) -> Supports:
    """All sides' recipes and all driven loads in one table."""
    builder = SupportBuilder(held=ground.held)
    for side, table in case.boundary.items():
        if side in edges:
            edge = edges[side]
            table.support(edge, boundary_medium(case, ground, edge.axis), case.wave, builder)
    factor = mass_factor(len(assembly.radii), edges, case.boundary)
    drive(case, assembly, ground.mass[assembly.brick_particle] * factor, builder)
    return builder.table()


def _monitors(case: DiskCase, assembly: Assembly, seam: Seam | None) -> dict[str, int]:
    """The particle of the body nearest to each monitor's position, and its twin in the free-field column."""
    if not case.monitor:
        return {}
    first = 0 if seam is None else seam.count
    _, nodes = cKDTree(assembly.positions[first:]).query([m.position for m in case.monitor])
    monitors = {m.name: first + int(node) for m, node in zip(case.monitor, nodes, strict=True)}
    if seam is not None:
        monitors |= {f"{name}{FREE_FIELD}": int(seam.twin[node]) for name, node in monitors.items()}
    return monitors
