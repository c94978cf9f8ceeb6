"""Ties between the particles of a box and the continuum round it, one for every bond that a side of the box cuts.

A tie is the half of the bond next to the particle (kernels/wall.py). The motion of the bond's middle is that of the
homogenised packing: the continuum's displacement U and gradient ∇U at the point of an element that is nearest to the
contact of the two disks i, j, plus

    c = ½(χ_i + χ_j) + ½(l_i χ^θ_i − l_j χ^θ_j) t + (x_middle − x_nearest),   c^θ = ½(χ^θ_i + χ^θ_j)   per unit ∇U

with the correctors χ of the brick (homogenise.py) and the arms l of the bond. Under a uniform gradient a tie then
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

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.boundaries.edge import SIDES
from dembound.continuum.interpolation import located
from dembound.continuum.mesh import Mesh
from dembound.disks.material.layered import LayeredGround
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.surroundings.cut_bonds import CutBonds
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.tables import WallTies
from dembound.motion.state import aligned_zeros

ROUNDING = 1e-9
"""Part of an element, arm or angle below which a length or rotation is rounding."""


@dataclass(frozen=True, eq=False)
class Wall:
    """Ties of cut bonds to the elements of a mesh.

    Attributes
    ----------
    bonds : sorted by element. mesh : the elements. element : (t,) element of each bond. local :
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
        """Each bond tied to the element nearest to its contact, or to the element's mean motion along x or y.

        The mean is for elements with less than one disk per node, which single bonds would indent.
        """
        element, local = located(mesh, bonds.point, bonds.side == SIDES.index("right"))
        inside = np.clip(local, -1.0, 1.0)
        bonds = bonds.read_at(bonds.point + 0.5 * (inside - local) * mesh.element_sizes[element])
        inside = np.where(1.0 - np.abs(inside) < ROUNDING, np.sign(inside), inside)
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
        """Nodes (m,) that ties act on, ascending; of lattices only those of the edges."""
        return np.unique(self.mesh.nodes[self.elements][self._acts_on])

    @cached_property
    def _acts_on(self) -> np.ndarray:
        """Whether ties act on the nodes of their elements, (e, N, N) by row and column."""
        (along, along_slope), (up, up_slope) = ([each != 0.0 for each in pair] for pair in self._shapes)
        xx, yy, xy, yx = np.any(self._corrector != 0.0, axis=0)
        of_tie = up[:, :, None] & along[:, None, :]
        of_tie |= (xx | yx)[:, None, None] & up[:, :, None] & along_slope[:, None, :]
        of_tie |= (yy | xy)[:, None, None] & up_slope[:, :, None] & along[:, None, :]
        acts: np.ndarray = np.zeros((len(self.elements), *of_tie.shape[1:]), dtype=bool)
        np.logical_or.at(acts, np.searchsorted(self.elements, self.element), of_tie)
        return acts

    @cached_property
    def _corrector(self) -> np.ndarray:
        """Correctors (3, 4, t) of the bonds, without rounding, and without rotation where a bond does not bend."""
        corrector = self.bonds.corrector * (self.bonds.stiffness != 0.0)[[0, 0, 2], None]
        unit = np.ones((3, 1, len(self.bonds.arm)))
        unit[:2] = self.bonds.arm
        return np.where(np.abs(corrector) < ROUNDING * unit, 0.0, corrector)

    @cached_property
    def _shapes(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Along x and y: shape functions (t, N) and slopes at the points of the ties, see `_seen`."""
        places, sizes = self.local.T, self.mesh.element_sizes[self.element].T
        return [self._seen(at, size, mean) for at, size, mean in zip(places, sizes, self.mean, strict=True)]

    @property
    def elongations(self) -> tuple[np.ndarray, np.ndarray]:
        """Elongations per unit motion of the ties' disks, (3, t, 3), and of the nodes of their elements, (3, t, 2, N²).

        Normal, shear and bending, as in the kernels: times the stiffness of the half bonds they are the forces
        with which ties pull disks and nodes together.
        """
        (along, along_slope), (up, up_slope) = self._shapes
        value, slope_x, slope_y = (
            (b[:, :, None] * a[:, None, :]).reshape(len(a), -1)
            for b, a in ((up, along), (up, along_slope), (up_slope, along))
        )
        xx, yy, xy, yx = np.moveaxis(self._corrector, 1, 0)[:, :, :, None]
        moved = np.stack([xx * slope_x + xy * slope_y, yy * slope_y + yx * slope_x], axis=2)  # x, y, rotation
        for component in (0, 1):
            moved[component, :, component] += value
        nx, ny = self.bonds.normal
        none, one = np.zeros_like(nx), np.ones_like(nx)
        turns = np.array([[nx, ny, none], [-ny, nx, none], [none, none, one]])
        of_disks = -turns.transpose(0, 2, 1)
        of_disks[1, :, 2] = -self.bonds.arm
        return of_disks, np.einsum("ekt,ktcq->etcq", turns, moved)

    def ties(
        self,
        particle: np.ndarray,
        node: np.ndarray,
        line: np.ndarray,
        twin: np.ndarray | None,
        rest: np.ndarray | None = None,
    ) -> WallTies:
        """The arrays for the kernels.

        particle : (n,) slot of every disk of the body; node : (m,) slot of every node of the mesh; line : (slots,) line
        of slots in the support table; twin : (t,) slot of the twin of every tie's disk in a free-field column, None for
        none; rest : (3, t) m, m and rad, motion of the disk less that of the twin without force; None: zero.
        """
        bonds, mesh = self.bonds, self.mesh
        start, place = self._blocks
        lanes = LANES * int(start[-1])

        def laid(values: np.ndarray) -> np.ndarray:
            """Values (…, t) by blocks of eight, zero where there is no tie."""
            wide = np.zeros((*values.shape[:-1], lanes), dtype=values.dtype)
            wide[..., place] = values
            return wide

        def in_blocks(values: np.ndarray) -> np.ndarray:
            """Values (f, t) with the f values of each block together."""
            wide = laid(values)
            return np.ascontiguousarray(wide.reshape(len(wide), -1, LANES).swapaxes(0, 1)).ravel()

        (along, along_slope), (up, up_slope) = ([in_blocks(values.T) for values in pair] for pair in self._shapes)
        own = np.full(lanes, particle[bonds.particle[0]])
        own[place] = particle[bonds.particle]
        twins = np.full(lanes, -1)
        if twin is not None:
            twins[place] = twin
        nodes = node[mesh.nodes[self.elements]].reshape(len(self.elements), -1)
        return WallTies(
            points=tuple(mesh.rule.points.tolist()),
            start=start,
            node=nodes,
            line=line[nodes],
            reach=np.concatenate([_range(self._acts_on, axis) for axis in (1, 2)], axis=1),
            particle=own,
            particle_line=line[own],
            twin=twins,
            rest=np.zeros(3 * lanes) if rest is None else laid(rest).ravel(),
            along=along,
            along_slope=along_slope,
            up=up,
            up_slope=up_slope,
            corrector=in_blocks(self._corrector.reshape(12, -1)),
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

        Slopes are taken at least an arm inside. Their mean is zero where an element is its own neighbour.
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


def _range(acts: np.ndarray, across: int) -> np.ndarray:
    """First index and end (e, 2) of the columns (across = 1) or rows (2) of acts (e, N, N) in which it is true."""
    any_of = np.any(acts, axis=across)
    return np.stack([np.argmax(any_of, axis=1), acts.shape[1] - np.argmax(any_of[:, ::-1], axis=1)], axis=1)


def lag_of(ground: PackedMaterial, damping: float) -> float:
    """η (s) of the ties: with half bonds of normal stiffness 2K, dashpots of `damping`·ρc_pD for K = ρc_p².

    In layers that of the fastest: the longest that shortens no step.
    """
    each = [layer.material for layer in ground.layers] if isinstance(ground, LayeredGround) else [ground]
    speed = max(float(np.sqrt(np.mean(np.diag(one.material_tensor)[:2]) / one.density)) for one in each)
    return 0.5 * damping * ground.brick.mean_diameter / speed
