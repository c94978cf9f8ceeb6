"""The scene: the arrays a case becomes. This is the one place that names them, their shapes and their units."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from dembound.boundaries import SIDES, normal_axis
from dembound.boundaries.exposed import exposed
from dembound.boundaries.support import Edge, Medium, SupportBuilder, Supports
from dembound.case import Case
from dembound.ground import Ground, make_ground, nominal_moduli
from dembound.packings.tiling import Assembly, tile


@dataclass(frozen=True)
class ContactRows:
    """Every particle's contacts, as the kernels read them.

    start (n + 1,) uint32: row of particle i is start[i]:start[i + 1]; neighbour (e,) uint32; kind (e,) uint32, a
    line of palette (2b, 6), whose columns kernels/elastic.py explains. Each contact stands in two rows.
    """

    start: np.ndarray
    neighbour: np.ndarray
    kind: np.ndarray
    palette: np.ndarray

    @property
    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """The four arrays in the order the kernels take them."""
        return self.start, self.neighbour, self.kind, self.palette


@dataclass(frozen=True)
class Scene:
    """A case turned into arrays; n particles, all SI.

    Attributes
    ----------
    case : where it came from.
    ground : brick and material.
    assembly : the tiled brick: positions (n, 2) m, radii (n,) m, brick_particle (n,), contacts.
    contacts : rows of contacts for the kernels.
    edges : side -> its exposed particles, for every side that is not periodic.
    supports : the table of what pushes from outside.
    monitors : name -> particle.
    """

    case: Case
    ground: Ground
    assembly: Assembly
    contacts: ContactRows
    edges: Mapping[str, Edge]
    supports: Supports
    monitors: Mapping[str, int]

    @property
    def count(self) -> int:
        """Number of particles n."""
        return len(self.assembly.radii)

    @cached_property
    def mass(self) -> np.ndarray:
        """(n,) kg."""
        return self.ground.mass[self.assembly.brick_particle]

    @cached_property
    def inertia(self) -> np.ndarray:
        """(n,) kg·m²."""
        return self.ground.inertia[self.assembly.brick_particle]

    @cached_property
    def free(self) -> np.ndarray:
        """(3,) 1 for a component that moves, 0 for one held everywhere."""
        free = np.ones(3)
        free[list(self.ground.held)] = 0.0
        return free

    @property
    def bytes(self) -> int:
        """Memory of the particle, contact and state arrays."""
        state = 9 * 8 * self.count  # u, its successor and v
        step = 4 * 8 * self.count  # mass, inertia and their mobilities
        arrays = (*self.contacts.arrays, *vars(self.assembly).values())
        return state + step + sum(a.nbytes for a in arrays if isinstance(a, np.ndarray))


def build(case: Case) -> Scene:
    """Pack, tile and support a case.

    Raises PackingError when the brick cannot be made.
    """
    ground = ground_of(case)
    periodic = (_is_periodic(case, "left"), _is_periodic(case, "bottom"))
    assembly = tile(ground.brick, case.packing.copies, periodic)
    edges = find_edges(assembly, periodic)
    return Scene(
        case=case,
        ground=ground,
        assembly=assembly,
        contacts=contact_rows(assembly, ground),
        edges=edges,
        supports=_supports(case, ground, edges),
        monitors=_monitors(case, assembly),
    )


def ground_of(case: Case) -> Ground:
    """The case's brick, packed or from the cache, with its material."""
    brick = case.packing.pack(nominal_moduli(case.material).emod)
    return make_ground(brick, case.material, case.motion.held)


def with_boundaries(scene: Scene, case: Case) -> Scene:
    """The same body under the boundaries of another case; only what stands in [boundary.*] and [wave.*] counts."""
    return replace(scene, case=case, supports=_supports(case, scene.ground, scene.edges))


def _is_periodic(case: Case, side: str) -> bool:
    return side in case.boundary and case.boundary[side].type == "periodic"


def contact_rows(assembly: Assembly, ground: Ground) -> ContactRows:
    """Sort the contacts into one row per particle, over a palette of the brick's contact constants.

    The palette's lines are put in the order the rows use them, so that walking along the particles also walks
    along the palette, which one core's cache then serves.
    """
    palette, line_of = _palette(ground)
    i, j = assembly.pairs.T
    owner = np.concatenate([i, j])
    neighbour = np.concatenate([j, i])
    kind = line_of[np.concatenate([2 * assembly.kind, 2 * assembly.kind + 1])]
    order = np.lexsort((neighbour, owner))
    start = np.zeros(len(assembly.radii) + 1, dtype=np.uint32)
    np.cumsum(np.bincount(owner, minlength=len(assembly.radii)), out=start[1:])
    return ContactRows(start, neighbour[order].astype(np.uint32), kind[order].astype(np.uint32), palette)


def _palette(ground: Ground) -> tuple[np.ndarray, np.ndarray]:
    """Palette lines (2b, 6), and the line of contact k seen from its first (2k) and second disk (2k + 1)."""
    brick, law = ground.brick, ground.stiffness
    vectors = brick.vectors
    n = vectors / np.hypot(*vectors.T)[:, None]
    root_n, root_s = np.sqrt(law.normal), np.sqrt(law.shear)
    ratio = np.divide(root_s, root_n, out=np.zeros_like(root_n), where=root_n > 0.0)  # a gap without bond has neither
    common = [root_n * n[:, 0], root_n * n[:, 1], ratio]
    lines = np.empty((len(vectors), 2, 6))
    lines[:, 0] = np.stack([*common, root_s * law.arm_i, root_s * law.arm_j, law.bending], axis=1)
    lines[:, 1] = np.stack([*common, -root_s * law.arm_j, -root_s * law.arm_i, law.bending], axis=1)
    flat = lines.reshape(-1, 6)
    order = np.lexsort((brick.pairs[:, ::-1].ravel(), brick.pairs.ravel()))
    line_of = np.empty(len(order), dtype=np.int64)
    line_of[order] = np.arange(len(order))
    return flat[order], line_of


def find_edges(assembly: Assembly, periodic: tuple[bool, bool]) -> dict[str, Edge]:
    """The exposed particles of every side that is not periodic."""
    edges = {}
    for side in SIDES:
        axis = normal_axis(side)
        if periodic[axis]:
            continue
        length = float(assembly.extent[1 - axis])
        nodes = exposed(assembly.positions, assembly.radii, side, period=length if periodic[1 - axis] else None)
        edges[side] = Edge(side, nodes, 2.0 * assembly.radii[nodes], length)
    return edges


def boundary_medium(case: Case, ground: Ground, axis: int) -> Medium:
    """What dashpots absorb into: the wave speeds the case names, else the packing's own along the side's normal.

    axis is that of the normal, 0 (x) or 1 (y): a packing may be stiffer along one than along the other.
    """
    p_gradient, s_gradient = ((0, 3), (1, 2))[axis]  # of u_n and of u_s along the normal, see ground.GRADIENTS
    p_speed, s_speed = case.material.p_wave_speed, case.material.s_wave_speed
    if p_speed is None:
        p_speed = float(np.sqrt(ground.material_tensor[p_gradient, p_gradient] / ground.density))
    if s_speed is None:
        s_speed = float(np.sqrt(ground.material_tensor[s_gradient, s_gradient] / ground.density))
    return Medium(ground.density, p_speed, s_speed)


def _supports(case: Case, ground: Ground, edges: Mapping[str, Edge]) -> Supports:
    """All sides' recipes in one table."""
    builder = SupportBuilder(held=ground.held)
    waves = {name: wave.velocity for name, wave in case.wave.items()}
    for side, table in case.boundary.items():
        if side in edges:
            edge = edges[side]
            table.support(edge, boundary_medium(case, ground, edge.axis), waves, builder)
    return builder.table()


def _monitors(case: Case, assembly: Assembly) -> dict[str, int]:
    """The particle nearest to each monitor's position."""
    if not case.monitor:
        return {}
    _, nodes = cKDTree(assembly.positions).query([m.position for m in case.monitor])
    return {m.name: int(node) for m, node in zip(case.monitor, nodes, strict=True)}
