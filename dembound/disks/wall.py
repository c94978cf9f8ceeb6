"""Ties between the particles of a box and the continuum round it, one for every bond that a side of the box cuts.

A tie is the half of the bond next to the particle (kernels/wall.py). The motion of the bond's middle is that of the
homogenised packing: the continuum's displacement U and gradient ∇U at the point where the two disks i, j touch, plus

    c = ½(χ_i + χ_j) + ½(l_i χ^θ_i − l_j χ^θ_j) t + (x_middle − x_contact),   c^θ = ½(χ^θ_i + χ^θ_j)   per unit ∇U

with the correctors χ of the brick (disks/homogenise.py) and the arms l of the bond. Under a uniform gradient a tie then
has exactly the force and moment of the bond.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.disks.packed_material import PackedMaterial
from dembound.kernels.lanes import LANES
from dembound.kernels.tables import WallTies
from dembound.motion.layout import aligned_zeros
from dembound.outside.mesh import Mesh
from dembound.packings.cut import CutContacts


@dataclass(frozen=True, eq=False)
class CutBonds:
    """The halves of cut bonds next to a body.

    Attributes
    ----------
    particle : (t,) disk of the body. normal : (2, t) from its centre to that beyond. arm : (t,) m, to the contact.
    point : (t, 2) m, of the contact. stiffness : (3, t) N/m, N/m and N·m, of half the bond: twice that of the bond.
    corrector : (3, 4, t) m and rad, c above per unit gradient xx, yy, xy, yx. side : (t,) int64, index in
    `boundaries.SIDES` of the side that cuts the bond, of two the first.
    """

    particle: np.ndarray
    normal: np.ndarray
    arm: np.ndarray
    point: np.ndarray
    stiffness: np.ndarray
    corrector: np.ndarray
    side: np.ndarray

    @classmethod
    def of(cls, ground: PackedMaterial, cut: CutContacts, positions: np.ndarray) -> CutBonds:
        """Those of cut contacts of a body with disks at these positions (n, 2) m."""
        law, kind, second = ground.stiffness, cut.contact_type, cut.is_second
        arms = np.where(second, [law.arm_j[kind], law.arm_i[kind]], [law.arm_i[kind], law.arm_j[kind]])
        vectors = cut.vectors(ground.brick).T
        normal = vectors / np.hypot(*vectors)
        centre = positions[cut.node]
        own = np.where(second, *ground.brick.pairs[kind].T[::-1])
        corrector = _middle(ground.continuum.corrector, own, cut.other, arms, normal)
        off = 0.5 * vectors - arms[0] * normal  # from the contact to the bond's middle
        for component, gradients in enumerate(((0, 2), (3, 1))):
            for axis, gradient in enumerate(gradients):
                corrector[component, gradient] += off[axis]
        stiffness = 2.0 * np.stack([law.normal[kind], law.shear[kind], law.bending[kind]])
        return cls(cut.node, normal, arms[0], centre + (arms[0] * normal).T, stiffness, corrector, cut.side)


def _middle(
    corrector: np.ndarray, own: np.ndarray, other: np.ndarray, arms: np.ndarray, normal: np.ndarray
) -> np.ndarray:
    """Motion (3, 4, t) of the middles of bonds per unit gradient, from that of both disks, corrector (3, n, 4).

    arms : (2, t) of the disk `own` (t,) of the brick and of the `other`.
    """
    first, second = (np.moveaxis(corrector[:, disk], 1, 2) for disk in (own, other))
    along = np.stack([-normal[1], normal[0]])
    middle = 0.5 * (first + second)
    middle[:2] += 0.5 * along[:, None] * (arms[0] * first[2] - arms[1] * second[2])
    return middle


@dataclass(frozen=True, eq=False)
class Wall:
    """Ties of cut bonds to the elements of a mesh.

    Attributes
    ----------
    bonds : sorted by the element they are tied to. mesh : the elements. element : (t,) that of each bond. lag : η, s.
    """

    bonds: CutBonds
    mesh: Mesh
    element: np.ndarray
    lag: float

    @classmethod
    def of(cls, mesh: Mesh, bonds: CutBonds, lag: float) -> Wall:
        """Each bond tied to the element nearest to its contact."""
        element = mesh.located(bonds.point)[0]
        order = np.argsort(element, kind="stable")
        ordered = {name: values[..., order] for name, values in vars(bonds).items() if name != "point"}
        return cls(CutBonds(**ordered, point=bonds.point[order]), mesh, element[order], lag)

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
        bonds, mesh, (width, height) = self.bonds, self.mesh, self.mesh.element
        start, place = self._blocks
        lanes = LANES * int(start[-1])
        local = mesh.located(bonds.point)[1].T

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
            (in_blocks(mesh.rule.shape(at).T), in_blocks(mesh.rule.slope(at).T * (2.0 / size)))
            for at, size in zip(local, (width, height), strict=True)
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
