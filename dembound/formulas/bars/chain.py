"""A bar with its layers as a chain of nodes and bonds, moved by its steps, at single frequencies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from dembound.bar.layers import EndLayer
from dembound.bar.scene import BarScene


class Link(NamedTuple):
    """The matrices A, B, C and D (f, b, b) of a link, at f frequencies, of blocks of b unknowns."""

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray


def joined(first: Link, middle: np.ndarray, second: Link) -> Link:
    """Two links as one, with the block between them, of the matrix middle (f, b, b), eliminated."""
    answer = solve(middle + first.d + second.a, np.concatenate([first.c, second.b], axis=2))
    by_left, by_right = np.split(answer, 2, axis=2)
    return Link(first.a - first.b @ by_left, -first.b @ by_right, -second.c @ by_left, second.d - second.c @ by_right)


class Row:
    """Equal blocks in a row, middle (f, b, b) the matrix of each, equal links between them."""

    def __init__(self, link: Link, middle: np.ndarray) -> None:
        self.middle = middle
        self._powers = [link]  # of 1, 2, 4 ... links

    def links(self, count: int) -> Link:
        """`count` ≥ 1 links as one, with the blocks between them eliminated."""
        found: Link | None = None
        for bit in range(count.bit_length()):
            if bit == len(self._powers):
                self._powers.append(joined(self._powers[-1], self.middle, self._powers[-1]))
            if count >> bit & 1:
                found = self._powers[bit] if found is None else joined(found, self.middle, self._powers[bit])
        assert found is not None
        return found


def velocities(own: Sequence[np.ndarray], links: Sequence[Link], force: np.ndarray) -> np.ndarray:
    """Velocities (f, k, b) of the k blocks of a row under forces (f, k, b).

    own : the matrices (f, b, b) of the blocks without links; links : between each block and the next.
    """
    whole = [np.array(matrix) for matrix in own]
    for k, link in enumerate(links):
        whole[k] += link.a
        whole[k + 1] += link.d
    rest, answers = force.copy(), []
    for k, link in enumerate(links):  # eliminate from the left
        answers.append(solve(whole[k], np.concatenate([link.b, rest[:, k, :, None]], axis=2)))
        passed = link.c @ answers[k]
        whole[k + 1] -= passed[:, :, :-1]
        rest[:, k + 1] -= passed[:, :, -1]
    moved = np.empty_like(rest)
    moved[:, -1] = solve(whole[-1], rest[:, -1, :, None])[:, :, 0]
    for k in range(len(links) - 1, -1, -1):
        moved[:, k] = answers[k][:, :, -1] - (answers[k][:, :, :-1] @ moved[:, k + 1, :, None])[:, :, 0]
    return moved


def solve(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solutions (f, b, c) of f systems; matrix (f, b, b), right (f, b, c)."""
    return right / matrix if matrix.shape[-1] == 1 else np.linalg.solve(matrix, right)


EQUAL = 1e-10
"""Relative difference up to which blocks are equal, for rounding."""

RIGID = 1e12
"""Dashpot of a node whose velocity is prescribed, over the largest of other constants."""


@dataclass(frozen=True)
class Frequencies:
    """Complex frequencies s (f,) rad/s, and their δ and μ (f,) in steps of so many s; 0 stands for exact time."""

    step: float
    s: np.ndarray
    change: np.ndarray
    mean: np.ndarray

    @classmethod
    def of(cls, s: np.ndarray, step: float) -> Frequencies:
        """Frequencies s (f,) rad/s for time steps `step` (s); 0 stands for exact time."""
        if step == 0.0:
            return cls(step, s, s, np.ones_like(s))
        half = 0.5 * step * s
        return cls(step, s, 2.0 / step * np.sinh(half), np.cosh(half))

    def part(self, chosen: slice) -> Frequencies:
        """A slice of the frequencies."""
        return Frequencies(self.step, self.s[chosen], self.change[chosen], self.mean[chosen])


class Chain:
    """The nodes of a bar between those of its layers, numbered from left to right, in blocks of the longest bond.

    Attributes
    ----------
    first : number of the bar's first node. count : number of nodes.
    mass, damping, ground : (blocks, b) kg, N·s/m, N/m. bond, decay : (blocks, b, m) N/m and 1/s, of the bonds that
    begin at each node, by length.
    rigid : N·s/m, the dashpot of nodes whose velocity is prescribed.
    """

    def __init__(self, scene: BarScene, layers: Mapping[str, EndLayer], step: float) -> None:
        bonds = scene.case.method.begin(scene.rod)
        wide = max([1, bonds.horizon, *(len(each.inner) for each in layers.values())])
        left, right = (layers[side].layer.nodes if side in layers else 0 for side in ("left", "right"))
        self.first, self.count, self._bar = left, left + scene.count + right, scene.count
        blocks = -(-self.count // wide)
        own = slice(left, left + scene.count)
        node = np.zeros((3, blocks * wide))
        node[0] = scene.mass.max()  # also of nodes beyond the end that fill the last block, which nothing moves
        bond = np.zeros((2, blocks * wide, wide))
        node[0, own] = scene.mass
        node[1, own] = scene.rod.drag_rate * scene.mass
        bond[0, own, : bonds.horizon] = bonds.bond.T
        bond[0, left : left + scene.count - 1, 0] += bonds.spring
        for side, layer in layers.items():
            self._lay(layer, node, bond, left if side == "left" else left + scene.count - 1, side == "right")
        supports = scene.supports
        along = supports.component == 0
        node[1, left + supports.node[along]] = supports.damping[along]
        stiffest = max(float(node[0].max()) / step, float(node[1].max()), float(bond[0].max()) * step)
        self.rigid = RIGID * stiffest
        node[1, left + supports.node[along & supports.prescribed]] = self.rigid
        self.mass, self.damping, self.ground = node.reshape(3, blocks, wide)
        self.bond, self.decay = bond.reshape(2, blocks, wide, wide)

    @staticmethod
    def _lay(layer: EndLayer, node: np.ndarray, bond: np.ndarray, end: int, outwards: bool) -> None:
        """Add the nodes and bonds of a layer beyond the bar's node `end`."""
        reach = len(layer.inner)
        depth = np.arange(layer.count) - (reach - 1)
        place = end + depth if outwards else end - depth
        beyond = slice(reach, None)
        node[0, place[beyond]] = layer.mass
        node[1, place[beyond]] = layer.mass * (layer.node_rates + layer.drag_rate)[beyond]
        node[2, place[beyond]] = layer.ground[beyond]
        for row in range(reach):
            held = np.flatnonzero(layer.bonds[row] > 0.0)
            begins = place[held] if outwards else place[held + row + 1]
            bond[0, begins, row] += layer.bonds[row, held]
            bond[1, begins, row] = layer.bond_rates[row, held]

    @property
    def wide(self) -> int:
        """Number b of nodes in a block, the length of the longest bond."""
        return self.mass.shape[1]

    def matrices(self, block: int, clock: Frequencies) -> tuple[np.ndarray, np.ndarray]:
        """The matrix (f, b, b) of a block with all its bonds, and its coupling (f, b, b) to the next block."""
        wide, change, mean = self.wide, clock.change, clock.mean
        own = np.zeros((len(change), wide, wide), dtype=complex)
        across = np.zeros_like(own)
        for i in range(wide):
            held = self.mass[block, i] * change + self.damping[block, i] * mean
            own[:, i, i] += held + self.ground[block, i] * mean**2 / change
            for p in (np.flatnonzero(self.bond[block, i]) + 1).tolist():
                stiffness = self.stiffness(block, i, p, clock)
                own[:, i, i] += stiffness
                if i + p < wide:
                    own[:, i + p, i + p] += stiffness
                    own[:, i, i + p] -= stiffness
                    own[:, i + p, i] -= stiffness
                else:
                    across[:, i, i + p - wide] -= stiffness
            for p in range(i + 1, wide + 1) if block > 0 else ():  # bonds that begin in the block before
                if self.bond[block - 1, wide + i - p, p - 1] > 0.0:
                    own[:, i, i] += self.stiffness(block - 1, wide + i - p, p, clock)
        return own, across

    def stiffness(self, block: int, i: int, length: int, clock: Frequencies) -> np.ndarray:
        """Force over velocity difference (f,) N·s/m of a bond, given its block, first node `i` and length."""
        k, decay = self.bond[block, i, length - 1], self.decay[block, i, length - 1]
        return np.asarray(k / (clock.change + decay * clock.mean))

    def mobility(self, side: str, clock: Frequencies) -> np.ndarray:
        """Velocity (f,) m/s of a node under 1 N in a bar that continues on both sides like the layer at an end."""
        nodes = self.first if side == "left" else self.first + self._bar + self.count
        block = nodes // self.wide // 2
        matrix, across = self.matrices(block, clock)
        link = _row(matrix, across).links(len(self.mass))
        push = np.zeros((len(clock.s), self.wide, 1), dtype=complex)
        push[:, 0] = 1.0
        return np.asarray(solve(matrix + link.a + link.d, push)[:, 0, 0])

    @property
    def kinds(self) -> np.ndarray:
        """(blocks,) numbers, equal for neighbouring blocks with equal nodes and bonds."""
        each = self.mass, self.damping, self.ground, self.bond, self.decay
        rows = np.concatenate([values.reshape(len(self.mass), -1) for values in each], axis=1)
        before = np.vstack([np.full((1, rows.shape[1]), -1.0), rows[:-1]])
        same = np.isclose(rows, before, rtol=EQUAL, atol=0.0).all(axis=1)  # as the one before
        new = ~same | ~np.concatenate([[True], same[:-1]])  # the one before is another than its own one before
        return np.cumsum(new)


class Response:
    """Velocities of some nodes of a chain under forces on some; uniform parts between them are eliminated.

    nodes : of the bar, that are pushed or observed.
    """

    def __init__(self, chain: Chain, nodes: Iterable[int]) -> None:
        self.chain = chain
        kinds, wide = chain.kinds, chain.wide
        chosen = np.zeros(len(kinds), dtype=bool)
        chosen[[0, -1]] = True
        chosen[1:] |= kinds[1:] != kinds[:-1]
        chosen[:-1] |= kinds[1:] != kinds[:-1]
        chosen[[(chain.first + node) // wide for node in nodes]] = True
        self._kinds = kinds
        self._stations: list[int] = np.flatnonzero(chosen).tolist()
        self._index = {block: k for k, block in enumerate(self._stations)}

    def velocities(self, clock: Frequencies, forces: Mapping[int, np.ndarray]) -> np.ndarray:
        """Velocities (f, k, b) of the stations under forces (f,) N on nodes of the bar."""
        chain, stations = self.chain, self._stations
        rows = {self._kinds[block]: block for block in reversed(stations)}
        alike = {kind: _row(*chain.matrices(block, clock)) for kind, block in rows.items()}
        own = [alike[self._kinds[block]] for block in stations]
        links = [row.links(after - block) for row, block, after in zip(own, stations, stations[1:], strict=False)]
        force = np.zeros((len(clock.s), len(stations), chain.wide), dtype=complex)
        for node, values in forces.items():
            block, i = divmod(chain.first + node, chain.wide)
            force[:, self._index[block], i] += values
        return velocities([row.middle for row in own], links, force)

    def at(self, moved: np.ndarray, place: int) -> np.ndarray:
        """Velocity (f,) of a node of the chain; moved : the result of `velocities`."""
        block, i = divmod(place, self.chain.wide)
        return np.asarray(moved[:, self._index[block], i])

    def tension(self, moved: np.ndarray, clock: Frequencies, plane: int) -> np.ndarray:
        """Force (f,) N through the plane between a node of the chain and the next, of all bonds that cross it."""
        chain, total = self.chain, np.zeros(len(clock.s), dtype=complex)
        for length in range(1, chain.wide + 1):
            for i in range(max(0, plane - length + 1), min(plane, chain.count - 1 - length) + 1):
                block, own = divmod(i, chain.wide)
                if chain.bond[block, own, length - 1] > 0.0:
                    stretch = self.at(moved, i + length) - self.at(moved, i)
                    total += chain.stiffness(block, own, length, clock) * stretch
        return total


def _row(matrix: np.ndarray, across: np.ndarray) -> Row:
    """Equal blocks in a row, from the matrices of one."""
    none = np.zeros_like(across)
    return Row(Link(none, across, across.swapaxes(1, 2), none), matrix)


def observed_near(chain: Chain, nodes: Sequence[int]) -> set[int]:
    """Nodes, numbered as in the bar, on which the stress at the given nodes depends."""
    low, high = -chain.first, chain.count - chain.first - 1
    return {near for node in nodes for near in range(max(low, node - chain.wide), min(high, node + chain.wide) + 1)}
