"""The continuum round a body of disks, on the sides of type "outside", and the ties between both."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from dembound.boundaries.edge import SIDES, normal_axis
from dembound.boundaries.support import Edge, SupportBuilder
from dembound.casefile.disks.layer import CONTINUUM
from dembound.continuum.edges import free_edges
from dembound.continuum.interpolation import located
from dembound.continuum.medium import Ground, Layered, Unlike, one_side
from dembound.continuum.mesh import Mesh
from dembound.continuum.part import GridBody
from dembound.damping import Attenuation
from dembound.disks.material.free_surface import mass_of
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.unlike import UnlikeGround
from dembound.disks.surroundings.cut_bonds import CutBonds
from dembound.disks.surroundings.media import medium_of
from dembound.disks.surroundings.mesh import Level, Outline, box_of, mass_extent, on_top
from dembound.disks.surroundings.settings import Settings
from dembound.disks.surroundings.wall import Wall, lag_of
from dembound.errors import CaseError
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.tables import WallTies
from dembound.kernels.wall import tie_forces
from dembound.motion.state import Layout, aligned_zeros
from dembound.packings.cut import cut_contacts
from dembound.packings.tiling import Assembly
from dembound.table import Box

ROUNDING = 1e-9
"""Distance over the size of the mesh up to which places are the same."""


@dataclass(frozen=True, eq=False)
class Surroundings:
    """A continuum round the disks of a body.

    Attributes
    ----------
    sides : with a continuum. settings : as given or chosen. body : elements, medium and layers. wall : the ties of cut
    bonds to it, by the numbers of disks in the scene. first : number of its first node in the scene. box : left,
    bottom, right and top of the body, m; waves from below pass its lower side at their own time. skins : depth of free
    edges below those of the packing, m, by side. levels : lower ground beyond left and right sides. twins : (m,) for
    each disk its twin in a free-field column, relative to which it is tied, of two columns in the first at the left and
    below and in the second at the right; none: tied by its own motion. rest : (3, n) m, m and rad, displacements of the
    scene's disks at which ties have no force; None: zero.
    surface_mass : kg/m², of the skin on its upper edge; level_masses : on that of lower ground, by side.
    """

    sides: tuple[str, ...]
    settings: Settings
    body: GridBody
    wall: Wall
    first: int
    box: Box
    skins: Mapping[str, float]
    levels: Mapping[str, Level]
    twins: tuple[np.ndarray, ...] = ()
    surface_mass: float = 0.0
    level_masses: Mapping[str, float] = field(default_factory=dict)
    rest: np.ndarray | None = None

    @property
    def count(self) -> int:
        """Number of nodes."""
        return self.body.count

    def is_beyond(self, places: np.ndarray) -> np.ndarray:
        """Whether places (k, 2) m are outside the body's box, (k,)."""
        low, high = np.array(self.box[:2]), np.array(self.box[2:])
        return np.any((places < low - self._near) | (places > high + self._near), axis=1)

    def is_right(self, places: np.ndarray) -> np.ndarray:
        """Whether the elements at places (k, 2) m are right of the body, also below it, (k,)."""
        return np.asarray(self.body.mesh.is_right[located(self.body.mesh, places)[0]])

    def height_at(self, places: np.ndarray) -> np.ndarray:
        """Heights (k,) m up to which there is ground at places (k, 2) m beyond lower sides; infinite at others."""
        left, _, right, _ = self.box
        x, height = places[:, 0], np.full(len(places), np.inf)
        for side, level in self.levels.items():
            height[x < left - self._near if side == "left" else x > right + self._near] = level.floor
        return height

    def allowed(self, places: np.ndarray) -> np.ndarray:
        """The places (k, 2) m; any in layers, beyond them, or above lower ground moved to the nearest other place."""
        mesh = self.body.mesh
        (low, high), thickness = mesh.between_layers, np.array([axis.thickness for axis in mesh.axes])
        too_low = (thickness[:, 0] > 0.0) & (places < low - self._near)
        too_high = (thickness[:, 1] > 0.0) & (places > high + self._near)
        allowed = np.where(too_low, low, np.where(too_high, high, places))
        allowed[:, 1] = np.minimum(allowed[:, 1], self.height_at(allowed))
        return allowed

    @property
    def depths(self) -> dict[str, float | np.ndarray]:
        """Depth (m) of free edges below those of the ground, by side; per node (n,) where the ground is lower."""
        if not self.levels:
            return {**self.skins}
        lower = {side: level.floor - level.surface for side, level in self.levels.items()}
        return {**self.skins, "top": on_top(self.body.mesh, self.skins["top"], lower)}

    @property
    def free_surface(self) -> tuple[float, float] | None:
        """Height y (m) and mass (kg/m²) of the free surface of the ground; None if it goes on above."""
        mesh = self.body.mesh
        if mesh.layer.top:
            return None
        return float(mesh.origin[1] + mesh.size[1]), self.surface_mass

    def surface_at(self, side: str) -> tuple[float, float]:
        """Height y (m) and mass (kg/m²) of the free surface beyond the left or right side."""
        if side in self.levels:
            return self.levels[side].surface, self.level_masses[side]
        assert self.free_surface is not None
        return self.free_surface

    @property
    def _near(self) -> float:
        """Distance (m) up to which places are the same."""
        return ROUNDING * float(self.body.mesh.size.max())

    @property
    def columns(self) -> dict[str, tuple[np.ndarray, str]]:
        """Data for the record: of nodes (m, …), of cells and elements, of its free surface, and of ties.

        Positions (m, 2) and whether nodes absorb (m,); corners (c, 4) of the cells between them; rectangles (e, 4) and
        nodes (e, N, N) of elements, by row and column; ends (k, 4) of free sides; points (t, 2) at which ties act.
        """
        mesh = self.body.mesh
        return {
            "position": (mesh.positions, "m"),
            "absorbs": (np.any(mesh.depth > 0.0, axis=1), "1"),
            "cell": (mesh.node_cells, "1"),
            "element": (mesh.rectangles, "m"),
            "node": (mesh.nodes, "1"),
            "surface": (free_edges(mesh), "m"),
            "tie": (self.wall.bonds.point, "m"),
        }

    @cached_property
    def tied(self) -> np.ndarray:
        """Disks and nodes (k,) that ties act on, by their numbers in the scene, ascending."""
        return np.union1d(self.wall.bonds.particle, self.first + self.wall.nodes)

    @cached_property
    def tied_by_side(self) -> dict[str, np.ndarray]:
        """Tied disks (k,) by side, and nodes (m,) of the continuum by ``<side>.continuum``, by number in the scene.

        A disk belongs to the side that cuts its first bond, a node to the side of the first element it belongs to.
        """
        wall = self.wall
        disk, first = np.unique(wall.bonds.particle, return_index=True)
        _, begin = np.unique(wall.element, return_index=True)
        nodes = self.body.mesh.nodes[wall.elements].reshape(len(wall.elements), -1)
        node, entry = np.unique(nodes, return_index=True)
        side_of_node, tied = wall.bonds.side[begin[entry // nodes.shape[1]]], {}
        for number, name in enumerate(SIDES):
            if name in self.sides:
                tied[name] = disk[wall.bonds.side[first] == number]
                tied[f"{name}{CONTINUUM}"] = self.first + node[side_of_node == number]
        return tied

    @cached_property
    def edges(self) -> dict[str, Edge]:
        """The tied nodes as sides of their own, by ``<side>.continuum``."""
        edges = {}
        for name, tied in self.tied_by_side.items():
            if name.endswith(CONTINUUM):
                side, nodes = name.removesuffix(CONTINUUM), tied - self.first
                length = float(self.body.mesh.size[1 - normal_axis(side)])
                edges[name] = Edge(side, tied, self.body.mesh.positions[nodes], np.ones(len(nodes)), length)
        return edges

    def laid_out(self, layout: Layout) -> Layout:
        """The slots of a layout, and those of the continuum's nodes behind them."""
        slots = np.concatenate([layout.slot, self.body.blocks.slot])
        return Layout(slots, -(-self.body.blocks.end // LANES) * LANES)

    @property
    def nodes(self) -> slice:
        """The range of its nodes in the scene."""
        return slice(self.first, self.first + self.count)

    def ties(self, layout: Layout, supported: np.ndarray) -> WallTies:
        """The ties for the kernels; supported (k,) are the nodes of the support table, ascending."""
        line, slot = np.zeros(layout.count, dtype=np.int64), layout.slot
        line[slot[supported]] = np.arange(len(supported))
        disk, twin, rest = self.wall.bonds.particle, None, None
        if self.twins:
            right = self.wall.bonds.side == SIDES.index("right")
            twin = np.where(right, self.twins[-1][disk], self.twins[0][disk])
        if self.rest is not None:
            rest = self.rest[:, disk] - (0.0 if twin is None else self.rest[:, twin])
        return self.wall.ties(slot, slot[self.nodes], line, None if twin is None else slot[twin], rest)

    def add_tie_forces(self, layout: Layout, u: np.ndarray, force: np.ndarray) -> None:
        """Add the forces (3, n) of its ties on all nodes of the scene at displacements u (3, slots), at rest."""
        of_ties = np.zeros((len(self.tied), 3))
        tie_forces(self.ties(layout, self.tied), u, np.zeros_like(u), of_ties, 0.0)
        force[:, self.tied] += of_ties.T

    def support(self, builder: SupportBuilder) -> None:
        """Add rows of its nodes with ties or drives, or on planes of symmetry, to the support table.

        These nodes do not rotate, nor move across the planes.
        """
        builder.side = ""
        for axis in (0, 1):
            builder.add(self.first + self.body.mesh.on_mirrors(axis), axis, prescribed=True)
        others = builder.nodes
        others = others[(others >= self.nodes.start) & (others < self.nodes.stop)]
        tied = np.union1d(self.wall.nodes, np.concatenate(self.body.mesh.doubled))
        builder.add(np.union1d(self.first + tied[~self.body.mesh.held[tied]], others), 2, prescribed=True)

    def adds_forces(self, layout: Layout) -> Callable[[np.ndarray, np.ndarray, float], None]:
        """A function of displacements u (3, slots), forces (3, slots) and a factor.

        It fills the forces on the continuum, and adds those of the ties times the factor to all.
        """
        slot, tied = self.body.blocks.slot, layout.slot[self.tied]
        ties = replace(self, twins=(), rest=None).ties(layout, self.tied)  # twins do not move with the body
        own, rest = aligned_zeros(3, layout.count), aligned_zeros(3, layout.count)
        of_ties = np.zeros((len(tied), 3))

        def add(u: np.ndarray, force: np.ndarray, times: float) -> None:
            self.body.fill_forces(u, own)
            force[:, slot] = own[:, slot]
            of_ties[:] = 0.0
            tie_forces(ties, u, rest, of_ties, 0.0)
            force[:, tied] += times * of_ties.T

        return add


def surroundings_of(
    ground: PackedMaterial,
    body: Assembly,
    outline: Outline,
    layout: Layout,
    first: int = 0,
    twins: tuple[np.ndarray, ...] = (),
    inner: float | None = None,
) -> Surroundings:
    """The continuum with an outline round a body.

    layout : of the nodes before its own, of which the body's disks are those from number `first` on. twins : see
    `Surroundings`. inner : see `GridBody`.

    Raises CaseError if the packing's sides cut no bonds, and for a body so thin that one side is no disk's first.
    """
    sides, size, rim, mesh = outline
    cut = cut_contacts(ground.brick, body, sides, mesh.periodic, rim.ends)
    if len(cut.node) == 0:
        raise CaseError([f"boundary.{sides[0]}: cuts no bonds, so nothing can be tied to the continuum"])
    massless: dict[str, float | np.ndarray] = {**rim.massless}
    if rim.levels:
        beyond = {side: level.mass_end - level.surface for side, level in rim.levels.items()}
        massless["top"] = on_top(mesh, rim.massless["top"], beyond)
    grid = GridBody(
        mesh=mesh,
        medium=_on_edges(medium_of(ground), mesh),
        mechanisms=mechanisms_upwards(ground),
        absorption=size.settings.absorption,
        thickness=float(np.prod(mass_extent(ground, body) / size.box)),
        first_slot=-(-layout.count // LANES) * LANES,
        inner=inner,
    )
    density = grid.own_mass / (grid.thickness * mesh.areas) if ground.is_layered else ground.density
    grid = replace(grid, added_mass=mass_of(massless, mesh, density))
    bonds = CutBonds.of(ground, cut, body.positions).between(mesh.sides)
    bonds = replace(bonds, particle=bonds.particle + first)
    wall = Wall.of(mesh, bonds, lag_of(ground, size.settings.damping), size.narrow)
    above = [ground.beside(side).at(rim.surface or rim.box[3]).density for side in ("left", "right")]
    surface_mass = rim.massless.get("top", 0.0) * (0.5 * sum(above))
    level_masses = {
        side: (level.mass_end - level.surface) * ground.beside(side).at(level.surface).density
        for side, level in rim.levels.items()
    }
    found = Surroundings(
        sides, size.settings, grid, wall, len(layout.slot), box_of(body), rim.skins, rim.levels, twins, surface_mass,
        level_masses,
    )  # fmt: skip
    if thin := [side for side in sides if len(found.tied_by_side[side]) == 0]:
        said = "has no disk that is not tied by another side; make the body two disks wide and high, or more"
        raise CaseError([f"boundary.{thin[0]}: {said}"])
    return found


def mechanisms_upwards(ground: PackedMaterial) -> tuple[Attenuation | None, ...]:
    """The mechanisms of the layers from the bottom up, in unlike ground those of the left side and then the right."""
    each = ground.sides if isinstance(ground, UnlikeGround) else (ground,)
    return tuple(one for side in each for one in side.mechanisms_by_layer[::-1])


def _on_edges(ground: Ground, mesh: Mesh) -> Ground:
    """The ground with its joints on the edges of rows nearest to them: one beside the edge of the box lies on it."""
    if isinstance(ground, Unlike):
        left, right = (one_side(_on_edges(side, mesh)) for side in (ground.left, ground.right))
        return Unlike(left, right)
    if not isinstance(ground, Layered):
        return ground
    edges = mesh.origin[1] + mesh.axes[1].edges
    nearest = [(joint, float(edges[np.argmin(np.abs(edges - joint))])) for joint in ground.joints]
    return replace(ground, joints=tuple(edge if edges[0] < joint < edges[-1] else joint for joint, edge in nearest))
