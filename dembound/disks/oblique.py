"""The forces by which a plane wave that comes at an angle enters a body on all its sides.

Disks have the total motion, the grid only what differs from that of the undisturbed ground. So a tied disk has the
bond's force in the undisturbed packing, and ties are strained by what differs from there, as in disks/incident.py,
whose formulas hold with all four gradients in place of ∂_y u:

    on the disk  f_i : ∇u(x_e) + A_iᵀK(1 + η d/dt)(B w − A_i(ξ_i − x_i)),
    on the grid  −BᵀK(1 + η d/dt)(B w − A_i(ξ_i − x_i)).

The place x_e of the gradient is the contact's, moved along the normal of the side to where the grid begins: the forces
of the bonds of a side accelerate the mass behind, which is that of a uniform body behind the grid's edge.

All ties are somewhere else along the wave. Those of one element of the grid are near each other: there the waves are
the polynomials of their delays through a few points (`NearPlaces`), and all forces follow from g at so many delays.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from dembound.boundaries.sides import SIDES, normal_axis
from dembound.boundaries.support import SupportBuilder
from dembound.disks.cut_bonds import CutBonds
from dembound.disks.ground_waves import GroundWaves, NearPlaces
from dembound.disks.surroundings import Surroundings
from dembound.disks.tie_forces import TieForces, forces_at_rest
from dembound.disks.wall import Wall
from dembound.kernels.sums import add_weighted_sums, weighted_sums
from dembound.outside.gll import Rule
from dembound.outside.plane_waves import PlaneWave

PLACES = 8
"""Places along a side at which the power of waves is summed."""


class Part(NamedTuple):
    """Forces through the ties of one element.

    ground : the motion near them. node, component : (r,) the degrees of freedom. moved, moving : (count, r) N or N·m
    per unit of the displacements, and of the velocities that ties see, of all amplitudes.
    """

    ground: NearPlaces
    node: np.ndarray
    component: np.ndarray
    moved: np.ndarray
    moving: np.ndarray

    @classmethod
    def of(cls, near: NearPlaces, forces: TieForces, first: int) -> Part:
        """Those on disks and nodes; first : number of the first node of the grid."""
        (disks, on_disks), (nodes, on_nodes) = forces.on_disks, forces.on_nodes
        node = np.concatenate([forces.disk[disks[1]], first + forces.node[nodes[1]]])
        moved, moving = np.split(np.hstack([on_disks, on_nodes]), 2)
        return cls(near, node, np.concatenate([disks[0], nodes[0]]), moved, moving)

    def per_displacement(self, half_step: float) -> np.ndarray:
        """All forces (count, r) per unit of displacements; velocities follow from these, half a step (s) behind."""
        factors = np.empty_like(self.moving)
        weighted_sums(np.ascontiguousarray(self.ground.velocities(half_step).T), self.moving, factors)
        return factors + self.moved


def parts_of(wall: Wall, ground: GroundWaves, positions: np.ndarray, first: int) -> Iterator[Part]:
    """The forces by which the ground's motion enters through the ties of each element.

    positions : (n, 2) m of disks. first : number of the first node of the grid.
    """
    for element in wall.elements:
        yield _part_of(wall.only(np.flatnonzero(wall.element == element)), ground, positions, first)


def _part_of(wall: Wall, ground: GroundWaves, positions: np.ndarray, first: int) -> Part:
    """Those of a few ties."""
    bonds = wall.bonds
    disk, own, place = np.unique(bonds.particle, return_index=True, return_inverse=True)
    edges = _at_edges(bonds, positions, wall.mesh.sides)
    near = ground.near(np.concatenate([positions[disk], edges]))
    of_bonds = np.zeros((3, len(disk), near.count))
    for sums, forces in zip(of_bonds, near.strained(edges, bonds.on_disks), strict=True):
        np.add.at(sums, place, forces)
    of_ties, reactions = forces_at_rest(wall, disk, -near.motion(positions[disk], bonds.own[:, :, own]))
    each = TieForces(disk=disk, bonds=of_bonds, ties=of_ties, node=wall.nodes, reactions=reactions, lag=wall.lag)
    return Part.of(near, each, first)


def _at_edges(bonds: CutBonds, positions: np.ndarray, sides: Sequence[float]) -> np.ndarray:
    """The contacts (t, 2) m of bonds, moved along the normals of their sides to the edges of the grid, m."""
    places = positions[bonds.particle] + (bonds.arm * bonds.normal).T
    for number, edge in enumerate(sides):
        places[bonds.side == number, number // 2] = edge
    return places


class SummedDrives:
    """Forces on some degrees of freedom, sums of those through the ties of several elements.

    Parameters
    ----------
    parts : of each element.

    Attributes
    ----------
    node, component : (count,) the degrees of freedom, each once.
    """

    def __init__(self, parts: Sequence[Part]) -> None:
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
            add_weighted_sums(part.ground.amplitudes(times), factors, column, forces, np.empty(len(column)))
        return forces


def let_in(outside: Surroundings, ground: GroundWaves, positions: np.ndarray, builder: SupportBuilder) -> None:
    """Add the forces by which the ground's motion enters a body to the support table; positions (n, 2) m of all."""
    drives = SummedDrives(list(parts_of(outside.wall, ground, positions, outside.first)))
    by_side = {side: np.zeros(0, dtype=np.int64) for side in outside.sides}
    for name, nodes in outside.tied_by_side.items():
        side = name.partition(".")[0]
        by_side[side] = np.concatenate([by_side[side], nodes])
    builder.add_forces(drives.node, drives.component, drives, by_side)
    for side in outside.sides:
        builder.add_power(side, power_through(side, outside.wall.mesh.sides, ground))


def power_through(side: str, edges: Sequence[float], ground: GroundWaves) -> Callable[[np.ndarray], np.ndarray]:
    """Power (W), at times (k,) s, of the waves whose energy runs inwards through a side, the mean of `PLACES` places.

    edges : left and right (x), lower and upper (y) of a body, m.
    """
    number, axis = SIDES.index(side), normal_axis(side)
    inwards = -1.0 if number % 2 else 1.0
    low, high = edges[2 - 2 * axis], edges[3 - 2 * axis]
    rule = Rule(PLACES - 1)
    places = np.full((PLACES, 2), edges[number])
    places[:, 1 - axis] = 0.5 * (low + high + (high - low) * rule.points)

    together: dict[tuple[float, float], list[PlaneWave]] = {}
    for wave in ground.waves:  # what a surface with a mass sends back is several waves of one slowness
        together.setdefault(wave.slowness, []).append(wave)

    def power(times: np.ndarray) -> np.ndarray:
        total = np.zeros(len(times))
        for slowness, waves in together.items():
            direction = np.array(waves[0].motion) / np.hypot(*waves[0].motion)
            x, y = direction.tolist()
            if (flux := inwards * PlaneWave(slowness, (x, y)).flux(ground.medium)[axis]) > 0.0:
                parts = [np.dot(wave.motion, direction) * _velocity(ground, wave, times, places) for wave in waves]
                total += 0.5 * (high - low) * flux * np.sum(np.sum(parts, axis=0) ** 2 * rule.weights, axis=1)
        return total

    return power


def _velocity(ground: GroundWaves, wave: PlaneWave, times: np.ndarray, places: np.ndarray) -> np.ndarray:
    """ġ (k, p) m/s of a wave at times (k,) s and places (p, 2) m."""
    return ground.signal.velocity(times[:, None] - wave.delays(places))
