"""A row of equal bricks from the inside of a body to one of its sides, and the side at its end.

Bricks are numbered outwards, along the normal of the side; their interface inwards consists of the disks that have
contacts with the previous brick. A brick condensed to its own interface p_c and the next one's, p_{c+1}, needs the
forces

    [S₁₁ S₁₂; S₂₁ S₂₂] [p_c; p_{c+1}],    so that    S₂₁ p_{c−1} + (S₂₂ + S₁₁) p_c + S₁₂ p_{c+1} = 0

in the row. Its end, the last brick with the supports of the side, is condensed to its interface, S_e, and
(S₂₂ + S_e) p₀ + S₂₁ p_{−1} = 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dembound.boundaries import Boundary, Periodic, is_far, normal_axis
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.material.homogenise import Network
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.reflection.modes import Body, Condensed
from dembound.disks.scene import DiskScene, build
from dembound.errors import CaseError
from dembound.laws import Stiffness
from dembound.packings.tiling import Assembly

LAST = 2
"""Number of bricks of the end scene, the last of which is the end: the first may lack disks at its open side."""


def is_outwards(side: str) -> int:
    """1 where a side's normal points along its axis, −1 elsewhere."""
    return 1 if is_far(side) else -1


class BrickInRow:
    """A brick within the row.

    Attributes
    ----------
    ground, side : the packing, and the side at the end of the row. copies : number of copies of a smaller brick along
    the side of which the brick consists, and from whose waves its waves are found. disks : (p,) the brick's disks at
    its interface inwards. components, places : of the interface's degrees of freedom (count,) 0 x, 1 y, 2 rotation, and
    the centres (count, 2) m of their disks. condensed : to this interface and the next brick's.
    """

    def __init__(self, ground: PackedMaterial, side: str, copies: int = 1) -> None:
        self.ground, self.side, self.copies = ground, side, copies
        brick, axis = ground.brick, normal_axis(side)
        outwards = is_outwards(side) * brick.images[:, axis]
        is_next = np.stack([outwards < 0, outwards > 0], axis=1)  # which disk of a contact is in the next brick
        self.disks = np.unique(brick.pairs[is_next])
        number, disks = np.zeros(len(brick.radii), dtype=np.int64), len(brick.radii)
        number[self.disks] = disks + np.arange(len(self.disks))
        every = disks + len(self.disks)
        pairs = np.where(is_next, number[brick.pairs], brick.pairs)
        periods = brick.images[:, 1 - axis]
        within, beyond = _split(every, pairs, brick.vectors, ground.stiffness, periods)
        mass = np.zeros((3, every))
        mass[:, :disks] = ground.mass, ground.mass, ground.inertia
        moves = np.ones((3, every), dtype=bool)
        moves[list(ground.held)] = False
        none = np.zeros(3 * every)
        body = Body(within, beyond, periods[periods != 0], mass.ravel(), none, none, moves.ravel())
        own, following = body.numbers(self.disks), body.numbers(number[self.disks])
        self.count = len(own)
        self.components = own // every
        self.places = brick.positions[own % every]
        self.condensed = Condensed(body, np.concatenate([own, following]))

    def shifts(self, phase: complex) -> np.ndarray:
        """Interface motions (c, k, k/c) whose phase grows evenly from copy to copy, by `phase` over all c copies."""
        copies = self.copies
        each = phase ** (1.0 / copies) * np.exp(2j * np.pi * np.arange(copies) / copies)
        turn = each[:, None] ** np.arange(copies) / np.sqrt(copies)
        moving, disks = len(np.unique(self.components)), len(self.disks) // copies  # numbered by component, then copy
        one = np.eye(moving * disks).reshape(moving, 1, disks, -1)
        return (turn[:, None, :, None, None] * one).reshape(copies, self.count, -1)


def _split(
    count: int, pairs: np.ndarray, vectors: np.ndarray, stiffness: Stiffness, periods: np.ndarray
) -> tuple[Network, Network]:
    """Contacts within a body of so many disks, and those across its periodic sides."""
    networks = []
    for chosen in (periods == 0, periods != 0):
        networks.append(Network(count, pairs[chosen], vectors[chosen], stiffness.of(chosen)))
    return networks[0], networks[1]


class LastBrick:
    """The last brick of `LAST` of them in a row, cut at the side.

    Parameters
    ----------
    assembly : the bricks, periodic along the side. row : a brick before them.

    Attributes
    ----------
    disks : (n,) its disks in the assembly. number : (m,) number in this brick of each of the assembly's disks, −1 for
    others.

    Raises CaseError if disks of the interface are missing.
    """

    def __init__(self, assembly: Assembly, row: BrickInRow) -> None:
        ground, side = row.ground, row.side
        axis, brick = normal_axis(side), ground.brick
        tile = assembly.tile[:, axis]
        outwards = tile if is_outwards(side) > 0 else assembly.copies[axis] - 1 - tile
        self.disks = np.flatnonzero(outwards >= LAST - 1)
        self.number = np.full(len(assembly.radii), -1)
        self.number[self.disks] = np.arange(len(self.disks))
        pairs = self.number[assembly.pairs]
        chosen = np.all(pairs >= 0, axis=1)
        pairs, kind = pairs[chosen], assembly.contact_type[chosen]
        plain, half = kind % len(brick.pairs), kind >= len(brick.pairs)
        stiffness = ground.stiffness.of(plain).times(np.where(half, 0.5, 1.0))  # half along a side of half cells
        first, second = assembly.positions[self.disks][pairs.T]
        across = (first + brick.vectors[plain] - second)[:, 1 - axis]
        periods = np.rint(across / assembly.size[1 - axis]).astype(int)
        self._networks = _split(len(self.disks), pairs, brick.vectors[plain], stiffness, periods)
        self._periods = periods[periods != 0]
        self._row = row

        first_of_last = np.flatnonzero(outwards[self.disks] == LAST - 1)
        place = np.full(len(brick.radii), -1)
        place[assembly.brick_particle[self.disks][first_of_last]] = first_of_last
        self._inner = place[row.disks]
        if (self._inner < 0).any():
            raise _missing(side)

    def condensed(
        self,
        mass: np.ndarray,
        moves: np.ndarray,
        damping: np.ndarray | None = None,
        springs: np.ndarray | None = None,
        kept: Sequence[int] | np.ndarray = (),
    ) -> Condensed:
        """The brick condensed to its interface and, behind it, ascending, to others (k,) of its 3n degrees of freedom.

        mass, moves, damping, springs : (3, n) kg and kg·m², bool, and of dashpots and springs to what is fixed.

        Raises CaseError if disks of the interface do not move.
        """
        none = np.zeros(mass.size)
        damping, springs = (none if each is None else each.ravel() for each in (damping, springs))
        body = Body(*self._networks, self._periods, mass.ravel(), damping, springs, moves.ravel())
        interface = body.numbers(self._inner)
        if len(interface) != self._row.count:
            raise _missing(self._row.side)
        return Condensed(body, np.concatenate([interface, np.setdiff1d(kept, interface)]).astype(int))


def _missing(side: str) -> CaseError:
    """The error for a last brick that cannot be condensed to its interface."""
    return CaseError([f"boundary.{side}: holds or leaves out disks at the inner side of its last brick; take longer"])


def end_of(scene: DiskScene, row: BrickInRow) -> Condensed:
    """The last brick of a scene of `LAST` of them with the supports of a side, condensed to its interface.

    Raises CaseError if disks of the interface are missing, or if the side prescribes their motion.
    """
    last = LastBrick(scene.assembly, row)
    mass = np.stack([scene.mass, scene.mass, scene.inertia])[:, last.disks]
    moves = np.ones(mass.shape, dtype=bool)
    moves[list(scene.ground.held)] = False
    damping, springs = np.zeros(mass.shape), np.zeros(mass.shape)
    table = scene.supports
    supported = last.number[table.node] >= 0
    where = table.component[supported], last.number[table.node[supported]]
    damping[where], springs[where] = table.damping[supported], table.stiffness[supported]
    moves[where] &= ~table.prescribed[supported]
    return last.condensed(mass, moves, damping, springs)


def end_scene(case: DiskCase, side: str, bricks: int = LAST) -> DiskScene:
    """A scene of bricks in a row outwards, with the side of the case at its end, one brick wide and periodic."""
    axis = normal_axis(side)
    lateral = ("bottom", "top") if axis == 0 else ("left", "right")
    copies = [1, 1]
    copies[axis] = bricks
    ends: dict[str, Boundary] = {name: Periodic(type="periodic") for name in lateral}
    ends[side] = case.side(side).stiffest(side, case.box).at_rest().on_whole_side()
    packing = case.packing.with_copies(*copies)
    case = case.uniform_at(case.box[3 if side == "top" else 1])  # beside layers the lowest
    static = None if LAWS[case.material.law].starts_elastic else case.static  # which gives contacts their stiffness
    alone = replace(case, packing=packing, boundary=ends, static=static, incident=None)
    alone = replace(alone, group=(), hole=(), wall=(), joint=(), load=(), monitor=(), wave={})
    return build(replace(alone, ground=case.ground.level()))
