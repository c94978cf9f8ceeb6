"""Ties between the particles of a box and the continuum round it, one for every bond that a side of the box cuts.

A tie is the half of the bond next to the particle (kernels/wall.py). The motion of the bond's middle is that of the
homogenised packing: the continuum's displacement U and gradient ∇U at the point of an element that is nearest to the
contact of the two disks i, j, plus

    c = ½(χ_i + χ_j) + ½(l_i χ^θ_i − l_j χ^θ_j) t + (x_middle − x_nearest),   c^θ = ½(χ^θ_i + χ^θ_j)   per unit ∇U

with the correctors χ of the brick (disks/homogenise.py) and the arms l of the bond. Under a uniform gradient a tie then
has exactly the force and moment of the bond. Derivatives of shape functions are large at the edges of an element, where
the nodes are light: ∂_x and ∂_y are taken at least an arm inside, without which the stable step may be ten times
smaller.

The continuum begins where the mass of the packing ends, at x_e along the normal (`Brick.mass_offset`). Its ties are
elsewhere: weighted by the forces f of a component under a unit gradient along the normal, at x_t = Σ f(x + c)/Σ f. So
they would have the motion at x_t, and the reaction, the transpose, would act there as well, which elements see as a
force at x_e with a couple. The couple strains them by as much again, so that waves would meet a gap of x_t − x_e and be
reflected in the ratio κ(x_t − x_e)/2. Therefore ties have the motion half-way between both, see `CutBonds.between`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.disks.packed_material import PackedMaterial
from dembound.kernels.lanes import LANES
from dembound.kernels.tables import WallTies
from dembound.motion.layout import aligned_zeros
from dembound.outside.mesh import Mesh
from dembound.packings.cut import CutContacts

GRADIENT = ((0, 2), (3, 1))
"""The gradient ∂u_a/∂b of components a and axes b, by its number in `homogenise.GRADIENTS`."""


@dataclass(frozen=True, eq=False)
class CutBonds:
    """The halves of cut bonds next to a body.

    Attributes
    ----------
    particle : (t,) disk of the body. normal : (2, t) from its centre to that beyond. arm : (t,) m, to the contact.
    height : (t,) m, of its centre. point : (t, 2) m, of the contact; in a `Wall` that of its element nearest to it.
    stiffness : (3, t) N/m, N/m and N·m, of half the bond: twice that of the bond.
    corrector : (3, 4, t) m and rad, c above per unit gradient xx, yy, xy, yx; own : the same, χ of the body's disk.
    force : (3, 4, t) N and N·m per unit gradient, of the bond at the contact: along x and y, and its bending moment.
    side : (t,) int64, index in `boundaries.SIDES` of the side that cuts the bond, of two the first.
    """

    particle: np.ndarray
    normal: np.ndarray
    arm: np.ndarray
    height: np.ndarray
    point: np.ndarray
    stiffness: np.ndarray
    corrector: np.ndarray
    own: np.ndarray
    force: np.ndarray
    side: np.ndarray

    @classmethod
    def of(cls, ground: PackedMaterial, cut: CutContacts, positions: np.ndarray) -> CutBonds:
        """Those of cut contacts of a body with disks at these positions (n, 2) m."""
        law, kind, second = ground.stiffness, cut.contact_type, cut.is_second
        arms = np.where(second, [law.arm_j[kind], law.arm_i[kind]], [law.arm_i[kind], law.arm_j[kind]])
        vectors = cut.vectors(ground.brick).T
        normal = vectors / np.hypot(*vectors)
        own, other = (
            np.moveaxis(ground.continuum.corrector[:, disk], 1, 2)
            for disk in (np.where(second, *ground.brick.pairs[kind].T[::-1]), cut.other)
        )
        # from the contact to the bond's middle
        corrector = _middle(own, other, arms, normal) + _uniform(0.5 * vectors - arms[0] * normal)
        stiffness = 2.0 * np.stack([law.normal[kind], law.shear[kind], law.bending[kind]])
        strained = _uniform(arms[0] * normal) + corrector - own
        return cls(
            particle=cut.node,
            normal=normal,
            arm=arms[0],
            height=positions[cut.node, 1],
            point=positions[cut.node] + (arms[0] * normal).T,
            stiffness=stiffness,
            corrector=corrector,
            own=own,
            force=_forces(stiffness, normal, arms[0], strained, own[2]),
            side=cut.side,
        )

    @property
    def on_disks(self) -> np.ndarray:
        """(3, 4, t) N and N·m per unit gradient, forces of the bonds on the disks, and moments about their centres."""
        nx, ny = self.normal
        fx, fy, bending = self.force
        return np.stack([fx, fy, bending + self.arm * (nx * fy - ny * fx)])

    def between(self, sides: Sequence[float]) -> CutBonds:
        """Those with the motion half-way between where they are and the sides of the continuum.

        sides : left and right (x), lower and upper (y), m. A component along the normal is moved by the strain along
        it, one across by the shear strain, so that no rotation strains a tie.
        """
        corrector = self.corrector.copy()
        for number, edge in enumerate(sides):
            axis, chosen = number // 2, self.side == number
            for component in range(2) if chosen.any() else ():
                gradient = GRADIENT[component][axis]
                force = self.force[:, gradient, chosen]
                moved = np.sum(force * self.corrector[:, gradient, chosen])
                place = (np.sum(force[component] * self.point[chosen, axis]) + moved) / np.sum(force[component])
                for each in {gradient, GRADIENT[axis][component]}:
                    corrector[component, each, chosen] += 0.5 * (edge - place)
        return replace(self, corrector=corrector)

    def read_at(self, point: np.ndarray) -> CutBonds:
        """The same with the continuum's motion at other points (t, 2) m: c has the way from there."""
        corrector = self.corrector + _uniform((self.point - point).T)
        return replace(self, point=point, corrector=corrector)

    def numbered_from(self, first: int) -> CutBonds:
        """The same where the body's first disk is that of this number."""
        return replace(self, particle=self.particle + first)


def _middle(own: np.ndarray, other: np.ndarray, arms: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Motion (3, 4, t) of the middles of bonds, from that of both disks, (3, 4, t), with arms (2, t)."""
    along = np.stack([-normal[1], normal[0]])
    middle = 0.5 * (own + other)
    middle[:2] += 0.5 * along[:, None] * (arms[0] * own[2] - arms[1] * other[2])
    return middle


def _uniform(vector: np.ndarray) -> np.ndarray:
    """Displacements (3, 4, t) over vectors (2, t) m under unit gradients; no rotation."""
    moved = np.zeros((3, 4, vector.shape[1]))
    for component, gradients in enumerate(GRADIENT):
        for axis, gradient in enumerate(gradients):
            moved[component, gradient] = vector[axis]
    return moved


def _forces(
    stiffness: np.ndarray, normal: np.ndarray, arm: np.ndarray, moved: np.ndarray, angle: np.ndarray
) -> np.ndarray:
    """Forces along x and y and bending moments (3, 4, t) of ties at motions (3, 4, t) relative to their disks.

    angle : (4, t) rotation of the disks.
    """
    nx, ny = normal
    pull = stiffness[0] * (nx * moved[0] + ny * moved[1])
    shear = stiffness[1] * (nx * moved[1] - ny * moved[0] - arm * angle)
    return np.stack([pull * nx - shear * ny, pull * ny + shear * nx, stiffness[2] * moved[2]])


@dataclass(frozen=True, eq=False)
class Wall:
    """Ties of cut bonds to the elements of a mesh.

    Attributes
    ----------
    bonds : sorted by the element they are tied to. mesh : the elements. element : (t,) that of each bond. local :
    (t, 2) places of the points in it, −1 … 1. lag : η, s. mean : along x and y, whether ties have the mean motion of
    their element.
    """

    bonds: CutBonds
    mesh: Mesh
    element: np.ndarray
    local: np.ndarray
    lag: float
    mean: tuple[bool, bool] = (False, False)

    @classmethod
    def of(cls, mesh: Mesh, bonds: CutBonds, lag: float, mean: tuple[bool, bool] = (False, False)) -> Wall:
        """Each bond tied to the element nearest to its contact, or to its mean motion along x or y.

        The mean is for elements with less than a disk to each node, which single bonds would indent.
        """
        element, local = mesh.located(bonds.point)
        inside = np.clip(local, -1.0, 1.0)
        bonds = bonds.read_at(bonds.point + 0.5 * (inside - local) * mesh.element_sizes[element])
        order = np.argsort(element, kind="stable")
        ordered = {name: values[..., order] for name, values in vars(bonds).items() if name != "point"}
        return cls(CutBonds(**ordered, point=bonds.point[order]), mesh, element[order], inside[order], lag, mean)

    def only(self, chosen: np.ndarray) -> Wall:
        """Some of the ties (k,), ascending."""
        ties = {name: values[..., chosen] for name, values in vars(self.bonds).items() if name != "point"}
        bonds = CutBonds(**ties, point=self.bonds.point[chosen])
        return replace(self, bonds=bonds, element=self.element[chosen], local=self.local[chosen])

    @cached_property
    def elements(self) -> np.ndarray:
        """(e,) the elements that have ties."""
        return np.unique(self.element)

    @cached_property
    def nodes(self) -> np.ndarray:
        """(m,) the nodes of these elements, ascending."""
        return np.unique(self.mesh.nodes[self.elements])

    def ties(self, particle: np.ndarray, node: np.ndarray, line: np.ndarray, twin: np.ndarray | None) -> WallTies:
        """The arrays for the kernels.

        particle : (n,) slot of every disk of the body; node : (m,) that of every node of the mesh; line : (slots,) line
        of slots in the support table; twin : (n,) slot of every disk's twin in the free-field column, None for none.
        """
        bonds, mesh, sizes = self.bonds, self.mesh, self.mesh.element_sizes[self.element]
        start, place = self._blocks
        lanes = LANES * int(start[-1])

        def laid(values: np.ndarray) -> np.ndarray:
            """Values (…, t) by blocks of eight, zero where there is no tie."""
            wide = np.zeros((*values.shape[:-1], lanes), dtype=values.dtype)
            wide[..., place] = values
            return wide

        def in_blocks(values: np.ndarray) -> np.ndarray:
            """Values (f, t), the f of each block together."""
            wide = laid(values)
            return np.ascontiguousarray(wide.reshape(len(wide), -1, LANES).swapaxes(0, 1)).ravel()

        (along, along_slope), (up, up_slope) = (
            [in_blocks(values.T) for values in self._seen(at, size, of_mean)]
            for at, size, of_mean in zip(self.local.T, sizes.T, self.mean, strict=True)
        )
        own = np.full(lanes, particle[bonds.particle[0]])
        own[place] = particle[bonds.particle]
        twins = np.full(lanes, -1)
        if twin is not None:
            twins[place] = twin[bonds.particle]
        nodes = node[mesh.nodes[self.elements]].reshape(len(self.elements), -1)
        return WallTies(
            points=tuple(mesh.rule.points.tolist()),
            start=start,
            node=nodes,
            line=line[nodes],
            particle=own,
            particle_line=line[own],
            twin=twins,
            along=along,
            along_slope=along_slope,
            up=up,
            up_slope=up_slope,
            corrector=in_blocks(bonds.corrector.reshape(12, -1)),
            normal=laid(bonds.normal).ravel(),
            arm=laid(bonds.arm),
            stiffness=laid(bonds.stiffness).ravel(),
            lag=self.lag,
            moved=np.zeros(2 * nodes.shape[1]),
            reaction=aligned_zeros(2 * nodes.shape[1] * LANES),
            field=aligned_zeros(6 * LANES),
            own=aligned_zeros(3 * LANES),
        )

    def _seen(self, at: np.ndarray, size: np.ndarray, mean: bool) -> tuple[np.ndarray, np.ndarray]:
        """Shape functions (t, N) and their slopes (1/m) at places −1 … 1 of elements of sizes (t,) m, or their means.

        Slopes are those at least an arm inside. Their mean is zero where an element has itself as its neighbour.
        """
        rule = self.mesh.rule
        if mean:
            return np.tile(0.5 * rule.weights, (len(at), 1)), np.zeros((len(at), rule.count))
        most = np.maximum(1.0 - 2.0 * self.bonds.arm / size, 0.0)
        return rule.shape(at), rule.slope(np.clip(at, -most, most)) * (2.0 / size[:, None])

    @cached_property
    def _blocks(self) -> tuple[np.ndarray, np.ndarray]:
        """First block of eight of each element with ties, (e + 1,), and the place (t,) of every tie in the blocks."""
        first = np.append(np.searchsorted(self.element, self.elements), len(self.element))
        many = np.diff(first)
        start = np.concatenate([[0], np.cumsum(-(-many // LANES))])
        return start, np.repeat(LANES * start[:-1] - first[:-1], many) + np.arange(len(self.element))


def lag_of(ground: PackedMaterial, damping: float) -> float:
    """η (s) of the ties: with half bonds of normal stiffness 2K, dashpots of `damping`·ρc_pD for K = ρc_p²."""
    speed = float(np.sqrt(np.mean(np.diag(ground.material_tensor)[:2]) / ground.density))
    return 0.5 * damping * ground.brick.mean_diameter / speed
