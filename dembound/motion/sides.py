"""The sides of a run: their mean displacements, and the forces from outside on their nodes.

Sides are those of the scene of the case. Each node of a smaller scene stepped in its place represents
several nodes, and the forces on these are computed from its motion.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from dembound.boundaries.support import Edge, Shares
from dembound.kernels import sides as kinds
from dembound.kernels import tables
from dembound.motion.part import System
from dembound.motion.scene import Scene
from dembound.motion.supports import NodeSupports


class _Batch(NamedTuple):
    """Elements of one kind and component of one side, see `tables.Sides`; lines of the support table (e,)."""

    kind: int
    side: int
    component: int
    signal: int
    line: np.ndarray
    constant: np.ndarray
    follow: np.ndarray
    column: np.ndarray
    leaves: bool = False


class Samples(NamedTuple):
    """Samples of the sides at each `every`-th step; `first` samples were taken earlier.

    record : (rows, s, 5) mean displacement, since the start, and force of every side, see `tables.Sides`.
    """

    every: int
    first: int
    record: np.ndarray

    @classmethod
    def between(cls, step: int, later: int, every: int, sides: int) -> Samples:
        """Empty rows for the steps from `step` on and before `later`; none if every is 0."""
        first, last = (-(-of // max(1, every)) for of in (step, later))
        return cls(every, first, np.empty((last - first if every > 0 else 0, sides, 5)))

    def before(self, later: int) -> Samples:
        """Rows of the steps before a step, such as the last one done."""
        return self._replace(record=self.record[: max(0, -(-later // max(1, self.every)) - self.first)])

    @property
    def steps(self) -> np.ndarray:
        """Steps of the rows, (rows,)."""
        return self.every * (self.first + np.arange(len(self.record)))


class NodeSides:
    """The sides of a scene for the kernels.

    Parameters
    ----------
    scene : the scene that is stepped.
    supports : its support table.

    Attributes
    ----------
    names : of the sides, in the order of the record. has_loads : whether loads follow a wave.
    """

    def __init__(self, scene: Scene, supports: NodeSupports) -> None:
        whole = scene.whole
        self._sides = whole.sides
        self.names = list(self._sides)
        shares = whole.supports.shares
        of_sides = 0 if shares is None else int(np.count_nonzero(shares.signal >= 0))
        self.has_loads = len(whole.supports.drive_row) > of_sides
        self._like = scene.widened("node", np.arange(scene.count))
        self._scene, self._whole, self._nodes = scene, whole, supports.nodes
        self._members: list[tuple[np.ndarray, np.ndarray]] = []
        self._origin: tuple[np.ndarray, np.ndarray] | None = None
        for edge in self._sides.values():
            self._members.append(self._mean(whole.case.side(edge.side).part_of(edge)))
        self._bearers = _bearers(list(self._sides.values()), whole.forces_by_side)
        batches = list(self._batches())
        self._springs = [batch for batch in batches if batch.kind == kinds.SPRING]
        self._table = self._laid_out(batches)

    def table(self, signals: np.ndarray, system: System, samples: Samples, work: np.ndarray) -> tables.Sides:
        """The arrays for steps with these signals (steps, q) of the table; samples and work (2, s, 2) are filled."""
        table, offset = self._table, np.zeros((len(self.names), 2))
        if system.turning is not None:  # then steady forces are loads and rotated balancing forces
            table, offset = self._bearing(table), self._borne(-system.load)
        elif system.balancing_force is not None:
            offset = self._borne(system.balancing_force)
        table = table._replace(borne=system.borne(self._nodes))
        every, first, record = samples
        return table._replace(offset=offset, signals=signals, every=every, first=first, record=record, work=work)

    def origin(self, datum: np.ndarray) -> np.ndarray:
        """Mean displacement (s, 3) of every side at the start, displacements (3, n)."""
        if self._origin is None or self._origin[0] is not datum:
            # copies, row after row in memory, have one order of terms in their sums
            each = [(weight * datum[:, node].copy()).sum(axis=1) for node, weight in self._members]
            self._origin = datum, np.array(each).reshape(-1, 3)
        return self._origin[1]

    def stored(self, u: np.ndarray, datum: np.ndarray) -> np.ndarray:
        """Energy (s,) J in the springs of every side at displacements u (3, slots), from rest at datum (3, n)."""
        stored, slot = np.zeros(len(self.names)), self._scene.layout.slot
        for batch in self._springs:
            node = self._nodes[batch.line]
            stretch = u[batch.component, slot[node]] - datum[batch.component, node]
            stored[batch.side] += 0.5 * float(np.sum(batch.constant * stretch**2))
        return stored

    def _borne(self, force: np.ndarray) -> np.ndarray:
        """Parts (s, 2) N of steady forces (3, n) N that belong to each side."""
        return np.array([(share * force[:2, node]).sum(axis=1) for node, share in self._bearers])

    def _bearing(self, table: tables.Sides) -> tables.Sides:
        """The table with the nodes' shares of steady forces added."""
        slot = self._scene.layout.slot
        share = np.concatenate([share for _, share in self._bearers], axis=1)
        return table._replace(
            bearer_start=np.cumsum([0, *(len(node) for node, _ in self._bearers)]),
            bearer=np.concatenate([slot[node] for node, _ in self._bearers]),
            share=np.ascontiguousarray(share),  # for columns in order the loop would be compiled again
        )

    def _mean(self, edge: Edge) -> tuple[np.ndarray, np.ndarray]:
        """Nodes (m,) and weights (m,) of the mean displacement of a side; by share of its diameters."""
        node, member = np.unique(self._like[edge.nodes], return_inverse=True)
        return node, np.bincount(member, edge.diameters / edge.diameters.sum(), len(node))

    def _batches(self) -> Iterator[_Batch]:
        """All batches, side by side."""
        shares = self._whole.supports.shares
        for number, (name, edge) in enumerate(self._sides.items()):
            tied = self._whole.tied.get(name, np.zeros(0, dtype=np.int64))
            batches: list[_Batch] = []
            if shares is not None:
                batches += self._of_supports(number, edge, np.union1d(edge.nodes, tied), shares)
            borne, share = self._whole.borne.get(name, (np.zeros(0, dtype=np.int64), np.zeros((0, 2))))
            for component in range(2):
                batches += self._split(kinds.BORNE, number, component, -1, borne, share[:, component])
            for component in range(3):
                batches += self._split(kinds.TIED, number, component, -1, tied, np.ones(len(tied)))
            if shares is not None and name in shares.power:
                # the power of waves that enter by forces only, given as a signal
                none, nothing = np.zeros(0, dtype=np.int64), np.zeros(0)
                yield _Batch(kinds.POWER, number, 0, shares.power[name], none, nothing, nothing, none)
                batches = [batch._replace(leaves=True) for batch in batches]
            yield from batches

    def _of_supports(self, number: int, edge: Edge, nodes: np.ndarray, shares: Shares) -> Iterator[_Batch]:
        """The batches of one side: its contributions to the rows of the support table at nodes (k,)."""
        if edge.side not in shares.sides:
            return
        own = (shares.side == shares.sides.index(edge.side)) & np.isin(shares.node, nodes)
        for call in np.unique(shares.call[own]):
            rows = np.flatnonzero(own & (shares.call == call))
            node, component = shares.node[rows], int(shares.component[rows[0]])
            signal, incident = int(shares.signal[rows[0]]), bool(shares.incident[rows[0]])
            damping, follow, stiffness = shares.damping[rows], shares.follow[rows], shares.stiffness[rows]
            if shares.prescribed[rows].any():
                node = node[shares.prescribed[rows]]
                yield from self._split(kinds.PRESCRIBED, number, component, -1, node, self._times(component, node))
                continue
            through = signal if incident else -1
            if follow.any():
                yield from self._split(kinds.FOLLOWING, number, component, through, node, damping, follow)
            elif damping.any():
                yield from self._split(kinds.DASHPOT, number, component, through, node, damping)
            if stiffness.any():
                yield from self._split(kinds.SPRING, number, component, -1, node, stiffness)
            if signal >= 0 and not incident:
                column = shares.signal[rows]
                yield from self._split(kinds.DRIVE, number, component, -1, node, shares.drive[rows], column=column)

    def _times(self, component: int, node: np.ndarray) -> np.ndarray:
        """Mass, or moment of inertia, of nodes (k,) of the whole scene over that of the node stepped in their place."""
        whole, own = ((each.inertia if component == 2 else each.mass) for each in (self._whole, self._scene))
        return whole[node] / own[self._like[node]]

    def _split(
        self,
        kind: int,
        number: int,
        component: int,
        signal: int,
        node: np.ndarray,
        constant: np.ndarray,
        follow: np.ndarray | None = None,
        column: np.ndarray | None = None,
    ) -> Iterator[_Batch]:
        """Elements at nodes (k,) of the whole scene with constants (k,) as batches of lines of the support table.

        Nodes that have no supported counterpart in a smaller scene have no force on them. column : (k,) of the signals
        of drives.
        """
        follow = np.zeros(len(node)) if follow is None else follow
        column = np.full(len(node), -1) if column is None else column
        stepped = self._like[node]
        line = np.searchsorted(self._nodes, stepped).clip(max=max(0, len(self._nodes) - 1))
        is_there = self._nodes[line] == stepped if len(self._nodes) else np.zeros(len(node), dtype=np.bool_)
        if is_there.any():
            alike = np.stack([line[is_there], column[is_there]])
            (lines, columns), element = np.unique(alike, axis=1, return_inverse=True)
            sums = [np.bincount(element.ravel(), values[is_there], len(lines)) for values in (constant, follow)]
            yield _Batch(kind, number, component, signal, lines, sums[0], sums[1], columns)

    def _laid_out(self, batches: list[_Batch]) -> tables.Sides:
        """All batches and members in one table."""
        columns: dict[str, Any] = {}
        for name in ("kind", "side", "component", "signal", "leaves"):
            kind: Any = np.bool_ if name == "leaves" else np.int64
            columns[name] = np.array([getattr(batch, name) for batch in batches], dtype=kind)
        for name in ("line", "column", "constant", "follow"):
            kind = np.int64 if name in ("line", "column") else np.float64
            columns[name] = np.concatenate([np.zeros(0, kind), *(getattr(b, name) for b in batches)]).astype(kind)
        nodes = [self._scene.layout.slot[node] for node, _ in self._members]
        return tables.NO_SIDES._replace(
            **columns,
            start=np.cumsum([0, *(len(batch.line) for batch in batches)]),
            member_start=np.cumsum([0, *(len(node) for node in nodes)]),
            member=np.concatenate([np.zeros(0, np.int64), *nodes]),
            weight=np.concatenate([np.zeros(0), *(weight for _, weight in self._members)]),
            bearer_start=np.zeros(len(nodes) + 1, dtype=np.int64),
        )


def _bearers(
    edges: list[Edge], known: Mapping[str, tuple[np.ndarray, np.ndarray, np.ndarray]]
) -> list[tuple[np.ndarray, np.ndarray]]:
    """For each side nodes (q,) and the shares (2, q) of the steady forces on them, along x and y, that belong to it.

    The force on a node of several sides is the sum of the forces that each side would exert with the mean traction of
    its other nodes, which are on no other side, and of a rest, which belongs to the side along whose normal it is.
    Under a uniform stress there is no rest. known : by side, nodes (k,), forces (2, k) N on them, in proportion to
    which sides share nodes, and recorded forces (2, k) N; empty where they are not known.
    """
    node = np.unique(np.concatenate([np.zeros(0, np.int64), *(edge.nodes for edge in edges)]))
    on = np.array([np.isin(node, edge.nodes) for edge in edges]).reshape(len(edges), len(node))
    diameter = np.zeros(len(node))
    for edge in edges:
        diameter[np.searchsorted(node, edge.nodes)] = edge.diameters
    alone = on & (on.sum(axis=0) == 1)
    traction = alone / np.maximum((alone * diameter).sum(axis=1), np.finfo(float).tiny)[:, None]
    share = np.stack([_of_rest(on, np.array([edge.axis == axis for edge in edges])) for axis in range(2)], axis=1)
    if known:
        share = _in_proportion(share, [known[edge.side] for edge in edges], node)
    shared = on[:, (on.sum(axis=0) > 1) & (not known)]
    for sides in np.unique(shared, axis=1).T:
        width = diameter[(on == sides[:, None]).all(axis=0)].sum()
        if alone[sides].any(axis=1).all():
            for axis in range(2):
                rest = _of_rest(sides[:, None], np.array([edge.axis == axis for edge in edges]))
                share[:, axis] += width * (sides[:, None] * traction - rest * traction[sides].sum(axis=0))
    return [(node[(of != 0.0).any(axis=0)], of[:, (of != 0.0).any(axis=0)]) for of in share]


def _in_proportion(
    share: np.ndarray, known: list[tuple[np.ndarray, np.ndarray, np.ndarray]], node: np.ndarray
) -> np.ndarray:
    """Shares (s, 2, q) of nodes (q,) by known forces of sides, recorded over acting ones; unchanged without any."""
    forces, total = np.zeros_like(share), np.zeros_like(share[0])
    for row, (nodes, acting, shown) in zip(forces, known, strict=True):
        here = np.searchsorted(node, nodes)
        row[:, here] = shown
        total[:, here] += acting
    return np.asarray(np.divide(forces, total, out=share.copy(), where=total != 0.0))


def _of_rest(on: np.ndarray, across: np.ndarray) -> np.ndarray:
    """Shares (s, q) by side of the rest of a force component on nodes; on (s, q): which nodes are on which side.

    across : (s,) bool, sides whose normal is along the component. Where a node has none, all its sides share equally.
    """
    chosen = on & across[:, None]
    chosen = np.where(chosen.any(axis=0), chosen, on)
    return chosen / chosen.sum(axis=0)
