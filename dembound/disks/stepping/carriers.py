"""The forces inside a scene of disks at rest, and the disks at each side that carry those of the ground beyond."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from dembound.boundaries.edge import OPPOSITE, SIDES, normal_axis
from dembound.disks.body import DiskBody
from dembound.disks.columns import COLUMNS
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.faces.tie import JointTie
from dembound.disks.stepping.scene_parts import DiskParts, contact_lists, disks_on_foot
from dembound.disks.stepping.walls import WallPart
from dembound.packings.cut import cut_contacts


class RestForces:
    """Forces and moments (3, n) N and N·m on all nodes of a scene at rest at some displacements (3, n) m and rad.

    Parameters
    ----------
    scene : the scene. disks : its parts of disks, whose contacts keep the last forces computed. joints : of the scene.
    walls : its walls, as further contacts; None: there are none.
    """

    def __init__(
        self, scene: DiskBody, disks: DiskParts, joints: Sequence[JointTie], walls: WallPart | None = None
    ) -> None:
        self._scene, self._disks, self._joints, self._walls = scene, disks, joints, walls

    def elastic(self, displacement: np.ndarray) -> np.ndarray:
        """Forces (3, n) of contacts and of the seam under the elastic law."""
        force = np.zeros_like(displacement)
        for part in self._disks.parts:
            force[:, part.nodes] += part.elastic_forces(displacement)[:, part.layout.slot[part.nodes]]
        for tie in self._disks.seams:
            force[:, tie.nodes] += tie.elastic_forces(displacement)
        return force

    def with_history(self, displacement: np.ndarray, *, fresh: bool) -> np.ndarray:
        """Forces (3, n) of contacts and of the seam under the history-dependent law.

        fresh : contacts have no history yet, and are first set to the state of the elastic law.
        """
        if fresh:
            self._disks.adopt(displacement)
        for pairs in self._disks.contacts.values():
            pairs.push(displacement)
        if self._walls is not None:
            self._walls.push(displacement)
        return self.last(self._disks.contacts)

    def as_built(self) -> np.ndarray:
        """Forces (3, n) of contacts and of the seam under the stress at rest, whatever friction and strength are."""
        contacts = self._disks.contacts or contact_lists(self._scene)
        for pairs in contacts.values():
            pairs.push(np.zeros((3, self._scene.count)), reference=True)
        return self.last(contacts)

    def last(self, contacts: Mapping[str, ContactList]) -> np.ndarray:
        """The last forces of the pairs of each part by name, and the forces across the seam that belong to them."""
        force = np.zeros((3, self._scene.count))
        for pairs in contacts.values():
            pairs.add_forces(force)
        if self._walls is not None:
            self._walls.add_forces(force)
        return force + self.across(contacts)

    def across(self, contacts: Mapping[str, ContactList]) -> np.ndarray:
        """The forces that act through the seam of a free field, from the last forces of the column's pairs."""
        force = np.zeros((3, self._scene.count))
        for tie in self._disks.seams:
            if contacts:
                force[:, tie.nodes] += tie.last_forces(contacts[tie.column.name])
        return force

    def of_ties(self, displacement: np.ndarray) -> np.ndarray:
        """Forces (3, n) of the ties to continua."""
        scene = self._scene
        force, u = np.zeros_like(displacement), scene.layout.spread(displacement)
        for each in scene.continua:
            each.add_tie_forces(scene.layout, u, force)
        if scene.feet:
            disks = disks_on_foot(scene)
            force[:, disks] += force[:, scene.seams[0].twin[disks]]
        return force

    def of_joints(self, displacement: np.ndarray) -> np.ndarray:
        """Forces (3, n) of the joints."""
        return sum((joint.force_at(displacement) for joint in self._joints), np.zeros_like(displacement))

    def shift(self, datum: np.ndarray) -> np.ndarray:
        """Forces that shift the zero of the springs of supports, and of the ties to continua, to a datum (3, n)."""
        return self._scene.supports.springs_at(datum) - self.of_ties(datum)


STANDS = 0.5
"""Share of the forces at a side that acted on disks which are left, for these to carry what the others did."""

BEARS = 1e-2
"""Force at rest, over the largest one, below which it does not count."""


class Carrier(NamedTuple):
    """The disks of one part at one of its sides.

    side, part : names. nodes : (k,) ascending; share : (3, k) of the force and moment on each that belongs to this
    side: at a corner each side has the force along its normal. turns : whether the part can turn, so that torques about
    the middle of a side are carried. disks : all of the part.
    """

    side: str
    part: str
    nodes: np.ndarray
    share: np.ndarray
    turns: bool
    disks: slice


def carriers_of(scene: DiskBody) -> list[Carrier]:
    """The carriers of all parts of a scene: disks exposed at a side, tied there, or with contacts beyond it."""
    found = []
    for name, nodes in scene.parts.items():
        part, upright = scene.assembly.part(nodes), name in COLUMNS
        periodic = (True, False) if upright else scene.case.periodic
        cut = cut_contacts(scene.ground.brick, part, SIDES[2:] if upright else tuple(scene.edges), periodic)
        at = {}
        for side, edge in scene.edges.items():
            own = np.concatenate([edge.nodes, scene.tied.get(side, edge.nodes[:0])])
            beyond = nodes.start + cut.node[cut.side == SIDES.index(side)]
            own = np.unique(np.concatenate([own[(own >= nodes.start) & (own < nodes.stop)], beyond]))
            if len(own):
                at[side] = own
        found += [
            Carrier(side, name, own, share, not any(periodic), nodes)
            for (side, own), share in zip(at.items(), _shares(at, nodes.stop), strict=True)
        ]
    return found


def _shares(at: dict[str, np.ndarray], count: int) -> list[np.ndarray]:
    """Shares (3, k) of each side in the forces and moments on its disks, see `Carrier`; at : disks (k,) by side."""
    along = np.zeros((2, count))  # sides of each disk by the axis of their normal
    for side, own in at.items():
        along[normal_axis(side), own] += 1.0
    found = []
    for side, own in at.items():
        axis, every = normal_axis(side), along[:, own].sum(axis=0)
        share = np.repeat(1.0 / every[None], 3, axis=0)
        corner = every > along[axis, own]
        share[axis, corner] = 1.0 / along[axis, own][corner]
        share[1 - axis, corner] = 0.0
        found.append(share)
    return found


def carried(
    carriers: list[Carrier],
    lost: np.ndarray,
    places: np.ndarray,
    ended: np.ndarray,
    loose: np.ndarray,
    size: np.ndarray,
    stands: np.ndarray,
) -> np.ndarray:
    """Forces and moments (3, n) on the remaining disks of each side in place of those lost (3, n) at that side.

    places : (2, n) m. ended : (n,) disks that carry nothing any more; loose : (n,) disks that carry no moments; size :
    (n,) N of the forces at the start. What disks carried inside the body goes to the remaining ones of all sides of
    their part. stands : (c,) whether each carrier still carries, see `standing`.
    """
    change = np.zeros_like(lost)
    for part in dict.fromkeys(each.part for each in carriers):
        own = [each for each in carriers if each.part == part]
        nodes = np.unique(np.concatenate([each.nodes for each in own]))
        everywhere = own[0]._replace(nodes=nodes, share=np.ones((3, len(nodes))))
        inside = np.zeros_like(lost)
        inside[:, everywhere.disks] = lost[:, everywhere.disks]
        inside[:, nodes] = 0.0
        for each, is_there in zip(carriers, stands, strict=True):
            if each.part == part and is_there:
                if ended[each.nodes].all():  # a side without forces at rest
                    inside += on_side(each, lost)
                else:
                    change += _share_out(on_side(each, lost), each, places, ended, loose, size)
        if not ended[nodes].all():
            change += _share_out(inside, everywhere, places, ended, loose, size)
    return change


def standing(carriers: list[Carrier], ended: np.ndarray, begun: np.ndarray) -> np.ndarray:
    """Whether each carrier (c,) still carries: enough of it has not ended (n,), and of the opposite side.

    Enough is `STANDS` of the forces (3, n) N that acted at the start; sides without forces always stand.

    On few disks the forces of a side would be a motor, and those of the opposite side, with which they were in balance,
    would push the body away.
    """
    left, all_of = np.array([_sizes(each, ended, begun) for each in carriers]).reshape(-1, 2).T
    enough = (left >= STANDS * all_of) | (all_of <= BEARS * all_of.max(initial=0.0))
    fallen = {(each.part, each.side) for each, is_there in zip(carriers, enough, strict=True) if not is_there}
    lost = [{(each.part, each.side), (each.part, OPPOSITE[each.side])} & fallen for each in carriers]
    return np.array([not each for each in lost], dtype=np.bool_)


def _sizes(carrier: Carrier, ended: np.ndarray, force: np.ndarray) -> tuple[float, float]:
    """Sums of the sizes of forces (3, n) at a side: on disks that have not ended (n,), and on all."""
    size = np.hypot(*(carrier.share * force[:, carrier.nodes])[:2])
    return float(size[~ended[carrier.nodes]].sum()), float(size.sum())


def on_side(carrier: Carrier, force: np.ndarray) -> np.ndarray:
    """The share of a carrier in forces (3, n), at its disks."""
    own = np.zeros_like(force)
    own[:, carrier.nodes] = carrier.share * force[:, carrier.nodes]
    return own


def _share_out(
    lost: np.ndarray, carrier: Carrier, places: np.ndarray, ended: np.ndarray, loose: np.ndarray, size: np.ndarray
) -> np.ndarray:
    """Equal forces (3, n) on the disks left of a carrier with the sum of those lost (3, n), and their torque.

    The torque is carried by disks of no other side, as far as none of them gets more by it than the mean size (n,) N of
    the forces at the start. In a part that cannot turn moments alone are carried, as moments on disks with bonds.
    """
    change = np.zeros_like(lost)
    if not lost.any():
        return change
    left = ~ended[carrier.nodes]
    held, share = carrier.nodes[left], carrier.share[:, left]
    share = np.where(share.sum(axis=1, keepdims=True) > 0.0, share, 1.0)
    change[:2, held] = lost[:2].sum(axis=1, keepdims=True) * (share / share.sum(axis=1, keepdims=True))[:2]
    if not carrier.turns:
        steady = held[~loose[held]]
        change[2, steady] = lost[2].sum() / max(1, len(steady))
        return change
    alone = held[(share == 1.0).all(axis=0)]
    if len(alone) > 1:
        apart = lost - change
        torque = float(np.sum(places[0] * apart[1] - places[1] * apart[0]) + apart[2].sum())
        arm = places[:, alone] - places[:, alone].mean(axis=1, keepdims=True)
        turn = np.stack([-arm[1], arm[0]])
        most = float(size[carrier.nodes].mean()) / np.hypot(*turn).max()
        change[:2, alone] += np.clip(torque / np.sum(turn**2), -most, most) * turn
    return change


def relative_work(carriers: list[Carrier], force: np.ndarray, moved: np.ndarray, ended: np.ndarray) -> np.ndarray:
    """Work (J) of forces and moments (3, n) on the disks of each carrier, less that on the mean motion of its side.

    moved : (3, n) m and rad since the forces began to act; the mean is that of disks that have not ended, (n,).
    """
    work = np.zeros(len(carriers))
    for number, (_, _, nodes, share, *_) in enumerate(carriers):
        held = nodes[~ended[nodes]]
        if len(held):
            apart = moved[:, nodes].copy()
            apart[:2] -= moved[:2, held].mean(axis=1, keepdims=True)
            work[number] = float(np.sum(share * force[:, nodes] * apart))
    return work
