"""Memories of past forces by which the ground of a scene is damped."""

from collections.abc import Callable

import numpy as np

from dembound.damping import Attenuation, factors_of
from dembound.disks.body import DiskBody
from dembound.disks.contacts.layout import Rows, elastic_constants
from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.damped import remember_crossing
from dembound.kernels.tables.contacts import LaneRows
from dembound.kernels.tables.grid import Crossing, Drag, Memories, NoDrag, TieMemories
from dembound.motion.part import Tie
from dembound.motion.state import Arrays, Layout, aligned_zeros


class DiskMemories:
    """Memories of the contact forces on the disks of a part.

    Parameters
    ----------
    factors : (layers, 2, K) see `factors_of`. layer : (m,) number of the layer of each disk. rows : their contacts.
    nodes : their range among the scene's nodes. layout : the slots of these. supported : (k,) ascending slots of all
    supported nodes. crossing : memories of contacts between layers. drag : on the disks.
    """

    def __init__(
        self,
        factors: np.ndarray,
        layer: np.ndarray,
        rows: Rows,
        nodes: slice,
        layout: Layout,
        supported: np.ndarray,
        crossing: Crossing,
        drag: Drag | NoDrag,
    ) -> None:
        slot = layout.slot[nodes]
        block = int(slot.min()) // LANES
        end = int(rows.group_block[-1]) if isinstance(rows, LaneRows) else -(-(int(slot.max()) + 1) // LANES)
        self._slot, self._count = slot - LANES * block, factors.shape[2]
        layers = np.zeros(LANES * (end - block), dtype=np.uint8)
        layers[self._slot] = layer
        kinds, kind = np.unique(layers.view(np.uint64), return_inverse=True)  # of blocks: eight layers
        each = np.moveaxis(factors[kinds.view(np.uint8).reshape(-1, LANES)], 1, -1)
        own = aligned_zeros(*each.shape)
        own[...] = each
        special = np.zeros(-(-layout.count // LANES), dtype=np.uint8)
        special[np.union1d(supported, crossing.target) // LANES] = 1
        self.arrays = Memories(
            mechanisms=tuple(np.zeros(self._count).tolist()),
            block=block,
            kind=np.concatenate([np.zeros(block), kind.ravel()]).astype(np.uint32),
            special=special,
            factors=own.reshape(-1),
            memory=aligned_zeros(3 * self._count * LANES * (end - block)),
            rest=np.zeros((3, 0)),
            force=aligned_zeros(3, layout.count),
            held=np.zeros(1),
            fading=np.zeros(1, dtype=np.uint8),
            crossing=crossing,
            drag=drag,
        )

    def rest_at(self, u: np.ndarray, force: np.ndarray) -> None:
        """Remember only differences from contact forces (3, slots) at rest, at displacements u (3, slots)."""
        crossing = self.arrays.crossing
        memory, factors = np.zeros((len(crossing.target), 3, 1)), np.zeros((len(crossing.target), 2, 1))
        factors[:, 1] = 1.0
        rest = np.zeros_like(crossing.rest)
        remember_crossing(crossing._replace(factors=factors, memory=memory, rest=np.zeros_like(rest), taken=rest), u, u)
        self.arrays = self.arrays._replace(rest=force, crossing=crossing._replace(rest=rest))

    @property
    def _blocks(self) -> np.ndarray:
        """The memories (blocks, 3, K, 8), a view."""
        return self.arrays.memory.reshape(-1, 3, self._count, LANES)

    def saved_arrays(self) -> Arrays:
        """The memories (m, 3, K) of the disks, and (t, 3, K) of contacts between layers."""
        block, lane = np.divmod(self._slot, LANES)
        return {"memory": self._blocks[block, :, :, lane], "crossing": self.arrays.crossing.memory}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        block, lane = np.divmod(self._slot, LANES)
        self._blocks[block, :, :, lane] = saved["memory"]
        self.arrays.crossing.memory[...] = saved["crossing"]


class DampedTies(Tie):
    """Memories of the forces of all ties of a scene; the last of its ties.

    Parameters
    ----------
    nodes : (t,) on which ties act, ascending. factors : (t, 2, K) of each, see `factors_of`.
    """

    name = "damped_ties"
    evolving = ("_memory",)

    def __init__(self, nodes: np.ndarray, factors: np.ndarray) -> None:
        self.nodes, self._factors = nodes, factors
        self._memory = np.zeros((len(nodes), 3, factors.shape[2]))
        self._rest = np.zeros((len(nodes), 3))

    def bundle(self, supported: np.ndarray) -> TieMemories:
        """The arrays of the tie for the kernels; supported (s,) are all nodes of the support table, ascending."""
        return TieMemories(np.searchsorted(supported, self.nodes), self._factors, self._memory, self._rest)

    def rest_at(self, force: np.ndarray) -> None:
        """Remember only differences from these forces (3, n) of ties on all nodes at rest."""
        self._rest = np.ascontiguousarray(force[:, self.nodes].T)


def layers_of(scene: DiskBody, nodes: np.ndarray) -> tuple[list[Attenuation | None], np.ndarray]:
    """The mechanisms of every layer of the ground, None for undamped ones, and the layer (k,) of some nodes (k,)."""
    ground = scene.ground
    return list(ground.mechanisms_by_layer), ground.layer_of(scene.positions[nodes]).astype(np.uint8)


def unrelaxed(scene: DiskBody) -> np.ndarray:
    """Unrelaxed stiffness of the ground of every disk (n,) over that of the given wave speeds."""
    layers, layer = layers_of(scene, np.arange(scene.disk_count))
    return np.array([1.0 if each is None else each.unrelaxed for each in layers])[layer]


def disk_memories(
    scene: DiskBody, nodes: slice, rows: Rows, supported: np.ndarray, time_step: float
) -> DiskMemories | None:
    """Memories of the disks of a part, for steps of this length (s); None in undamped ground, or where bonds have arms.

    supported : (k,) slots of all supported nodes.
    """
    layers, layer = layers_of(scene, np.arange(nodes.start, nodes.stop))
    if scene.ground.relaxes or not any(layers):
        return None
    factors, crossing = factors_of(layers, time_step), _crossing(scene, nodes, time_step)
    drag = _drag(scene, nodes, supported, time_step)
    return DiskMemories(factors, layer, rows, nodes, scene.layout, supported, crossing, drag)


def drag_rates(scene: DiskBody) -> np.ndarray:
    """Drag α (n,) 1/s of all nodes of a scene; (0,) if there is none."""
    layers, layer = layers_of(scene, np.arange(scene.count))
    rates = np.array([0.0 if each is None else each.drag for each in layers])
    return rates[layer] if rates.any() else np.zeros(0)


def _drag(scene: DiskBody, nodes: slice, supported: np.ndarray, time_step: float) -> Drag | NoDrag:
    """Drag on the disks of a part; supported : (k,) slots of all supported nodes."""
    rates, layout = drag_rates(scene)[nodes], scene.layout
    if len(rates) == 0:
        return NoDrag()
    slot, share, half = layout.slot[nodes], aligned_zeros(layout.count), aligned_zeros(2, layout.count)
    share[:] = 1.0
    share[slot] = 1.0 / (1.0 + 0.5 * time_step * rates)
    share[supported] = 1.0
    half[:, slot] = 0.5 * rates * np.stack([scene.mass[nodes], scene.inertia[nodes]])
    return Drag(share, half, np.zeros((3, layout.count)))


def growing_by_lag(scene: DiskBody, lags: np.ndarray, time_step: float) -> Callable[[np.ndarray, np.ndarray], None]:
    """What Rayleigh damping adds to contact forces (3, slots) of motions that change their sign in every step.

    lags : β (layers,) s of all layers. Forces of the second memory only: those of the first one cancel.
    """
    _, layer = layers_of(scene, np.arange(scene.disk_count))
    factor = scene.layout.spread(1.0 + 2.0 / time_step * lags[layer])
    crossings = [_crossing(scene, nodes, time_step) for nodes in scene.parts.values()]
    for crossing in crossings:
        crossing.factors[:, 1, ::2] = 0.0
        crossing.factors[crossing.target != crossing.owner] = 0.0  # forces across a seam do not act back

    def grow(u: np.ndarray, force: np.ndarray) -> None:
        force *= factor
        for crossing in crossings:
            crossing.memory[...] = 0.0
            remember_crossing(crossing, u, u)
            np.subtract.at(force.T, crossing.target, crossing.taken)

    return grow


def _crossing(scene: DiskBody, nodes: slice, time_step: float) -> Crossing:
    """Memories of the contacts of a part's disks between layers of unlike damping, also of those across a seam."""
    target, owner, neighbour, end = _contacts(scene, nodes)
    layers, layer = layers_of(scene, np.arange(scene.disk_count))
    number = np.array([layers.index(each) for each in layers])[layer]  # equal for layers of equal damping
    chosen = np.flatnonzero(number[owner] != number[neighbour])
    chosen = chosen[np.lexsort((neighbour[chosen], layer[neighbour[chosen]], owner[chosen], target[chosen]))]
    target, owner, neighbour, end = (each[chosen] for each in (target, owner, neighbour, end))
    keys = np.stack([target, owner, layer[neighbour]])
    first = np.flatnonzero(np.append(True, (keys[:, 1:] != keys[:, :-1]).any(axis=0))[: len(target)])
    each, count = factors_of(layers, time_step), len(first)
    factors = np.zeros((count, 2, 2 * each.shape[2]))
    own, other = layer[owner[first]], layer[neighbour[first]]
    factors[:, 0] = np.concatenate([each[own, 0], each[other, 0]], axis=1)
    share = shares_of_others(scene.ground, scene.positions[owner[first]], scene.positions[neighbour[first]])
    factors[:, 1] = share[:, None] * np.concatenate([-each[own, 1], each[other, 1]], axis=1)
    constants, row_of = elastic_constants(scene.inside) if count else (np.zeros((0, 6)), np.zeros(0, dtype=np.int64))
    slot = scene.layout.slot
    start = np.append(first, len(target))
    start, near, row = (each.astype(np.uint32) for each in (start, slot[neighbour], row_of[end]))
    memory, rest, taken = np.zeros((count, 3, factors.shape[2])), np.zeros((count, 3)), np.zeros((count, 3))
    target, owner = slot[target[first]], slot[owner[first]]
    return Crossing(target, owner, start, near, row, constants, factors, memory, rest, taken, np.zeros(1))


def _contacts(scene: DiskBody, nodes: slice) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Ends of contacts that act on disks of a part: the disk, that which has it, its neighbour, and 2·type + end."""
    part = scene.assembly.part(nodes)
    first, second = part.pairs.T.astype(np.int64) + nodes.start
    owner, neighbour = np.concatenate([first, second]), np.concatenate([second, first])
    end = np.concatenate([2 * part.contact_type, 2 * part.contact_type + 1])
    target = owner
    for seam in scene.seams if nodes.start == scene.column_count else ():
        beside = np.repeat(seam.node, seam.contact_counts)
        target, owner = np.concatenate([target, beside]), np.concatenate([owner, seam.twin[beside]])
        neighbour = np.concatenate([neighbour, seam.neighbour])
        end = np.concatenate([end, 2 * seam.contact_type + seam.twin_is_second])
    return target, owner, neighbour, end


def shares_of_others(ground: PackedMaterial, places: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Share k₁/(k₁ + k₂) of the other layer's damping in contacts of disks at places (k, 2) m with those at others."""
    number, shares = ground.pairing_of(places, others), np.zeros(len(places))
    for each in np.unique(number).tolist():
        one, other = (ground.stiffness_of((zone, zone)) for zone in ground.pairings[each])
        own, beyond = (float((each.normal + each.shear).sum()) for each in (one, other))
        shares[number == each] = own / (own + beyond)
    return shares


def ties_remembering(scene: DiskBody, tied: np.ndarray, time_step: float) -> DampedTies | None:
    """Memories of the forces of ties on nodes (t,), some of them several times; None without ties or damping."""
    nodes = np.unique(tied)
    layers, layer = layers_of(scene, nodes)
    if len(nodes) == 0 or not any(layers):
        return None
    return DampedTies(nodes, factors_of(layers, time_step)[layer])
