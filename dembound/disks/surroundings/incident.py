"""The forces by which plane waves of the ground enter a body through its ties to the continuum.

Disks have the total motion, the grid has only the scattered motion: the total without the motion u of the undisturbed
ground (ground_waves.py). In the undisturbed packing a disk i at x_i then moves by ξ⁰_i = u(x_i) + χ_i : ∇u, with
the correctors χ (homogenise.py). Let A_i ξ_i be the share of a disk in the elongations of a tie, B w that of the
grid's motion w, K the stiffness of the tie, and f_i the force of the bond on the disk per unit gradient of the packing.
On a tied disk acts the force of the bond in the undisturbed packing, and that of the tie, which is strained by
the deviation from there; on the grid acts the transpose of the latter alone:

    on the disk  f_i : ∇u(x_e) + A_iᵀK(1 + η d/dt)(B w − A_i(ξ_i − ξ⁰_i)),
    on the grid  −BᵀK(1 + η d/dt)(B w − A_i(ξ_i − ξ⁰_i)).

So in a packing that moves as undisturbed the grid remains at rest. The terms of w and ξ are those of the kernel
(kernels/wall.py). The others are the drives here: the bond's force, and the kernel's forces for the motions −ξ⁰_i
of the disks and a grid at rest.

The place x_e of the gradient is the contact's, moved along the normal of the side to where the grid begins: the forces
of the bonds of a side accelerate the mass behind, which is that of a uniform body behind the grid's edge
(`Brick.mass_offset`). Then errors are of second order in D/λ. With the gradient at the bonds, or the grid's motion at
the contact in place of f_i, they would be of first order.

Each tie is at another place along the waves. The ties of one element of the grid are near each other: there the waves
are polynomials of their delays through a few points (`NearPlaces`), and all forces follow from g at these delays.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from dembound.boundaries.edge import SIDES, normal_axis
from dembound.boundaries.support import Incident, SupportBuilder
from dembound.continuum.axis import Rule
from dembound.continuum.medium import ElasticPlaneWave
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.cut_bonds import CutBonds
from dembound.disks.surroundings.ground_waves import NearPlaces, UnlikeWaves
from dembound.disks.surroundings.layered_waves import LayeredWaves, NearLayers, Undisturbed
from dembound.disks.surroundings.oblique_layers import NearObliqueLayers, ObliqueLayers
from dembound.disks.surroundings.wall import Wall
from dembound.kernels.common import add_weighted_sums, weighted_sums
from dembound.kernels.wall import tie_forces

PLACES = 8
"""Places along a side at which the power of waves is summed."""

Sharing = tuple[np.ndarray, np.ndarray]
"""Tied disks (k,), and disks (k,) on which the same forces act."""


class TieForces(NamedTuple):
    """Forces through the ties of one element.

    ground : the motion near them. node, component : (r,) the degrees of freedom. moved, moving : (count, r) N or N·m
    per unit of the displacements, and of the velocities seen by the ties, of all amplitudes.
    """

    ground: NearPlaces | NearLayers | NearObliqueLayers
    node: np.ndarray
    component: np.ndarray
    moved: np.ndarray
    moving: np.ndarray

    def per_displacement(self, half_step: float) -> np.ndarray:
        """All forces (count, r) per unit of displacements; velocities are derived from these, half a step behind."""
        factors = np.empty_like(self.moving)
        weighted_sums(np.ascontiguousarray(self.ground.velocities(half_step).T), self.moving, factors)
        return factors + self.moved

    def shared(self, sharing: Sharing) -> TieForces:
        """The forces, repeated on the disks that share them."""
        row, which = np.nonzero(self.node[:, None] == sharing[0])
        rows = np.concatenate([np.arange(len(self.node)), row])
        node = np.concatenate([self.node, sharing[1][which]])
        return TieForces(self.ground, node, self.component[rows], self.moved[:, rows], self.moving[:, rows])


def parts_of(wall: Wall, ground: Undisturbed, positions: np.ndarray, first: int) -> Iterator[TieForces]:
    """The forces by which the ground's motion enters through the ties of each element.

    positions : (n, 2) m of disks. first : number of the first node of the grid.
    """
    if isinstance(ground, UnlikeWaves):
        right = wall.bonds.side == SIDES.index("right")
        for own, chosen in ((ground.left, ~right), (ground.right, right)):
            yield from parts_of(wall.only(np.flatnonzero(chosen)), own, positions, first)
        return
    for element in wall.elements:
        yield _part_of(wall.only(np.flatnonzero(wall.element == element)), ground, positions, first)


def _part_of(wall: Wall, ground: Undisturbed, positions: np.ndarray, first: int) -> TieForces:
    """The forces that enter through a few ties."""
    bonds = wall.bonds
    disk, own, place = np.unique(bonds.particle, return_index=True, return_inverse=True)
    edges = _at_edges(bonds, positions, wall.mesh.sides)
    near = ground.near(np.concatenate([positions[disk], edges]))
    of_bonds = np.zeros((3, len(disk), near.count))
    for sums, forces in zip(of_bonds, near.strained(edges, bonds.on_disks, bonds.height), strict=True):
        np.add.at(sums, place, forces)
    of_ties, reactions = forces_at_rest(wall, disk, -near.motion(positions[disk], bonds.own[:, :, own]))
    component, node, at_once = _listed(of_bonds + of_ties, disk)
    nodes = _listed(reactions, first + wall.nodes)
    lagged = wall.lag * np.hstack([_listed(of_ties, disk)[2], nodes[2]])
    return TieForces(
        near, np.concatenate([node, nodes[1]]), np.concatenate([component, nodes[0]]), np.hstack([at_once, nodes[2]]),
        lagged,
    )  # fmt: skip


def _listed(forces: np.ndarray, nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Components (r,), nodes (r,) and forces (count, r), of forces (c, k, count) on nodes (k,)."""
    component, number = np.indices(forces.shape[:2]).reshape(2, -1)
    return component, nodes[number], np.ascontiguousarray(forces.reshape(len(number), -1).T)


def forces_at_rest(wall: Wall, disk: np.ndarray, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Tie forces (3, d, q) on disks (d,) with motions (3, d, q), and (2, m, q) on the nodes, which are at rest.

    disk : all tied disks, ascending.
    """
    count = len(disk) + len(wall.nodes)
    own, node = np.zeros(int(disk.max()) + 1, dtype=np.int64), np.zeros(wall.mesh.count, dtype=np.int64)
    own[disk], node[wall.nodes] = np.arange(len(disk)), np.arange(len(disk), count)
    ties = wall.ties(own, node, np.arange(count), None)
    forces = np.zeros((motion.shape[2], count, 3))
    for force, each in zip(forces, np.moveaxis(motion, 2, 0), strict=True):
        u = np.zeros((3, count))
        u[:, : len(disk)] = each
        tie_forces(ties, u, np.zeros_like(u), force, 0.0)
    of_all = np.moveaxis(forces, 0, 2).swapaxes(0, 1)
    return of_all[:, : len(disk)], of_all[:2, len(disk) :]


def _at_edges(bonds: CutBonds, positions: np.ndarray, sides: Sequence[float]) -> np.ndarray:
    """The contacts (t, 2) m of bonds, moved along the normals of their sides to the edges of the grid, m."""
    places = positions[bonds.particle] + (bonds.arm * bonds.normal).T
    for number, edge in enumerate(sides):
        places[bonds.side == number, number // 2] = edge
    return places


class SummedDrives:
    """Forces on some degrees of freedom, summed over the ties of several elements.

    Parameters
    ----------
    parts : forces of each element.

    Attributes
    ----------
    node, component : (count,) the degrees of freedom, each once.
    """

    def __init__(self, parts: Sequence[TieForces]) -> None:
        numbers = [3 * part.node + part.component for part in parts]
        unique, column = np.unique(np.concatenate(numbers), return_inverse=True)
        self.node, self.component = unique // 3, unique % 3
        self._parts = parts
        self._columns = np.split(column, np.cumsum([len(each) for each in numbers])[:-1])
        self._factors: tuple[float, list[np.ndarray]] | None = None

    @property
    def count(self) -> int:
        """Number of the degrees of freedom."""
        return len(self.node)

    def __call__(self, times: np.ndarray, half_step: float) -> np.ndarray:
        """Forces (k, count) at times (k,) s; velocities are half a step (s) behind."""
        if self._factors is None or self._factors[0] != half_step:  # all steps of a run have one length
            self._factors = half_step, [part.per_displacement(half_step) for part in self._parts]
        forces = np.zeros((len(times), self.count))
        for part, column, factors in zip(self._parts, self._columns, self._factors[1], strict=True):
            add_weighted_sums(part.ground.amplitudes(times, half_step), factors, column, forces, np.empty(len(column)))
        return forces


def let_in(outside: Surroundings, ground: Undisturbed, positions: np.ndarray, builder: SupportBuilder) -> None:
    """Add the forces by which the ground's motion enters a body on all its sides to the support table.

    positions : (n, 2) m of all nodes of the scene.
    """
    drives = SummedDrives(list(parts_of(outside.wall, ground, positions, outside.first)))
    by_side = {side: np.zeros(0, dtype=np.int64) for side in outside.sides}
    for name, nodes in outside.tied_by_side.items():
        side = name.partition(".")[0]
        by_side[side] = np.concatenate([by_side[side], nodes])
    builder.add_forces(drives.node, drives.component, drives, by_side)
    for side in outside.sides:
        builder.add_power(side, power_through(side, outside.wall.mesh.sides, ground, outside.body.thickness))


def let_in_below(
    outside: Surroundings, ground: Undisturbed, positions: np.ndarray, builder: SupportBuilder, sharing: Sharing
) -> None:
    """Add the forces of waves that run straight up and enter a body from below to the support table.

    The continuum above also carries these waves. sharing : disks on which the forces of others act. Other parameters as
    of `let_in`.
    """
    below = outside.wall.only(np.flatnonzero(outside.wall.bonds.side == SIDES.index("bottom")))
    parts = parts_of(below, ground, positions, outside.first)
    drives = SummedDrives([part.shared(sharing) for part in parts])
    builder.add_forces(drives.node, drives.component, drives)


def power_through(
    side: str, edges: Sequence[float], ground: Undisturbed, thickness: float = 1.0
) -> Callable[[np.ndarray], np.ndarray]:
    """Power (W), at times (k,) s, of the waves whose energy runs inwards through a side, the mean of `PLACES` places.

    edges : left and right (x), lower and upper (y) of a body, m; thickness : m.
    """
    if isinstance(ground, LayeredWaves):
        return ground.power_through(side, edges, thickness)
    if isinstance(ground, UnlikeWaves) and side == "right":
        ground = ground.right
    number, axis = SIDES.index(side), normal_axis(side)
    if isinstance(ground, ObliqueLayers):
        span = (edges[number], edges[number]) if axis else (edges[2], edges[3])
        parts = [
            power_through(side, (*edges[:2], low, high), waves, thickness) for low, high, waves in ground.within(*span)
        ]
        return lambda times: np.sum([part(times) for part in parts], axis=0)
    inwards = -1.0 if number % 2 else 1.0
    low, high = edges[2 - 2 * axis], edges[3 - 2 * axis]
    rule = Rule(PLACES - 1)
    places = np.full((PLACES, 2), edges[number])
    places[:, 1 - axis] = 0.5 * (low + high + (high - low) * rule.points)

    together: dict[tuple[float, float], list[tuple[ElasticPlaneWave, Incident]]] = {}
    for wave, signal in zip(ground.waves, ground.signals, strict=True):  # several may have one slowness
        together.setdefault(wave.slowness, []).append((wave, signal))

    def power(times: np.ndarray) -> np.ndarray:
        total = np.zeros(len(times))
        for slowness, waves in together.items():
            direction = np.array(waves[0][0].motion) / np.hypot(*waves[0][0].motion)
            x, y = direction.tolist()
            if (flux := inwards * ElasticPlaneWave(slowness, (x, y)).flux(ground.medium)[axis]) > 0.0:
                velocity = sum(
                    np.dot(wave.motion, direction) * signal.velocity(times[:, None] - wave.delays(places))
                    for wave, signal in waves
                )
                total += 0.5 * thickness * (high - low) * flux * np.sum(velocity**2 * rule.weights, axis=1)
        return total

    return power
