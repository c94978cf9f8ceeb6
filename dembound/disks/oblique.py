"""The forces by which a plane wave that comes at an angle enters a body on all its sides.

Disks have the total motion, the grid only what differs from that of the undisturbed ground. So a tied disk has the
bond's force in the undisturbed packing, and ties are strained by what differs from there, as in disks/incident.py, whose
formulas hold with all four gradients in place of ∂_y u:

    on the disk  f_i : ∇u(x_e) + A_iᵀK(1 + η d/dt)(B w − A_i(ξ_i − x_i)),
    on the grid  −BᵀK(1 + η d/dt)(B w − A_i(ξ_i − x_i)).

The place x_e of the gradient is the contact's, moved along the normal of the side to where the grid begins: the forces
of the bonds of a side accelerate the mass behind, which is that of a uniform body behind the grid's edge.

All ties are somewhere else along the wave. Those of one element of the grid are near each other: there the waves are the
polynomials of their delays through a few points (`NearPlaces`), and all forces follow from g at so many delays.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dembound.boundaries.sides import SIDES, normal_axis
from dembound.boundaries.support import SupportBuilder
from dembound.disks.ground_waves import GroundWaves, NearPlaces
from dembound.disks.incident import Drives, IncidentForces, forces_at_rest
from dembound.disks.surroundings import Surroundings
from dembound.disks.wall import CutBonds, Wall
from dembound.outside.gll import Rule

PLACES = 8
"""Places along a side at which the power of waves is summed."""


def forces_of_elements(wall: Wall, ground: GroundWaves, positions: np.ndarray) -> Iterator[IncidentForces]:
    """The forces by which the ground's motion enters through the ties of each element; positions (n, 2) m of disks."""
    for element in wall.elements:
        yield _forces_of(wall.only(np.flatnonzero(wall.element == element)), ground, positions)


def _forces_of(wall: Wall, ground: GroundWaves, positions: np.ndarray) -> IncidentForces:
    """Those of a few ties."""
    bonds = wall.bonds
    disk, first, place = np.unique(bonds.particle, return_index=True, return_inverse=True)
    edges = _at_edges(bonds, positions, wall.mesh.sides)
    near = ground.near(np.concatenate([positions[disk], edges]))
    of_bonds = np.zeros((3, len(disk), near.count))
    strained = near.strained(edges, bonds.on_disks)
    for sums, forces in zip(of_bonds, strained, strict=True):
        np.add.at(sums, place, forces)
    of_ties, reactions = forces_at_rest(wall, disk, -near.motion(positions[disk], bonds.own[:, :, first]))
    return IncidentForces(near, disk, of_bonds, of_ties, wall.nodes, reactions, wall.lag)


def _at_edges(bonds: CutBonds, positions: np.ndarray, sides: Sequence[float]) -> np.ndarray:
    """The contacts (t, 2) m of bonds, moved along the normals of their sides to the edges of the grid, m."""
    places = positions[bonds.particle] + (bonds.arm * bonds.normal).T
    for number, edge in enumerate(sides):
        places[bonds.side == number, number // 2] = edge
    return places


@dataclass(frozen=True, eq=False)
class SummedDrives:
    """Forces on some degrees of freedom, sums of those of several elements.

    Attributes
    ----------
    count : number of the degrees of freedom. parts : the forces of each element, and the degrees of freedom (r,) that
    they act on.
    """

    count: int
    parts: tuple[tuple[Drives, np.ndarray], ...]

    def __call__(self, times: np.ndarray, half_step: float) -> np.ndarray:
        """Forces (k, count) at times (k,) s; velocities are half a step (s) behind."""
        forces = np.zeros((len(times), self.count))
        for drives, where in self.parts:
            forces[:, where] += drives(times, half_step)
        return forces


def _summed(forces: Iterable[tuple[np.ndarray, np.ndarray, Drives]]) -> tuple[np.ndarray, np.ndarray, SummedDrives]:
    """Nodes (r,) and components (r,), each degree of freedom once, and the forces on them, of elements: the same."""
    each = list(forces)
    number = [3 * node + component for node, component, _ in each]
    unique, place = np.unique(np.concatenate(number), return_inverse=True)
    ends = np.cumsum([len(numbers) for numbers in number])[:-1]
    parts = zip((drives for *_, drives in each), np.split(place, ends), strict=True)
    return unique // 3, unique % 3, SummedDrives(len(unique), tuple(parts))


def let_in(outside: Surroundings, ground: GroundWaves, positions: np.ndarray, builder: SupportBuilder) -> None:
    """Add the forces by which the ground's motion enters a body to the support table; positions (n, 2) m of all."""

    def forces() -> Iterator[tuple[np.ndarray, np.ndarray, Drives]]:
        for each in forces_of_elements(outside.wall, ground, positions):
            for nodes, ((component, number), drives) in (
                (each.disk, each.on_disks),
                (outside.first + each.node, each.on_nodes),
            ):
                yield nodes[number], component, drives

    by_side = {side: np.zeros(0, dtype=np.int64) for side in outside.sides}
    for name, nodes in outside.tied_by_side.items():
        side = name.partition(".")[0]
        by_side[side] = np.concatenate([by_side[side], nodes])
    builder.add_forces(*_summed(forces()), by_side)
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

    def power(times: np.ndarray) -> np.ndarray:
        total = np.zeros(len(times))
        for wave in ground.waves:
            if (flux := inwards * wave.flux(ground.medium)[axis]) > 0.0:
                squares = ground.signal.velocity(times[:, None] - wave.delays(places)) ** 2
                total += 0.5 * (high - low) * flux * np.sum(squares * rule.weights, axis=1)
        return total

    return power
